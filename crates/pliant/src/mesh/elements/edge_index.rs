//! Which edges triangles have, for a mesh that is edited.

use crate::held::{self, held};
use crate::ids::CallerTriangle;
use crate::mesh::edges::{firsts_of, number_of, sides};
use crate::mesh::{Bits, Topology, TrianglesAt};
use std::collections::BTreeSet;

/// The ends of a number that no edge has.
pub(crate) const NO_EDGE: [u32; 2] = [u32::MAX; 2];

/// The number of no edge: there are fewer.
pub(super) const UNSEEN: u32 = u32::MAX;

/// Which edges triangles have, and where edges are.
#[derive(Clone, Debug)]
pub(super) struct EdgeIndex {
    /// For each of the caller's triangles the edges that begin at its corners; [`UNSEEN`] where two corners are one vertex.
    pub(super) of_triangles: Vec<[u32; 3]>,
    /// For each of the caller's edges its number in tree order.
    pub(super) tree_edges: Vec<u32>,
    /// The caller's numbers that are empty.
    pub(super) free: BTreeSet<u32>,
    /// In tree order, those that are edges no more.
    pub(super) gone: Bits,
}

impl EdgeIndex {
    /// Of edges that are sorted. Cost: linear.
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

    /// The edge with these ends, of the triangles at a vertex whose edges are known.
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
