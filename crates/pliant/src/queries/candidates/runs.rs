//! The boxes of the vertices, edges or triangles that belong to runs of triangles: those of a run side by side, by eights.
//!
//! Runs are the blocks of a tree's leaves, or its triangles where every leaf is one. Boxes are made for all runs of a body at once, the first
//! time that a shape, or a motion, is asked about: by as many threads as there are. They do not depend on the margin.

use crate::geometry::{Aabb, Points, Shape, larger};
use crate::held::{self, Held};
use crate::ids::TreeVertex;
use crate::kernels::gaps::{self, Eight, EightCorners, Limits};
use crate::kernels::{Coordinate, Instructions, Simd, dispatch};
use crate::threads::Executor;
use crate::tree::{STRICT_UPPER, Version};
use std::ops::Range;

/// Runs in a job: some microseconds of work.
const JOB: usize = 256;

/// Where the vertices of a body are, and where at the end of a motion, if it has one.
pub(crate) type Ends<'p, S> = (&'p Shape<'p, S>, Option<&'p Points<S>>);

/// The boxes of the elements of one kind of a body, which have `C` corners each.
#[derive(Debug)]
pub(crate) struct RunBoxes<const C: usize> {
    /// What they were made of; none before the first time, and after one that was interrupted.
    version: Option<Version>,
    /// For each run the elements that belong to it: those from this one on, up to that of the next.
    elements: Vec<u32>,
    /// For each run its first eight.
    firsts: Vec<u32>,
    eights: Vec<Eight>,
    /// Of each eight the corners; those that are missing to the last one of a run are its first again.
    corners: Vec<EightCorners<C>>,
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

impl<const C: usize> RunBoxes<C> {
    /// For runs to which these elements belong, which have these corners. Those of a run are numbered in a row, but runs in any order.
    pub(crate) fn new(
        elements_of: impl ExactSizeIterator<Item = Range<u32>>,
        corners_of: impl Fn(u32) -> [TreeVertex; C],
    ) -> Self {
        let runs = elements_of.len();
        let mut firsts = Vec::with_capacity(runs + 1);
        let mut elements = Vec::with_capacity(2 * runs);
        let mut corners = Vec::new();
        for run in elements_of {
            // Up to three vertices, or edges, belong to a triangle.
            debug_assert!(run.len() <= 24, "{run:?}");
            firsts.push(corners.len() as u32);
            elements.extend([run.start, run.end]);
            for first in run.clone().step_by(8) {
                let mut eight = [[0; 8]; C];
                for lane in 0..8 {
                    let element = first + lane as u32;
                    let element = if element < run.end { element } else { first };
                    let corners = corners_of(element);
                    for which in 0..C {
                        eight[which][lane] = corners[which].0;
                    }
                }
                corners.push(eight);
            }
        }
        firsts.push(corners.len() as u32);
        corners.shrink_to_fit();
        Self {
            version: None,
            elements,
            firsts,
            eights: vec![Eight::EMPTY; corners.len()],
            corners,
            hulls: vec![Eight::EMPTY.get(0); runs],
            most: 0.0,
        }
    }

    /// Makes all boxes, unless they are those of this version. Returns false if it was interrupted.
    pub(crate) fn make<S: Coordinate>(
        &mut self,
        version: Version,
        (instructions, executor): (Instructions, Executor),
        positions: Ends<S>,
    ) -> bool {
        if self.version == Some(version) {
            return true;
        }
        self.version = None;
        let Self {
            firsts,
            eights,
            corners,
            hulls,
            ..
        } = self;
        let (mut rest, mut start) = (&mut eights[..], 0);
        let jobs = hulls.chunks_mut(JOB).map(|hulls| {
            let runs = start..start + hulls.len();
            start = runs.end;
            let [first, end] = [runs.start, runs.end].map(|run| firsts[run] as usize);
            Job {
                first,
                runs,
                eights: rest.split_off_mut(..end - first).unwrap_or_default(),
                hulls,
                most: 0.0,
            }
        });
        let make = |_, job: &mut Job| {
            dispatch!(instructions, i => {
                for run in job.runs.clone() {
                    let [first, end] = [firsts[run], firsts[run + 1]].map(|at| at as usize);
                    let eights = &mut job.eights[first - job.first..end - job.first];
                    let all = make_run(i, positions, &corners[first..end], eights);
                    job.hulls[run - job.runs.start] = all;
                    for side in [all.lo, all.hi] {
                        for x in side {
                            // Of a run without elements it is no number, and passed over.
                            job.most = larger(job.most, x.abs());
                        }
                    }
                }
            });
        };
        self.most = if executor.are_many() {
            let mut jobs: Vec<Job> = jobs.collect();
            executor.run(&mut jobs, make);
            jobs.iter().fold(0.0, |most, job| larger(most, job.most))
        } else {
            // Without a list of them, which a step would allocate.
            jobs.fold(0.0, |most, mut job| {
                executor.run(std::slice::from_mut(&mut job), make);
                larger(most, job.most)
            })
        };
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
    pub(super) fn run(&self, run: u32) -> ElementRun<'_, C> {
        let run = run as usize;
        let [first, end] = [self.firsts[run], self.firsts[run + 1]].map(|at| at as usize);
        ElementRun {
            elements: self.elements[2 * run]..self.elements[2 * run + 1],
            boxes: &self.eights[first..end],
            corners: &self.corners[first..end],
            all: &self.hulls[run],
        }
    }
}

/// Makes the boxes of the elements of a run; returns the box of all.
#[inline(always)]
fn make_run<I: Simd, S: Coordinate, const C: usize>(
    i: I,
    (shape, end): Ends<S>,
    corners: &[EightCorners<C>],
    eights: &mut [Eight],
) -> Aabb {
    let mut all = Eight::EMPTY.get(0);
    for (place, (lanes, corners)) in eights.iter_mut().zip(corners).enumerate() {
        gaps::of_elements(i, shape, end, corners, lanes);
        let of_eight = lanes.union();
        all = if place == 0 {
            of_eight
        } else {
            all.union(&of_eight)
        };
    }
    all
}

/// So many pairs of runs are looked at in a row.
pub(super) const RUNS_AT_ONCE: usize = 32;

/// Keeps pairs of runs the boxes of whose elements are possibly near each other; there are no more than [`RUNS_AT_ONCE`].
#[inline(always)]
pub(super) fn near_runs<'k, const C: usize, const D: usize>(
    a: &RunBoxes<C>,
    b: &RunBoxes<D>,
    pairs: &[[u32; 2]],
    limits: Limits,
    kept: &'k mut [[u32; 2]; RUNS_AT_ONCE],
) -> &'k [[u32; 2]] {
    let mut count = 0;
    for &pair in pairs {
        let [a, b] = [&a.hulls[pair[0] as usize], &b.hulls[pair[1] as usize]];
        // Whether they are cannot be predicted. The box of no element is no number, and near nothing.
        kept[count] = pair;
        count += usize::from(limits.are_possibly_near(a, b));
    }
    &kept[..count]
}

/// The elements of one kind that belong to a run of triangles, and their boxes.
#[derive(Clone)]
pub(super) struct ElementRun<'b, const C: usize> {
    /// Numbers of the elements.
    elements: Range<u32>,
    boxes: &'b [Eight],
    corners: &'b [EightCorners<C>],
    /// The box of all.
    all: &'b Aabb,
}

impl<const C: usize> ElementRun<'_, C> {
    /// Which elements are possibly near a box: bit i for the i-th.
    #[inline(always)]
    fn near<I: Simd>(&self, i: I, other: &Aabb, limits: Limits) -> u32 {
        let mut near = 0;
        // In one number: a list of masks would be written byte by byte and read as one, which processors wait for.
        for (place, eight) in self.boxes.iter().enumerate() {
            near |= (gaps::near_box(i, eight, other, limits) as u32) << (8 * place);
        }
        near & ((1 << self.elements.len()) - 1)
    }

    /// Shows `found` the pairs of elements, one of either run, that are possibly near each other and those that surely are, as bits
    /// 8 i + j of two masks, behind the numbers of the first elements. Of one body those that have no corner in common; of a run with
    /// itself, if it is the same kind of elements too, each pair once and none with itself.
    #[inline(always)]
    pub(super) fn compare<I: Simd, const D: usize>(
        &self,
        i: I,
        other: &ElementRun<'_, D>,
        (is_one_body, itself): (bool, bool),
        limits: Limits,
        mut found: impl FnMut([u32; 2], u64, u64),
    ) {
        let rows = self.near(i, other.all, limits);
        // Where all are side by side, asking which are near is as much work as a row.
        let columns = if other.boxes.len() == 1 {
            (1 << other.elements.len()) - 1
        } else {
            other.near(i, self.all, limits)
        };
        for (a, boxes_a) in self.boxes.iter().enumerate() {
            let rows = rows >> (8 * a) & 0xFF;
            if rows == 0 {
                continue;
            }
            let of_a = (boxes_a, &self.corners[a]);
            let first = if itself { a } else { 0 };
            for (b, boxes_b) in other.boxes.iter().enumerate().skip(first) {
                let columns = u64::from(columns >> (8 * b) & 0xFF);
                if columns == 0 {
                    continue;
                }
                let of_b = (boxes_b, &other.corners[b]);
                let (mut near, is_unsure) =
                    gaps::near_pairs(i, of_a, rows, of_b, is_one_body, limits);
                // A byte of it for each row.
                near &= columns * 0x0101_0101_0101_0101;
                if itself && a == b {
                    near &= STRICT_UPPER;
                }
                if near != 0 {
                    let sure = if is_unsure {
                        gaps::sure_pairs(i, boxes_a, boxes_b, limits)
                    } else {
                        u64::MAX
                    };
                    let [a, b] = [(&self.elements, a), (&other.elements, b)]
                        .map(|(elements, eight)| elements.start + 8 * eight as u32);
                    found([a, b], near, sure);
                }
            }
        }
    }
}

impl<const C: usize> Held for RunBoxes<C> {
    fn held(&self) -> usize {
        held::list(&self.elements)
            + held::list(&self.firsts)
            + held::list(&self.eights)
            + held::list(&self.corners)
            + held::list(&self.hulls)
    }
}
