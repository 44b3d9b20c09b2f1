//! Separating axis test over time (separating directions): which of eight pairs of moving elements
//! stay apart during a motion.
//!
//! Corners move on straight lines, so on a fixed direction n the difference q(t) of two corners has
//! a projection affine in t. An element is the hull of its corners. So if all projections are above
//! zero at two times, the elements are apart at all times between. That is a proof for every n;
//! here n is the way between the closest points at the latest time known to be free. Most pairs,
//! whether tangential, parting or near, are known to be apart all the way after one direction.

use super::coordinate::{Coordinate, Vectors};
use crate::geometry::vector::{dot, minus, plus, times};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, mask32x8};

/// Relative bound on rounding: 10 u.
const RELATIVE_ERROR: f32 = 10.0 * (f32::EPSILON / 2.0);
/// Bound on what is lost below the normal range: 2^-60.
const LOST: f32 = 1.0 / (1_u64 << 60) as f32;
/// Bound on the components of a direction: 2^60.
const LONGEST: f32 = (1_u64 << 60) as f32;
/// Bound on sums of products: 2^120. Below it no product, and no sum of products, overflows or is
/// NaN.
const LARGEST: f32 = LONGEST * LONGEST;
/// Part of a gain in time that is taken: a thousandth is more than the rounding of times.
const THOUSANDTH_LESS: f32 = 0.999;
/// The least gain in time that counts: 2^-12.
const LEAST_GAIN: f32 = 1.0 / (1_u64 << 12) as f32;
/// Number of directions that are tried before a pair is left open.
const DIRECTIONS: usize = 3;

/// Corners of eight pairs of moving elements, by corner and lane.
///
/// Corners 0 to 3 are at the start of the motion, 4 to 7 at its end. They are a vertex and a
/// triangle's corners, or both ends of either edge.
pub(crate) type MovingCorners<'p, S> = [[&'p [S; 4]; 8]; 8];

/// Differences of the corners of two elements: a polygon in motion, in eight lanes. A triangle does
/// not use the last corner.
struct Polygon<I: Simd> {
    start: [Vectors<I>; 4],
    end: [Vectors<I>; 4],
    /// Per component, the larger magnitude at start and end.
    most: [Vectors<I>; 4],
}

/// Corner differences of two edges: a parallelogram's corners in order, at the start and at the
/// end.
const OF_EDGES: [(usize, usize); 8] = [
    (0, 2),
    (1, 2),
    (1, 3),
    (0, 3),
    (4, 6),
    (5, 6),
    (5, 7),
    (4, 7),
];

/// Corner differences of a triangle and a vertex: a triangle, at the start and at the end.
const OF_TRIANGLES: [(usize, usize); 6] = [(1, 0), (2, 0), (3, 0), (5, 4), (6, 4), (7, 4)];

/// Bit mask of the pairs, of eight, that surely stay further apart than `distance` up to the time
/// `until`, at most 1.
///
/// All are two edges each, or all are a vertex and a triangle.
#[inline(always)]
pub(crate) fn apart<I: Simd, S: Coordinate>(
    i: I,
    are_edges: bool,
    corners: &MovingCorners<S>,
    until: f32,
    distance: f32,
) -> u8 {
    let corner = |corner: usize, lane: usize| corners[corner][lane];
    if are_edges {
        let [a0, b0, c0, d0, a1, b1, c1, d1] = S::differences(i, 8, corner, OF_EDGES);
        let polygon = Polygon::new([a0, b0, c0, d0], [a1, b1, c1, d1]);
        stays_off::<I, true>(&polygon, until, distance)
    } else {
        let [a0, b0, c0, a1, b1, c1] = S::differences(i, 8, corner, OF_TRIANGLES);
        // A repeated first corner in place of a fourth costs little.
        let polygon = Polygon::new([a0, b0, c0, a0], [a1, b1, c1, a1]);
        stays_off::<I, false>(&polygon, until, distance)
    }
}

/// Bit mask of the polygons, of eight, that surely stay further from the origin than `distance` up
/// to the time `until`.
///
/// Affine functions are compared with their values, less the error bound, at both ends of the rest
/// of the motion. Let these be a > 0 and b < 0. Then the function is above zero, in exact
/// arithmetic, up to the part a / (a - b) of the rest. A thousandth less is taken, which is more
/// than the rounding of times if the gain is at least 2^-12. Smaller gains do not count.
///
/// # Rounding
///
/// Let u = 2^-24. These roundings are on every path:
///
/// - A difference of corners: one rounding to `f32`. Differences of `f64` have a second one, 2^29
///   times smaller.
/// - A projection: one for each product, and two sums.
/// - A value between two times: three more.
///
/// That is seven roundings. Each is of a number of at most s, the sum of |n| |q| over the axes,
/// with the larger |q| of both ends. The bound allows 10 u s.
///
/// Below the normal range a difference loses less than 2^-126 times a component of n, and a product
/// less than 2^-126. That holds even where subnormal numbers are flushed to zero. Where the
/// components of n are below 2^60, the loss in all is less than 2^-62. The bound allows 2^-60.
/// Other lanes, and lanes in which something is infinite, are not known to be apart.
#[inline(always)]
fn stays_off<I: Simd, const ARE_EDGES: bool>(
    polygon: &Polygon<I>,
    until: f32,
    distance: f32,
) -> u8 {
    let i = polygon.start[0][0].token();
    let splat = |x: f32| f32x8::splat(i, x);
    let (zero, until) = (splat(0.0), splat(until));
    let mut known = zero;
    let mut are_apart = 0;
    for _ in 0..DIRECTIONS {
        let now = polygon.at(known);
        let n = nearest_of::<I, ARE_EDGES>(&now);
        let wide = n[0].abs() + n[1].abs() + n[2].abs();
        // Divided by the length of n, which is off by less than 4 u of itself, the projections
        // would be distances.
        let level = dot(n, n).sqrt() * splat(distance * (1.0 + f32::EPSILON * 8.0));
        let (mut at_known, mut at_end) = (splat(f32::INFINITY), splat(f32::INFINITY));
        let mut gain = splat(1.0);
        let mut sums = zero;
        let corners = if ARE_EDGES { 4 } else { 3 };
        for corner in 0..corners {
            let most = &polygon.most[corner];
            let sum = n[0].abs() * most[0] + n[1].abs() * most[1] + n[2].abs() * most[2];
            sums += sum;
            let error = sum * splat(RELATIVE_ERROR) + splat(LOST) + level;
            let start = dot(n, polygon.start[corner]);
            let step = dot(n, polygon.end[corner]) - start;
            let first = start + known * step - error;
            let last = start + until * step - error;
            at_known = at_known.min(first);
            at_end = at_end.min(last);
            // Where `last` is above zero there is no limit: `part` is then at least 1, or NaN.
            let part = first / (first - last);
            gain = last.simd_gt(zero).select(gain, gain.min(part));
        }
        let is_finite = wide.simd_lt(splat(LONGEST)) & sums.simd_lt(splat(LARGEST));
        let is_known = at_known.simd_gt(zero) & is_finite;
        let is_apart: mask32x8<I> = is_known & at_end.simd_gt(zero);
        are_apart |= is_apart.to_bitmask() as u8;
        if are_apart == u8::MAX {
            break;
        }
        let gain = gain * (until - known) * splat(THOUSANDTH_LESS);
        let is_gained = is_known & gain.simd_gt(splat(LEAST_GAIN));
        if !is_gained.any_true() {
            break;
        }
        known = is_gained.select(known + gain, known);
    }
    are_apart
}

impl<I: Simd> Polygon<I> {
    #[inline(always)]
    fn new(start: [Vectors<I>; 4], end: [Vectors<I>; 4]) -> Self {
        let mut most = start;
        for corner in 0..4 {
            for axis in 0..3 {
                let [first, last] = [start[corner][axis], end[corner][axis]];
                most[corner][axis] = first.abs().max(last.abs());
            }
        }
        Self { start, end, most }
    }

    /// Approximate corners at the time `t`.
    #[inline(always)]
    fn at(&self, t: f32x8<I>) -> [Vectors<I>; 4] {
        let mut at = self.start;
        for corner in 0..4 {
            for axis in 0..3 {
                let [first, last] = [self.start[corner][axis], self.end[corner][axis]];
                at[corner][axis] = first + t * (last - first);
            }
        }
        at
    }
}

/// The nearest point so far, and the square of its distance from the origin.
struct Nearest<I: Simd> {
    point: Vectors<I>,
    square: f32x8<I>,
}

impl<I: Simd> Nearest<I> {
    #[inline(always)]
    fn take(&mut self, is_candidate: Option<mask32x8<I>>, point: Vectors<I>) {
        let square = dot(point, point);
        let mut mask = square.simd_lt(self.square);
        if let Some(is_candidate) = is_candidate {
            mask &= is_candidate;
        }
        for axis in 0..3 {
            self.point[axis] = mask.select(point[axis], self.point[axis]);
        }
        self.square = mask.select(square, self.square);
    }
}

/// Approximate point of a parallelogram, or of a triangle, that is nearest to the origin.
#[inline(always)]
fn nearest_of<I: Simd, const ARE_EDGES: bool>([a, b, c, d]: &[Vectors<I>; 4]) -> Vectors<I> {
    let last = if ARE_EDGES { d } else { c };
    let (e, f) = (minus(*b, *a), minus(*last, *a));
    let first = on_segment(*a, e);
    let mut nearest = Nearest {
        point: first,
        square: dot(first, first),
    };
    nearest.take(None, on_segment(*a, f));
    nearest.take(None, on_segment(*b, minus(*c, *b)));
    if ARE_EDGES {
        nearest.take(None, on_segment(*d, minus(*c, *d)));
    }
    let (x, y, is_inside) = foot(*a, e, f);
    let one = f32x8::splat(x.token(), 1.0);
    let are_not_beyond = if ARE_EDGES {
        x.simd_le(one) & y.simd_le(one)
    } else {
        (x + y).simd_le(one)
    };
    nearest.take(
        Some(is_inside & are_not_beyond),
        along(along(*a, x, e), y, f),
    );
    nearest.point
}

/// The point nearest to the origin on the segment from `p` to `p + e`.
#[inline(always)]
fn on_segment<I: Simd>(p: Vectors<I>, e: Vectors<I>) -> Vectors<I> {
    let i = p[0].token();
    let (zero, one) = (f32x8::splat(i, 0.0), f32x8::splat(i, 1.0));
    let (part, whole) = (zero - dot(p, e), dot(e, e));
    // A segment that is a point has zero for both.
    let inside = part.simd_lt(whole).select(part / whole, one);
    along(p, part.simd_gt(zero).select(inside, zero), e)
}

/// Foot of the perpendicular from the origin to the plane through `p` with sides `e` and `f`.
///
/// Returns how far along both sides it is, and whether neither is below zero.
#[inline(always)]
fn foot<I: Simd>(p: Vectors<I>, e: Vectors<I>, f: Vectors<I>) -> (f32x8<I>, f32x8<I>, mask32x8<I>) {
    let zero = f32x8::splat(p[0].token(), 0.0);
    let (ee, ef, ff) = (dot(e, e), dot(e, f), dot(f, f));
    let (pe, pf) = (zero - dot(p, e), zero - dot(p, f));
    let whole = ee * ff - ef * ef;
    let (x, y) = ((ff * pe - ef * pf) / whole, (ee * pf - ef * pe) / whole);
    (
        x,
        y,
        whole.simd_gt(zero) & x.simd_ge(zero) & y.simd_ge(zero),
    )
}

#[inline(always)]
fn along<I: Simd>(p: Vectors<I>, t: f32x8<I>, e: Vectors<I>) -> Vectors<I> {
    plus(p, times(t, e))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernels::{Instructions, dispatch};
    use pliant_exact::distance::{Primitives, are_within_distance};
    use pliant_oracle::{Elements, MotionClass, Moving, Random, first_contact, motion_fits_f32};
    use std::cmp::Ordering;

    /// Bit mask of the motions, of eight, that are surely apart. Asserts that it is equal for all
    /// instruction sets.
    fn claims<S: Coordinate>(
        motions: &[(Elements, Moving); 8],
        elements: Elements,
        of: fn(f64) -> S,
        until: f32,
        distance: f32,
    ) -> u8 {
        let padded = motions.map(|(_, motion)| {
            let corners = [motion[0], motion[1]].concat();
            let padded = corners.iter().map(|&[x, y, z]| [x, y, z, z].map(of));
            padded.collect::<Vec<[S; 4]>>()
        });
        let mut corners = [[&padded[0][0]; 8]; 8];
        for (lane, pair) in padded.iter().enumerate() {
            for (which, corner) in pair.iter().enumerate() {
                corners[which][lane] = corner;
            }
        }
        let of_all = Instructions::all().into_iter().map(|instructions| {
            let are_edges = matches!(elements, Elements::EdgeEdge);
            dispatch!(instructions, i => apart(i, are_edges, &corners, until, distance))
        });
        let of_all: Vec<u8> = of_all.collect();
        assert!(of_all.iter().all(|claims| *claims == of_all[0]));
        of_all[0]
    }

    #[test]
    fn what_is_claimed_to_be_apart_is() {
        let mut random = Random::new(77);
        let [mut claimed, mut claimed_far, mut total] = [0; 3];
        for round in 0..12_000 {
            let class = MotionClass::ALL[round % MotionClass::ALL.len()];
            let mut motions: Vec<(Elements, Moving)> = Vec::new();
            let elements = [Elements::VertexTriangle, Elements::EdgeEdge][round / 64 % 2];
            while motions.len() < 8 {
                let motion = class.motion(&mut random);
                if motion.0 == elements {
                    motions.push(motion);
                }
            }
            let motions: [(Elements, Moving); 8] = motions.try_into().expect("eight");
            let until = [1.0, 0.5, 0.125][round % 3];
            let doubles = claims(&motions, elements, |x| x, until, 0.0);
            let are_single = motions.iter().all(|(_, motion)| motion_fits_f32(motion));
            let singles = if are_single {
                claims(&motions, elements, |x| x as f32, until, 0.0)
            } else {
                0
            };
            // A distance of the size that occurs in the motion.
            let distance = (motions[0].1[0][0][0] - motions[0].1[0][2][0]).abs() as f32 * 0.25;
            let far = claims(&motions, elements, |x| x, until, distance);
            assert_eq!(far & !doubles, 0, "further apart than a distance is apart");
            for (lane, (_, motion)) in motions.iter().enumerate() {
                total += 1;
                let is = |mask: u8| mask >> lane & 1 == 1;
                if is(doubles | singles) {
                    claimed += 1;
                    if let Some(first) = first_contact(elements, motion) {
                        assert_eq!(first.compare(until.into()), Ordering::Greater, "{motion:?}");
                    }
                }
                if is(far) && distance > 0.0 {
                    claimed_far += 1;
                    for corners in [Some(motion[0]), (until == 1.0).then_some(motion[1])] {
                        let Some(corners) = corners else { continue };
                        let elements = match elements {
                            Elements::VertexTriangle => Primitives::VertexTriangle(corners),
                            Elements::EdgeEdge => Primitives::EdgeEdge(corners),
                        };
                        assert!(!are_within_distance(&elements, f64::from(distance)));
                    }
                }
            }
        }
        assert!(
            claimed > total / 10 && claimed_far > total / 50,
            "{claimed} {claimed_far} of {total}"
        );
    }
}
