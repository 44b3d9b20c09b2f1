//! Refit of the boxes of triangles in leaves that a traversal reached.
//!
//! The paper's leaves are single triangles; here a leaf holds several. Many leaves whose own boxes
//! a traversal needs never meet another: on two spheres in contact, half of them. So boxes of
//! triangles are made last of all. In a body that meets itself they are made ahead, because every
//! leaf meets at least itself.

use super::dirty_set::DirtySet;
use super::refitted::{Refit, Refitted};
use crate::ids::{BlockId, LeafId, TreeVertex};
use crate::kernels::extent::{self, Extent, Four};
use crate::kernels::{Coordinate, EightBoxes, Simd, dispatch};
use crate::statistics::Statistics;
use crate::threads::Grain;
use crate::tree::{
    BLOCK_LANES, BoxSource, Leaves, LeavesMut, Over, make_block_capsules, of_source,
};
use std::ops::Range;

/// Words of 64 leaves in a job.
const WORDS: usize = 2;
/// Words of 64 leaves between two checks for interruption.
const UNINTERRUPTED: usize = 64;

/// Job: the leaves of some words of a dirty set, with their boxes, and counters of the boxes made.
struct LeafRun<'t> {
    words: Range<usize>,
    boxes: LeavesMut<'t>,
    stamp: u64,
    leaves: usize,
    triangles: usize,
}

impl Refit<'_> {
    /// Makes the boxes of the triangles in all reached leaves that are stale, and empties the set.
    pub(crate) fn reached_leaves<S: Coordinate>(
        &self,
        one: &mut Refitted<S>,
        reached: &mut DirtySet,
        statistics: &mut Statistics,
    ) {
        let leaves = &one.tree.leaves;
        if !leaves.have_blocks() {
            reached.clear();
            return;
        }
        let executor = self.executor;
        let whole = LeafRun {
            words: reached.words(),
            stamp: one.boxes.stamp(),
            boxes: one.boxes.leaves_mut(),
            leaves: 0,
            triangles: 0,
        };
        let nanoseconds = if executor.are_many() {
            Grain::LEAVES.time(reached.count())
        } else {
            0
        };
        let work = |job: &mut LeafRun| {
            let words = job.words.clone();
            for start in words.clone().step_by(UNINTERRUPTED) {
                if executor.is_interrupted() {
                    return;
                }
                let words = start..words.end.min(start + UNINTERRUPTED);
                of_source!(one.source, source => {
                    if !job.boxes.capsules.is_empty() {
                        for leaf in reached.of(words.clone()).map(LeafId) {
                            job.make_capsules(leaf, leaves, source);
                        }
                    }
                    dispatch!(self.instructions, i => {
                        for leaf in reached.of(words).map(LeafId) {
                            job.refit(i, leaf, leaves, source);
                        }
                    });
                });
            }
        };
        let mut made = 0;
        let done = |job: &LeafRun| {
            made += job.leaves;
            statistics.triangle_boxes += job.triangles as u64;
        };
        executor.run_cut(whole, nanoseconds, |it| it.cut(reached, leaves), work, done);
        reached.clear();
        one.boxes.count_reached(made);
    }
}

impl LeafRun<'_> {
    /// Cuts the words into smaller jobs; jobs without a reached leaf are left out.
    fn cut(self, reached: &DirtySet, leaves: &Leaves) -> Vec<Self> {
        let Range { start, end } = self.words;
        let mut rest = self.boxes;
        let mut jobs = Vec::new();
        for start in (start..end).step_by(WORDS).rev() {
            let words = start..end.min(start + WORDS);
            if reached.are_any_in(words.clone()) {
                let leaf = LeafId(64 * start as u32);
                let block = BlockId(leaves.blocks(leaf).start);
                let [before, boxes] = rest.split_before(leaf, block);
                rest = before;
                jobs.push(Self {
                    words,
                    boxes,
                    ..self
                });
            }
        }
        jobs.reverse();
        jobs
    }

    /// Makes the boxes of the triangles in one leaf, unless they are valid.
    #[inline(always)]
    fn refit<I: Simd, B: BoxSource>(&mut self, i: I, leaf: LeafId, leaves: &Leaves, source: &B) {
        let stamp = &mut self.boxes.stamps[leaf.index() - self.boxes.first_leaf];
        if *stamp == self.stamp {
            return;
        }
        *stamp = self.stamp;
        let (triangles, block) = leaves.triangles_and_block(leaf);
        let triangles = &source.shape().triangles[triangles];
        self.leaves += 1;
        self.triangles += triangles.len();
        let blocks = &mut self.boxes.blocks[block.index() - self.boxes.first_block..];
        for (triangles, block) in triangles.chunks(BLOCK_LANES).zip(blocks) {
            refit_block(i, triangles, block, source);
        }
    }

    /// Makes the capsules of the triangles in one leaf, unless its boxes are valid.
    fn make_capsules<B: BoxSource>(&mut self, leaf: LeafId, leaves: &Leaves, source: &B) {
        if self.boxes.stamps[leaf.index() - self.boxes.first_leaf] == self.stamp {
            return;
        }
        let (triangles, block) = leaves.triangles_and_block(leaf);
        let triangles = &source.shape().triangles[triangles];
        let capsules = &mut self.boxes.capsules[block.index() - self.boxes.first_block..];
        for (triangles, capsules) in triangles.chunks(BLOCK_LANES).zip(capsules) {
            make_block_capsules(capsules, triangles, source);
        }
    }
}

/// Makes the boxes of one to eight triangles, and returns the box of all.
#[inline(always)]
pub(super) fn refit_block<I: Simd, B: BoxSource>(
    i: I,
    triangles: &[[TreeVertex; 3]],
    block: &mut EightBoxes,
    source: &B,
) -> Extent<I> {
    // A short block is padded to eight with its last triangle.
    let padded;
    let eight: &[[TreeVertex; 3]; BLOCK_LANES] = if let Ok(eight) = triangles.try_into() {
        eight
    } else {
        padded = padded_to_eight(triangles);
        &padded
    };
    let mut fours = [[extent::nothing(i); 4]; 2];
    for half in 0..2 {
        for lane in 0..4 {
            fours[half][lane] = source.over(i, Over::Triangle(&eight[4 * half + lane]));
        }
    }
    let [first, later] = fours;
    Four::new(first).store(Four::new(later), triangles.len(), block)
}

/// Pads one to seven triangles to eight with the last.
#[inline(never)]
fn padded_to_eight(triangles: &[[TreeVertex; 3]]) -> [[TreeVertex; 3]; 8] {
    let mut eight = [triangles[triangles.len() - 1]; 8];
    eight[..triangles.len()].copy_from_slice(triangles);
    eight
}
