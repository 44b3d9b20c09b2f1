//! Quantization of triangle boxes to bytes, for a body that meets itself.
//!
//! Nearly all its leaves overlap neighbours in the mesh, but touch only triangles that share a
//! vertex. Quantized boxes reject such pairs sooner (`kernels::quantized`). One unit serves all
//! leaves: a part of their mean length. Leaves that are much longer do not fit, and are never told
//! apart; much shorter ones are told apart less often. Nothing is missed either way, for the boxes
//! themselves are compared next.

use super::dirty_set::DirtySet;
use super::refitted::{Refit, Refitted};
use crate::ids::{BlockId, LeafId, NodeId};
use crate::kernels::{Coordinate, EightBoxes, FARTHEST, QuantizedLanes, dispatch, quantize};
use crate::statistics::Statistics;
use crate::threads::Grain;
use crate::tree::{BoxSet, Child, Quantized, Tree};

/// Units in the mean of the longest sides of leaves.
const UNITS: f32 = 32.0;

impl Refit<'_> {
    /// Makes the boxes of the triangles in all leaves, and quantizes them where each leaf is a
    /// block.
    ///
    /// All nodes are valid. `reached` is scratch.
    pub(crate) fn all_leaves<S: Coordinate>(
        &self,
        one: &mut Refitted<S>,
        reached: &mut DirtySet,
        statistics: &mut Statistics,
    ) {
        if !one.boxes.are_leaves_complete() {
            reached.insert_below(one.tree.leaves.len());
            self.reached_leaves(one, reached, statistics);
            one.boxes.complete_leaves();
        }
        quantize_all(self, one);
    }
}

/// Quantizes the boxes of the triangles in all leaves. All other boxes are valid.
///
/// Does nothing if leaves are not blocks, if it is done, or if they lie too far from zero.
fn quantize_all<S: Coordinate>(refit: &Refit, one: &mut Refitted<S>) {
    let tree = one.tree;
    if !tree.leaves.are_blocks() || one.boxes.quantized().is_some() {
        return;
    }
    let Some(units) = units_of(tree, one.boxes) else {
        return;
    };
    let executor = refit.executor;
    let (blocks, quantized) = one.boxes.blocks_and_quantized();
    quantized.units = units;
    let quantized = &mut quantized.blocks;
    quantized.resize_with(blocks.len(), Default::default);
    let jobs = quantized
        .chunks_mut(Grain::QUANTIZED.items)
        .zip(blocks.chunks(Grain::QUANTIZED.items));
    let make = |(quantized, blocks): &mut (&mut [QuantizedLanes], &[EightBoxes])| {
        dispatch!(refit.instructions, i => {
            for (quantized, block) in quantized.iter_mut().zip(*blocks) {
                *quantized = quantize(i, block, units);
            }
        });
    };
    executor.run_each(jobs, Grain::QUANTIZED, make, |_| {});
    if executor.is_interrupted() {
        return;
    }
    set_fits(tree, one.boxes, units);
    one.boxes.complete_quantized();
}

/// Records of each leaf whether it is short enough for its quantized boxes.
fn set_fits(tree: &Tree, boxes: &mut BoxSet, units: f32) {
    let ((nodes, ..), _, Quantized { blocks, .. }) = boxes.all_mut();
    for (id, wide_node) in tree.with_ids() {
        let count = wide_node.len();
        nodes.longest_sides(id, |lane, longest| {
            if lane < count
                && let Child::Leaf(LeafId(block)) = wide_node.child(lane)
            {
                blocks[BlockId(block).index()].set_fits(longest, units);
            }
        });
    }
}

/// Units to a length of one; `None` if quantized boxes are of no use. All nodes are valid.
pub(super) fn units_of(tree: &Tree, boxes: &BoxSet) -> Option<f32> {
    let nodes = boxes.nodes();
    let (mut sum, mut count) = (0.0, 0);
    for (id, wide_node) in tree.with_ids() {
        if wide_node.first_leaf.is_some() {
            // Unused lanes are NaN.
            nodes.longest_sides(id, |_, side| sum += side.max(0.0));
            count += wide_node.len();
        }
    }
    let units = UNITS * count as f32 / sum;
    (units.is_finite() && is_near_enough(boxes, units)).then_some(units)
}

/// Whether the whole body lies few enough units from zero.
pub(super) fn is_near_enough(boxes: &BoxSet, units: f32) -> bool {
    let all = boxes.nodes().one(NodeId::ROOT);
    let ends = all.lo.iter().chain(&all.hi);
    let farthest = ends.fold(0.0, |most: f32, x| most.max(x.abs()));
    farthest * units < FARTHEST
}
