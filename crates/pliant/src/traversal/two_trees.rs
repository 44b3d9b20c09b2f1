//! Two bodies.

use super::descent::Meeting;
use super::{Side, expand, overlapping_triangles};
use crate::geometry::Scalar;
use crate::narrow_phase;
use crate::pairs::{Candidate, LeafPair, NodePair};
use crate::statistics::Statistics;
use crate::tree::{Below, NodeId};
use crate::update::{reach_group, reach_leaf};

/// Two trees whose root boxes are true and overlap.
pub(crate) struct TwoTrees<'t, const N: usize, S> {
    pub(crate) a: Side<'t, N, S>,
    pub(crate) b: Side<'t, N, S>,
    /// How many levels are made when one is reached.
    pub(crate) levels_at_once: u32,
}

impl<const N: usize, S: Scalar> Meeting for TwoTrees<'_, N, S> {
    fn start(&self) -> NodePair {
        [NodeId::ROOT; 2]
    }

    fn reach(&mut self, pair: NodePair, scratch: &mut Vec<u32>, statistics: &mut Statistics) {
        for (side, node) in [&mut self.a, &mut self.b].into_iter().zip(pair) {
            if let Below::Group(below) = side.tree.child(node).below() {
                statistics.boxes_top_down +=
                    reach_group(side.tree, below, self.levels_at_once, &side.shape, scratch);
            }
        }
    }

    fn expand(&self, pair: NodePair, nodes: &mut Vec<NodePair>, leaves: &mut Vec<LeafPair>) {
        expand(self.a.tree, self.b.tree, pair, nodes, leaves);
    }

    fn reach_leaves(&mut self, pair: LeafPair, statistics: &mut Statistics) {
        for (side, leaf) in [&mut self.a, &mut self.b].into_iter().zip(pair) {
            statistics.triangle_boxes += reach_leaf(side.tree, leaf, &side.shape);
        }
    }

    fn blocks(&self, [leaf_a, _]: LeafPair) -> usize {
        self.a.tree.leaves.block_count(leaf_a)
    }

    fn candidates(
        &self,
        [leaf_a, leaf_b]: LeafPair,
        block: usize,
        candidates: &mut Vec<Candidate>,
    ) {
        let (leaves_a, leaves_b) = (&self.a.tree.leaves, &self.b.tree.leaves);
        if leaves_a.have_boxes() {
            let all = |_| u64::MAX;
            candidates.extend(overlapping_triangles(
                leaves_a,
                (leaf_a, block),
                leaves_b,
                leaf_b,
                all,
            ));
        } else {
            // One triangle a leaf: its box is the leaf's, which overlaps.
            candidates.push([
                leaves_a.triangles(leaf_a).start,
                leaves_b.triangles(leaf_b).start,
            ]);
        }
    }

    fn decide(&self, [a, b]: Candidate, statistics: &mut Statistics) -> Option<[u32; 2]> {
        let corners_a = self.a.shape.corners(a);
        let corners_b = self.b.shape.corners(b);
        narrow_phase::intersect::<S>(&corners_a, &corners_b, statistics).then(|| {
            [
                self.a.mesh.triangle_ids()[a as usize],
                self.b.mesh.triangle_ids()[b as usize],
            ]
        })
    }
}
