//! Boxes of the elements (vertices, edges or triangles) of runs of triangles, eight side by side.
//!
//! Runs are the blocks of a tree's leaves, or its triangles where every leaf is one. All boxes of a
//! body are made at once, by all threads, the first time that a shape, or a motion, is asked about.
//! They do not depend on the margin. Pairs of runs are compared by their hulls, then elements with
//! hulls, then eight elements with each that is left.

use crate::geometry::{Aabb, Points, Shape, larger};
use crate::held::{self, Held};
use crate::ids::TreeVertex;
use crate::kernels::gaps::{self, EightCorners, Limits, PaddedBox};
use crate::kernels::ring::{MOST_OF_RUN, Ring};
use crate::kernels::{Coordinate, EightBoxes, Instructions, Simd, dispatch};
use crate::threads::{Executor, Grain};
use crate::tree::Version;
use pliant_exact::DEBUG;
use std::ops::Range;

/// Positions of a body's vertices, and positions at the end of its motion, if it has one.
pub(crate) type Ends<'p, S> = (&'p Shape<'p, S>, Option<&'p Points<S>>);

/// Boxes of a body's elements of one kind, with `C` corners each, by runs of triangles.
#[derive(Debug)]
pub(crate) struct RunBoxes<const C: usize> {
    /// Version of the source. None before the first time, and after an interruption.
    version: Option<Version>,
    runs: Vec<Run>,
    eights: Vec<ElementEight<C>>,
    /// The largest coordinate, relative to the origin.
    most: f32,
}

/// Hull of a run's elements and where they are: all that is needed before single elements are
/// compared.
#[derive(Debug)]
struct Run {
    /// Box of all elements.
    hull: PaddedBox,
    /// Number of the first group of eight.
    first: u32,
    /// Number of the first element.
    start: u32,
    /// Number of elements.
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
    /// Corners by lane. A run's last group is filled up with its own first element.
    corners: EightCorners<C>,
}

/// Some runs and their elements, for one thread.
struct Job<'b, const C: usize> {
    runs: &'b mut [Run],
    eights: &'b mut [ElementEight<C>],
    most: f32,
}

impl<const C: usize> RunBoxes<C> {
    /// Boxes to be made, for runs with these elements, which have these corners.
    ///
    /// The elements of a run are numbered in a row, but runs are in any order.
    pub(crate) fn new(
        elements_of: impl ExactSizeIterator<Item = Range<u32>>,
        corners_of: impl Fn(u32) -> [TreeVertex; C],
    ) -> Self {
        let mut runs = Vec::with_capacity(elements_of.len());
        let mut eights = Vec::new();
        for elements in elements_of {
            // Up to three vertices, or edges, belong to a triangle.
            assert!(!DEBUG || elements.len() <= MOST_OF_RUN, "{elements:?}");
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

    /// Makes all boxes, unless they are already of this version. Returns false if interrupted.
    /// O(elements).
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
        let jobs = self.runs.chunks_mut(Grain::RUNS.items).map(|runs| {
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
                            // A run without elements has NaN, which is skipped.
                            job.most = larger(job.most, x.abs());
                        }
                    }
                }
            });
        };
        self.most = 0.0;
        executor.run_each(jobs, Grain::RUNS, make, |job| {
            self.most = larger(self.most, job.most);
        });
        if executor.is_interrupted() {
            return false;
        }
        self.version = Some(version);
        true
    }

    /// The largest coordinate of any box, relative to the origin.
    pub(in crate::queries) fn most(&self) -> f32 {
        self.most
    }

    /// Elements of a run, and their boxes.
    #[inline(always)]
    pub(in crate::queries) fn run(&self, run: u32) -> ElementRun<'_, C> {
        let run = &self.runs[run as usize];
        let eights = &self.eights[run.eights()];
        ElementRun { run, eights }
    }
}

/// Makes the boxes of a run's elements. Returns their union.
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

/// Pairs of runs that are compared by their hulls in a row, before elements are.
pub(in crate::queries) const RUNS_AT_ONCE: usize = 32;

/// Pairs of runs, of two bodies or of one, to be compared.
#[derive(Clone, Copy)]
pub(in crate::queries) struct RunPairs<'p> {
    /// Pairs of runs, at most [`RUNS_AT_ONCE`].
    pub(in crate::queries) pairs: &'p [[u32; 2]],
    /// Place in each pair of the run that comes first here.
    pub(in crate::queries) first: usize,
    /// Whether to leave out a run with itself.
    pub(in crate::queries) without_itself: bool,
}

/// Keeps the pairs of runs whose hulls are possibly near each other.
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
        // A branch on that could not be predicted. The hull of no elements is NaN, and near
        // nothing.
        kept[count] = pair;
        let is_left_out = runs.without_itself & (pair[0] == pair[1]);
        count += usize::from(limits.are_possibly_near(i, a, b) & !is_left_out);
    }
    &kept[..count]
}

/// Elements of one kind that belong to a run of triangles, and their boxes.
pub(in crate::queries) struct ElementRun<'b, const C: usize> {
    run: &'b Run,
    eights: &'b [ElementEight<C>],
}

impl<const C: usize> ElementRun<'_, C> {
    /// First element of the group of eight at this place.
    #[inline(always)]
    fn element(&self, eight: usize) -> u32 {
        self.run.start + 8 * eight as u32
    }

    /// Mask with a bit for each element.
    #[inline(always)]
    fn all(&self) -> u32 {
        (1 << self.run.count) - 1
    }

    /// Bit mask of the elements that are possibly near a box.
    #[inline(always)]
    fn near<I: Simd>(&self, i: I, other: &PaddedBox, limits: Limits) -> u32 {
        let mut near = 0;
        // One number: a list of masks would be written byte by byte and read as one, which stalls
        // processors.
        for (place, eight) in self.eights.iter().enumerate() {
            near |= (gaps::near_box(i, &eight.boxes, other, limits) as u32) << (8 * place);
        }
        near & self.all()
    }

    /// Shows `found` the pairs of elements, one of either run, that are possibly near each other.
    ///
    /// `found` gets the numbers of the first elements and two masks, with bit `8 i + j` for the
    /// elements i and j behind these. The first mask marks the pairs that are possibly near, the
    /// second the pairs that surely are. Within one body, elements that share a corner are left
    /// out.
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
        // Where all elements are in one group, finding the near ones takes as much work as a row.
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
                // The mask of columns, repeated in each byte, one a row.
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

    /// Shows `found` the pairs of elements of this run that are possibly near each other, and
    /// whether they surely are.
    ///
    /// Elements that share a corner are left out.
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
