//! All boxes of a body that meets itself, in one go, where every leaf is one block.
//!
//! Every leaf meets at least itself, so the boxes of all triangles are made. A leaf's box is then that of its triangles' boxes, which
//! are still in registers, and they are quantized on the way, in the units of the step before. Corners are read once.

use super::leaves::refit_block;
use super::quantize::{is_near_enough, units_of};
use super::refit::refit_from_children;
use super::refitted::{Refit, Refitted};
use crate::ids::{BlockId, WideNodeId};
use crate::kernels::extent::{self, Extent};
use crate::kernels::{Coordinate, QuantizedLanes, Simd, dispatch, quantize};
use crate::tree::{BoxSource, LeavesMut, NodesMut, Source, Tree, of_degree, of_source};

/// Wide nodes in a job: some microseconds of work.
const JOB: usize = 4;
/// So many wide nodes, or fewer, are not worth waking a thread.
const SHARED: usize = 8 * JOB;
/// So many wide nodes are refitted before it is asked whether the query was interrupted.
const UNINTERRUPTED: usize = 256;
/// Where units have changed by more than this factor since the step before, boxes quantized on the way are of no use.
const CHANGED: f32 = 1.25;

/// A run of wide nodes of leaves, and the parts of a set of boxes that hold theirs, those of their triangles, and these quantized.
struct WholeRun<'t, const N: usize> {
    run: &'t [WideNodeId],
    nodes: NodesMut<'t, N>,
    leaves: LeavesMut<'t>,
    /// From the first leaf of `leaves` on.
    quantized: &'t mut [QuantizedLanes],
    stamp: u64,
    units: f32,
    made: usize,
    triangles: usize,
}

/// Makes all boxes of nodes, and those of all triangles whose leaves are side by side. `wide_nodes` is scratch. Returns how many boxes
/// of nodes and of triangles it made.
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
    let (nodes, stamps, leaves, quantized) = one.boxes.all_mut();
    let units = quantized.units;
    quantized
        .blocks
        .resize_with(tree.leaves.len(), Default::default);
    let [made, triangles] = of_degree!(nodes, boxes => {
        let end = boxes.len();
        let whole = WholeRun {
            run: wide_nodes,
            nodes: NodesMut::before(boxes, stamps, end).0,
            leaves,
            quantized: &mut quantized.blocks,
            stamp,
            units,
            made: 0,
            triangles: 0,
        };
        refit_runs(refit, whole, tree, one.source)
    });
    one.boxes.count_reached(made);
    // A leaf beside an inner node has no box yet, nor have its triangles.
    let all_leaves = made == tree.leaves.len();
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
    [made as u64 + merged, triangles as u64]
}

/// Makes the boxes of a run, cut into shorter ones if there are threads for them. Returns how many of leaves and of triangles it made.
fn refit_runs<const N: usize, S: Coordinate>(
    refit: &Refit,
    whole: WholeRun<'_, N>,
    tree: &Tree,
    source: &Source<S>,
) -> [usize; 2] {
    let executor = refit.executor;
    let is_worth_it = whole.run.len() > SHARED && executor.are_many();
    let work = |job: &mut WholeRun<'_, N>| {
        for run in job.run.chunks(UNINTERRUPTED) {
            if executor.is_interrupted() {
                return;
            }
            of_source!(source, source => dispatch!(refit.instructions, i => {
                for &wide_node in run {
                    job.refit(i, wide_node, tree, source);
                }
            }));
        }
    };
    let mut all = [0; 2];
    executor.run_cut(
        whole,
        is_worth_it,
        |whole| whole.cut(tree),
        work,
        |job| {
            all[0] += job.made;
            all[1] += job.triangles;
        },
    );
    all
}

impl<const N: usize> WholeRun<'_, N> {
    /// Jobs of fewer wide nodes.
    fn cut(self, tree: &Tree) -> Vec<Self> {
        let Self {
            run,
            mut nodes,
            mut leaves,
            mut quantized,
            ..
        } = self;
        let mut jobs = Vec::with_capacity(run.len().div_ceil(JOB));
        for run in run.chunks(JOB).rev() {
            let Some(first) = tree.wide_node(run[0]).first_leaf else {
                continue;
            };
            let [earlier_nodes, nodes_here] = nodes.split_before(run[0]);
            let [earlier_leaves, leaves_here] = leaves.split_before(first, BlockId(first.0));
            let (earlier, quantized_here) = quantized.split_at_mut(first.index());
            jobs.push(Self {
                run,
                nodes: nodes_here,
                leaves: leaves_here,
                quantized: quantized_here,
                stamp: self.stamp,
                units: self.units,
                made: 0,
                triangles: 0,
            });
            (nodes, leaves, quantized) = (earlier_nodes, earlier_leaves, earlier);
        }
        jobs.reverse();
        jobs
    }

    /// Makes the boxes of a wide node of leaves, each a block, and of their triangles.
    #[inline(always)]
    fn refit<I: Simd, B: BoxSource>(
        &mut self,
        i: I,
        wide_node: WideNodeId,
        tree: &Tree,
        source: &B,
    ) {
        let structure = tree.wide_node(wide_node);
        let Some(first) = structure.first_leaf else {
            return;
        };
        let count = structure.len();
        let place = first.index() - self.leaves.first_leaf;
        let stamps = &mut self.leaves.stamps[place..][..count];
        let blocks = &mut self.leaves.blocks[place..][..count];
        let quantized = &mut self.quantized[place..][..count];
        let mut boxes: [Extent<I>; 8] = [extent::nothing(i); 8];
        for lane in 0..count {
            let triangles = tree.leaves.triangles(first.plus(lane as u32));
            let corners = &source.shape().triangles[triangles];
            self.triangles += corners.len();
            boxes[lane] = refit_block(i, corners, &mut blocks[lane], source);
            quantized[lane] = quantize(i, &blocks[lane], self.units);
            stamps[lane] = self.stamp;
        }
        let place = wide_node.index() - self.nodes.first;
        let lanes = &mut self.nodes.boxes[place];
        extent::store(boxes, count, lanes);
        for (quantized, longest) in quantized.iter_mut().zip(lanes.longest_sides()) {
            quantized.set_fits(longest, self.units);
        }
        self.nodes.stamps[place] = self.stamp;
        self.made += count;
    }
}
