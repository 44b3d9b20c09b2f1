//! Boxes of elements (vertices, edges, triangles) in lanes, and which of them are near each other.
//!
//! The **gap** of two boxes is the largest of six differences, lower sides less upper sides; it is
//! at most zero where they overlap. These boxes are not rounded outward. Sides of `f32` positions
//! are exact; sides of `f64` positions are relative to the origin and rounded to the nearest `f32`.
//! So a gap computed in `f32` has an error, which [`Limits`] bounds. A gap below the lower limit is
//! surely small enough, one above the upper limit surely not; between them exact arithmetic
//! (`pliant_exact`) decides.

use super::Coordinate;
use super::boxes::{EightBoxes, Registers};
use super::coordinate::lanes_of;
use crate::geometry::{Aabb, Points, Real, Shape};
use crate::ids::TreeVertex;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x4, f32x8, mask32x8, u32x8};

/// Corners of eight elements with `C` corners each, by corner and lane.
pub(crate) type EightCorners<const C: usize> = [[u32; 8]; C];

/// Error bounds of a computed gap against a distance d.
///
/// A gap below `sure` is surely at most d, and a gap above `possible` is surely more.
///
/// # Positions of `f32`
///
/// A computed gap is the true gap, rounded. Rounding is monotonic, so it is below `fl(d)` only if
/// the gap is below d, and above `fl(d)` only if the gap is above d. So both limits are `fl(d)`.
///
/// # Positions of `f64`
///
/// Let m bound `|x - origin|` for all coordinates x.
///
/// - A side is off by at most 2^-53 m from the subtraction, and by `(1 + 2^-53) 2^-24 m` from the
///   rounding.
/// - Below the normal range the rounding is off by 2^-150, or by 2^-126 where subnormal numbers are
///   flushed.
/// - A difference of two sides adds 2^-24 of itself, which is at most `2^-23 (1 + 2^-23) m`.
///
/// In all that is less than `2^-21.8 m + 2^-124`. The limits allow `2^-21 m + 2^-120`. Sides that
/// were beyond `f32` are off by more. So where m is not far below the largest `f32`, no limit is
/// sure.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    sure: f32,
    possible: f32,
}

impl Limits {
    /// Limits for a distance of at least 0 between two bounds, where no coordinate is further than
    /// `most` from the origin on any axis.
    pub(crate) fn new<S: Real>([least, greatest]: [f64; 2], most: f64) -> Self {
        if S::BOXES_ARE_EXACT {
            return Self {
                sure: least as f32,
                possible: greatest as f32,
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
            sure: ((least - error) as f32).next_down(),
            possible: ((greatest + error) as f32).next_up(),
        }
    }

    /// Both limits, `sure` and `possible`, in every lane.
    #[inline(always)]
    pub(super) fn in_lanes<I: Simd>(self, i: I) -> [f32x8<I>; 2] {
        [f32x8::splat(i, self.sure), f32x8::splat(i, self.possible)]
    }

    /// Whether two boxes are possibly near each other.
    #[inline(always)]
    pub(crate) fn are_possibly_near<I: Simd>(self, i: I, a: &PaddedBox, b: &PaddedBox) -> bool {
        let load = |corner: &[f32; 4]| f32x4::load_array_ref(i, corner);
        let gaps = (load(&a.lo) - load(&b.hi)).max(load(&b.lo) - load(&a.hi));
        gaps.simd_le(f32x4::splat(i, self.possible)).all_true()
    }
}

/// A box whose corners fill registers of four. Behind z is 0, so that the fourth axis has no gap.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PaddedBox {
    pub(crate) lo: [f32; 4],
    pub(crate) hi: [f32; 4],
}

impl From<Aabb> for PaddedBox {
    fn from(Aabb { lo, hi }: Aabb) -> Self {
        let [lo, hi] = [lo, hi].map(|[x, y, z]| [x, y, z, 0.0]);
        Self { lo, hi }
    }
}

/// Boxes of eight elements with `C` corners each, written to `lanes`.
///
/// With `end`, the positions of vertices at the end of a motion, a box holds the element at both
/// ends.
#[inline(always)]
pub(crate) fn of_elements<I: Simd, S: Coordinate, const C: usize>(
    i: I,
    shape: &Shape<S>,
    end: Option<&Points<S>>,
    corners: &EightCorners<C>,
    lanes: &mut EightBoxes,
) {
    let zero = f32x4::splat(i, 0.0);
    let (mut lo, mut hi) = ([zero; 8], [zero; 8]);
    for lane in 0..8 {
        let corner = |which: usize| TreeVertex(corners[which][lane]);
        let first = S::load(i, shape.positions.padded(corner(0)));
        let (mut least, mut most) = (first, first);
        for which in 1..C {
            let corner = S::load(i, shape.positions.padded(corner(which)));
            (least, most) = (least.min(corner), most.max(corner));
        }
        if let Some(end) = end {
            for which in 0..C {
                let corner = S::load(i, end.padded(corner(which)));
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

impl<I: Simd> Registers<I> {
    /// Gaps between the boxes of two registers, lane by lane.
    #[inline(always)]
    pub(super) fn gaps_to(&self, others: &Self) -> f32x8<I> {
        let on = |axis: usize| {
            let below = self.lo[axis] - others.hi[axis];
            below.max(others.lo[axis] - self.hi[axis])
        };
        on(0).max(on(1)).max(on(2))
    }

    /// Gap of each box to one box.
    #[inline(always)]
    fn gaps<const D: usize>(&self, one_lo: [f32; D], one_hi: [f32; D]) -> f32x8<I> {
        let i = self.lo[0].token();
        let on = |axis: usize| {
            let below = self.lo[axis] - one_hi[axis];
            let above = f32x8::splat(i, one_lo[axis]) - self.hi[axis];
            below.max(above)
        };
        on(0).max(on(1)).max(on(2))
    }
}

/// Bit mask of the lanes that are possibly near a box.
#[inline(always)]
pub(crate) fn near_box<I: Simd>(i: I, lanes: &EightBoxes, all: &PaddedBox, limits: Limits) -> u64 {
    let gaps = Registers::new(i, lanes).gaps(all.lo, all.hi);
    gaps.simd_le(f32x8::splat(i, limits.possible)).to_bitmask()
}

/// Bit mask `8 i + j` of the pairs of lanes (i, j) that are possibly near each other, and whether
/// any of these is not surely so.
///
/// Only the lanes i of the mask `rows` are compared. Within one body, elements that share a corner
/// are left out.
#[inline(always)]
pub(crate) fn near_pairs<I: Simd, const A: usize, const B: usize>(
    i: I,
    (a, corners_a): (&EightBoxes, &EightCorners<A>),
    rows: u32,
    (b, corners_b): (&EightBoxes, &EightCorners<B>),
    is_one_body: bool,
    limits: Limits,
) -> (u64, bool) {
    let registers = Registers::new(i, b);
    let corners_b = corners_b.map(|corners| u32x8::load_array(i, corners));
    let [least_unsure, possible] = limits.in_lanes(i);
    let mut all = 0;
    let mut unsure = mask32x8::splat(i, false);
    let mut rest = rows;
    while rest != 0 {
        let lane = rest.trailing_zeros() as usize % 8;
        rest &= rest - 1;
        let gaps = registers.gaps(
            [a.lo[0][lane], a.lo[1][lane], a.lo[2][lane]],
            [a.hi[0][lane], a.hi[1][lane], a.hi[2][lane]],
        );
        let mut near = gaps.simd_le(possible);
        if is_one_body {
            for corners in corners_a {
                let corner = u32x8::splat(i, corners[lane]);
                for corners in corners_b {
                    near &= !corners.simd_eq(corner);
                }
            }
        }
        unsure |= near & gaps.simd_ge(least_unsure);
        all |= near.to_bitmask() << (8 * lane);
    }
    (all, unsure.any_true())
}

/// Bit mask `8 i + j` of the pairs of lanes (i, j) that are surely near each other.
#[inline(always)]
pub(crate) fn sure_pairs<I: Simd>(i: I, a: &EightBoxes, b: &EightBoxes, limits: Limits) -> u64 {
    let registers = Registers::new(i, b);
    let mut sure = 0;
    for lane in 0..8 {
        let one = a.get(lane);
        let gaps = registers.gaps(one.lo, one.hi);
        sure |= gaps.simd_lt(f32x8::splat(i, limits.sure)).to_bitmask() << (8 * lane);
    }
    sure
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Bounds;
    use crate::kernels::{Instructions, dispatch};
    use pliant_oracle::{Class, Random};

    /// Compares two triangles at distances round their gap with exact arithmetic.
    ///
    /// Returns how often the limits were not certain, and how often limits for a sixty-fourth of
    /// the error would have been wrong.
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
                version: 1,
            };
            let triangles = [[0, 1, 2], [3, 4, 5]].map(|it| it.map(TreeVertex));
            let lanes = triangles.map(|corners| corners.map(|corner| [corner.0; 8]));
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
                let expected = exact[0].are_within(&exact[1], distance);
                for instructions in Instructions::all() {
                    dispatch!(instructions, i => {
                        let [mut a, mut b] = [EightBoxes::EMPTY; 2];
                        of_elements(i, &shape, None, &lanes[0], &mut a);
                        of_elements(i, &shape, None, &lanes[1], &mut b);
                        let all = [a, b].map(|lanes| lanes.get(0));
                        let most = all.iter().flat_map(|it| [it.lo, it.hi]).flatten();
                        let most = most.fold(0.0, |most: f32, x| most.max(x.abs()));
                        let limits = Limits::new::<S>([distance; 2], most.into());
                        let decide = |limits| {
                            let [a, b] = [(&a, &lanes[0]), (&b, &lanes[1])];
                            let (possible, is_unsure) = near_pairs(i, a, 1, b, true, limits);
                            let sure = sure_pairs(i, a.0, b.0, limits) & 1 == 1;
                            let possible = possible & 1 == 1;
                            assert_eq!(is_unsure, possible && !sure);
                            (sure, possible)
                        };
                        let (sure, possible) = decide(limits);
                        assert!(!sure || expected, "{corners:?} {origin:?} {distance}");
                        assert!(possible || !expected, "{corners:?} {origin:?} {distance}");
                        uncertain += usize::from(possible && !sure);
                        let narrow = Limits::new::<S>([distance; 2], f64::from(most) / 64.0);
                        let (sure, possible) = decide(narrow);
                        wrong += usize::from(sure && !expected || !possible && expected);
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
        // Positions of `f32` need no allowance at all.
        assert!(uncertain > 1000 && wrong == 0, "{uncertain} {wrong}");
    }
}
