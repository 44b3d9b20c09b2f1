//! Whether elements that move stay apart: eight pairs side by side, by separating directions.
//!
//! Corners move on straight lines. So for any direction n that stands still, the projection n . q(t) of the difference q of two corners is
//! affine in t; and elements are hulls of their corners at every time. If at two times all projections of corners of the one less corners
//! of the other are above zero, the elements are apart at all times between them. This is a proof for every n, however it was found. Here n
//! is the way between the closest points at the time up to which a pair is known to be apart, from plain arithmetic; a time is gained up to
//! which the projections stay above zero, and from there again. Most pairs are known to be apart all the way after one direction, be they
//! tangential, parting or near.
//!
//! **Rounding.** Let u = 2^-24. Differences of corners are off by one rounding to f32 (those of f64 by a second, 2^29 times smaller); a
//! projection by another of each product and two sums, one between two times by three more: seven roundings on every path, each of a number
//! of at most the sum s of |n| |q| over the axes, with the larger |q| of both ends. The bound allows 10 u s. What is lost below the normal
//! range, even where subnormal numbers are flushed to zero, is less than 2^-126 times a component of n in a difference, and 2^-126 in a
//! product: where the components of n are below 2^60, all of it is less than 2^-62, and the bound allows 2^-60. Other lanes, and those in
//! which something is infinite, are not known to be apart.
//!
//! Affine functions are compared with their values at both ends of what is left of the motion, less the bound. So up to a part a / (a - b)
//! of it, where these are a > 0 and b, they are above zero in exact arithmetic; a thousandth less is taken, which is more than the rounding
//! of times if the gain is at least 2^-12. Smaller gains do not count.

use super::coordinate::{Coordinate, Vectors};
use super::vector::{dot, minus, plus, times};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, mask32x8};

/// 10 u.
const RELATIVE_ERROR: f32 = 10.0 * (f32::EPSILON / 2.0);
/// 2^-60.
const LOST: f32 = 1.0 / (1_u64 << 60) as f32;
/// 2^60.
const LONGEST: f32 = (1_u64 << 60) as f32;
/// 2^120: where the sums are below it, no product and no sum of such is infinite, or no number.
const LARGEST: f32 = LONGEST * LONGEST;
const THOUSANDTH_LESS: f32 = 0.999;
/// 2^-12.
const LEAST_GAIN: f32 = 1.0 / (1_u64 << 12) as f32;
/// So many directions are tried.
const DIRECTIONS: usize = 3;

/// The corners of eight pairs of elements at the start of a motion, 0 to 3, and at its end, 4 to 7: a vertex and the corners of a triangle;
/// or both ends of either edge.
pub(crate) type MovingCorners<'p, S> = [[&'p [S; 4]; 8]; 8];

/// The differences of two elements: corners of a polygon that move. Of triangles the last is not used.
struct Polygon<I: Simd> {
    start: [Vectors<I>; 4],
    end: [Vectors<I>; 4],
    /// The larger magnitude of both.
    most: [Vectors<I>; 4],
}

/// Differences of two edges: the corners of a parallelogram in order, at the start and at the end.
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

/// Differences of a triangle's corners and a vertex: a triangle, at the start and at the end.
const OF_TRIANGLES: [(usize, usize); 6] = [(1, 0), (2, 0), (3, 0), (5, 4), (6, 4), (7, 4)];

/// Which of eight pairs surely stay further apart than `distance` up to `until`, at most 1.
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
        // The first corner again in place of a fourth costs little.
        let polygon = Polygon::new([a0, b0, c0, a0], [a1, b1, c1, a1]);
        stays_off::<I, false>(&polygon, until, distance)
    }
}

/// Which of eight polygons surely stay further from the origin than that.
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
        // Divided by the length, which is off by less than 4 u of itself, the projections would be distances.
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
            // Where the last is above zero there is no limit; then it is 1 or more, or no number.
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

    /// About where the corners are at a time.
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

/// The nearest point so far, and the square of its distance.
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

/// About the point of a parallelogram, or of a triangle, that is nearest to the origin.
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

/// The point of a segment from p to p + e that is nearest to the origin.
#[inline(always)]
fn on_segment<I: Simd>(p: Vectors<I>, e: Vectors<I>) -> Vectors<I> {
    let i = p[0].token();
    let (zero, one) = (f32x8::splat(i, 0.0), f32x8::splat(i, 1.0));
    let (part, whole) = (zero - dot(p, e), dot(e, e));
    // Of a segment that is a point, both are zero.
    let inside = part.simd_lt(whole).select(part / whole, one);
    along(p, part.simd_gt(zero).select(inside, zero), e)
}

/// The foot of the origin on the plane through p with sides e and f: how far along both, and whether neither is below zero.
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

    /// Which of eight motions are surely apart; the same with all instructions.
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
            // Of the size that distances in it have.
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
                        assert!(!are_within_distance(&elements, distance.into()));
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
