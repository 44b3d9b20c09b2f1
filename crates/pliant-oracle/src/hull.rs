//! Exact test of whether the origin is in the convex hull of a few points.
//!
//! By Carathéodory's theorem it is if and only if it is in a simplex of at most four of the points.
//! All points, segments, triangles and tetrahedra are tested, from small to large: 255 for nine
//! points. A degenerate simplex needs no special case, since the smaller ones in it were tested
//! before.

use crate::integers::{Exact, Ring, Vector};

pub(crate) fn minus<I: Ring>(p: &Vector<I>, q: &Vector<I>) -> Vector<I> {
    [0, 1, 2].map(|i| p[i].minus(&q[i]))
}

pub(crate) fn cross<I: Ring>(p: &Vector<I>, q: &Vector<I>) -> Vector<I> {
    [(1, 2), (2, 0), (0, 1)].map(|(j, k)| p[j].times(&q[k]).minus(&p[k].times(&q[j])))
}

pub(crate) fn dot<I: Ring>(p: &Vector<I>, q: &Vector<I>) -> I {
    (p[0].times(&q[0]))
        .plus(&p[1].times(&q[1]))
        .plus(&p[2].times(&q[2]))
}

pub(crate) fn determinant<I: Ring>(p: &Vector<I>, q: &Vector<I>, r: &Vector<I>) -> I {
    dot(&cross(p, q), r)
}

fn is_zero<I: Exact>(p: &Vector<I>) -> bool {
    p.iter().all(|x| x.sign() == 0)
}

/// Whether the origin is in the convex hull of the points.
///
/// That is: non-negative factors, not all zero, combine the points to zero.
pub(crate) fn zero_in_hull<const N: usize, I: Exact>(p: &[Vector<I>; N]) -> bool {
    // Most pairs of triangles are far apart: all points are on one side along an axis.
    let beyond = |axis: usize, sign: i8| p.iter().all(|point| point[axis].sign() == sign);
    if (0..3).any(|axis| beyond(axis, 1) || beyond(axis, -1)) {
        return false;
    }
    // A point that is zero, or a segment whose ends are in opposite directions.
    let crosses: [[Option<Vector<I>>; N]; N] =
        std::array::from_fn(|i| std::array::from_fn(|j| (i < j).then(|| cross(&p[i], &p[j]))));
    let cross_of = |i: usize, j: usize| crosses[i][j].as_ref().expect("i < j");
    if pairs(N).any(|[i, j]| is_zero(cross_of(i, j)) && dot(&p[i], &p[j]).sign() <= 0) {
        return true;
    }
    let mut sides = [[[0_i8; N]; N]; N];
    for [i, j, k] in triples(N) {
        sides[i][j][k] = dot(cross_of(i, j), &p[k]).sign();
        if sides[i][j][k] == 0 && in_triangle([cross_of(i, j), cross_of(j, k), cross_of(i, k)]) {
            return true;
        }
    }
    // A tetrahedron. With the origin in place of one corner after the other, its volume never
    // changes its sign. The four volumes add up to the volume of the whole. So one that is not zero
    // proves that the tetrahedron is not degenerate.
    quadruples(N).any(|[i, j, k, l]| {
        let parts = [
            sides[j][k][l],
            -sides[i][k][l],
            sides[i][j][l],
            -sides[i][j][k],
        ];
        parts != [0; 4] && one_way(&parts)
    })
}

/// Whether the origin is in the interior of the convex hull of points.
///
/// It is not if and only if some plane through it has all points on one closed side. If the points
/// span space, then one such plane goes through two points that are not in line with the origin.
/// For the normals of such planes are a cone without a line. The cone is the hull of its edges, and
/// at an edge two of its sides meet.
pub(crate) fn zero_inside<const N: usize, I: Exact>(p: &[Vector<I>; N]) -> bool {
    let mut do_span = false;
    for [i, j] in pairs(N) {
        let normal = cross(&p[i], &p[j]);
        if is_zero(&normal) {
            continue;
        }
        let sides: Vec<i8> = p.iter().map(|point| dot(&normal, point).sign()).collect();
        if one_way(&sides) {
            return false;
        }
        do_span = true;
    }
    // Signs that are not all of one kind are not all zero.
    do_span
}

/// Whether all points are in a plane through the origin, with the origin in the interior of their
/// hull there.
///
/// `normal` is the plane's normal, and is not zero. For the same reason as in space, no line
/// through a point has all points on one closed side.
pub(crate) fn zero_inside_of_plane<const N: usize, I: Exact>(
    p: &[Vector<I>; N],
    normal: &Vector<I>,
) -> bool {
    let is_in_plane = |point: &Vector<I>| dot(normal, point).sign() == 0;
    // Projected along an axis on which the normal is not zero, no area vanishes.
    let Some(axis) = (0..3).find(|&axis| normal[axis].sign() != 0) else {
        return false;
    };
    if !p.iter().all(is_in_plane) {
        return false;
    }
    let mut do_span = false;
    for point in p.iter().filter(|point| !is_zero(point)) {
        let side = |other: &Vector<I>| cross(point, other)[axis].sign();
        let sides: Vec<i8> = p.iter().map(side).collect();
        if one_way(&sides) {
            return false;
        }
        do_span = true;
    }
    do_span
}

/// Whether a triangle in one plane with the origin contains it.
///
/// The cross products p x q, q x r and r x p are parallel. They must have one direction. They add
/// up to the triangle's area. So one that is not zero proves that the triangle is not degenerate.
fn in_triangle<I: Exact>([pq, qr, pr]: [&Vector<I>; 3]) -> bool {
    (0..3).any(|axis| {
        // r x p is -(p x r).
        let ways = [pq[axis].sign(), qr[axis].sign(), -pr[axis].sign()];
        ways != [0; 3] && one_way(&ways)
    })
}

/// Whether all signs are >= 0, or all <= 0.
fn one_way(signs: &[i8]) -> bool {
    signs.iter().all(|&sign| sign >= 0) || signs.iter().all(|&sign| sign <= 0)
}

pub(crate) fn pairs(count: usize) -> impl Iterator<Item = [usize; 2]> {
    (0..count).flat_map(move |i| (i + 1..count).map(move |j| [i, j]))
}

pub(crate) fn triples(count: usize) -> impl Iterator<Item = [usize; 3]> {
    pairs(count).flat_map(move |[i, j]| (j + 1..count).map(move |k| [i, j, k]))
}

fn quadruples(count: usize) -> impl Iterator<Item = [usize; 4]> {
    triples(count).flat_map(move |[i, j, k]| (k + 1..count).map(move |l| [i, j, k, l]))
}
