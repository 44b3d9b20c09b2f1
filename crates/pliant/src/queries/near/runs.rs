//! The boxes of the vertices, edges or triangles that belong to runs of triangles: those of a run side by side, by eights.
//!
//! Runs are the blocks of a tree's leaves, or its triangles where every leaf is one. Boxes are made for all runs of a body at once, the first
//! time that a shape, or a motion, is asked about: by as many threads as there are. They do not depend on the margin.

use crate::geometry::{Aabb, Points, Shape, larger};
use crate::held::{self, Held};
use crate::ids::TreeVertex;
use crate::kernels::gaps::{self, EightCorners, Limits, PaddedBox};
use crate::kernels::ring::{MOST_OF_RUN, Ring};
use crate::kernels::{Coordinate, EightBoxes, Instructions, Simd, dispatch};
use crate::threads::Executor;
use crate::tree::Version;
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
    runs: Vec<Run>,
    eights: Vec<ElementEight<C>>,
    /// The largest coordinate.
    most: f32,
}

/// All that is asked of a run before its elements are, side by side.
#[derive(Debug)]
struct Run {
    /// The box of all elements.
    hull: PaddedBox,
    /// Its first eight.
    first: u32,
    /// Its elements: from this number on,
    start: u32,
    /// so many.
    count: u32,
}

impl Run {
    #[inline(always)]
    fn eights(&self) -> Range<usize> {
        let first = self.first as usize;
        first..first + self.count.div_ceil(8) as usize
    }
}

/// Eight elements side by side.
#[derive(Debug)]
struct ElementEight<const C: usize> {
    boxes: EightBoxes,
    /// Those that are missing to the last eight of a run are its first again.
    corners: EightCorners<C>,
}

/// Some runs and their elements.
struct Job<'b, const C: usize> {
    runs: &'b mut [Run],
    eights: &'b mut [ElementEight<C>],
    most: f32,
}

impl<const C: usize> RunBoxes<C> {
    /// For runs to which these elements belong, which have these corners. Those of a run are numbered in a row, but runs in any order.
    pub(crate) fn new(
        elements_of: impl ExactSizeIterator<Item = Range<u32>>,
        corners_of: impl Fn(u32) -> [TreeVertex; C],
    ) -> Self {
        let mut runs = Vec::with_capacity(elements_of.len());
        let mut eights = Vec::new();
        for elements in elements_of {
            // Up to three vertices, or edges, belong to a triangle.
            debug_assert!(elements.len() <= MOST_OF_RUN, "{elements:?}");
            runs.push(Run {
                hull: EightBoxes::EMPTY.get(0).into(),
                first: eights.len() as u32,
                start: elements.start,
                count: elements.len() as u32,
            });
            for first in elements.clone().step_by(8) {
                let mut corners = [[0; 8]; C];
                for lane in 0..8 {
                    let element = first + lane as u32;
                    let element = if element < elements.end {
                        element
                    } else {
                        first
                    };
                    let of_element = corners_of(element);
                    for which in 0..C {
                        corners[which][lane] = of_element[which].0;
                    }
                }
                let boxes = EightBoxes::EMPTY;
                eights.push(ElementEight { boxes, corners });
            }
        }
        eights.shrink_to_fit();
        Self {
            version: None,
            runs,
            eights,
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
        let (mut rest, mut first) = (&mut self.eights[..], 0);
        let jobs = self.runs.chunks_mut(JOB).map(|runs| {
            let end = runs.last().map_or(first, |run| run.eights().end);
            let eights = rest.split_off_mut(..end - first).unwrap_or_default();
            first = end;
            Job {
                runs,
                eights,
                most: 0.0,
            }
        });
        let make = |job: &mut Job<C>| {
            dispatch!(instructions, i => {
                let mut rest = &mut *job.eights;
                for run in &mut *job.runs {
                    let own = rest.split_off_mut(..run.eights().len());
                    let hull = make_run(i, positions, own.unwrap_or_default());
                    run.hull = hull.into();
                    for side in [hull.lo, hull.hi] {
                        for x in side {
                            // Of a run without elements it is no number, and passed over.
                            job.most = larger(job.most, x.abs());
                        }
                    }
                }
            });
        };
        self.most = 0.0;
        executor.run_each(jobs, make, |job| self.most = larger(self.most, job.most));
        if executor.is_interrupted() {
            return false;
        }
        self.version = Some(version);
        true
    }

    /// The largest coordinate, relative to the origin, of any box.
    pub(in crate::queries) fn most(&self) -> f32 {
        self.most
    }

    /// The elements of a run and their boxes.
    #[inline(always)]
    pub(in crate::queries) fn run(&self, run: u32) -> ElementRun<'_, C> {
        let run = &self.runs[run as usize];
        let eights = &self.eights[run.eights()];
        ElementRun { run, eights }
    }
}

/// Makes the boxes of the elements of a run; returns the box of all.
#[inline(always)]
fn make_run<I: Simd, S: Coordinate, const C: usize>(
    i: I,
    (shape, end): Ends<S>,
    eights: &mut [ElementEight<C>],
) -> Aabb {
    let mut all = EightBoxes::EMPTY.get(0);
    for (place, ElementEight { boxes, corners }) in eights.iter_mut().enumerate() {
        gaps::of_elements(i, shape, end, corners, boxes);
        let of_eight = boxes.union();
        all = if place == 0 {
            of_eight
        } else {
            all.union(&of_eight)
        };
    }
    all
}

/// So many pairs of runs are looked at in a row.
pub(in crate::queries) const RUNS_AT_ONCE: usize = 32;

/// Which runs of two bodies, or of one, are looked at.
#[derive(Clone, Copy)]
pub(in crate::queries) struct RunPairs<'p> {
    /// There are no more than [`RUNS_AT_ONCE`].
    pub(in crate::queries) pairs: &'p [[u32; 2]],
    /// The place in a pair of the run that comes first here.
    pub(in crate::queries) first: usize,
    /// Whether a run is not looked at with itself.
    pub(in crate::queries) without_itself: bool,
}

/// Keeps pairs of runs the boxes of whose elements are possibly near each other.
#[inline(always)]
pub(in crate::queries) fn near_runs<'k, I: Simd, const C: usize, const D: usize>(
    i: I,
    (a, b): (&RunBoxes<C>, &RunBoxes<D>),
    runs: RunPairs,
    limits: Limits,
    kept: &'k mut [[u32; 2]; RUNS_AT_ONCE],
) -> &'k [[u32; 2]] {
    let mut count = 0;
    for pair in runs.pairs {
        let pair = [pair[runs.first], pair[1 - runs.first]];
        let [a, b] = [
            &a.runs[pair[0] as usize].hull,
            &b.runs[pair[1] as usize].hull,
        ];
        // Whether they are cannot be predicted. The box of no element is no number, and near nothing.
        kept[count] = pair;
        let is_left_out = runs.without_itself & (pair[0] == pair[1]);
        count += usize::from(limits.are_possibly_near(i, a, b) & !is_left_out);
    }
    &kept[..count]
}

/// The elements of one kind that belong to a run of triangles, and their boxes.
pub(in crate::queries) struct ElementRun<'b, const C: usize> {
    run: &'b Run,
    eights: &'b [ElementEight<C>],
}

impl<const C: usize> ElementRun<'_, C> {
    /// The first of its elements that belongs to the eight with this place.
    #[inline(always)]
    fn element(&self, eight: usize) -> u32 {
        self.run.start + 8 * eight as u32
    }

    /// A bit for each of its elements.
    #[inline(always)]
    fn all(&self) -> u32 {
        (1 << self.run.count) - 1
    }

    /// Which elements are possibly near a box: bit i for the i-th.
    #[inline(always)]
    fn near<I: Simd>(&self, i: I, other: &PaddedBox, limits: Limits) -> u32 {
        let mut near = 0;
        // In one number: a list of masks would be written byte by byte and read as one, which processors wait for.
        for (place, eight) in self.eights.iter().enumerate() {
            near |= (gaps::near_box(i, &eight.boxes, other, limits) as u32) << (8 * place);
        }
        near & self.all()
    }

    /// Shows `found` the pairs of elements, one of either run, that are possibly near each other and those that surely are, as bits
    /// 8 i + j of two masks, behind the numbers of the first elements. Of one body those that have no corner in common.
    #[inline(always)]
    pub(in crate::queries) fn compare<I: Simd, const D: usize>(
        &self,
        i: I,
        other: &ElementRun<'_, D>,
        is_one_body: bool,
        limits: Limits,
        mut found: impl FnMut([u32; 2], u64, u64),
    ) {
        let rows = self.near(i, &other.run.hull, limits);
        // Where all are side by side, asking which are near is as much work as a row.
        let columns = if other.eights.len() == 1 {
            other.all()
        } else {
            other.near(i, &self.run.hull, limits)
        };
        for (a, eight_a) in self.eights.iter().enumerate() {
            let rows = rows >> (8 * a) & 0xFF;
            if rows == 0 {
                continue;
            }
            let of_a = (&eight_a.boxes, &eight_a.corners);
            for (b, eight_b) in other.eights.iter().enumerate() {
                let columns = u64::from(columns >> (8 * b) & 0xFF);
                if columns == 0 {
                    continue;
                }
                let of_b = (&eight_b.boxes, &eight_b.corners);
                let (mut near, is_unsure) =
                    gaps::near_pairs(i, of_a, rows, of_b, is_one_body, limits);
                // A byte of it for each row.
                near &= columns * 0x0101_0101_0101_0101;
                if near != 0 {
                    let sure = if is_unsure {
                        gaps::sure_pairs(i, of_a.0, of_b.0, limits)
                    } else {
                        u64::MAX
                    };
                    found([self.element(a), other.element(b)], near, sure);
                }
            }
        }
    }

    /// Shows `found` the pairs of its elements that are possibly near each other and have no corner in common, and whether they surely are.
    #[inline(always)]
    pub(in crate::queries) fn compare_within<I: Simd>(
        &self,
        i: I,
        ring: &mut Ring<C>,
        limits: Limits,
        mut found: impl FnMut([u32; 2], bool),
    ) {
        let eights = self.eights.iter();
        let eights = eights.map(|eight| (&eight.boxes, &eight.corners));
        ring.fill(self.run.count as usize, eights);
        ring.near_pairs(i, limits, |places, is_sure| {
            found(places.map(|place| self.run.start + place as u32), is_sure);
        });
    }
}

impl<const C: usize> Held for RunBoxes<C> {
    fn held(&self) -> usize {
        held::list(&self.runs) + held::list(&self.eights)
    }
}
