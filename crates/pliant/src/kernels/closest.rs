//! Closest points of elements (vertex and triangle, or two edges), and proven bounds of their
//! distance.
//!
//! Four pairs are decided side by side in double precision, or eight in single precision where only
//! the bounds are wanted. **Any two points bound the distance from above, any direction from
//! below**: the elements are at least as far apart as their projections on it. So points are
//! searched in plain arithmetic, on ends, edges and insides, and the way between the nearest ones
//! is the direction. If the points are right, the two bounds differ only by rounding. If not, as
//! for slivers, the bounds are far apart and say so.

use super::coordinate::{Coordinate, eight_differences, turn};
use crate::geometry::Real;
use crate::geometry::vector::{Vector, cross, difference, dot, minus, plus, square_of, times};
use fearless_simd::prelude::*;
use fearless_simd::{Select, Simd, f32x8, f64x4};
use pliant_exact::{ELEMENT_PAIRS, FIRST_OF_EDGES, Feature, four_corners, is_swapped};

/// The four corners of a pair of elements, each with padding.
pub(crate) type FourCorners<'q, S> = [&'q [S; 4]; 4];

/// Closest points of four pairs of elements, and bounds of the distances.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct FourClosest {
    /// Parameters of the two points, as `pliant_exact::distance::Closest` has them.
    pub(crate) along: [[f64; 4]; 2],
    /// Vector from the second point to the first, by axis.
    pub(crate) way: [[f64; 4]; 3],
    /// Length of `way`.
    pub(crate) distance: [f64; 4],
    /// Lower bound of the true distance. It may be negative.
    pub(crate) least: [f64; 4],
    /// Upper bound of the true distance. It may be infinite.
    pub(crate) most: [f64; 4],
}

/// Floating-point lanes, and the constants of their rounding bounds.
trait Lanes<I: Simd>: SimdFloat<I> {
    /// Allowed error: 20 u, relative to the sum of coordinates.
    const ERROR: Self::Element;
    /// Least sum of coordinates for which anything is sure; `LARGEST` is the largest.
    const SMALLEST: Self::Element;
    const LARGEST: Self::Element;
    /// Factor on the squared distance of the nearest end: the insides of two edges are taken only
    /// if they are nearer than that. Parallel edges never are.
    const NEARER: Self::Element;

    /// One number in all lanes.
    #[inline(always)]
    fn all(i: I, x: Self::Element) -> Self {
        Self::simd_from(i, x)
    }
}

/// Allowed relative error in double precision: 20 u.
const ERROR: f64 = 20.0 * (f64::EPSILON / 2.0);

/// Least sum of coordinates in double precision: 2^-200.
const SMALLEST: f64 = f64::from_bits((1023 - 200) << 52);

impl<I: Simd> Lanes<I> for f64x4<I> {
    const ERROR: f64 = ERROR;
    const SMALLEST: f64 = SMALLEST;
    /// No limit: coordinates are in the range of `f32`.
    const LARGEST: f64 = f64::INFINITY;
    /// Nearer by a part of 2^-40.
    const NEARER: f64 = 1.0 - f64::from_bits((1023 - 40) << 52);
}

impl<I: Simd> Lanes<I> for f32x8<I> {
    const ERROR: f32 = 20.0 * (f32::EPSILON / 2.0);
    /// Least sum of coordinates in single precision: 2^-30.
    const SMALLEST: f32 = f32::from_bits((127 - 30) << 23);
    /// Largest sum of coordinates in single precision: 2^60.
    const LARGEST: f32 = f32::from_bits((127 + 60) << 23);
    /// Nearer by a part of 2^-12.
    const NEARER: f32 = 1.0 - f32::from_bits((127 - 12) << 23);
}

/// Closest points and bounds of some pairs, in registers. Fields are as in `FourClosest`.
struct Found<V> {
    along: [V; 2],
    way: Vector<V>,
    distance: V,
    least: V,
    most: V,
}

/// Nearest points so far: their parameters, and the square of their distance.
struct Best<V> {
    along: [V; 2],
    square: V,
}

impl<V> Best<V> {
    /// Replaces the points in the lanes of a mask.
    #[inline(always)]
    fn take<I: Simd>(&mut self, mask: V::Mask, along: [V; 2], square: V)
    where
        V: Lanes<I>,
    {
        self.along = [
            mask.select(along[0], self.along[0]),
            mask.select(along[1], self.along[1]),
        ];
        self.square = mask.select(square, self.square);
    }

    /// Replaces the points in the lanes where the new ones are nearer.
    #[inline(always)]
    fn take_nearer<I: Simd>(&mut self, along: [V; 2], square: V)
    where
        V: Lanes<I>,
    {
        let mask = square.simd_lt(self.square);
        self.take(mask, along, square);
    }
}

/// Closest points of four pairs of elements: edges `a0 a1` and `b0 b1`, or points p and triangles
/// `a b c`.
///
/// Corners are in this order.
#[inline(always)]
pub(crate) fn of_elements<I: Simd, S: Real>(
    i: I,
    are_edges: bool,
    pairs: &[FourCorners<S>; 4],
) -> FourClosest {
    let [p, q, r, s] = [
        lanes(i, pairs, 0),
        lanes(i, pairs, 1),
        lanes(i, pairs, 2),
        lanes(i, pairs, 3),
    ];
    let found = if are_edges {
        let differences = [minus(p, r), minus(q, r), minus(p, s), minus(q, s)];
        edges_and_edges(i, differences, [minus(q, p), minus(s, r)])
    } else {
        let (e1, e2, e3) = (minus(r, q), minus(s, q), minus(s, r));
        let differences = [minus(p, q), minus(p, r), minus(p, s)];
        vertices_and_triangles(i, differences, [e1, e2, e3])
    };
    found.store()
}

/// Closest points of points and triangles `a b c`, from differences of corners.
///
/// The first three are the point less a, b and c; the others are b - a, c - a and c - b.
#[inline(always)]
fn vertices_and_triangles<I: Simd, V: Lanes<I>>(
    i: I,
    [t, of_b, of_c]: [Vector<V>; 3],
    [e1, e2, e3]: [Vector<V>; 3],
) -> Found<V> {
    let zero = V::all(i, 0_u8.into());
    let one = V::all(i, 1_u8.into());
    let (s, square) = on_segment(t, e1);
    let mut best = Best {
        along: [s, zero],
        square,
    };
    let (s, square) = on_segment(t, e2);
    best.take_nearer([zero, s], square);
    let (s, square) = on_segment(of_b, e3);
    // The sum of x and 1 - x is exactly 1, so the first corner has weight zero.
    let x = one - s;
    best.take_nearer([x, one - x], square);

    // Foot of the perpendicular on the plane, by Cramer's rule.
    let (d11, d12, d22) = (dot(e1, e1), dot(e1, e2), dot(e2, e2));
    let (t1, t2) = (dot(t, e1), dot(t, e2));
    let whole = d11 * d22 - d12 * d12;
    let (x, y) = ((d22 * t1 - d12 * t2) / whole, (d11 * t2 - d12 * t1) / whole);
    let is_inside = whole.simd_gt(zero) & x.simd_ge(zero) & y.simd_ge(zero) & (x + y).simd_le(one);
    let square = square_of(plus(plus(t, times(zero - x, e1)), times(zero - y, e2)));
    best.take(is_inside & square.simd_lt(best.square), [x, y], square);

    let [x, y] = best.along;
    let way = plus(plus(t, times(zero - x, e1)), times(zero - y, e2));
    let projections = [dot(way, t), dot(way, of_b), dot(way, of_c)];
    let least = projections[0].min(projections[1]).min(projections[2]);
    bounds(i, [x, y], way, least, [t, e1, e2])
}

/// Closest points of pairs of edges, from differences of corners.
///
/// The first four are ends of the first edge less ends of the second; the others are each edge's
/// own direction.
#[inline(always)]
fn edges_and_edges<I: Simd, V: Lanes<I>>(
    i: I,
    [t, t10, t01, t11]: [Vector<V>; 4],
    [e, f]: [Vector<V>; 2],
) -> Found<V> {
    let zero = V::all(i, 0_u8.into());
    let one = V::all(i, 1_u8.into());
    let back = times(V::all(i, (-1_i8).into()), e);

    // Ends of the first edge on the second, then ends of the second on the first.
    let (y, square) = on_segment(t, f);
    let mut best = Best {
        along: [zero, y],
        square,
    };
    let (y, square) = on_segment(t10, f);
    best.take_nearer([one, y], square);
    let (x, square) = on_segment(t, back);
    best.take_nearer([x, zero], square);
    let (x, square) = on_segment(t01, back);
    best.take_nearer([x, one], square);

    // Feet of the common normal, by Cramer's rule.
    let (d11, d12, d22) = (dot(e, e), dot(e, f), dot(f, f));
    let (t1, t2) = (dot(t, e), dot(t, f));
    let whole = d11 * d22 - d12 * d12;
    let (x, y) = ((d12 * t2 - d22 * t1) / whole, (d11 * t2 - d12 * t1) / whole);
    let is_inside =
        whole.simd_gt(zero) & x.simd_ge(zero) & x.simd_le(one) & y.simd_ge(zero) & y.simd_le(one);
    let square = square_of(plus(plus(t, times(x, e)), times(zero - y, f)));
    let is_nearer = square.simd_lt(best.square * V::all(i, V::NEARER));
    best.take(is_inside & is_nearer, [x, y], square);

    let [x, y] = best.along;
    let way = plus(plus(t, times(x, e)), times(zero - y, f));
    let least = dot(way, t)
        .min(dot(way, t10))
        .min(dot(way, t01).min(dot(way, t11)));
    bounds(i, [x, y], way, least, [t, e, f])
}

/// Part of the triangle that certainly has the closest point of four points and triangles, if one
/// does; in double precision.
///
/// By Voronoi regions and their signs, four side by side. Where nothing is certain,
/// `pliant_exact::distance::closest_features` knows.
///
/// # Rounding
///
/// Let u = 2^-53. Let E, T, F and G be sums of absolute coordinates: of an edge, of the way to the
/// point, and of two edges.
///
/// - A dot product has two differences, a product and two sums on each path: 6 u E T.
/// - A component of a cross product has 4 u of its two terms, whose sum over all is at most E T.
/// - A dot product of two such is off by 4 u from either, and 3 u: 11 u E T F G.
///
/// 32 u are allowed for both. A product that is lost below the normal range, 2^-1020, is multiplied
/// by two lengths. Where these are below 2^103 the 2^-780 that are added are far more.
#[inline(always)]
pub(crate) fn certain_parts<I: Simd, S: Real>(
    i: I,
    pairs: &[FourCorners<S>; 4],
) -> [Option<Feature>; 4] {
    let p = lanes(i, pairs, 0);
    let corners = [lanes(i, pairs, 1), lanes(i, pairs, 2), lanes(i, pairs, 3)];
    let edges = [
        minus(corners[1], corners[0]),
        minus(corners[2], corners[1]),
        minus(corners[0], corners[2]),
    ];
    let ways = [
        minus(p, corners[0]),
        minus(p, corners[1]),
        minus(p, corners[2]),
    ];
    let of_edges = [size(edges[0]), size(edges[1]), size(edges[2])];
    let of_ways = [size(ways[0]), size(ways[1]), size(ways[2])];
    let n = cross(edges[0], edges[1]);
    let of_plane = of_edges[0] * of_edges[1];
    let sum = of_edges[0] + of_edges[1] + of_ways[0] + of_ways[1] + of_ways[2];
    let known = sum.simd_lt(f64::from_bits((1023 + 101) << 52)).to_bitmask();
    // What is certainly above 0, and what below, a bit for each lane.
    let (mut ahead, mut behind, mut sides) = ([[0; 2]; 3], [[0; 2]; 3], [[0; 2]; 3]);
    for k in 0..3 {
        let next = (k + 1) % 3;
        ahead[k] = signs(dot(edges[k], ways[k]), of_edges[k] * of_ways[k]);
        behind[k] = signs(dot(edges[k], ways[next]), of_edges[k] * of_ways[next]);
        let x = dot(cross(edges[k], ways[k]), n);
        sides[k] = signs(x, of_edges[k] * of_ways[k] * of_plane);
    }
    let mut parts = [None; 4];
    let inside = known & sides[0][0] & sides[1][0] & sides[2][0];
    for (lane, part) in parts.iter_mut().enumerate() {
        if inside >> lane & 1 == 1 {
            *part = Some(Feature::Inside);
        }
    }
    for k in 0..3 {
        let edge = known & sides[k][1] & ahead[k][0] & behind[k][1];
        let corner = known & ahead[k][1] & behind[(k + 2) % 3][0];
        for (lane, part) in parts.iter_mut().enumerate() {
            if edge >> lane & 1 == 1 {
                *part = Some(Feature::Edge(k));
            }
            if corner >> lane & 1 == 1 {
                *part = Some(Feature::Corner(k));
            }
        }
    }
    parts
}

/// Sum of absolute coordinates.
#[inline(always)]
fn size<I: Simd>(way: Vector<f64x4<I>>) -> f64x4<I> {
    way[0].abs() + way[1].abs() + way[2].abs()
}

/// Lanes that are certainly above 0, and lanes that are certainly below, of products whose factors
/// have a product of sizes: see [`certain_parts`].
#[inline(always)]
fn signs<I: Simd>(x: f64x4<I>, size: f64x4<I>) -> [u64; 2] {
    let error = size * (16.0 * f64::EPSILON) + f64::from_bits((1023 - 780) << 52);
    [
        x.simd_gt(error).to_bitmask(),
        (x + error).simd_lt(0.0).to_bitmask(),
    ]
}

/// Closest points of two triangles, and bounds of their distance, if they do not intersect.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TwoClosest {
    /// Number of the nearest pair of elements, and the parameters of its two points.
    pub(crate) which: usize,
    pub(crate) along: [f64; 2],
    /// Vector from the second triangle to the first.
    pub(crate) way: [f64; 3],
    /// Length of `way`.
    pub(crate) distance: f64,
    /// Lower bound of the true distance. It may be negative, and is where the triangles intersect.
    pub(crate) least: f64,
    /// Upper bound of the true distance. It may be infinite.
    pub(crate) most: f64,
}

/// Closest points of two triangles, given their corners.
///
/// Triangles that do not intersect are as far apart as the nearest of their fifteen pairs of
/// elements. The way between the points of that pair is a direction, and the projections of all
/// corners on it bound the distance from below. If the triangles intersect, no direction separates
/// them, and the two bounds are far apart.
///
/// # Rounding
///
/// As in [`bounds`], with S for the largest sum of absolute coordinates of a difference of two
/// corners, one of either triangle.
#[inline(always)]
pub(crate) fn of_triangles<I: Simd, S: Real>(
    i: I,
    a: &[&[S; 4]; 3],
    b: &[&[S; 4]; 3],
) -> TwoClosest {
    let mut nearest = TwoClosest {
        distance: f64::INFINITY,
        most: f64::INFINITY,
        ..TwoClosest::default()
    };
    let mut least_of_nearest = f64::NEG_INFINITY;
    let mut first = 0;
    while first < ELEMENT_PAIRS {
        let are_edges = first >= FIRST_OF_EDGES;
        let end = if are_edges {
            ELEMENT_PAIRS
        } else {
            FIRST_OF_EDGES
        };
        let count = (end - first).min(4);
        let mut pairs = [four_corners(first, a, b); 4];
        for lane in 1..count {
            pairs[lane] = four_corners(first + lane, a, b);
        }
        let found = of_elements(i, are_edges, &pairs);
        for lane in 0..count {
            nearest.most = nearest.most.min(found.most[lane]);
            if found.distance[lane] < nearest.distance {
                nearest.which = first + lane;
                nearest.along = [found.along[0][lane], found.along[1][lane]];
                nearest.way = [found.way[0][lane], found.way[1][lane], found.way[2][lane]];
                nearest.distance = found.distance[lane];
                least_of_nearest = found.least[lane];
            }
        }
        first += count;
    }
    if is_swapped(nearest.which) {
        let [x, y, z] = nearest.way;
        nearest.way = [0.0 - x, 0.0 - y, 0.0 - z];
    }
    nearest.least = f64::NEG_INFINITY;
    let way = nearest.way;
    if least_of_nearest > 0.0 {
        let [mut projection, mut largest] = [f64::INFINITY, 0.0_f64];
        for p in a {
            for q in b {
                let d = difference(p, q);
                projection = projection.min(dot(way, d));
                largest = largest.max(d[0].abs() + d[1].abs() + d[2].abs());
            }
        }
        nearest.least = projection / nearest.distance - ERROR * largest;
    }
    nearest
}

/// Decides in single precision which of eight pairs are at most some distance apart, and which are
/// further apart.
///
/// `limits` are bounds of that distance, lower and upper, in lanes: see [`rounded_outward`].
/// Returns two bit masks of the pairs for which this is certain: near, then far. `of_elements` or
/// exact arithmetic decides the others.
///
/// # Rounding
///
/// As in [`bounds`], with u = 2^-24. Only t, e and f are differences of corners. They are taken in
/// the caller's precision and rounded to `f32`, so they are off by `(1 + 2^-28) u` of themselves.
/// Projections need other differences, which are computed from them. Each is off by at most u S
/// from its terms, and by 2 u S from two roundings. So a projection is off by `3 u |r| S`, and by
/// another `3 u |r| S` for the dot product. With 6 u S for division, length and subtraction, a
/// lower bound is off by 12 u S. The bound of |r| is as in [`bounds`]. 20 u S are allowed again.
///
/// Below the normal range a product of two is off by 2^-126, a length by 2^-62. That is nothing
/// beside u S where S is at least 2^-30. Where S is at most 2^60, no square and no projection
/// overflows `f32`. Products of four may overflow; then an inside is missed, or some other point is
/// taken. For other sizes of S nothing is certain.
#[inline(always)]
pub(crate) fn decide_eight<I: Simd, S: Coordinate>(
    i: I,
    are_edges: bool,
    pairs: &[FourCorners<S>; 8],
    limits: &[[f32; 8]; 2],
) -> [u64; 2] {
    let found = eight(i, are_edges, pairs);
    let [below, above] = limits
        .each_ref()
        .map(|lanes| f32x8::load_array_ref(i, lanes));
    let is_close = found.most.simd_le(below);
    let is_far = found.least.simd_gt(above);
    [is_close.to_bitmask(), is_far.to_bitmask()]
}

/// Bounds of the distances of eight points from triangles, in single precision: lower, then upper.
///
/// As in [`decide_eight`]; infinite where nothing is certain.
#[inline(always)]
pub(crate) fn bound_eight<I: Simd, S: Coordinate>(
    i: I,
    pairs: &[FourCorners<S>; 8],
) -> [[f32; 8]; 2] {
    let found = eight(i, false, pairs);
    let mut bounds = [[0.0; 8]; 2];
    found.least.store_array(&mut bounds[0]);
    found.most.store_array(&mut bounds[1]);
    bounds
}

/// Bounds of the distances of eight points from triangles, in double precision: lower, then upper.
#[inline(always)]
pub(crate) fn bound_eight_closely<I: Simd, S: Real>(
    i: I,
    pairs: &[FourCorners<S>; 8],
) -> [[f64; 8]; 2] {
    let [p, q, r, s, t, u, v, w] = *pairs;
    // Not by `map` of arrays: functions of the standard library have no wider instructions.
    let first = of_elements(i, false, &[p, q, r, s]);
    let later = of_elements(i, false, &[t, u, v, w]);
    let mut bounds = [[0.0; 8]; 2];
    for lane in 0..4 {
        bounds[0][lane] = first.least[lane];
        bounds[0][lane + 4] = later.least[lane];
        bounds[1][lane] = first.most[lane];
        bounds[1][lane + 4] = later.most[lane];
    }
    bounds
}

/// Closest points of eight pairs in single precision, and bounds.
#[inline(always)]
fn eight<I: Simd, S: Coordinate>(
    i: I,
    are_edges: bool,
    pairs: &[FourCorners<S>; 8],
) -> Found<f32x8<I>> {
    let less = |k: usize, l: usize| eight_differences(i, |lane| [pairs[lane][k], pairs[lane][l]]);
    if are_edges {
        let (t, e, f) = (less(0, 2), less(1, 0), less(3, 2));
        let (t10, t01) = (plus(t, e), minus(t, f));
        edges_and_edges(i, [t, t10, t01, minus(t10, f)], [e, f])
    } else {
        let (t, e1, e2) = (less(0, 1), less(2, 1), less(3, 1));
        let differences = [t, minus(t, e1), minus(t, e2)];
        vertices_and_triangles(i, differences, [e1, e2, minus(e2, e1)])
    }
}

/// Bounds of a distance, rounded outward.
#[inline]
pub(crate) fn rounded_outward([least, most]: [f64; 2]) -> [f32; 2] {
    let [low, high] = [least as f32, most as f32];
    let low = if f64::from(low) > least {
        low.next_down()
    } else {
        low
    };
    let high = if f64::from(high) < most {
        high.next_up()
    } else {
        high
    };
    [low, high]
}

/// Unit direction of the common normal of two elements, and a lower bound of their distance along
/// it.
///
/// The direction points from the second element to the first. None where it is hardly a direction,
/// or where nothing is sure.
///
/// This is for elements that nearly touch. The way between two close points is a difference of
/// numbers that are large beside it. As a direction it is off by `u S / |r|`, and the projections
/// of the elements' ends are off by that part of S. Where insides are nearest, the cross product of
/// both edges, or of two sides, is off as a direction by u only, at any distance.
///
/// # Rounding
///
/// Allowed are 20 u S, for differences that are off by u, `3 u |r| S` for the dot product, and
/// division, length and subtraction as in [`bounds`]. The length of r is at least 2^-30 of its
/// largest possible value S^2. So no product of four is a rounding error below the normal range.
pub(crate) fn along_normal<S: Real>(
    are_edges: bool,
    [p, q, r, s]: &FourCorners<S>,
) -> Option<([f64; 3], f64)> {
    // Two sides, and all ways from a corner of the second element to a corner of the first.
    let (e, f, between) = if are_edges {
        let between = [(p, r), (q, r), (p, s), (q, s)];
        (difference(q, p), difference(s, r), between)
    } else {
        let between = [(p, q), (p, r), (p, s), (p, s)];
        (difference(r, q), difference(s, q), between)
    };
    let ways = between.map(|(p, q)| difference(p, q));
    let n = cross(e, f);
    let sum: f64 = [ways[0], e, f].as_flattened().iter().map(|x| x.abs()).sum();
    let length = dot(n, n).sqrt();
    if sum < SMALLEST || length < sum * sum * f64::powi(0.5, 30) {
        return None;
    }
    let sign = if dot(n, ways[0]) < 0.0 { -1.0 } else { 1.0 };
    let projections = ways.map(|way| sign * dot(n, way));
    let least = projections.into_iter().fold(f64::INFINITY, f64::min);
    let direction = n.map(|x| sign * x / length);
    Some((direction, least / length - ERROR * sum))
}

/// Lower bound of the distance of two triangles along a direction from the second to the first,
/// from their corners.
///
/// The direction has length 1, up to an error of less than 2^-40. The bound may be negative. No
/// pair of elements is looked at.
///
/// # Rounding
///
/// Let S be the largest sum of coordinates of a corner of one triangle, plus the largest of the
/// other. Corners are relative to one of them. A projection of such a corner is off by 4 u of the
/// sum of its coordinates. So the result is off by less than 7 u S. 20 u S are allowed.
#[inline(always)]
pub(crate) fn apart_along<S: Real>(direction: [f64; 3], a: &[&[S; 4]; 3], b: &[&[S; 4]; 3]) -> f64 {
    let origin = b[0];
    let [mut least, mut most] = [f64::INFINITY, 0.0_f64];
    let mut largest = [0.0_f64; 2];
    let mut from_origin = |p: &[S; 4], which: usize| {
        let d = difference(p, origin);
        largest[which] = largest[which].max(d[0].abs() + d[1].abs() + d[2].abs());
        dot(direction, d)
    };
    for p in a {
        least = least.min(from_origin(p, 0));
    }
    for q in &b[1..] {
        most = most.max(from_origin(q, 1));
    }
    let sum = largest[0] + largest[1];
    if sum < SMALLEST {
        return f64::NEG_INFINITY;
    }
    let allowed = ERROR * sum;
    (least - most - allowed) * (1.0 - f64::powi(0.5, 39))
}

/// Parameter, from 0 to 1, of the point nearest to `t` on the segment from 0 to `e`; and the square
/// of their distance.
#[inline(always)]
fn on_segment<I: Simd, V: Lanes<I>>(t: Vector<V>, e: Vector<V>) -> (V, V) {
    let i = t[0].token();
    let (zero, one) = (V::all(i, 0_u8.into()), V::all(i, 1_u8.into()));
    let (part, whole) = (dot(t, e), dot(e, e));
    // A segment that is a point has zero for both.
    let inside = part.simd_lt(whole).select(part / whole, one);
    let s = part.simd_gt(zero).select(inside, zero);
    (s, square_of(plus(t, times(zero - s, e))))
}

/// Bounds of the distance, from a way computed out of three differences of corners, and from its
/// least projection.
///
/// # Rounding
///
/// Let u = 2^-53. The way is `r = t + x e + y f`, with x and y of magnitude at most 1, where t, e
/// and f are differences of corners. Let S be the sum of the absolute values of the coordinates of
/// t, e and f.
///
/// - A coordinate of r is off by at most `3 u` of its part of t, and `4 u` of its parts of e and f.
/// - If the sum of x and y was rounded to 1, it is at most `1 + u`. The point is then off by
///   another u of both. So `|r|` is off by less than `6 u S`.
/// - A length adds `4 u` of itself, at most `4 u S (1 + 6 u)`. Upper bounds allow `20 u S`.
/// - In a projection a difference of corners is off by u of itself. A dot product is off by `3 u`
///   of its terms, whose sum is at most `|r| S`.
/// - Division and length add `6 u`. Lower bounds allow `20 u S` too.
///
/// Results below the normal range are off by less than 2^-1020 each. Where S is at least 2^-200,
/// that is nothing beside `2^-250 S`, even in products of four. Where S is smaller, nothing is
/// sure. A way that is a rounding error is no direction, so there is no lower bound where `|r|` is
/// below `20 u S`.
#[inline(always)]
fn bounds<I: Simd, V: Lanes<I>>(
    i: I,
    along: [V; 2],
    way: Vector<V>,
    projection: V,
    differences: [Vector<V>; 3],
) -> Found<V> {
    let zero = V::all(i, 0_u8.into());
    let mut sum = zero;
    for difference in differences {
        for x in difference {
            sum += x.abs();
        }
    }
    let infinity = V::all(i, 1_u8.into()) / zero;
    let error = sum * V::all(i, V::ERROR);
    let distance = square_of(way).sqrt();
    let is_known = sum.simd_ge(V::all(i, V::SMALLEST)) & sum.simd_le(V::all(i, V::LARGEST));
    let is_a_way = is_known & distance.simd_ge(error);
    Found {
        along,
        way,
        distance,
        least: is_a_way.select(projection / distance - error, zero - infinity),
        most: is_known.select(distance + error, infinity),
    }
}

impl<I: Simd> Found<f64x4<I>> {
    #[inline(always)]
    fn store(self) -> FourClosest {
        let mut closest = FourClosest::default();
        for which in 0..2 {
            self.along[which].store_array(&mut closest.along[which]);
        }
        for axis in 0..3 {
            self.way[axis].store_array(&mut closest.way[axis]);
        }
        self.distance.store_array(&mut closest.distance);
        self.least.store_array(&mut closest.least);
        self.most.store_array(&mut closest.most);
        closest
    }
}

/// Transposes corner `which` of four pairs into lanes.
#[inline(always)]
fn lanes<I: Simd, S: Real>(i: I, pairs: &[FourCorners<S>; 4], which: usize) -> Vector<f64x4<I>> {
    let load = |lane: usize| {
        let [x, y, z, w] = *pairs[lane][which];
        f64x4::load_array(i, [x.to_f64(), y.to_f64(), z.to_f64(), w.to_f64()])
    };
    turn([load(0), load(1), load(2), load(3)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernels::{Instructions, dispatch};
    use pliant_exact::distance::{Primitives, closest, closest_features};
    use pliant_oracle::{Class, Random, compare_distance, compare_dot, compare_length};
    use std::cmp::Ordering;

    /// Promised accuracy of distances.
    const ACCURACY: f64 = f64::from_bits((1023 - 30) << 52);

    /// Eight pairs of elements of a hard pair of triangles, and the corners of either.
    fn hard_pairs(
        triangles: &[[[f64; 3]; 3]; 2],
    ) -> Vec<(Primitives, Vec<[f64; 3]>, Vec<[f64; 3]>)> {
        let pairs = pliant_oracle::element_pairs(triangles).into_iter();
        let of = |(first, corners): (usize, [[f64; 3]; 4])| {
            let elements = match first {
                1 => Primitives::VertexTriangle(corners),
                _ => Primitives::EdgeEdge(corners),
            };
            let (a, b) = corners.split_at(first);
            (elements, a.to_vec(), b.to_vec())
        };
        pairs.map(of).collect()
    }

    /// Closest points of four pairs, one in each lane.
    fn four(i: impl Simd, all: [&Primitives; 4]) -> FourClosest {
        let corners = all.map(|elements| {
            let (Primitives::VertexTriangle(four) | Primitives::EdgeEdge(four)) = elements;
            four.map(|[x, y, z]| [x, y, z, z])
        });
        let pairs = corners.each_ref().map(<[_; 4]>::each_ref);
        of_elements(i, matches!(all[0], Primitives::EdgeEdge(_)), &pairs)
    }

    /// A part that is certain is one that exact arithmetic finds, whatever the instruction set.
    #[test]
    fn certain_parts_are_exact_ones() {
        let mut random = Random::new(57);
        let [mut certain, mut total] = [0; 2];
        for round in 0..3_000 {
            let class = Class::ALL[round % Class::ALL.len()];
            for (elements, ..) in hard_pairs(&class.pair(&mut random)) {
                let Primitives::VertexTriangle(corners) = elements else {
                    continue;
                };
                let four = [corners.map(|[x, y, z]| [x, y, z, z]); 4];
                let pairs = four.each_ref().map(<[_; 4]>::each_ref);
                let mut exact = Vec::new();
                closest_features(&elements, |[_, on]| exact.push(on));
                for instructions in Instructions::all() {
                    let parts = dispatch!(instructions, i => certain_parts(i, &pairs));
                    assert_eq!(parts, [parts[0]; 4]);
                    // Corners are found from either edge.
                    let is_it = |on: Feature| exact.iter().all(|it| *it == on);
                    assert!(parts[0].is_none_or(is_it), "{elements:?}");
                    certain += u32::from(parts[0].is_some());
                    total += 1;
                }
            }
        }
        assert!(certain > total / 5, "{certain} of {total}");
    }

    #[test]
    fn bounds_hold_the_distance() {
        let mut random = Random::new(42);
        let [mut known, mut close, mut total] = [0; 3];
        for round in 0..6_000 {
            let class = Class::ALL[round % Class::ALL.len()];
            let pair = class.pair(&mut random);
            for (elements, a, b) in hard_pairs(&pair) {
                let exact = closest(&elements);
                let mut of_all: Option<FourClosest> = None;
                for instructions in Instructions::all() {
                    let found = dispatch!(instructions, i => four(i, [&elements; 4]));
                    let bits = |found: &FourClosest| format!("{found:?}");
                    let before = of_all.get_or_insert(found);
                    assert_eq!(bits(before), bits(&found));
                }
                let found = of_all.expect("there are instructions");
                let (least, most) = (found.least[0], found.most[0]);
                assert!(most >= 0.0 && !least.is_nan());
                if least > 0.0 {
                    assert_ne!(
                        compare_distance(&a, &b, least),
                        Ordering::Less,
                        "{elements:?} {found:?}"
                    );
                }
                if most < f64::INFINITY {
                    assert_ne!(
                        compare_distance(&a, &b, most),
                        Ordering::Greater,
                        "{elements:?} {found:?}"
                    );
                }
                total += 1;
                known += u32::from(most < f64::INFINITY);
                close += u32::from(most - least <= 1e-9 * exact.distance);
            }
        }
        assert!(
            known > total / 2 && close > total / 5,
            "{known} {close} {total}"
        );
    }

    /// Decision of single precision on a pair at a distance, in some lane: whether it is surely
    /// that near, and whether surely further apart.
    ///
    /// Asserts that all instruction sets agree.
    fn decided<S: Coordinate>(
        corners: &[[S; 4]; 4],
        others: &[[S; 4]; 4],
        are_edges: bool,
        lane: usize,
        distance: f64,
    ) -> [bool; 2] {
        let mut pairs = [others.each_ref(); 8];
        pairs[lane] = corners.each_ref();
        let mut of_all: Option<[u64; 2]> = None;
        for instructions in Instructions::all() {
            let limits = rounded_outward([distance; 2]).map(|limit| [limit; 8]);
            let masks = dispatch!(instructions, i => decide_eight(i, are_edges, &pairs, &limits));
            assert_eq!(*of_all.get_or_insert(masks), masks);
        }
        of_all
            .expect("there are instructions")
            .map(|mask| mask >> lane & 1 == 1)
    }

    /// Counts pairs that are decided, and pairs that are left open, at distances round their own.
    /// Decisions are compared with the oracle.
    fn check_eight<S: Coordinate>(of: fn(f64) -> S, seed: u64) -> [usize; 2] {
        let mut random = Random::new(seed);
        let [mut decisions, mut open] = [0; 2];
        let mut before = None;
        for round in 0..5_000 {
            let class = Class::ALL[round % Class::ALL.len()];
            // Pairs of ordinary size are scaled to other magnitudes too, where nothing is sure.
            let scale = match class {
                Class::Scales
                | Class::Subnormal
                | Class::NearUnderflow
                | Class::BelowUnderflow
                | Class::AnyBits => 1.0,
                _ => [1.0, f64::powi(0.5, 70), f64::powi(2.0, 80), 1.0][round / 16 % 4],
            };
            let pair = class.pair(&mut random);
            let pair = pair.map(|it| it.map(|p| p.map(|x| of(x * scale).to_f64())));
            for (elements, a, b) in hard_pairs(&pair) {
                let (Primitives::VertexTriangle(four) | Primitives::EdgeEdge(four)) = elements;
                let corners = four.map(|[x, y, z]| [x, y, z, z].map(of));
                let others = before.replace(corners).unwrap_or(corners);
                let are_edges = matches!(elements, Primitives::EdgeEdge(_));
                let d = closest(&elements).distance;
                for x in [
                    d,
                    d * (1.0 + 1e-7),
                    d * (1.0 - 1e-7),
                    d * (1.0 + 1e-5),
                    d * (1.0 - 1e-5),
                    d * 1.01,
                    d * 0.99,
                    d * 4.0,
                    0.0,
                    0.3 * scale,
                ] {
                    let [is_close, is_far] = decided(&corners, &others, are_edges, round % 8, x);
                    assert!(!(is_close && is_far));
                    if is_close || is_far {
                        let is_within = compare_distance(&a, &b, x) != Ordering::Greater;
                        assert_eq!(is_within, is_close, "{elements:?} {x}");
                        decisions += 1;
                    } else {
                        open += 1;
                    }
                }
            }
        }
        [decisions, open]
    }

    #[test]
    fn what_single_precision_is_sure_of_is_so() {
        for [decisions, open] in [check_eight(|x| x, 46), check_eight(|x| x as f32, 47)] {
            assert!(decisions > 60_000 && open > 60_000, "{decisions} {open}");
        }
    }

    #[test]
    fn eight_well_shaped_pairs_are_decided_to_a_few_units() {
        // For triangles and edges a unit long and as far apart, single precision leaves open no
        // more than its rounding.
        let mut random = Random::new(48);
        let mut unit = || f64::from(random.below(1 << 20)) / f64::from(1 << 20);
        for round in 0..4_000 {
            let near = |to: [f64; 3], unit: &mut dyn FnMut() -> f64| to.map(|x| x + unit() / 8.0);
            let are_edges = round % 2 == 0;
            let four = if are_edges {
                [[0.0; 3], [1.0, 0.0, 0.0], [0.5, -0.5, 1.0], [0.5, 0.5, 1.0]]
            } else {
                [[0.3, 0.3, 1.0], [0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
            };
            let four = four.map(|p| near(p, &mut unit));
            let elements = if are_edges {
                Primitives::EdgeEdge(four)
            } else {
                Primitives::VertexTriangle(four)
            };
            let d = closest(&elements).distance;
            let corners = four.map(|[x, y, z]| [x, y, z, z]);
            let at = |by: f64| decided(&corners, &corners, are_edges, round % 8, d * by);
            assert_eq!(at(1.0 + 2f64.powi(-14)), [true, false], "{four:?}");
            assert_eq!(at(1.0 - 2f64.powi(-14)), [false, true], "{four:?}");
        }
    }

    #[test]
    fn elements_are_as_far_apart_along_their_normal_as_is_said() {
        let mut random = Random::new(50);
        let [mut positive, mut tight] = [0; 2];
        for round in 0..6_000 {
            let pair = Class::ALL[round % Class::ALL.len()].pair(&mut random);
            for (elements, a, b) in hard_pairs(&pair) {
                let (Primitives::VertexTriangle(four) | Primitives::EdgeEdge(four)) = elements;
                let corners = four.map(|[x, y, z]| [x, y, z, z]);
                let are_edges = matches!(elements, Primitives::EdgeEdge(_));
                let Some((direction, least)) = along_normal(are_edges, &corners.each_ref()) else {
                    continue;
                };
                if least <= 0.0 {
                    continue;
                }
                positive += 1;
                assert_ne!(
                    compare_distance(&a, &b, least),
                    Ordering::Less,
                    "{elements:?}"
                );
                for p in &a {
                    for q in &b {
                        // The direction itself is rounded.
                        let by = compare_dot(direction, *p, *q, least * (1.0 - 1e-12));
                        assert_ne!(by, Ordering::Less, "{elements:?} {direction:?}");
                    }
                }
                let d = closest(&elements).distance;
                tight += u32::from(d - least <= ACCURACY * d);
            }
        }
        assert!(positive > 4_000 && tight > 2_000, "{positive} {tight}");
    }

    #[test]
    fn insides_that_nearly_touch_are_measured_without_integers() {
        // At distances of 2^-12 to 2^-14 the way between points is often too poor a direction, and
        // the normal is good enough.
        let mut random = Random::new(51);
        let mut unit = || f64::from(random.below(1 << 20)) / f64::from(1 << 20);
        let mut by_way = 0;
        for round in 0..2_000 {
            let apart = f64::powi(0.5, 12 + round % 3);
            let are_edges = round % 2 == 0;
            let points = if are_edges {
                [
                    [-1.0, 0.1, 0.0],
                    [1.0, -0.2, 0.0],
                    [0.1, -1.0, apart],
                    [0.0, 1.0, apart],
                ]
            } else {
                [
                    [0.3, 0.2, apart],
                    [-1.0, -1.0, 0.0],
                    [2.0, -1.0, 0.0],
                    [0.0, 2.0, 0.0],
                ]
            };
            // The same pair in any position: turned about two axes, and moved.
            let [u, v] = [unit(), unit()].map(|x| 6.0 * x);
            let offset = [unit(), unit(), unit()];
            let points = points.map(|[x, y, z]: [f64; 3]| {
                let [x, y] = [x * u.cos() - y * u.sin(), x * u.sin() + y * u.cos()];
                let [y, z] = [y * v.cos() - z * v.sin(), y * v.sin() + z * v.cos()];
                [x + offset[0], y + offset[1], z + offset[2]]
            });
            let elements = if are_edges {
                Primitives::EdgeEdge(points)
            } else {
                Primitives::VertexTriangle(points)
            };
            let d = closest(&elements).distance;
            let corners = points.map(|[x, y, z]| [x, y, z, z]);
            let (_, least) = along_normal(are_edges, &corners.each_ref()).expect("a direction");
            assert!(d - least <= ACCURACY * d, "{elements:?} {d} {least}");
            let found = dispatch!(Instructions::widest(), i => four(i, [&elements; 4]));
            by_way += u32::from(found.most[0] - found.least[0] <= ACCURACY * d);
        }
        assert!(by_way < 1_500, "{by_way}");
    }

    #[test]
    fn triangles_are_as_far_apart_along_a_direction_as_is_said() {
        let mut random = Random::new(49);
        let [mut positive, mut tight] = [0; 2];
        for round in 0..8_000 {
            let [a, b] = Class::ALL[round % Class::ALL.len()].pair(&mut random);
            let scale = if round % 9 == 0 { 1e-300 } else { 1.0 };
            let [a, b] = [a, b].map(|it| it.map(|p| p.map(|x| x * scale)));
            let padded = [a, b].map(|it| it.map(|[x, y, z]| [x, y, z, z]));
            let [of_a, of_b] = padded.each_ref().map(<[_; 3]>::each_ref);
            let measured = dispatch!(Instructions::widest(), i => of_triangles(i, &of_a, &of_b));
            let [x, y, z] = measured.way;
            // Any direction, the way between closest points among them.
            let length = (x * x + y * y + z * z).sqrt();
            let directions = [
                [x, y, z].map(|x| x / length),
                [0.0, 0.6, -0.8],
                [1.0, 0.0, 0.0],
            ];
            for (which, direction) in directions.into_iter().enumerate() {
                if !direction.iter().all(|x| x.is_finite()) {
                    continue;
                }
                let least = apart_along(direction, &of_a, &of_b);
                if least <= 0.0 {
                    continue;
                }
                positive += 1;
                assert_ne!(
                    compare_distance(&a, &b, least),
                    Ordering::Less,
                    "{a:?} {b:?}"
                );
                for p in &a {
                    for q in &b {
                        let by = compare_dot(direction, *p, *q, least);
                        assert_ne!(by, Ordering::Less, "{a:?} {b:?} {direction:?}");
                    }
                }
                tight += u32::from(which == 0 && least >= measured.least * (1.0 - 1e-9));
            }
        }
        assert!(positive > 2_000 && tight > 1_000, "{positive} {tight}");
    }

    #[test]
    fn points_and_direction_are_as_far_apart_as_is_said() {
        // Both ways to find a bound, where one of them is certain.
        let mut random = Random::new(43);
        let mut checked = [0; 2];
        for round in 0..4_000 {
            let pair = Class::ALL[round % Class::ALL.len()].pair(&mut random);
            for (elements, a, b) in hard_pairs(&pair) {
                let exact = closest(&elements);
                let found = dispatch!(Instructions::widest(), i => four(i, [&elements; 4]));
                let is_certain =
                    found.most[0] - found.least[0] <= 2f64.powi(-30) * found.distance[0];
                let mut answers = vec![(0, exact.distance, exact.along, exact.direction)];
                if is_certain {
                    let d = found.distance[0];
                    let along = found.along.map(|it| it[0]);
                    answers.push((1, d, along, found.way.map(|it| it[0] / d)));
                }
                let size = a
                    .iter()
                    .chain(&b)
                    .flat_map(|p| (0..3).map(|x| (p[x] - a[0][x]).abs()));
                let size = size.fold(0.0, f64::max);
                if size < 1e-30 {
                    continue;
                }
                for (which, d, [x, y], direction) in answers {
                    let sum = match elements {
                        Primitives::VertexTriangle([p, a, b, c]) => {
                            vec![(1.0, p), (-1.0, a), (-x, b), (x, a), (-y, c), (y, a)]
                        }
                        Primitives::EdgeEdge([a0, a1, b0, b1]) => {
                            vec![(1.0, a0), (x, a1), (-x, a0), (-1.0, b0), (-y, b1), (y, b0)]
                        }
                    };
                    let slack = 2f64.powi(-30) * d + 2f64.powi(-48) * size;
                    assert_ne!(
                        compare_length(&sum, d + slack),
                        Ordering::Greater,
                        "{elements:?} {x} {y} {d}"
                    );
                    if d > f64::MIN_POSITIVE {
                        for p in &a {
                            for q in &b {
                                assert_ne!(
                                    compare_dot(direction, *p, *q, d - slack),
                                    Ordering::Less,
                                    "{elements:?} {direction:?} {d}"
                                );
                            }
                        }
                    }
                    checked[which] += 1;
                }
            }
        }
        assert!(checked[0] > 15_000 && checked[1] > 5_000, "{checked:?}");
    }
}
