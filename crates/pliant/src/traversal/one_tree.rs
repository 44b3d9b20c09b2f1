//! One body with itself: every pair of its triangles once, without those that share a vertex.
//!
//! A pair of one node with itself stands for the pairs within it; it expands into its children with themselves and into
//! the pairs of different children that overlap.

use super::descent::Meeting;
use super::{Side, expand, overlapping_triangles};
use crate::geometry::Scalar;
use crate::kernels::bits_of;
use crate::narrow_phase;
use crate::pairs::{Candidate, LeafPair, NodePair};
use crate::statistics::Statistics;
use crate::tree::{Below, NodeId};
use crate::update::{reach_group, reach_leaf};
use std::cmp::Ordering;

/// A tree whose root box is true.
pub(crate) struct OneTree<'t, const N: usize, S> {
    pub(crate) side: Side<'t, N, S>,
    /// How many levels are made when one is reached.
    pub(crate) levels_at_once: u32,
}

/// Of the pairs (i, j) of eight lanes, bit 8 i + j, those with j > i.
const LATER_LANES: u64 = {
    let (mut mask, mut lane) = (0, 0);
    while lane < 8 {
        mask |= (0xff << (lane + 1) & 0xff) << (8 * lane);
        lane += 1;
    }
    mask
};

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
                        group.boxes.overlaps(&group.boxes.get(lane)) & (u64::MAX << lane << 1);
                    nodes.extend(
                        bits_of(later).map(|other| [child, NodeId::new::<N>(below, other)]),
                    );
                }
            }
        }
    }

    fn reach_leaves(&mut self, pair: LeafPair, statistics: &mut Statistics) {
        let Side { tree, shape, .. } = &mut self.side;
        for leaf in pair {
            statistics.triangle_boxes += reach_leaf(tree, leaf, shape);
        }
    }

    fn blocks(&self, [leaf_a, _]: LeafPair) -> usize {
        self.side.tree.leaves.block_count(leaf_a)
    }

    fn candidates(
        &self,
        [leaf_a, leaf_b]: LeafPair,
        block: usize,
        candidates: &mut Vec<Candidate>,
    ) {
        let Side { tree, mesh, .. } = &self.side;
        let leaves = &tree.leaves;
        if leaves.have_boxes() {
            // Within one leaf, each pair of triangles once, and none with itself.
            let keep = |other: usize| match other.cmp(&block) {
                _ if leaf_a != leaf_b => u64::MAX,
                Ordering::Less => 0,
                Ordering::Equal => LATER_LANES,
                Ordering::Greater => u64::MAX,
            };
            let overlapping = overlapping_triangles(leaves, (leaf_a, block), leaves, leaf_b, keep);
            candidates.extend(overlapping.filter(|&[a, b]| !mesh.share_a_vertex(a, b)));
        } else {
            let [a, b] = [leaf_a, leaf_b].map(|leaf| leaves.triangles(leaf).start);
            // A leaf with itself is one triangle with itself, which shares its vertices.
            if !mesh.share_a_vertex(a, b) {
                candidates.push([a, b]);
            }
        }
    }

    fn decide(&self, [a, b]: Candidate, statistics: &mut Statistics) -> Option<[u32; 2]> {
        let Side { mesh, shape, .. } = &self.side;
        let id = |triangle: u32| mesh.triangle_ids()[triangle as usize];
        narrow_phase::intersect::<S>(&shape.corners(a), &shape.corners(b), statistics)
            .then(|| [id(a).min(id(b)), id(a).max(id(b))])
    }
}
