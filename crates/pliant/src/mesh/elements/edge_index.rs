//! Index of the edges of each triangle, for a mesh that is edited.

use crate::held::{self, held};
use crate::ids::CallerTriangle;
use crate::mesh::edges::{firsts_of, number_of, sides};
use crate::mesh::{Bits, Topology, TrianglesAt};
use std::collections::BTreeSet;

/// Ends of an empty number: the sentinel for no edge.
pub(crate) const NO_EDGE: [u32; 2] = [u32::MAX; 2];

/// Sentinel: no number of an edge, for there are fewer.
pub(super) const UNSEEN: u32 = u32::MAX;

/// Edges of each triangle, and the place of each edge in tree order.
#[derive(Clone, Debug)]
pub(super) struct EdgeIndex {
    /// For each of the caller's triangles the edges that begin at its corners; [`UNSEEN`] where two
    /// corners are one vertex.
    pub(super) of_triangles: Vec<[u32; 3]>,
    /// Number in tree order of each of the caller's edges.
    pub(super) tree_edges: Vec<u32>,
    /// Caller's numbers of edges that are empty.
    pub(super) free: BTreeSet<u32>,
    /// Numbers in tree order that are edges no more.
    pub(super) gone: Bits,
}

impl EdgeIndex {
    /// Builds the index from sorted edges. Cost: linear, apart from a binary search among the edges
    /// at a vertex.
    pub(super) fn new(callers: &[[u32; 2]], numbers: &[u32], topology: &Topology) -> Self {
        let firsts = firsts_of(callers, topology.vertex_count());
        let number = |ends: [u32; 2]| number_of(callers, &firsts, ends).unwrap_or(UNSEEN);
        let mut tree_edges = vec![UNSEEN; callers.len()];
        for (tree_edge, &number) in (0..).zip(numbers) {
            tree_edges[number as usize] = tree_edge;
        }
        let triangles = topology.triangles().iter();
        Self {
            of_triangles: triangles
                .map(|&corners| sides(corners).map(number))
                .collect(),
            tree_edges,
            free: BTreeSet::new(),
            gone: Bits::default(),
        }
    }

    /// Finds the edge with these ends among the known edges of the triangles at its first end.
    pub(super) fn find(
        &self,
        at: &TrianglesAt,
        topology: &Topology,
        ends: [u32; 2],
    ) -> Option<u32> {
        at.of(ends[0]).find_map(|triangle| {
            let of_triangle = self.of_triangles[triangle as usize];
            let sides = sides(topology.corners(CallerTriangle(triangle)).map(|it| it.0));
            let place = sides.into_iter().position(|side| side == ends)?;
            Some(of_triangle[place]).filter(|&number| number != UNSEEN)
        })
    }
}

held!(EdgeIndex: of_triangles[], tree_edges[], gone;
    |index| held::entries::<u32>(index.free.len()));
