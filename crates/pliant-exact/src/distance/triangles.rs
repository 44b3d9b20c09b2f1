//! Distance of two triangles: zero if they intersect, otherwise the least distance of their
//! elements.
//!
//! Whether they intersect is decided exactly, as everywhere. If so, they have a point in common:
//! where elements touch, or where an edge goes through the inside of the other triangle. Such a
//! point is first computed in floating point, once on either triangle. The distance of the two
//! points tells how good they are. If it is too large, as for slivers, integers find better ones.

use super::super::element_pairs::in_triangle;
use super::super::float::{U, power};
use super::super::integer::powers_of_all;
use super::super::ring::Ring;
use super::super::triangles::edge;
use super::super::vector::{cross, dot, in_units, minus};
use super::super::{
    ELEMENT_PAIRS, FIRST_OF_EDGES, Length, Point, Precision, Triangle, barycentric, four_corners,
    intersect, is_swapped, on_edge, reference,
};
use super::{Primitives, are_within_distance, closest, closest_of, fraction};

/// Where two triangles are closest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TrianglesClosest {
    /// How far apart they are, in the unit of the coordinates; 0 if they intersect.
    pub distance: f64,
    /// From the second to the first, of length 1 within rounding; zero if the distance is.
    pub direction: Point,
    /// The weights of the corners of either triangle in its point.
    pub barycentric: [[f64; 3]; 2],
}

/// Points in common that were computed may be so far apart, as a part of the largest coordinate of
/// any difference of corners: 2^-40.
const APART: f64 = power(-40);

/// Some points of two triangles: a pair of elements, how far along them the points are, and how far
/// they are apart at most.
#[derive(Clone, Copy, Debug)]
pub struct SomePoints {
    /// The number of the pair of elements, below [`ELEMENT_PAIRS`](crate::ELEMENT_PAIRS).
    pub which: usize,
    /// How far along them the points are, as in [`Closest`](super::Closest).
    pub along: [f64; 2],
    /// How far apart they are at most, in the unit of the coordinates; infinite if nothing is
    /// known.
    pub apart: f64,
}

/// Whether two triangles are at most a distance apart. Exact.
///
/// The distance is at least 0, in the unit of the coordinates, which are [in
/// range](crate::is_in_range). Cost: up to fifteen pairs of elements in integers, tens of
/// microseconds.
#[cold]
pub fn are_triangles_within(
    precision: Precision,
    a: &Triangle,
    b: &Triangle,
    distance: impl Into<Length>,
) -> bool {
    let distance = distance.into();
    intersect(precision, a, b, &mut 0)
        || (0..ELEMENT_PAIRS).any(|which| are_within_distance(&pair(which, a, b), distance))
}

/// Where two triangles are closest, with an error of less than 2^-48 of distance and direction.
///
/// Where they intersect, the points are no further apart than 2^-40 of the largest coordinate of
/// any difference of corners. `known` are some points, which need not be good ones. Coordinates are
/// [in range](crate::is_in_range), distances in their unit. Cost: tens of microseconds.
#[cold]
pub fn closest_triangles(
    precision: Precision,
    a: &Triangle,
    b: &Triangle,
    known: SomePoints,
) -> TrianglesClosest {
    if !intersect(precision, a, b, &mut 0) {
        let pairs: [Primitives; ELEMENT_PAIRS] = std::array::from_fn(|which| pair(which, a, b));
        let (which, closest) = closest_of(&pairs);
        return TrianglesClosest {
            distance: closest.distance,
            direction: if is_swapped(which) {
                closest.direction.map(|x| 0.0 - x)
            } else {
                closest.direction
            },
            barycentric: barycentric(which, closest.along),
        };
    }
    let near_enough = APART * largest_difference(a, b);
    let barycentric = if known.apart <= near_enough {
        barycentric(known.which, known.along)
    } else {
        match crossing(a, b) {
            Some((points, apart)) if apart <= near_enough => points,
            _ => point_in_common(a, b),
        }
    };
    TrianglesClosest {
        barycentric,
        ..TrianglesClosest::default()
    }
}

/// A pair of elements of two triangles.
fn pair(which: usize, a: &Triangle, b: &Triangle) -> Primitives {
    let corners = four_corners(which, a, b);
    if which < FIRST_OF_EDGES {
        Primitives::VertexTriangle(corners)
    } else {
        Primitives::EdgeEdge(corners)
    }
}

fn largest_difference(a: &Triangle, b: &Triangle) -> f64 {
    let corners = || a.iter().chain(b);
    let differences = corners().flat_map(|p| corners().flat_map(|q| minus(p, q)));
    differences.fold(0.0, f64::max)
}

/// An edge of either triangle, and the other triangle: whose edge it is, which of its three, the
/// ends.
fn edges_and_triangles<'t>(
    a: &'t Triangle,
    b: &'t Triangle,
) -> impl Iterator<Item = (bool, usize, [Point; 2], &'t Triangle)> {
    let of_one = |one: &'t Triangle, other: &'t Triangle, is_second: bool| {
        (0..3).map(move |i| (is_second, i, edge(one, i), other))
    };
    of_one(a, b, false).chain(of_one(b, a, true))
}

/// The weights of corners in a point of an edge and in one of a triangle, the first triangle's
/// first.
fn points(is_second: bool, edge: usize, t: f64, [u, v]: [f64; 2]) -> [[f64; 3]; 2] {
    let [p, q] = [on_edge(edge, t), in_triangle([u, v])];
    if is_second { [q, p] } else { [p, q] }
}

/// Where an edge goes through the other triangle, in plain arithmetic; none if no edge does.
/// Returns points of both that are nearly one, and how far they are apart at most.
///
/// The way between them is r = (p - a) + t (q - p) - u (b - a) - v (c - a). Let S be the sum of the
/// absolute values of all coordinates of these four differences. A difference, a product and three
/// sums round each coordinate; the length adds 4 roundings of itself. That is less than 20 2^-53 S
/// in all. Where numbers are below the normal range it is 2^-1020 besides, which is no more if S is
/// at least 2^-200.
fn crossing(a: &Triangle, b: &Triangle) -> Option<([[f64; 3]; 2], f64)> {
    let mut nearest: Option<([[f64; 3]; 2], f64)> = None;
    for (is_second, edge, [p, q], [c0, c1, c2]) in edges_and_triangles(a, b) {
        let (e, f) = (minus(c1, c0), minus(c2, c0));
        let (from, way) = (minus(&p, c0), minus(&q, &p));
        let n = cross(&e, &f);
        let [height, rise] = [dot(&n, &from), dot(&n, &way)];
        let square = dot(&n, &n);
        if rise == 0.0 || square == 0.0 {
            continue;
        }
        let t = (0.0 - height / rise).clamp(0.0, 1.0);
        let at: Point = std::array::from_fn(|axis| from[axis] + t * way[axis]);
        let u = (dot(&cross(&at, &f), &n) / square).clamp(0.0, 1.0);
        let v = (dot(&cross(&e, &at), &n) / square).max(0.0).min(1.0 - u);
        let r: Point = std::array::from_fn(|axis| at[axis] - u * e[axis] - v * f[axis]);
        let sum: f64 = [from, way, e, f]
            .as_flattened()
            .iter()
            .map(|x| x.abs())
            .sum();
        let apart = dot(&r, &r).sqrt() + 20.0 * U * sum;
        let is_known = sum >= power(-200);
        if is_known && nearest.is_none_or(|(_, known)| apart < known) {
            nearest = Some((points(is_second, edge, t, [u, v]), apart));
        }
    }
    nearest
}

/// A point in common of triangles that intersect, by the weights of either's corners; in integers.
///
/// Each weight is within 2^-48. Of triangles that do not intersect the answer says nothing. Cost:
/// tens of microseconds.
pub fn point_in_common(a: &Triangle, b: &Triangle) -> [[f64; 3]; 2] {
    let touching = (0..ELEMENT_PAIRS).find(|&which| are_within_distance(&pair(which, a, b), 0.0));
    if let Some(which) = touching {
        return barycentric(which, closest(&pair(which, a, b)).along);
    }
    // So an edge goes through the inside of the other triangle, and not in its plane.
    for (is_second, edge, [p, q], other) in edges_and_triangles(a, b) {
        if reference::intersect(&[p, q, q], other) {
            let all = [p, q, other[0], other[1], other[2]];
            let [unit, _] = powers_of_all(all.as_flattened());
            let [t, u, v] = exact_crossing(&all, unit);
            return points(is_second, edge, t, [u, v]);
        }
    }
    // Where triangles intersect, elements touch or an edge crosses.
    [[1.0, 0.0, 0.0]; 2]
}

/// Crossing of an edge p q with a triangle whose plane it is not in, as three fractions. The first
/// is the part of the edge, the others are along both sides of the first corner. Each is within
/// 2^-48 of the exact one.
///
/// Let n be normal to the triangle, h = n.(c0 - p) and w = n.(q - p). The point is at the part t =
/// h / w of the way. Times w it is x = w (p - c0) + h (q - p) from the first corner, and u = (x x
/// f).n / (w n.n). That is 7 (b + 1) + 7 bits for coordinates of b.
fn exact_crossing(all: &[Point; 5], unit: i32) -> [f64; 3] {
    let [p, q, c0, c1, c2] = all.map(|corner| in_units(&corner, unit));
    let (e, f) = (minus(&c1, &c0), minus(&c2, &c0));
    let (from, way) = (minus(&p, &c0), minus(&q, &p));
    let n = cross(&e, &f);
    let mut w = dot(&n, &way);
    let mut h = dot(&n, &from).negated();
    if w.sign() < 0 {
        (w, h) = (w.negated(), h.negated());
    }
    let x = std::array::from_fn(|axis| from[axis].times(&w).plus(&way[axis].times(&h)));
    let whole = dot(&n, &n).times(&w);
    let [u, v] = [dot(&cross(&x, &f), &n), dot(&cross(&e, &x), &n)];
    [fraction(&h, &w), fraction(&u, &whole), fraction(&v, &whole)]
}
