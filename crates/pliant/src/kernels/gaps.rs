//! Boxes of vertices, edges and triangles side by side, and which of them are near each other, eight at a time.
//!
//! Between two boxes the *gap* is the largest of six differences, lower sides less upper ones: at most zero where they overlap. The
//! boxes here are not rounded outward: in single precision they are exact, and in double precision their sides are relative to the origin
//! and rounded to the nearest `f32`. So a gap computed in `f32` is off, and [`Limits`] says by how much at most: below the one it
//! is surely small enough, above the other surely not, and between them exact arithmetic is asked (`predicates::gap`).
//!
//! With positions of `f32`, a computed gap is the true one, rounded. Rounding is monotonic, so it is below `fl(d)` only if the gap is below
//! d, and above `fl(d)` only if the gap is above d: both limits are `fl(d)`.
//!
//! With positions of `f64`, let m bound |x - origin| for all coordinates x. A side is off by at most 2^-53 m from the subtraction, and from
//! the rounding by (1 + 2^-53) 2^-24 m, or below the normal range by 2^-150 (by 2^-126 where subnormal numbers are flushed). A difference
//! of two sides adds 2^-24 of itself, which is at most 2^-23 (1 + 2^-23) m. In all that is less than 2^-21.8 m + 2^-124; the limits allow
//! 2^-21 m + 2^-120. Sides that were beyond `f32` are off by more: where m is not far below the largest `f32`, no limit is sure.

use super::Coordinate;
use super::boxes::{BoxLanes, eight};
use super::coordinate::lanes_of;
use crate::geometry::{Aabb, Points, Real, Shape};
use crate::ids::TreeVertex;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x4, f32x8};

/// Boxes side by side.
pub(crate) type Eight = BoxLanes<8>;

/// A gap below the one is surely at most the distance asked for, above the other surely not.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    sure: f32,
    possible: f32,
}

impl Limits {
    /// For a distance that is at least 0, where no coordinate is further than `most` from the origin on any axis.
    pub(crate) fn new<S: Real>(distance: f64, most: f64) -> Self {
        if S::BOXES_ARE_EXACT {
            let rounded = distance as f32;
            return Self {
                sure: rounded,
                possible: rounded,
            };
        }
        if most > f64::from(f32::MAX) / 4.0 {
            return Self {
                sure: f32::NEG_INFINITY,
                possible: f32::INFINITY,
            };
        }
        let error = most * f64::powi(0.5, 21) + f64::powi(0.5, 120);
        Self {
            sure: ((distance - error) as f32).next_down(),
            possible: ((distance + error) as f32).next_up(),
        }
    }
}

/// The boxes of up to eight elements, each of which has `C` corners; those that are missing are the first again. `end` is where the
/// vertices are at the end of a motion.
#[inline(always)]
pub(crate) fn of_elements<I: Simd, S: Coordinate, const C: usize>(
    i: I,
    shape: &Shape<S>,
    end: Option<&Points<S>>,
    elements: &[[TreeVertex; C]; 8],
    lanes: &mut Eight,
) {
    let zero = f32x4::splat(i, 0.0);
    let (mut lo, mut hi) = ([zero; 8], [zero; 8]);
    for lane in 0..8 {
        let corners = &elements[lane];
        let first = S::load(i, shape.positions.padded(corners[0]));
        let (mut least, mut most) = (first, first);
        for which in 1..C {
            let corner = S::load(i, shape.positions.padded(corners[which]));
            (least, most) = (least.min(corner), most.max(corner));
        }
        if let Some(end) = end {
            for which in 0..C {
                let corner = S::load(i, end.padded(corners[which]));
                (least, most) = (least.min(corner), most.max(corner));
            }
        }
        (lo[lane], hi[lane]) = S::nearest(least, most, &shape.origin);
    }
    let (lo, hi) = (lanes_of(lo), lanes_of(hi));
    for axis in 0..3 {
        lo[axis].store_array(&mut lanes.lo[axis]);
        hi[axis].store_array(&mut lanes.hi[axis]);
    }
}

/// Which lanes are surely near a box, and which possibly: bit i for lane i.
#[inline(always)]
fn near_one<I: Simd>(
    lo: &[f32x8<I>; 3],
    hi: &[f32x8<I>; 3],
    one: ([f32; 3], [f32; 3]),
    limits: Limits,
) -> (u64, u64) {
    let (one_lo, one_hi) = one;
    let i = lo[0].token();
    let mut gap = (lo[0] - one_hi[0]).max(f32x8::splat(i, one_lo[0]) - hi[0]);
    for axis in 1..3 {
        let below = lo[axis] - one_hi[axis];
        let above = f32x8::splat(i, one_lo[axis]) - hi[axis];
        gap = gap.max(below.max(above));
    }
    let sure = gap.simd_lt(f32x8::splat(i, limits.sure));
    let possible = gap.simd_le(f32x8::splat(i, limits.possible));
    (sure.to_bitmask(), possible.to_bitmask())
}

/// Which lanes are possibly near a box.
#[inline(always)]
pub(crate) fn near_box<I: Simd>(i: I, lanes: &Eight, all: &Aabb, limits: Limits) -> u64 {
    let (lo, hi) = registers(i, lanes);
    near_one(&lo, &hi, (all.lo, all.hi), limits).1
}

/// Which pairs of lanes (i, j) are surely near each other, and which possibly: bit 8 i + j. Of the first only the lanes of a mask.
#[inline(always)]
pub(crate) fn near_pairs<I: Simd>(
    i: I,
    a: &Eight,
    rows: u64,
    b: &Eight,
    limits: Limits,
) -> (u64, u64) {
    let (lo, hi) = registers(i, b);
    let (mut sure, mut possible) = (0, 0);
    let mut rest = rows;
    while rest != 0 {
        let lane = rest.trailing_zeros() as usize % 8;
        rest &= rest - 1;
        let one = (
            [a.lo[0][lane], a.lo[1][lane], a.lo[2][lane]],
            [a.hi[0][lane], a.hi[1][lane], a.hi[2][lane]],
        );
        let (row_sure, row_possible) = near_one(&lo, &hi, one, limits);
        sure |= row_sure << (8 * lane);
        possible |= row_possible << (8 * lane);
    }
    (sure, possible)
}

#[inline(always)]
fn registers<I: Simd>(i: I, lanes: &Eight) -> ([f32x8<I>; 3], [f32x8<I>; 3]) {
    let empty = f32x8::splat(i, 0.0);
    let (mut lo, mut hi) = ([empty; 3], [empty; 3]);
    for axis in 0..3 {
        lo[axis] = eight(i, &lanes.lo[axis]);
        hi[axis] = eight(i, &lanes.hi[axis]);
    }
    (lo, hi)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Bounds;
    use crate::kernels::{Instructions, dispatch};
    use crate::predicates::are_within;
    use pliant_oracle::{Class, Random};

    /// Compares two triangles at distances round their gap with exact arithmetic; returns how often the limits were not certain, and how
    /// often limits that allow for a sixty-fourth of the error would have been wrong.
    fn check<S: Coordinate>(of: fn(f64) -> S, classes: &[Class], rounds: usize) -> [usize; 2] {
        let mut random = Random::new(31);
        let [mut uncertain, mut wrong] = [0; 2];
        for round in 0..rounds {
            let corners = classes[round % classes.len()].pair(&mut random).concat();
            let points = Points::of(corners.iter().map(|corner| corner.map(of)));
            let origin = if S::BOXES_ARE_EXACT || round % 3 == 0 {
                [0.0; 4]
            } else {
                let [x, y, z] = corners[round % 6];
                [x, y, z, 0.0]
            };
            let shape = Shape {
                positions: &points,
                triangles: &[],
                origin,
                epoch: 1,
            };
            let triangles = [[0, 1, 2], [3, 4, 5]].map(|it| it.map(TreeVertex));
            let exact = triangles.map(|corners| {
                let mut bounds = Bounds::EMPTY;
                for corner in corners {
                    bounds.include(points.get(corner).map(Real::to_f64));
                }
                bounds
            });
            let gap = (0..3).fold(f64::NEG_INFINITY, |gap, axis| {
                let [a, b] = &exact;
                gap.max(a.lo[axis] - b.hi[axis])
                    .max(b.lo[axis] - a.hi[axis])
            });
            let gap = gap.max(0.0);
            let near = |by: f64| gap * (1.0 + by);
            for distance in [
                gap,
                gap.next_up(),
                gap.next_down(),
                near(1e-7),
                near(-1e-7),
                near(0.5),
                0.0,
            ] {
                if distance < 0.0 {
                    continue;
                }
                let expected = are_within(&exact[0], &exact[1], distance);
                for instructions in Instructions::all() {
                    dispatch!(instructions, i => {
                        let [mut a, mut b] = [Eight::EMPTY; 2];
                        of_elements(i, &shape, None, &[triangles[0]; 8], &mut a);
                        of_elements(i, &shape, None, &[triangles[1]; 8], &mut b);
                        let all = [a, b].map(|lanes| lanes.get(0));
                        let most = all.iter().flat_map(|it| [it.lo, it.hi]).flatten();
                        let most = most.fold(0.0, |most: f32, x| most.max(x.abs()));
                        let limits = Limits::new::<S>(distance, most.into());
                        let (sure, possible) = near_pairs(i, &a, 1, &b, limits);
                        let (sure, possible) = (sure & 1 == 1, possible & 1 == 1);
                        assert!(!sure || expected, "{corners:?} {origin:?} {distance}");
                        assert!(possible || !expected, "{corners:?} {origin:?} {distance}");
                        uncertain += usize::from(possible && !sure);
                        let narrow = Limits::new::<S>(distance, f64::from(most) / 64.0);
                        let (sure, possible) = near_pairs(i, &a, 1, &b, narrow);
                        wrong += usize::from(sure & 1 == 1 && !expected || possible & 1 == 0 && expected);
                    });
                }
            }
        }
        [uncertain, wrong]
    }

    #[test]
    fn what_the_limits_are_sure_of_is_so() {
        let [uncertain, wrong] = check(|x| x, &Class::ALL, 4000);
        assert!(uncertain > 1000 && wrong > 0, "{uncertain} {wrong}");
        let [uncertain, wrong] = check(|x| x as f32, &Class::ALL, 4000);
        // Positions of single precision need no allowance at all.
        assert!(uncertain > 1000 && wrong == 0, "{uncertain} {wrong}");
    }
}
