//! Triangle against triangle: six edge-triangle tests over fifteen shared signs, without special
//! cases.
//!
//! The signs are the sides of planes on which corners lie, and on which edges pass each other. A
//! degenerate triangle (a segment, a point) is no case of its own. The tests check this against an
//! independent definition, 0 in the convex hull of all a_i - b_j, in integer arithmetic. Guigue and
//! Devillers (2003) need fewer determinants. But they need canonical rotations of the corners, and
//! branches for what is degenerate, which this formulation does not have.

use super::orientation::Orientation;
use super::point::{PLANES, Point2, Sign, Triangle, projected};

/// Whether two closed triangles have a point in common; any answer if the source of signs gives up.
///
/// Let A = a0 a1 a2 and B = b0 b1 b2 be closed triangles. Take the orientation of each corner of B
/// against A (three plane signs) and of each corner of A against B (three). Take it of each edge of
/// A with each edge of B, too (nine edge signs).
///
/// 1. All plane signs of one side are positive, or all negative: **no**; that triangle lies on one
///    side of the other's plane.
/// 2. All six are zero. If a triangle has an area, all corners lie in its plane. The answer is that
///    of a closed two-dimensional test in an axis projection in which it has one. Else there are
///    two segments or points. If an edge sign is not zero they are skew: **no**. Else what meets,
///    meets in all three projections, and what does not is kept apart by one of them.
/// 3. Else the answer is **yes** if and only if two things hold for some edge of either triangle.
///    Its plane signs are not both zero and do not agree. Its three edge signs with the other
///    triangle are all >= 0 or all <= 0. It crosses or touches the plane, and its line passes
///    through the triangle. Edges in the plane need not be looked at: other edges end where they
///    end.
#[inline]
pub(super) fn triangles_intersect(
    a: &Triangle,
    b: &Triangle,
    orientation: &mut impl Orientation,
) -> bool {
    let of_b = orientation.plane_signs(a, b);
    if one_side(of_b) || orientation.has_given_up() {
        return false;
    }
    let of_a = orientation.plane_signs(b, a);
    if one_side(of_a) || orientation.has_given_up() {
        return false;
    }
    if of_a == [0; 3] && of_b == [0; 3] {
        return intersect_in_one_plane(a, b, orientation);
    }
    // Edge signs are wanted twice, once for either triangle, and often not at all.
    let mut edge_signs = [[None; 3]; 3];
    let mut edge_sign = |i: usize, j: usize| {
        *edge_signs[i][j]
            .get_or_insert_with(|| orientation.sign(&a[i], &a[(i + 1) % 3], &b[j], &b[(j + 1) % 3]))
    };
    (0..3).any(|i| crosses(of_a, i) && agree([edge_sign(i, 0), edge_sign(i, 1), edge_sign(i, 2)]))
        || (0..3)
            .any(|j| crosses(of_b, j) && agree([edge_sign(0, j), edge_sign(1, j), edge_sign(2, j)]))
}

#[inline]
pub(super) fn one_side(signs: [Sign; 3]) -> bool {
    signs == [1; 3] || signs == [-1; 3]
}

/// Whether edge `i` meets the plane without lying in it.
#[inline]
fn crosses(signs: [Sign; 3], i: usize) -> bool {
    let [start, end] = edge(&signs, i);
    start * end <= 0 && [start, end] != [0, 0]
}

/// All >= 0 or all <= 0.
#[inline]
fn agree(signs: [Sign; 3]) -> bool {
    signs.iter().all(|&sign| sign >= 0) || signs.iter().all(|&sign| sign <= 0)
}

/// Whether two triangles whose six plane signs are zero have a point in common.
///
/// If one of them has an area both lie in its plane, and so a projection in which it has one keeps
/// all points apart. Else both are segments or points, perhaps skew.
fn intersect_in_one_plane(a: &Triangle, b: &Triangle, orientation: &mut impl Orientation) -> bool {
    let in_plane = |plane| [a, b].map(|triangle| projected(triangle, plane));
    for plane in PLANES {
        let both = in_plane(plane);
        let mut has_area = |&[p, q, r]: &[Point2; 3]| orientation.sign_in_plane(p, q, r) != 0;
        if has_area(&both[0]) || has_area(&both[1]) {
            return intersect_2d(&both[0], &both[1], orientation);
        }
    }
    (0..3).all(|i| {
        (0..3).all(|j| orientation.sign(&a[i], &a[(i + 1) % 3], &b[j], &b[(j + 1) % 3]) == 0)
    }) && PLANES.into_iter().all(|plane| {
        let [a, b] = in_plane(plane);
        intersect_2d(&a, &b, orientation)
    })
}

/// Closed triangles of the plane: an edge meets an edge, or one triangle holds a corner of the
/// other.
fn intersect_2d(a: &[Point2; 3], b: &[Point2; 3], orientation: &mut impl Orientation) -> bool {
    (0..3).any(|i| (0..3).any(|j| segments_meet(edge(a, i), edge(b, j), orientation)))
        || holds(a, b[0], orientation)
        || holds(b, a[0], orientation)
}

/// An edge, from the corner with its number to the next.
#[inline]
pub(super) fn edge<T: Copy>(triangle: &[T; 3], i: usize) -> [T; 2] {
    [triangle[i], triangle[(i + 1) % 3]]
}

/// Closed segments, points included: their boxes overlap and neither lies on one side of the
/// other's line.
fn segments_meet(
    [p0, p1]: [Point2; 2],
    [q0, q1]: [Point2; 2],
    orientation: &mut impl Orientation,
) -> bool {
    let boxes_overlap = (0..2).all(|axis| {
        p0[axis].min(p1[axis]) <= q0[axis].max(q1[axis])
            && q0[axis].min(q1[axis]) <= p0[axis].max(p1[axis])
    });
    let mut sign = |a, b, c| orientation.sign_in_plane(a, b, c);
    boxes_overlap
        && sign(p0, p1, q0) * sign(p0, p1, q1) <= 0
        && sign(q0, q1, p0) * sign(q0, q1, p1) <= 0
}

/// Whether a closed triangle holds a point. The box is for the triangle that is a segment or a
/// point.
fn holds(triangle: &[Point2; 3], point: Point2, orientation: &mut impl Orientation) -> bool {
    let in_box = (0..2).all(|axis| {
        let [a, b, c] = triangle.map(|corner| corner[axis]);
        a.min(b).min(c) <= point[axis] && point[axis] <= a.max(b).max(c)
    });
    let mut side = |i: usize| orientation.sign_in_plane(triangle[i], triangle[(i + 1) % 3], point);
    in_box && agree([side(0), side(1), side(2)])
}

#[cfg(test)]
mod tests {
    use super::super::lattice::on_lattice;
    use super::super::orientation::{Exact, Filtered};
    use super::*;

    type Lattice = [[i64; 3]; 3];

    /// Two convex sets meet if and only if 0 is in the convex hull of their differences. By
    /// Carathéodory it is then in that of at most four of the nine differences a_i - b_j; here in
    /// integers, from the smallest simplex up.
    fn zero_in_hull_of_differences(a: &Lattice, b: &Lattice) -> bool {
        let sub = |p: [i64; 3], q: [i64; 3]| -> [i64; 3] { std::array::from_fn(|i| p[i] - q[i]) };
        let cross = |p: [i64; 3], q: [i64; 3]| -> [i64; 3] {
            std::array::from_fn(|i| {
                p[(i + 1) % 3] * q[(i + 2) % 3] - p[(i + 2) % 3] * q[(i + 1) % 3]
            })
        };
        let dot = |p: [i64; 3], q: [i64; 3]| -> i64 { (0..3).map(|i| p[i] * q[i]).sum() };
        let det = |p, q, r| dot(cross(p, q), r);
        let d: Vec<[i64; 3]> = a
            .iter()
            .flat_map(|&p| b.iter().map(move |&q| sub(p, q)))
            .collect();
        let n = d.len();
        let zero = [0; 3];
        // A point is zero.
        if d.contains(&zero) {
            return true;
        }
        // A segment holds zero: opposite directions.
        let segment = |p, q| cross(p, q) == zero && dot(p, q) < 0;
        if (0..n).any(|i| (i + 1..n).any(|j| segment(d[i], d[j]))) {
            return true;
        }
        // A triangle that is not degenerate holds zero: the three cross products point one way.
        let triangle = |p, q, r| {
            let normal = cross(sub(q, p), sub(r, p));
            normal != zero && dot(normal, p) == 0 && {
                let sides = [
                    dot(normal, cross(p, q)),
                    dot(normal, cross(q, r)),
                    dot(normal, cross(r, p)),
                ];
                sides.iter().all(|&side| side >= 0) || sides.iter().all(|&side| side <= 0)
            }
        };
        if (0..n).any(|i| (i + 1..n).any(|j| (j + 1..n).any(|k| triangle(d[i], d[j], d[k])))) {
            return true;
        }
        // A tetrahedron that is not degenerate holds zero: putting zero for a corner never turns it
        // over.
        let tetrahedron = |p, q, r, s| {
            let whole = det(sub(q, p), sub(r, p), sub(s, p)).signum();
            // Volumes of (0,q,r,s), (p,0,r,s), (p,q,0,s), (p,q,r,0), oriented as the whole.
            let parts = [det(q, r, s), -det(p, r, s), det(p, q, s), -det(p, q, r)];
            whole != 0 && parts.iter().all(|part| part * whole >= 0)
        };
        (0..n).any(|i| {
            (i + 1..n).any(|j| {
                (j + 1..n).any(|k| (k + 1..n).any(|l| tetrahedron(d[i], d[j], d[k], d[l])))
            })
        })
    }

    struct Lcg(u64);

    impl Lcg {
        fn below(&mut self, range: i64) -> i64 {
            self.0 = self
                .0
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            ((self.0 >> 33) as i64).rem_euclid(range)
        }
        fn triangle(&mut self, range: i64) -> Lattice {
            std::array::from_fn(|_| std::array::from_fn(|_| self.below(range)))
        }
    }

    fn as_f64(triangle: &Lattice) -> Triangle {
        triangle.map(|point| point.map(|x| x as f64))
    }

    fn check(a: &Lattice, b: &Lattice) -> bool {
        let expected = zero_in_hull_of_differences(a, b);
        for (p, q) in [(a, b), (b, a)] {
            for rotation in [[0, 1, 2], [1, 2, 0], [2, 1, 0]] {
                let p = rotation.map(|i| p[i]);
                let (p, q) = (as_f64(&p), as_f64(q));
                assert_eq!(
                    triangles_intersect(&p, &q, &mut Filtered::new(crate::Precision::Single)),
                    expected,
                    "{p:?} {q:?}"
                );
                assert_eq!(
                    triangles_intersect(&p, &q, &mut Exact),
                    expected,
                    "{p:?} {q:?}"
                );
                let found = on_lattice!(crate::Precision::Double, &p, &q, |p, q, signs| {
                    triangles_intersect(&p, &q, signs)
                });
                assert_eq!(found.unwrap_or(expected), expected, "{p:?} {q:?}");
                let found = crate::intersect(crate::Precision::Double, &p, &q, &mut 0);
                assert_eq!(found, expected, "{p:?} {q:?}");
            }
        }
        expected
    }

    #[test]
    fn lattice_pairs_agree_with_the_convex_hull_of_differences() {
        // The smaller the lattice, the more of the pairs touch, are coplanar, or degenerate.
        let mut random = Lcg(7);
        let mut intersecting = 0;
        for round in 0..60_000 {
            let range = [2, 3, 4, 6, 12][round % 5];
            let (a, b) = (random.triangle(range), random.triangle(range));
            intersecting += u32::from(check(&a, &b));
        }
        assert!((10_000..50_000).contains(&intersecting), "{intersecting}");
    }

    #[test]
    fn coplanar_collinear_and_skew_pairs_agree_too() {
        let mut random = Lcg(11);
        for round in 0..30_000 {
            let (mut a, mut b) = (random.triangle(5), random.triangle(5));
            match round % 4 {
                // In one plane, z = x + y.
                0 => [&mut a, &mut b]
                    .into_iter()
                    .flatten()
                    .for_each(|p| p[2] = p[0] + p[1]),
                // Two segments, in general position or not.
                1 => (a[2], b[2]) = (a[0], b[1]),
                // On one line.
                2 => [&mut a, &mut b]
                    .into_iter()
                    .flatten()
                    .for_each(|p| *p = [p[0], 2 * p[0], -p[0]]),
                // A point and a triangle.
                _ => a = [a[0]; 3],
            }
            check(&a, &b);
        }
    }

    #[test]
    fn touching_counts() {
        let a = [[0, 0, 0], [4, 0, 0], [0, 4, 0]];
        // A corner on the face, on an edge, on a corner; an edge across an edge; the triangle
        // itself.
        for b in [
            [[1, 1, 0], [1, 1, 5], [2, 1, 5]],
            [[2, 0, 0], [2, 0, 5], [3, -1, 5]],
            [[0, 4, 0], [0, 9, 5], [0, 9, 6]],
            [[1, -1, 1], [1, 1, -1], [1, -9, -9]],
            a,
        ] {
            assert!(check(&a, &b), "{b:?}");
        }
        assert!(!check(&a, &[[5, 0, 0], [9, 0, 0], [9, 9, 0]]));
    }
}
