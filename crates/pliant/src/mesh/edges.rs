//! The edges of a mesh, sorted by their ends: a counting sort by the lower ends, then a sort of
//! each run.
//!
//! Linear, apart from the sorts of the edges at one vertex.

/// The number of triangles or vertices between two looks whether somebody wants to stop.
pub(super) const UNINTERRUPTED: usize = 1 << 14;

/// Edges in the order of their ends, each once, the smaller end first.
pub(super) struct SortedEdges {
    pub(super) edges: Vec<[u32; 2]>,
    firsts: Vec<u32>,
}

impl SortedEdges {
    /// The edges of which `is_wanted` says so, by how many triangles have each. `None` if `stop`
    /// said so on the way.
    pub(super) fn new(
        triangles: &[[u32; 3]],
        vertices: usize,
        is_wanted: impl Fn(usize) -> bool,
        stop: &dyn Fn() -> bool,
    ) -> Option<Self> {
        let mut next = vec![0_u32; vertices + 1];
        each_edge(triangles, stop, |[low, _]| next[low as usize + 1] += 1)?;
        sum_up(&mut next);
        let mut higher = vec![0_u32; next[vertices] as usize];
        each_edge(triangles, stop, |[low, high]| {
            let place = &mut next[low as usize];
            higher[*place as usize] = high;
            *place += 1;
        })?;
        // The run of each vertex ends now at `next`, where the run of the one behind it began.
        let mut edges = Vec::with_capacity(higher.len() / 2 + 1);
        let mut firsts = Vec::with_capacity(vertices + 1);
        let mut start = 0;
        for vertex in 0..vertices {
            firsts.push(edges.len() as u32);
            let end = next[vertex] as usize;
            let others = &mut higher[start..end];
            others.sort_unstable();
            for same in others.chunk_by(|a, b| a == b) {
                if is_wanted(same.len()) {
                    edges.push([vertex as u32, same[0]]);
                }
            }
            start = end;
            if vertex % UNINTERRUPTED == 0 && stop() {
                return None;
            }
        }
        firsts.push(edges.len() as u32);
        drop((next, higher));
        edges.shrink_to_fit();
        Some(Self { edges, firsts })
    }

    /// The number of the edge with these ends, if there is one.
    #[inline]
    pub(super) fn number_of(&self, ends: [u32; 2]) -> Option<u32> {
        number_of(&self.edges, &self.firsts, ends)
    }
}

/// The number of the edge with these ends among sorted ones; none of one vertex twice. `firsts`
/// says where the edges with each lower end begin.
#[inline]
pub(super) fn number_of(edges: &[[u32; 2]], firsts: &[u32], [a, b]: [u32; 2]) -> Option<u32> {
    if a == b {
        return None;
    }
    let [low, high] = [a.min(b), a.max(b)];
    let [first, end] = [0, 1].map(|next| firsts[low as usize + next] as usize);
    let number = first + edges[first..end].partition_point(|edge| edge[1] < high);
    (edges.get(number) == Some(&[low, high])).then_some(number as u32)
}

/// Where edges with each lower end begin, if these are in order; and how many there are.
pub(super) fn firsts_of(edges: &[[u32; 2]], vertices: usize) -> Vec<u32> {
    let mut firsts = vec![0; vertices + 1];
    for [low, _] in edges {
        firsts[*low as usize + 1] += 1;
    }
    sum_up(&mut firsts);
    firsts
}

/// Makes each number the sum of all up to it: the prefix sum.
fn sum_up(counts: &mut [u32]) {
    let mut sum = 0;
    for count in counts {
        sum += *count;
        *count = sum;
    }
}

/// Shows the edges of all triangles, the smaller end first; `None` if `stop` said so on the way.
/// One triangle that runs along an edge twice has it once.
pub(super) fn each_edge(
    triangles: &[[u32; 3]],
    stop: &dyn Fn() -> bool,
    mut found: impl FnMut([u32; 2]),
) -> Option<()> {
    for some in triangles.chunks(UNINTERRUPTED) {
        for &[a, b, c] in some {
            let mut sides = sides([a, b, c]).into_iter();
            if a != b && b != c && c != a {
                sides.for_each(&mut found);
            } else if let Some(edge) = sides.find(|[low, high]| low != high) {
                found(edge);
            }
        }
        if stop() {
            return None;
        }
    }
    Some(())
}

/// The sides of a triangle that have two different ends.
#[cfg(test)]
pub(super) fn edges_of(&corners: &[u32; 3]) -> impl Iterator<Item = [u32; 2]> {
    sides(corners).into_iter().filter(|[low, high]| low != high)
}

/// The ends of the three sides of a triangle, the smaller first, from its first corner on. A side
/// whose corners are one vertex has it twice.
pub(super) fn sides([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)])
}
