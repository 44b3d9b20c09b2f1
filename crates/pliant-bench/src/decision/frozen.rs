//! Exact triangle-triangle test, as it stood when the project began: a frozen yardstick for later
//! gains.
//!
//! Six edge-triangle tests over fifteen orientation signs. Each sign comes from a filter in f64
//! and, where that is uncertain, from `robust`. This copy is scalar and for f32 only, and is kept
//! unchanged on purpose. `pliant-exact` explains and proves the test.

use super::Triangle;

type Point = [f64; 3];
type Sign = i8;
type Corners = [Point; 3];

/// Whether two closed triangles have a point in common.
pub fn intersect(a: &Triangle, b: &Triangle) -> bool {
    let wide = |triangle: &Triangle| triangle.map(|corner| corner.map(f64::from));
    triangles_intersect(&wide(a), &wide(b))
}

/// Error bound of the filter, 9 u: eight roundings on every path of a determinant, and one for the
/// bound.
const RELATIVE_ERROR: f64 = 9.0 * (f64::EPSILON / 2.0);

/// Side of the plane through a, b, c on which d lies.
#[inline]
fn sign(a: &Point, b: &Point, c: &Point, d: &Point) -> Sign {
    let difference = |p: &Point| -> Point { std::array::from_fn(|axis| p[axis] - a[axis]) };
    let (e1, e2, t) = (difference(b), difference(c), difference(d));
    let (mut determinant, mut magnitude) = (0.0, 0.0);
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let (left, right) = (e1[j] * e2[k], e1[k] * e2[j]);
        determinant += (left - right) * t[i];
        magnitude += (left.abs() + right.abs()) * t[i].abs();
    }
    if determinant.abs() > RELATIVE_ERROR * magnitude {
        return sign_of(determinant);
    }
    let coord = |&[x, y, z]: &Point| robust::Coord3D { x, y, z };
    sign_of(-robust::orient3d(coord(a), coord(b), coord(c), coord(d)))
}

fn orientation_2d(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> Sign {
    let coord = |[x, y]: [f64; 2]| robust::Coord { x, y };
    sign_of(robust::orient2d(coord(a), coord(b), coord(c)))
}

fn sign_of(value: f64) -> Sign {
    i8::from(value > 0.0) - i8::from(value < 0.0)
}

#[inline]
fn triangles_intersect(a: &Corners, b: &Corners) -> bool {
    let of_b = plane_signs(a, b);
    if one_side(of_b) {
        return false;
    }
    let of_a = plane_signs(b, a);
    if one_side(of_a) {
        return false;
    }
    if of_a == [0; 3] && of_b == [0; 3] {
        return in_one_plane(a, b) && intersect_in_one_plane(a, b);
    }
    // Edge signs are needed twice, once for either triangle, and often not at all.
    let mut edge_signs = [[None; 3]; 3];
    let mut edge_sign = |i: usize, j: usize| {
        *edge_signs[i][j]
            .get_or_insert_with(|| sign(&a[i], &a[(i + 1) % 3], &b[j], &b[(j + 1) % 3]))
    };
    (0..3).any(|i| crosses(of_a, i) && agree([edge_sign(i, 0), edge_sign(i, 1), edge_sign(i, 2)]))
        || (0..3)
            .any(|j| crosses(of_b, j) && agree([edge_sign(0, j), edge_sign(1, j), edge_sign(2, j)]))
}

/// Sides of the plane of a triangle on which three points lie.
#[inline]
fn plane_signs([a, b, c]: &Corners, points: &Corners) -> [Sign; 3] {
    [0, 1, 2].map(|i| sign(a, b, c, &points[i]))
}

#[inline]
fn one_side(signs: [Sign; 3]) -> bool {
    signs == [1; 3] || signs == [-1; 3]
}

/// Whether edge `i` meets the plane without lying in it.
#[inline]
fn crosses(signs: [Sign; 3], i: usize) -> bool {
    let (start, end) = (signs[i], signs[(i + 1) % 3]);
    start * end <= 0 && (start, end) != (0, 0)
}

/// Whether all signs are >= 0, or all are <= 0.
#[inline]
fn agree(signs: [Sign; 3]) -> bool {
    signs.iter().all(|&sign| sign >= 0) || signs.iter().all(|&sign| sign <= 0)
}

/// Whether two triangles whose six plane signs are zero lie in one plane. False only for two skew
/// segments.
fn in_one_plane(a: &Corners, b: &Corners) -> bool {
    (0..3).all(|i| (0..3).all(|j| sign(&a[i], &a[(i + 1) % 3], &b[j], &b[(j + 1) % 3]) == 0))
}

fn intersect_in_one_plane(a: &Corners, b: &Corners) -> bool {
    [(0, 1), (1, 2), (2, 0)].into_iter().all(|(x, y)| {
        let project = |triangle: &Corners| triangle.map(|point| [point[x], point[y]]);
        intersect_2d(&project(a), &project(b))
    })
}

type Point2 = [f64; 2];

/// Whether closed triangles in the plane intersect: edges meet, or one holds a corner of the other.
fn intersect_2d(a: &[Point2; 3], b: &[Point2; 3]) -> bool {
    (0..3).any(|i| (0..3).any(|j| segments_meet([a[i], a[(i + 1) % 3]], [b[j], b[(j + 1) % 3]])))
        || holds(a, b[0])
        || holds(b, a[0])
}

/// Whether closed segments meet, points included: their boxes overlap, and each touches or crosses
/// the other's line.
fn segments_meet([p0, p1]: [Point2; 2], [q0, q1]: [Point2; 2]) -> bool {
    let boxes_overlap = (0..2).all(|axis| {
        p0[axis].min(p1[axis]) <= q0[axis].max(q1[axis])
            && q0[axis].min(q1[axis]) <= p0[axis].max(p1[axis])
    });
    boxes_overlap
        && orientation_2d(p0, p1, q0) * orientation_2d(p0, p1, q1) <= 0
        && orientation_2d(q0, q1, p0) * orientation_2d(q0, q1, p1) <= 0
}

/// Whether a closed triangle holds a point. The box decides for a triangle that is a segment or a
/// point.
fn holds(triangle: &[Point2; 3], point: Point2) -> bool {
    let in_box = (0..2).all(|axis| {
        let [a, b, c] = triangle.map(|corner| corner[axis]);
        a.min(b).min(c) <= point[axis] && point[axis] <= a.max(b).max(c)
    });
    in_box && agree([0, 1, 2].map(|i| orientation_2d(triangle[i], triangle[(i + 1) % 3], point)))
}
