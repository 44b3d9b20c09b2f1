//! Orientation signs of eight candidates at once in `f32`, where rounding cannot change them.
//!
//! This is the floating-point filter of the intersection test; signs that are not certain go to
//! exact arithmetic. The bound of [`compare`] is coarser than the bound of `pliant_exact`'s filter,
//! by the shape of the triangles. But it needs no second sum for each sign.

use super::coordinate::{Coordinate, TrianglePairs, Vectors};
use crate::geometry::vector::{cross, dot};
use fearless_simd::prelude::*;
use fearless_simd::{f32x8, mask32x8};

/// 54 u, divided by the factor [`ROOM`].
const RELATIVE_ERROR: f32 = 54.0 * (f32::EPSILON / 2.0) / ROOM;
/// Factor against overflow: the terms of n . t add up to at most six times `|e1| |e2| |t|`.
///
/// Where `ROOM` times that product is finite, no term has overflowed. Where it is not, the bound is
/// infinite and nothing is certain.
const ROOM: f32 = 8.0;
/// Least length, 2^-40, for which a sign can be certain.
const SHORTEST: f32 = 1.0 / (1_u64 << 40) as f32;

/// Plane signs of eight pairs of triangles A, B. Bit i of a mask is pair i.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PlaneSigns {
    /// Pairs of which one triangle is strictly on one side of the other's plane: they do not
    /// intersect.
    pub(crate) apart: u8,
    /// Pairs whose six signs are all certain, and none zero.
    pub(crate) certain: u8,
    /// Positive signs: of the corners of A against the plane of B, then of B's against A's.
    pub(crate) positive: [u8; 6],
}

/// Plane signs of eight pairs of triangles: each corner against the plane of the other triangle.
#[inline(always)]
pub(crate) fn plane_signs<I: Simd, S: Coordinate>(i: I, corners: &TrianglePairs<S>) -> PlaneSigns {
    let (a0, a1, a2, b0, b1, b2) = (0, 1, 2, 3, 4, 5);
    let [a_1, a_2, a_b, a_b1, a_b2, b_1, b_2, b_a1, b_a2] = corners.differences(
        i,
        [
            (a1, a0),
            (a2, a0),
            (b0, a0),
            (b1, a0),
            (b2, a0),
            (b1, b0),
            (b2, b0),
            (a1, b0),
            (a2, b0),
        ],
    );
    let (l_1, l_2, l_b) = (length(a_1), length(a_2), length(a_b));
    let (l_b1, l_b2) = (length(a_b1), length(a_b2));
    let (k_1, k_2, k_a1, k_a2) = (length(b_1), length(b_2), length(b_a1), length(b_a2));

    // Corners of B against the plane of A.
    let (normal, scale) = (cross(a_1, a_2), l_1 * l_2 * ROOM);
    let of_b = Signs([
        compare(dot(normal, a_b), scale * l_b),
        compare(dot(normal, a_b1), scale * l_b1),
        compare(dot(normal, a_b2), scale * l_b2),
    ]);
    // Corners of A against the plane of B. b0 - a0 stands for a0 - b0.
    let (normal, scale) = (cross(b_1, b_2), k_1 * k_2 * ROOM);
    let [plus, minus] = compare(dot(normal, a_b), scale * l_b);
    let of_a = Signs([
        [minus, plus],
        compare(dot(normal, b_a1), scale * k_a1),
        compare(dot(normal, b_a2), scale * k_a2),
    ]);

    let shortest = l_1.min(l_2).min(l_b).min(l_b1).min(l_b2);
    let shortest = shortest.min(k_1).min(k_2).min(k_a1).min(k_a2);
    let long_enough = shortest.simd_ge(SHORTEST);
    PlaneSigns {
        apart: bits((of_a.one_side() | of_b.one_side()) & long_enough),
        certain: bits(of_a.certain() & of_b.certain() & long_enough),
        positive: [
            bits(of_a.0[0][0]),
            bits(of_a.0[1][0]),
            bits(of_a.0[2][0]),
            bits(of_b.0[0][0]),
            bits(of_b.0[1][0]),
            bits(of_b.0[2][0]),
        ],
    }
}

/// Signs of three points: certainly positive, certainly negative.
struct Signs<I: Simd>([[mask32x8<I>; 2]; 3]);

impl<I: Simd> Signs<I> {
    /// Mask of the lanes with all three positive or all three negative.
    #[inline(always)]
    fn one_side(&self) -> mask32x8<I> {
        let [a, b, c] = self.0;
        (a[0] & b[0] & c[0]) | (a[1] & b[1] & c[1])
    }

    /// Mask of the lanes with all three known.
    #[inline(always)]
    fn certain(&self) -> mask32x8<I> {
        let [a, b, c] = self.0;
        (a[0] | a[1]) & (b[0] | b[1]) & (c[0] | c[1])
    }
}

#[inline(always)]
fn bits<I: Simd>(mask: mask32x8<I>) -> u8 {
    mask.to_bitmask() as u8
}

/// Two line signs of eight pairs of triangles. Bit i of a mask is pair i.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct LineSigns {
    /// Pairs with two signs that are certainly negative.
    pub(crate) both_negative: u8,
    /// Pairs with at least one sign that is certainly positive.
    pub(crate) one_positive: u8,
}

/// Orientations of `p1 q1 p2 q2` and `p1 r1 r2 p2`, for corners p1, q1, r1 of A and p2, q2, r2 of
/// B.
#[inline(always)]
pub(crate) fn line_signs<I: Simd, S: Coordinate>(i: I, corners: &TrianglePairs<S>) -> LineSigns {
    let [q1, r1, p2, q2, r2] = corners.differences(i, [(1, 0), (2, 0), (3, 0), (4, 0), (5, 0)]);
    let (lq1, lr1, lp2) = (length(q1), length(r1), length(p2));
    let (lq2, lr2) = (length(q2), length(r2));
    let [first_plus, first_minus] = compare(dot(cross(q1, p2), q2), lq1 * lp2 * ROOM * lq2);
    let [second_plus, second_minus] = compare(dot(cross(r1, r2), p2), lr1 * lr2 * ROOM * lp2);
    let shortest = lq1.min(lr1).min(lp2).min(lq2).min(lr2);
    let long_enough = shortest.simd_ge(SHORTEST);
    LineSigns {
        both_negative: bits(first_minus & second_minus & long_enough),
        one_positive: bits((first_plus | second_plus) & long_enough),
    }
}

/// Largest component of a vector, by magnitude.
#[inline(always)]
fn length<I: Simd>([x, y, z]: Vectors<I>) -> f32x8<I> {
    x.abs().max(y.abs()).max(z.abs())
}

/// Certainly positive and certainly negative lanes, from n . t and `ROOM` times `|e1| |e2| |t|`.
///
/// # Rounding
///
/// For points p0, p1, p2, q let `e1 = p1 - p0`, `e2 = p2 - p0`, `n = e1 x e2`, `t = q - p0`. Let
/// `|v|` be the largest component of v, and u = 2^-24.
///
/// - Each difference has one rounding to `f32`. Differences of `f64` have a second one, 2^29 times
///   smaller.
/// - Each component of n has two differences, a product and a subtraction.
/// - n . t has another difference, a product and two sums.
///
/// That is eight roundings on every path. n . t is six products of magnitude at most `|e1| |e2|
/// |t|`. So the computed value is off by at most `8 u 6 |e1| |e2| |t|`, to first order. A ninth u
/// covers the rest and the rounding of the bound:
///
/// ```text
/// |n . t| > 54 u |e1| |e2| |t|    the sign is certain
/// ```
///
/// # Underflow
///
/// Each step below the normal range loses at most 2^-126, times two of the lengths. Such steps are
/// differences of `f64` that are no normal `f32`, products that underflow, and everything if the
/// thread flushes subnormals to zero. The loss is less than the slack of the ninth u if every
/// length is at least 2^-40, which is [`SHORTEST`]. Shorter lengths, zero among them, are left to
/// exact arithmetic. Comparisons are strict, so infinities and NaN are not certain either.
#[inline(always)]
fn compare<I: Simd>(value: f32x8<I>, size: f32x8<I>) -> [mask32x8<I>; 2] {
    let bound = size * RELATIVE_ERROR;
    [value.simd_gt(bound), value.simd_lt(-bound)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Points;
    use crate::ids::TreeVertex;
    use crate::kernels::{Instructions, dispatch};
    use pliant_oracle::{Class, Random, fits_f32, orientation as sign};

    /// Counts certain signs of eight pairs. Asserts that each is right, and equal for all
    /// instruction sets.
    fn check<S: Coordinate>(pairs: &[[[[f64; 3]; 3]; 2]; 8], of: impl Fn(f64) -> S) -> u32 {
        let points = |side: usize| -> Vec<[S; 3]> {
            let corners = pairs.iter().flat_map(|pair| pair[side]);
            corners.map(|point| point.map(&of)).collect()
        };
        let positions = [0, 1].map(|side| Points::of(points(side).into_iter()));
        let mut vertices = [[TreeVertex(0); 6]; 8];
        for lane in 0..8 {
            let first = 3 * lane as u32;
            vertices[lane] = [0, 1, 2, 0, 1, 2].map(|corner| TreeVertex(first + corner));
        }
        let corners = TrianglePairs {
            positions: [&positions[0], &positions[1]],
            vertices,
        };
        let instructions = Instructions::widest();
        let planes = dispatch!(instructions, i => plane_signs(i, &corners));
        let lines = dispatch!(instructions, i => line_signs(i, &corners));
        for instructions in Instructions::all() {
            assert_eq!(
                dispatch!(instructions, i => plane_signs(i, &corners)),
                planes,
                "{instructions:?}"
            );
            assert_eq!(
                dispatch!(instructions, i => line_signs(i, &corners)),
                lines,
                "{instructions:?}"
            );
        }
        let mut certain = 0;
        for (lane, [a, b]) in pairs.iter().enumerate() {
            let is = |mask: u8| mask >> lane & 1 == 1;
            let of_a = a.map(|corner| sign(&b[0], &b[1], &b[2], &corner));
            let of_b = b.map(|corner| sign(&a[0], &a[1], &a[2], &corner));
            if is(planes.apart) {
                assert!(
                    [of_a, of_b]
                        .iter()
                        .any(|signs| *signs == [1; 3] || *signs == [-1; 3]),
                    "{a:?} {b:?}"
                );
            }
            if is(planes.certain) {
                let found = planes.positive.map(|mask| if is(mask) { 1 } else { -1 });
                assert_eq!(
                    found,
                    [of_a[0], of_a[1], of_a[2], of_b[0], of_b[1], of_b[2]],
                    "{a:?} {b:?}"
                );
            }
            let first = sign(&a[0], &a[1], &b[0], &b[1]);
            let second = sign(&a[0], &a[2], &b[2], &b[0]);
            if is(lines.both_negative) {
                assert_eq!([first, second], [-1; 2], "{a:?} {b:?}");
            }
            if is(lines.one_positive) {
                assert!(first == 1 || second == 1, "{a:?} {b:?}");
            }
            certain += u32::from(is(planes.certain | planes.apart));
            certain += u32::from(is(lines.both_negative | lines.one_positive));
        }
        certain
    }

    #[test]
    fn certain_signs_are_right_on_hard_pairs_and_at_any_scale() {
        let mut random = Random::new(3);
        let (mut certain, mut certain_narrow) = (0, 0);
        for scale in [0, -40, -60, -126, -149, 60, 120].map(|exponent| 2f64.powi(exponent)) {
            for class in Class::ALL {
                // More rounds for scales so mixed that products overflow in single precision.
                let rounds = if class == Class::Scales { 3000 } else { 60 };
                for _ in 0..rounds {
                    let pairs: [[[[f64; 3]; 3]; 2]; 8] = std::array::from_fn(|_| {
                        class.pair(&mut random).map(|triangle| {
                            triangle.map(|point| {
                                point.map(|x| {
                                    let x = x * scale;
                                    if x.abs() <= f32::MAX.into() { x } else { 1.0 }
                                })
                            })
                        })
                    });
                    certain += check(&pairs, |x| x);
                    if pairs.iter().all(fits_f32) {
                        certain_narrow += check(&pairs, |x| x as f32);
                    }
                }
            }
        }
        assert!(
            certain > 4_000 && certain_narrow > 1_500,
            "{certain} {certain_narrow}"
        );
    }
}
