//! The boxes of the vertices, edges or triangles that belong to runs of triangles: those of a run side by side, by eights.
//!
//! Runs are the blocks of a tree's leaves, or its triangles where every leaf is one. Boxes are made for all runs of a body at once, the first
//! time that a shape, or a motion, is asked about: by as many threads as there are. They do not depend on the margin.

use crate::geometry::{Aabb, Points, Shape, larger};
use crate::held::{self, Held};
use crate::ids::TreeVertex;
use crate::kernels::gaps::{self, Eight, Limits};
use crate::kernels::{Coordinate, Instructions, Simd, dispatch};
use crate::threads::Executor;
use crate::tree::{STRICT_UPPER, Version};
use std::ops::Range;

/// Up to three vertices, or edges, belong to a triangle, so there are up to three eights of them in a run of eight triangles.
const EIGHTS: usize = 3;

/// Runs in a job: some microseconds of work.
const JOB: usize = 256;

/// Where the vertices of a body are, and where at the end of a motion, if it has one.
pub(crate) type Ends<'p, S> = (&'p Shape<'p, S>, Option<&'p Points<S>>);

/// The boxes of the elements of one kind of a body.
#[derive(Debug, Default)]
pub(crate) struct RunBoxes {
    /// What they were made of; none before the first time, and after one that was interrupted.
    version: Option<Version>,
    /// For each run the elements that belong to it: those from this one on, up to that of the next.
    elements: Vec<u32>,
    /// For each run its first eight.
    firsts: Vec<u32>,
    eights: Vec<Eight>,
    /// For each run the box of all.
    hulls: Vec<Aabb>,
    /// The largest coordinate.
    most: f32,
}

/// Some runs, and where their boxes are.
struct Job<'b> {
    runs: Range<usize>,
    first: usize,
    eights: &'b mut [Eight],
    hulls: &'b mut [Aabb],
    most: f32,
}

impl RunBoxes {
    /// For runs to which these elements belong. Those of a run are numbered in a row, but runs in any order.
    pub(crate) fn new(elements_of: impl ExactSizeIterator<Item = Range<u32>>) -> Self {
        let mut boxes = Self::default();
        let mut count = 0;
        for elements in elements_of {
            boxes.firsts.push(count);
            count += (elements.len() as u32).div_ceil(8);
            boxes.elements.extend([elements.start, elements.end]);
        }
        let runs = boxes.firsts.len();
        boxes.firsts.push(count);
        boxes.eights = vec![Eight::EMPTY; count as usize];
        boxes.hulls = vec![Eight::EMPTY.get(0); runs];
        boxes
    }

    /// Makes all boxes, unless they are those of this version; the elements have these corners. Returns false if it was interrupted.
    pub(crate) fn make<S: Coordinate, const C: usize>(
        &mut self,
        version: Version,
        (instructions, executor): (Instructions, Executor),
        positions: Ends<S>,
        corners: impl Fn(u32) -> [TreeVertex; C] + Sync,
    ) -> bool {
        if self.version == Some(version) {
            return true;
        }
        self.version = None;
        let Self {
            elements,
            firsts,
            eights,
            hulls,
            ..
        } = self;
        let mut jobs = Vec::with_capacity(hulls.len().div_ceil(JOB));
        let (mut rest, mut start) = (&mut eights[..], 0);
        for hulls in hulls.chunks_mut(JOB) {
            let runs = start..start + hulls.len();
            start = runs.end;
            let count = (firsts[runs.end] - firsts[runs.start]) as usize;
            let (own, others) = rest.split_at_mut(count);
            rest = others;
            jobs.push(Job {
                first: firsts[runs.start] as usize,
                runs,
                eights: own,
                hulls,
                most: 0.0,
            });
        }
        executor.run(&mut jobs, |_, job| {
            if executor.is_interrupted() {
                return;
            }
            dispatch!(instructions, i => {
                for run in job.runs.clone() {
                    let first = firsts[run] as usize - job.first;
                    let end = firsts[run + 1] as usize - job.first;
                    let of_run = elements[2 * run]..elements[2 * run + 1];
                    let eights = &mut job.eights[first..end];
                    let all = make_run(i, positions, of_run, eights, &corners);
                    job.hulls[run - job.runs.start] = all;
                    for side in [all.lo, all.hi] {
                        for x in side {
                            // Of a run without elements it is no number, and passed over.
                            job.most = larger(job.most, x.abs());
                        }
                    }
                }
            });
        });
        self.most = jobs.iter().fold(0.0, |most, job| larger(most, job.most));
        if executor.is_interrupted() {
            return false;
        }
        self.version = Some(version);
        true
    }

    /// The largest coordinate, relative to the origin, of any box.
    pub(super) fn most(&self) -> f32 {
        self.most
    }

    /// The elements of a run and their boxes.
    #[inline(always)]
    pub(super) fn run(&self, run: u32) -> ElementRun<'_> {
        let run = run as usize;
        let [first, end] = [self.firsts[run], self.firsts[run + 1]].map(|at| at as usize);
        ElementRun {
            elements: self.elements[2 * run]..self.elements[2 * run + 1],
            boxes: &self.eights[first..end],
            all: &self.hulls[run],
        }
    }
}

/// Makes the boxes of the elements of a run; returns the box of all.
#[inline(always)]
fn make_run<I: Simd, S: Coordinate, const C: usize>(
    i: I,
    (shape, end): Ends<S>,
    elements: Range<u32>,
    eights: &mut [Eight],
    corners: &impl Fn(u32) -> [TreeVertex; C],
) -> Aabb {
    let mut all = Eight::EMPTY.get(0);
    for (place, lanes) in eights.iter_mut().enumerate() {
        let first = elements.start + 8 * place as u32;
        let mut eight = [corners(first); 8];
        for lane in 1..8 {
            let element = first + lane;
            if element < elements.end {
                eight[lane as usize] = corners(element);
            }
        }
        gaps::of_elements(i, shape, end, &eight, lanes);
        let of_eight = lanes.union();
        all = if place == 0 {
            of_eight
        } else {
            all.union(&of_eight)
        };
    }
    all
}

/// The elements of one kind that belong to a run of triangles, and their boxes.
#[derive(Clone)]
pub(super) struct ElementRun<'b> {
    /// Numbers of the elements.
    elements: Range<u32>,
    boxes: &'b [Eight],
    /// The box of all.
    all: &'b Aabb,
}

impl ElementRun<'_> {
    /// Of each eight the elements that are possibly near a box: bit i of the i-th.
    #[inline(always)]
    fn near<I: Simd>(&self, i: I, other: &Aabb, limits: Limits) -> [u64; EIGHTS] {
        let mut near = [0; EIGHTS];
        let mut left = self.elements.len();
        for (near, eight) in near.iter_mut().zip(self.boxes) {
            let there = if left < 8 { (1 << left) - 1 } else { 0xFF };
            *near = gaps::near_box(i, eight, other, limits) & there;
            left = left.saturating_sub(8);
        }
        near
    }

    /// Shows `found` the pairs of elements, one of either run, that are surely near each other and those that possibly are, as bits
    /// 8 i + j of two masks, behind the numbers of the first elements. Of a run with itself each pair once and none with itself.
    #[inline(always)]
    pub(super) fn compare<I: Simd>(
        &self,
        i: I,
        other: &Self,
        itself: bool,
        limits: Limits,
        mut found: impl FnMut([u32; 2], u64, u64),
    ) {
        if self.boxes.is_empty() || other.boxes.is_empty() {
            return;
        }
        let rows = self.near(i, other.all, limits);
        if rows == [0; EIGHTS] {
            return;
        }
        let columns = other.near(i, self.all, limits);
        for (a, boxes_a) in self.boxes.iter().enumerate() {
            if rows[a] == 0 {
                continue;
            }
            for (b, boxes_b) in other
                .boxes
                .iter()
                .enumerate()
                .skip(if itself { a } else { 0 })
            {
                if columns[b] == 0 {
                    continue;
                }
                let (sure, mut possible) = gaps::near_pairs(i, boxes_a, rows[a], boxes_b, limits);
                // A byte of it for each row.
                possible &= columns[b] * 0x0101_0101_0101_0101;
                if itself && a == b {
                    possible &= STRICT_UPPER;
                }
                if possible != 0 {
                    let [of_a, of_b] = [(self, a), (other, b)]
                        .map(|(run, eight)| run.elements.start + 8 * eight as u32);
                    found([of_a, of_b], sure & possible, possible);
                }
            }
        }
    }
}

impl Held for RunBoxes {
    fn held(&self) -> usize {
        held::list(&self.elements)
            + held::list(&self.firsts)
            + held::list(&self.eights)
            + held::list(&self.hulls)
    }
}
