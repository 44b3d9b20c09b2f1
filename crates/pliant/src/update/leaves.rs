//! Boxes of the triangles in leaves that are about to meet others.
//!
//! The paper's leaves are single triangles. Here a leaf holds several, and many leaves whose own boxes a traversal needs never meet
//! another: on two spheres in contact, half of them. So the triangles get theirs last of all, but in a body that meets itself, where
//! every leaf meets at least itself: there they are made ahead.

use super::make::Work;
use super::noted::Noted;
use crate::geometry::Scalar;
use crate::kernels::extent;
use crate::tree::{LEAF_LANES, LeafBoxes, Tree};
use fearless_simd::dispatch;
use std::ops::Range;

/// Words of 64 leaves in a job: at most some microseconds of work.
const JOB: usize = 2;
/// So many leaves, or fewer, are not worth waking a thread.
const SHARED: usize = 256;

/// The leaves of some words, their boxes, and how many of what was made.
struct Job<'t> {
    words: Range<usize>,
    boxes: LeafBoxes<'t>,
    leaves: usize,
    triangles: usize,
}

/// Makes the boxes of the triangles in leaves that were reached, unless they are true, and forgets what was reached. Returns how
/// many boxes it made.
pub(super) fn reach_leaves<const N: usize, S: Scalar>(
    work: Work<'_, '_, S>,
    tree: &mut Tree<N>,
    reached: &mut Noted,
) -> u64 {
    if !tree.leaves.have_boxes() {
        reached.clear();
        return 0;
    }
    let make = |job: &mut Job| {
        let shape = work.shape;
        dispatch!(work.level, i => {
            for leaf in reached.of(job.words.clone()) {
                let (triangles, epoch, blocks) = job.boxes.of(leaf);
                if *epoch == shape.epoch {
                    continue;
                }
                *epoch = shape.epoch;
                job.leaves += 1;
                job.triangles += triangles.len();
                for (triangles, block) in shape.triangles[triangles].chunks(LEAF_LANES).zip(blocks) {
                    extent::make_block(i, shape, triangles, block);
                }
            }
        });
    };
    let mut whole = Job {
        words: reached.words(),
        boxes: tree.leaves.boxes(),
        leaves: 0,
        triangles: 0,
    };
    let (leaves, triangles) = if !work.threads.are_many() || reached.count() <= SHARED {
        make(&mut whole);
        (whole.leaves, whole.triangles)
    } else {
        let mut jobs = whole.cut(reached);
        work.threads.run(&mut jobs, |_, job| make(job));
        let counts = jobs.iter().map(|job| (job.leaves, job.triangles));
        counts.fold((0, 0), |all, part| (all.0 + part.0, all.1 + part.1))
    };
    reached.clear();
    tree.leaves.note_reached(leaves);
    triangles as u64
}

impl Job<'_> {
    /// Jobs of fewer words, those in which something was reached.
    fn cut(self, reached: &Noted) -> Vec<Self> {
        let Range { start, end } = self.words;
        let mut rest = self.boxes;
        let mut jobs = Vec::new();
        for start in (start..end).step_by(JOB).rev() {
            let words = start..end.min(start + JOB);
            if reached.are_any_in(words.clone()) {
                let [before, boxes] = rest.split_before(64 * start as u32);
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
}
