//! Vertices that become one, and which of them may not: corners of one triangle.

use crate::mesh::components::leader;
use crate::mesh::edges::each_edge;
use std::collections::BTreeSet;

/// The place of a vertex that is not among them.
const NO_PLACE: u32 = u32::MAX;

/// The vertices at some edges, by which of them have become one. Those that share a triangle never do.
pub(super) struct Classes {
    /// The vertices, in order.
    vertices: Vec<u32>,
    /// For each of all vertices its place there, if it has one.
    places: Vec<u32>,
    /// By place: another of those that are one, or itself if it stands for them: union-find, with paths halved.
    next: Vec<u32>,
    /// Of those that stand for others: the lowest of them, and which have a triangle in common with one of them, so that they may not
    /// become one.
    lowest: Vec<u32>,
    conflicts: Vec<BTreeSet<u32>>,
}

impl Classes {
    /// Of the ends of some edges; `None` if `stop` said so on the way.
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
            next: all.clone().collect(),
            lowest: all.collect(),
            vertices,
            places,
            conflicts,
        })
    }

    /// The place that stands for a vertex.
    fn of(&mut self, vertex: u32) -> u32 {
        leader(&mut self.next, self.places[vertex as usize])
    }

    /// Whether the ends of two sides, one by one, are not all one and may become it. What they may not, they never may.
    pub(super) fn may_join(&mut self, [a, b]: [u32; 2], [x, y]: [u32; 2]) -> bool {
        let [a, b, x, y] = [a, b, x, y].map(|vertex| self.of(vertex));
        let may = |one: u32, other: u32| !self.conflicts[one as usize].contains(&other);
        [a, b] != [x, y] && may(a, x) && may(b, y)
    }

    /// Makes the ends of two sides one, if they may be. Returns whether they are.
    pub(super) fn join(&mut self, [a, b]: [u32; 2], [x, y]: [u32; 2]) -> bool {
        if self.may_join([a, b], [x, y]) {
            self.make_one(a, x);
            self.make_one(b, y);
        }
        self.of(a) == self.of(x) && self.of(b) == self.of(y)
    }

    fn make_one(&mut self, a: u32, b: u32) {
        let [a, b] = [self.of(a), self.of(b)];
        if a == b {
            return;
        }
        // The fewer are told that they have another name now.
        let is_more = self.conflicts[a as usize].len() >= self.conflicts[b as usize].len();
        let (kept, gone) = if is_more { (a, b) } else { (b, a) };
        for other in std::mem::take(&mut self.conflicts[gone as usize]) {
            let of_other = &mut self.conflicts[other as usize];
            of_other.remove(&gone);
            of_other.insert(kept);
            self.conflicts[kept as usize].insert(other);
        }
        self.next[gone as usize] = kept;
        let lowest = self.lowest[gone as usize].min(self.lowest[kept as usize]);
        self.lowest[kept as usize] = lowest;
    }

    /// Pairs of the lowest of those that are one and another of them, sorted by the other.
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
