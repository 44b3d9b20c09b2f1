//! One body with itself: every pair of its triangles once, without those that share a vertex.
//!
//! A pair of one node with itself stands for the pairs within it; it expands into its children with themselves and into
//! the pairs of different children that overlap.

use super::descent::Meeting;
use super::{Side, expand, overlapping_triangles, triangle_box};
use crate::geometry::Scalar;
use crate::kernels::lanes_of;
use crate::narrow_phase;
use crate::pairs::{Candidate, LeafPair, NodePair};
use crate::statistics::Statistics;
use crate::tree::{Below, NodeId};
use crate::update::{reach_group, reach_leaf};
use std::ops::Range;

/// A tree whose root box is true.
pub(crate) struct OneTree<'t, const N: usize, S> {
    pub(crate) side: Side<'t, N, S>,
    /// How many levels are made when one is reached.
    pub(crate) levels_at_once: u32,
}

impl<const N: usize, S: Scalar> Meeting for OneTree<'_, N, S> {
    fn start(&self) -> NodePair {
        [NodeId::ROOT; 2]
    }

    fn reach(&mut self, pair: NodePair, scratch: &mut Vec<u32>, statistics: &mut Statistics) {
        let Side { tree, shape, .. } = &mut self.side;
        for node in pair {
            if let Below::Group(below) = tree.child(node).below() {
                statistics.boxes_top_down +=
                    reach_group(tree, below, self.levels_at_once, shape, scratch);
            }
        }
    }

    fn expand(&self, pair: NodePair, nodes: &mut Vec<NodePair>, leaves: &mut Vec<LeafPair>) {
        let tree = &*self.side.tree;
        let [a, b] = pair;
        if a != b {
            return expand(tree, tree, pair, nodes, leaves);
        }
        match tree.child(a).below() {
            Below::Leaf(leaf) => leaves.push([leaf, leaf]),
            Below::Group(below) => {
                let group = &tree.groups[below as usize];
                for lane in 0..group.len() {
                    let child = NodeId::new::<N>(below, lane);
                    nodes.push([child, child]);
                    let later =
                        group.boxes.overlaps(&group.boxes.get(lane)) & (u32::MAX << lane << 1);
                    nodes.extend(
                        lanes_of(later).map(|other| [child, NodeId::new::<N>(below, other)]),
                    );
                }
            }
        }
    }

    fn reach_leaves(&mut self, pair: LeafPair, statistics: &mut Statistics) {
        let Side { tree, mesh, shape } = &mut self.side;
        for leaf in pair {
            statistics.triangle_boxes += reach_leaf(tree, leaf, mesh.corners(), shape);
        }
    }

    fn rows(&self, [leaf_a, leaf_b]: LeafPair) -> Range<u32> {
        let triangles = self.side.tree.leaves.triangles(leaf_a).len() as u32;
        // The last triangle of a leaf has none after it.
        0..if leaf_a == leaf_b {
            triangles - 1
        } else {
            triangles
        }
    }

    fn candidates(&self, [leaf_a, leaf_b]: LeafPair, row: u32, candidates: &mut Vec<Candidate>) {
        let Side { tree, mesh, .. } = &self.side;
        let leaves = &tree.leaves;
        let a = leaves.triangles(leaf_a).start + row;
        if leaves.have_boxes() {
            let from = if leaf_a == leaf_b { row + 1 } else { 0 };
            let overlapping =
                overlapping_triangles(leaves, leaf_b, from, triangle_box(leaves, leaf_a, row));
            candidates.extend(
                overlapping
                    .filter(|&b| !mesh.share_a_vertex(a, b))
                    .map(|b| [a, b]),
            );
        } else {
            let b = leaves.triangles(leaf_b).start;
            if !mesh.share_a_vertex(a, b) {
                candidates.push([a, b]);
            }
        }
    }

    fn decide(&self, [a, b]: Candidate, statistics: &mut Statistics) -> Option<[u32; 2]> {
        let Side { mesh, shape, .. } = &self.side;
        let corners = |triangle: u32| shape.corners(mesh.corners()[triangle as usize]);
        let id = |triangle: u32| mesh.triangle_ids()[triangle as usize];
        narrow_phase::intersect::<S>(&corners(a), &corners(b), statistics)
            .then(|| [id(a).min(id(b)), id(a).max(id(b))])
    }
}
