//! Refit of all boxes of a body that meets itself in one pass, where every leaf is one block.
//!
//! Every leaf meets at least itself, so boxes of all triangles are needed. The box of a leaf is
//! merged from these while they are in registers. They are quantized on the way, in the units of
//! the step before. So corners are read once.

use super::leaves::refit_block;
use super::quantize::{is_near_enough, units_of};
use super::refit::{Below, NodeRun, refit_all, refit_from_children};
use super::refitted::{Refit, Refitted};
use crate::ids::{BlockId, LeafId, WideNodeId};
use crate::kernels::extent::{self, Extent};
use crate::kernels::{BoxLanes, Coordinate, QuantizedLanes, Simd, quantize};
use crate::threads::Grain;
use crate::tree::{BoxSource, LeavesMut, NodesMut, Tree, make_block_capsules, of_degree};

/// Largest change of units since the step before, as a factor. With more, boxes quantized on the
/// way are discarded.
const CHANGED: f32 = 1.25;

/// Maker of the boxes of leaves, of their triangles, and of these quantized, for a run of wide
/// nodes of leaves.
struct Triangles<'t> {
    leaves: LeavesMut<'t>,
    /// Quantized boxes from the first leaf of `leaves` on.
    quantized: &'t mut [QuantizedLanes],
    stamp: u64,
    units: f32,
    made: usize,
}

/// Makes all boxes of nodes, and of all triangles in wide nodes of leaves.
///
/// Returns how many boxes of nodes and of triangles it made. `wide_nodes` is scratch.
pub(super) fn refit_whole<S: Coordinate>(
    refit: &Refit,
    one: &mut Refitted<S>,
    wide_nodes: &mut Vec<WideNodeId>,
) -> [u64; 2] {
    let tree = one.tree;
    let list = |wide_nodes: &mut Vec<WideNodeId>, of_leaves: bool| {
        let all = tree.with_ids();
        let listed = all.filter(|(_, wide_node)| wide_node.first_leaf.is_some() == of_leaves);
        wide_nodes.clear();
        wide_nodes.extend(listed.map(|(id, _)| id));
    };
    list(wide_nodes, true);
    let stamp = one.boxes.stamp();
    let ((nodes, stamps, capsules), leaves, quantized) = one.boxes.all_mut();
    let units = quantized.units;
    quantized
        .blocks
        .resize_with(tree.leaves.len(), Default::default);
    let mut triangles = 0;
    let made = of_degree!(nodes, boxes => {
        let end = boxes.len();
        let nodes = NodesMut::before(boxes, stamps, capsules, end).0;
        let from = Triangles { leaves, quantized: &mut quantized.blocks, stamp, units, made: 0 };
        let whole = NodeRun { run: wide_nodes, nodes, from, stamp, made: 0 };
        refit_all(refit, whole, tree, one.source, |from| triangles += from.made as u64)
    });
    let leaves = made as usize;
    one.boxes.count_reached(leaves);
    // A leaf beside an inner node has no box yet, nor have its triangles.
    let all_leaves = leaves == tree.leaves.len();
    if all_leaves {
        one.boxes.complete_leaves();
    }
    list(wide_nodes, false);
    let merged = refit_from_children(refit, one, wide_nodes);
    let now = units_of(tree, one.boxes);
    let is_near = |now: f32| units <= now * CHANGED && now <= units * CHANGED;
    if all_leaves && now.is_some_and(is_near) && is_near_enough(one.boxes, units) {
        one.boxes.complete_quantized();
    }
    let (_, quantized) = one.boxes.blocks_and_quantized();
    quantized.units = now.unwrap_or_default();
    [made + merged, triangles]
}

impl<const N: usize> Below<N> for Triangles<'_> {
    const GRAIN: Grain = Grain::WHOLE;

    fn split_before(self, wide_node: WideNodeId, tree: &Tree) -> [Self; 2] {
        let first = first_leaf(tree, wide_node);
        let place = first.index() - self.leaves.first_leaf;
        let [leaves, later_leaves] = self.leaves.split_before(first, BlockId(first.0));
        let (quantized, later) = self.quantized.split_at_mut(place);
        [(leaves, quantized), (later_leaves, later)].map(|(leaves, quantized)| Self {
            leaves,
            quantized,
            ..self
        })
    }

    /// Each leaf is a block.
    #[inline(always)]
    fn make<I: Simd, B: BoxSource>(
        &mut self,
        i: I,
        wide_node: WideNodeId,
        lanes: &mut BoxLanes<N>,
        tree: &Tree,
        source: &B,
    ) -> usize {
        let first = first_leaf(tree, wide_node);
        let count = tree.wide_node(wide_node).len();
        let place = first.index() - self.leaves.first_leaf;
        let stamps = &mut self.leaves.stamps[place..][..count];
        let blocks = &mut self.leaves.blocks[place..][..count];
        let quantized = &mut self.quantized[place..][..count];
        let mut boxes: [Extent<I>; 8] = [extent::nothing(i); 8];
        for lane in 0..count {
            let triangles = tree.leaves.triangles(first.plus(lane as u32));
            let corners = &source.shape().triangles[triangles];
            self.made += corners.len();
            boxes[lane] = refit_block(i, corners, &mut blocks[lane], source);
            quantized[lane] = quantize(i, &blocks[lane], self.units);
            stamps[lane] = self.stamp;
        }
        extent::store(boxes, count, lanes);
        for (quantized, longest) in quantized.iter_mut().zip(lanes.longest_sides()) {
            quantized.set_fits(longest, self.units);
        }
        count
    }

    fn make_capsules<B: BoxSource>(&mut self, wide_node: WideNodeId, tree: &Tree, source: &B) {
        let first = first_leaf(tree, wide_node);
        let place = first.index() - self.leaves.first_leaf;
        for lane in 0..tree.wide_node(wide_node).len() {
            let triangles = tree.leaves.triangles(first.plus(lane as u32));
            let corners = &source.shape().triangles[triangles];
            make_block_capsules(&mut self.leaves.capsules[place + lane], corners, source);
        }
    }
}

/// First leaf of a wide node of leaves.
#[inline(always)]
fn first_leaf(tree: &Tree, wide_node: WideNodeId) -> LeafId {
    let first = tree.wide_node(wide_node).first_leaf;
    first.expect("these are the wide nodes of leaves")
}
