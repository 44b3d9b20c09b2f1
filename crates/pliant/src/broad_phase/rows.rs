//! Rows of a pass, found by several threads: a job has some consecutive bodies and their pairs.

use super::body_tree::{BodyTree, Descent};
use super::brute_force;
use super::overlap::{Boxes, Overlap};
use crate::held::held;
use crate::ids::Rank;
use crate::kernels::Instructions;
use crate::threads::{Executor, Grain};
use std::ops::Range;

/// Jobs for each thread, so that none waits long for the last.
const JOBS_A_THREAD: usize = 4;
/// Fewest bodies in a job, if their pairs are not too many.
const FEWEST: usize = 32;

/// Rows of one job.
#[derive(Debug, Default)]
pub(super) struct Rows {
    /// Bodies whose rows are still to be found.
    rest: Range<u32>,
    /// Pairs that were found and are kept.
    pairs: Vec<Overlap>,
    descent: Descent,
}

/// Which pairs are kept.
pub(crate) type Keep<'k> = &'k (dyn Fn(Overlap) -> bool + Sync);

/// Who is shown the pairs that are kept, some at a time.
pub(crate) type Show<'s> = &'s mut dyn FnMut(&[Overlap]);

/// A pass over the rows of all bodies, at the body that is next.
#[derive(Debug, Default)]
pub(super) struct Pass {
    next: u32,
    /// Nodes that were tested so far.
    tested: usize,
    /// Pairs that rows had lately, on average: jobs are sized by them.
    pairs_a_row: usize,
    jobs: Vec<Rows>,
}

impl Pass {
    /// Begins a pass over some bodies. In the first all may overlap, for what is known.
    pub(super) fn begin(&mut self, bodies: usize) {
        (self.next, self.tested) = (0, 0);
        if self.jobs.is_empty() {
            self.pairs_a_row = bodies;
        }
    }

    /// Shows the pairs of the next rows, in order: of one row at least, about `most` at once.
    ///
    /// Returns how many nodes the pass has tested when it is done. Without a tree all boxes are
    /// compared.
    pub(super) fn next(
        &mut self,
        (executor, instructions): (Executor, Instructions),
        tree: Option<&BodyTree>,
        boxes: Boxes,
        (most, keep): (usize, Keep),
        show: Show,
    ) -> Option<usize> {
        let end = boxes.of_bodies.len() as u32;
        let left = (end - self.next) as usize;
        let nanoseconds = Grain::ROWS.time(left);
        let threads = executor.threads_for(nanoseconds);
        let (mut jobs, mut size, mut most_of_job) = (1, left, most);
        if threads > 1 {
            // Each finds one row at least, which may be all that is wanted.
            let rows = 1 + most / (1 + self.pairs_a_row);
            let longest = 1 + JOBS_A_THREAD * most / boxes.of_bodies.len();
            jobs = (JOBS_A_THREAD * threads).min(rows).min(longest);
            most_of_job = 2 * most.div_ceil(jobs);
            // Half of that is expected, so that few rows are found in vain.
            let room = most_of_job / (2 + 2 * self.pairs_a_row);
            size = left.div_ceil(jobs).max(FEWEST).min(room.max(1));
            jobs = jobs.min(left.div_ceil(size));
        }
        if self.jobs.len() < jobs {
            self.jobs.resize_with(jobs, Rows::default);
        }
        let mut start = self.next;
        for job in &mut self.jobs[..jobs] {
            let bodies = start..end.min(start.saturating_add(size as u32));
            start = bodies.end;
            job.begin(bodies);
        }
        let find = |job: &mut Rows| {
            job.find((executor, instructions), tree, boxes, (most_of_job, keep));
        };
        match &mut self.jobs[..jobs] {
            [job] => find(job),
            jobs => executor.run(jobs, nanoseconds, |_, job| find(job)),
        }
        let (first, mut shown) = (self.next, 0);
        for job in &self.jobs[..jobs] {
            show(&job.pairs);
            shown += job.pairs.len();
            self.tested += job.descent.tested;
            self.next = job.rest.start;
            if !job.rest.is_empty() {
                // It has found enough; the rows of the jobs behind it are found again.
                break;
            }
        }
        if threads > 1 {
            let rows = (self.next - first).max(1);
            self.pairs_a_row = shown / rows as usize;
        }
        (self.next == end).then_some(self.tested)
    }
}

impl Rows {
    fn begin(&mut self, bodies: Range<u32>) {
        self.rest = bodies;
        self.pairs.clear();
        self.descent.tested = 0;
    }

    /// Finds rows until there are `most` pairs, or it is interrupted; at least one row.
    fn find(
        &mut self,
        (executor, instructions): (Executor, Instructions),
        tree: Option<&BodyTree>,
        boxes: Boxes,
        (most, keep): (usize, Keep),
    ) {
        while !self.rest.is_empty() && self.pairs.len() < most && !executor.is_interrupted() {
            let body = Rank(self.rest.start);
            let (pairs, descent) = (&mut self.pairs, &mut self.descent);
            let before = pairs.len();
            match tree {
                Some(tree) => tree.row(instructions, body, boxes, descent, pairs),
                None => brute_force::row(boxes.of_bodies, body, pairs),
            }
            let _ = pairs.extract_if(before.., |&mut pair| !keep(pair)).count();
            self.rest.start += 1;
        }
    }
}

held!(Pass: jobs);

held!(Rows: pairs[], descent);
