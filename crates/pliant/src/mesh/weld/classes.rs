//! Union-find over welded vertices, and which of them may not be welded: corners of one triangle.

use crate::mesh::components::find_root;
use crate::mesh::edges::each_edge;
use std::collections::BTreeSet;

/// Sentinel: a vertex that is at none of the edges.
const NO_PLACE: u32 = u32::MAX;

/// Union-find over the vertices at some edges, with conflicts: vertices that share a triangle are
/// never united.
pub(super) struct Classes {
    /// Vertices at the edges, ascending.
    vertices: Vec<u32>,
    /// For each vertex of the mesh its place in `vertices`, or [`NO_PLACE`].
    places: Vec<u32>,
    /// Union-find parent of each place; a root is its own parent.
    parents: Vec<u32>,
    /// Lowest place of the set of each root.
    lowest: Vec<u32>,
    /// For each root the roots that it may not be united with: they share a triangle with it.
    conflicts: Vec<BTreeSet<u32>>,
}

impl Classes {
    /// Begins with each end of an edge in a set of its own. Returns `None` if `stop` returned true.
    pub(super) fn new(
        triangles: &[[u32; 3]],
        count: usize,
        edges: &[[u32; 2]],
        stop: &dyn Fn() -> bool,
    ) -> Option<Self> {
        let mut places = vec![NO_PLACE; count];
        for &vertex in edges.as_flattened() {
            places[vertex as usize] = 0;
        }
        let vertices = (0..count as u32).filter(|&it| places[it as usize] == 0);
        let vertices: Vec<u32> = vertices.collect();
        for (place, &vertex) in (0..).zip(&vertices) {
            places[vertex as usize] = place;
        }
        let all = 0..vertices.len() as u32;
        let mut conflicts = vec![BTreeSet::new(); vertices.len()];
        each_edge(triangles, stop, |ends| {
            let [a, b] = ends.map(|vertex| places[vertex as usize]);
            if a != NO_PLACE && b != NO_PLACE {
                conflicts[a as usize].insert(b);
                conflicts[b as usize].insert(a);
            }
        })?;
        Some(Self {
            parents: all.clone().collect(),
            lowest: all.collect(),
            vertices,
            places,
            conflicts,
        })
    }

    /// Returns the union-find root of a vertex.
    fn of(&mut self, vertex: u32) -> u32 {
        find_root(&mut self.parents, self.places[vertex as usize])
    }

    /// Whether two sides, end by end, may be welded and are not yet. Once it is false it stays so.
    pub(super) fn may_join(&mut self, [a, b]: [u32; 2], [x, y]: [u32; 2]) -> bool {
        let [a, b, x, y] = [a, b, x, y].map(|vertex| self.of(vertex));
        let may = |one: u32, other: u32| !self.conflicts[one as usize].contains(&other);
        [a, b] != [x, y] && may(a, x) && may(b, y)
    }

    /// Welds two sides, end by end, if they may be. Returns whether their ends are one now.
    pub(super) fn join(&mut self, [a, b]: [u32; 2], [x, y]: [u32; 2]) -> bool {
        if self.may_join([a, b], [x, y]) {
            self.make_one(a, x);
            self.make_one(b, y);
        }
        self.of(a) == self.of(x) && self.of(b) == self.of(y)
    }

    /// Unites the sets of two vertices.
    fn make_one(&mut self, a: u32, b: u32) {
        let [a, b] = [self.of(a), self.of(b)];
        if a == b {
            return;
        }
        // Smaller to larger: the root with fewer conflicts is renamed in the conflicts of others.
        let is_more = self.conflicts[a as usize].len() >= self.conflicts[b as usize].len();
        let (kept, gone) = if is_more { (a, b) } else { (b, a) };
        for other in std::mem::take(&mut self.conflicts[gone as usize]) {
            let of_other = &mut self.conflicts[other as usize];
            of_other.remove(&gone);
            of_other.insert(kept);
            self.conflicts[kept as usize].insert(other);
        }
        self.parents[gone as usize] = kept;
        let lowest = self.lowest[gone as usize].min(self.lowest[kept as usize]);
        self.lowest[kept as usize] = lowest;
    }

    /// Pairs of the lowest vertex of a set and another of it, sorted by the other.
    pub(super) fn pairs(&mut self) -> Vec<[u32; 2]> {
        let mut pairs = Vec::new();
        for place in 0..self.vertices.len() {
            let vertex = self.vertices[place];
            let stands = self.of(vertex);
            let lowest = self.vertices[self.lowest[stands as usize] as usize];
            if lowest != vertex {
                pairs.push([lowest, vertex]);
            }
        }
        pairs
    }
}
