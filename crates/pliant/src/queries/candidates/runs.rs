//! The boxes of the vertices, edges or triangles of a run of triangles, side by side; kept during a descent, in which a run comes up again
//! and again, mostly soon.

use crate::geometry::{Aabb, Points, Shape, larger};
use crate::held::{self, Held};
use crate::ids::TreeVertex;
use crate::kernels::gaps::{self, Eight, Limits};
use crate::kernels::{Coordinate, Simd};
use crate::mesh::TriangleRun;
use crate::tree::STRICT_UPPER;
use std::ops::Range;

/// Up to three vertices, or edges, belong to a triangle, so there are up to three eights of them in a run of eight triangles.
const EIGHTS: usize = 3;

/// Runs that are kept, as a power of two.
const KEPT: u32 = 8;

/// The elements of one kind that belong to a run of triangles, and their boxes.
#[derive(Debug)]
pub(super) struct ElementRun {
    of: TriangleRun,
    /// The descent that this was made for; 0 is none.
    descent: u64,
    /// Numbers of the elements.
    elements: Range<u32>,
    boxes: [Eight; EIGHTS],
    /// The box of all, and the largest coordinate in it.
    all: Aabb,
    pub(super) most: f32,
}

/// Where the vertices of a body are, and where at the end of a motion, if it has one.
pub(super) type Ends<'p, S> = (&'p Shape<'p, S>, Option<&'p Points<S>>);

/// Runs that were looked at in a descent; each has one place where it may be.
#[derive(Debug, Default)]
pub(super) struct Runs {
    kept: Vec<ElementRun>,
    descent: u64,
}

impl Runs {
    /// Goes on with a descent, or begins it.
    pub(super) fn go_on(&mut self, descent: u64) {
        if self.kept.is_empty() {
            self.kept.resize_with(1 << KEPT, ElementRun::none);
        }
        self.descent = descent;
    }

    /// The elements of a run of triangles, of which there are as many as `numbers` says, each with its corners.
    #[inline(always)]
    pub(super) fn get<I: Simd, S: Coordinate, const C: usize>(
        &mut self,
        i: I,
        run: TriangleRun,
        positions: Ends<S>,
        numbers: Range<u32>,
        corners: impl Fn(u32) -> [TreeVertex; C],
    ) -> &ElementRun {
        // The high bits of a product depend on all of the number.
        let place = run.first.0.wrapping_mul(0x9E37_79B9) >> (u32::BITS - KEPT);
        let kept = &mut self.kept[place as usize];
        if kept.descent != self.descent || kept.of != run {
            kept.descent = self.descent;
            kept.of = run;
            kept.make(i, positions, numbers, corners);
        }
        kept
    }
}

impl ElementRun {
    fn none() -> Self {
        Self {
            of: TriangleRun::default(),
            descent: 0,
            elements: 0..0,
            boxes: [Eight::EMPTY; EIGHTS],
            all: Eight::EMPTY.get(0),
            most: 0.0,
        }
    }

    #[inline(always)]
    fn make<I: Simd, S: Coordinate, const C: usize>(
        &mut self,
        i: I,
        (shape, end): Ends<S>,
        elements: Range<u32>,
        corners: impl Fn(u32) -> [TreeVertex; C],
    ) {
        self.elements = elements.clone();
        let mut eights = self.boxes.iter_mut();
        for first in elements.clone().step_by(8) {
            let Some(lanes) = eights.next() else {
                break;
            };
            let mut eight = [corners(first); 8];
            for lane in 1..8 {
                let element = first + lane;
                if element < elements.end {
                    eight[lane as usize] = corners(element);
                }
            }
            gaps::of_elements(i, shape, end, &eight, lanes);
            let all = lanes.union();
            self.all = if first == elements.start {
                all
            } else {
                self.all.union(&all)
            };
        }
        self.most = 0.0;
        for side in [self.all.lo, self.all.hi] {
            for x in side {
                self.most = larger(self.most, x.abs());
            }
        }
    }

    /// Of each eight the elements that are possibly near a box: bit i of the i-th.
    #[inline(always)]
    fn near<I: Simd>(&self, i: I, other: &Aabb, limits: Limits) -> [u64; EIGHTS] {
        let mut near = [0; EIGHTS];
        let mut left = self.elements.len();
        for eight in 0..EIGHTS {
            if left == 0 {
                break;
            }
            let there = if left < 8 { (1 << left) - 1 } else { 0xFF };
            near[eight] = gaps::near_box(i, &self.boxes[eight], other, limits) & there;
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
        if self.elements.is_empty() || other.elements.is_empty() {
            return;
        }
        let rows = self.near(i, &other.all, limits);
        if rows == [0; EIGHTS] {
            return;
        }
        let columns = other.near(i, &self.all, limits);
        for a in 0..EIGHTS {
            if rows[a] == 0 {
                continue;
            }
            for b in (if itself { a } else { 0 })..EIGHTS {
                if columns[b] == 0 {
                    continue;
                }
                let (boxes_a, boxes_b) = (&self.boxes[a], &other.boxes[b]);
                let (sure, mut possible) = gaps::near_pairs(i, boxes_a, rows[a], boxes_b, limits);
                // A byte of it for each row.
                possible &= columns[b] * 0x0101_0101_0101_0101;
                if itself && a == b {
                    possible &= STRICT_UPPER;
                }
                if possible != 0 {
                    let firsts = [
                        self.elements.start + 8 * a as u32,
                        other.elements.start + 8 * b as u32,
                    ];
                    found(firsts, sure & possible, possible);
                }
            }
        }
    }
}

impl Held for Runs {
    fn held(&self) -> usize {
        held::list(&self.kept)
    }
}
