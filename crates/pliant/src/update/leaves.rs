//! Boxes of the triangles in leaves that are about to meet others.
//!
//! The paper's leaves are single triangles. Here a leaf holds several, and many leaves whose own boxes a traversal needs never meet
//! another: on two spheres in contact, half of them. So the triangles get theirs last of all.

use super::make::Work;
use super::top_down::Reached;
use crate::geometry::Scalar;
use crate::kernels::extent;
use crate::tree::{LEAF_LANES, LeafBoxes, Tree};
use fearless_simd::dispatch;

/// Leaves in a job: some ten microseconds of work.
const JOB: usize = 128;

/// Makes the boxes of the triangles in leaves that were reached, unless they are true. Returns how many boxes it made.
pub(super) fn reach_leaves<const N: usize, S: Scalar>(
    work: Work<'_, '_, S>,
    tree: &mut Tree<N>,
    reached: &mut Reached,
) -> u64 {
    let epoch = work.shape.epoch;
    let (leaves, untrue) = reached.list();
    untrue.clear();
    let is_untrue = |&leaf: &u32| !tree.leaves.are_true(leaf, epoch);
    untrue.extend(leaves.iter().copied().filter(is_untrue));
    tree.leaves.note_reached(untrue.len());
    let make = |run: &[u32], boxes: &mut LeafBoxes| {
        let shape = work.shape;
        let mut made = 0;
        dispatch!(work.level, i => {
            for &leaf in run {
                let (triangles, epoch, blocks) = boxes.of(leaf);
                made += triangles.len() as u64;
                *epoch = shape.epoch;
                for (triangles, block) in shape.triangles[triangles].chunks(LEAF_LANES).zip(blocks) {
                    extent::make_block(i, shape, triangles, block);
                }
            }
        });
        made
    };
    let mut rest = tree.leaves.boxes();
    if untrue.len() <= JOB || !work.threads.are_many() {
        return make(untrue, &mut rest);
    }
    let mut jobs = Vec::with_capacity(untrue.len().div_ceil(JOB));
    for run in untrue.chunks(JOB).rev() {
        let [before, own] = rest.split_before(run[0]);
        jobs.push((run, own, 0));
        rest = before;
    }
    jobs.reverse();
    work.threads
        .run(&mut jobs, |_, (run, boxes, made)| *made = make(run, boxes));
    jobs.iter().map(|&(_, _, made)| made).sum()
}
