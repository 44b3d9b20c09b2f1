//! Sorted edges of a mesh: a counting sort by their lower ends, then a sort of each run.
//!
//! O(m + n) for m triangles and n vertices, apart from sorting the edges at one vertex.

/// Triangles or vertices between two checks whether to stop.
pub(super) const UNINTERRUPTED: usize = 1 << 14;

/// Edges sorted by their ends, each once, the smaller end first.
pub(super) struct SortedEdges {
    pub(super) edges: Vec<[u32; 2]>,
    /// Where the edges with each lower end begin, and the end of the last: CSR offsets.
    firsts: Vec<u32>,
}

impl SortedEdges {
    /// Sorts the edges for which `is_wanted` holds, by the number of triangles that have each.
    /// Returns `None` if `stop` returned true.
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
        // The run of each vertex now ends at `next`, where the run behind it began before.
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

    /// Returns the number of the edge with these ends, if there is one.
    #[inline]
    pub(super) fn number_of(&self, ends: [u32; 2]) -> Option<u32> {
        number_of(&self.edges, &self.firsts, ends)
    }
}

/// Number of the edge with these ends among sorted edges, by binary search.
///
/// None if both ends are one vertex. `firsts` says where the edges with each lower end begin.
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

/// CSR offsets of sorted edges: where those with each lower end begin, and how many there are.
pub(super) fn firsts_of(edges: &[[u32; 2]], vertices: usize) -> Vec<u32> {
    let mut firsts = vec![0; vertices + 1];
    for [low, _] in edges {
        firsts[*low as usize + 1] += 1;
    }
    sum_up(&mut firsts);
    firsts
}

/// Prefix sum in place: each number becomes the sum of all up to it.
fn sum_up(counts: &mut [u32]) {
    let mut sum = 0;
    for count in counts {
        sum += *count;
        *count = sum;
    }
}

/// Calls `found` with the edges of all triangles, the smaller end first. Returns `None` if `stop`
/// returned true. A triangle that runs along an edge twice has it once.
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

/// Sides of a triangle that have two different ends.
#[cfg(test)]
pub(super) fn edges_of(&corners: &[u32; 3]) -> impl Iterator<Item = [u32; 2]> {
    sides(corners).into_iter().filter(|[low, high]| low != high)
}

/// Ends of the three sides of a triangle, the smaller first, from its first corner on.
///
/// A side between two equal corners has that vertex twice.
pub(super) fn sides([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)])
}
