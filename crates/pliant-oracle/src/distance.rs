//! Exact comparison of distances between points, segments and triangles, in integers.
//!
//! The distance of two hulls is the distance of the origin from the hull of all differences of
//! their points. The nearest point of that hull is in a simplex of differences, and is the nearest
//! of the simplex's whole plane or line. So each point, segment and triangle of differences is
//! examined. If the nearest point of its plane lies in it, its distance is a candidate, and the
//! least candidate is the answer. If the origin is inside the hull, which only two triangles allow,
//! they intersect, and the distance is 0.

use crate::hull::minus;
use crate::integers::{Vector, integers};
use crate::intersect;
use dashu_int::IBig;
use std::cmp::Ordering;

/// Compares the distance of two convex hulls with x, exactly.
///
/// The hulls are a point and one to three points, two points each, or three points each.
///
/// # Panics
///
/// If a number is not finite, x is negative, or the numbers of points are others.
pub fn compare_distance(a: &[[f64; 3]], b: &[[f64; 3]], x: f64) -> Ordering {
    assert!(x >= 0.0 && matches!([a.len(), b.len()], [1, 1..=3] | [2, 2] | [3, 3]));
    if let ([a, b, c], [d, e, f]) = (a, b)
        && intersect(&[*a, *b, *c], &[*d, *e, *f])
    {
        return if x > 0.0 {
            Ordering::Less
        } else {
            Ordering::Equal
        };
    }
    let numbers: Vec<f64> = [a, b].concat().into_iter().flatten().chain([x]).collect();
    let all = integers(&numbers);
    let points: Vec<Vector<IBig>> = all[..numbers.len() - 1]
        .chunks(3)
        .map(|it| std::array::from_fn(|axis| it[axis].clone()))
        .collect();
    let (of_a, of_b) = points.split_at(a.len());
    let mut differences: Vec<Vector<IBig>> = Vec::new();
    for p in of_a {
        differences.extend(of_b.iter().map(|q| minus(p, q)));
    }
    let x = &all[numbers.len() - 1];
    let square = x * x;
    let mut least = Ordering::Greater;
    let mut some = |over: IBig, under: &IBig| least = least.min(over.cmp(&(&square * under)));
    let count = differences.len();
    for (i, p) in differences.iter().enumerate() {
        some(dot(p, p), &IBig::ONE);
        for j in i + 1..count {
            let u = minus(&differences[j], p);
            let uu = dot(&u, &u);
            // p + s u is nearest where s u.u = -p.u.
            let s = -dot(p, &u);
            if s >= IBig::ZERO && s <= uu && uu != IBig::ZERO {
                // The square of the distance: |p|^2 - (p.u)^2 / u.u
                some(dot(p, p) * &uu - &s * &s, &uu);
            }
            for k in j + 1..count {
                let v = minus(&differences[k], p);
                let (uv, vv, pv) = (dot(&u, &v), dot(&v, &v), dot(p, &v));
                // Cramer's rule for s u.u + t u.v = -p.u and s u.v + t v.v = -p.v.
                let whole = &uu * &vv - &uv * &uv;
                let s_whole = &s * &vv + &pv * &uv;
                let t_whole = -(&pv * &uu) - &s * &uv;
                let zero = IBig::ZERO;
                if whole != zero
                    && s_whole >= zero
                    && t_whole >= zero
                    && &s_whole + &t_whole <= whole
                {
                    // At the nearest point, (p + s u + t v).p is the square of the distance.
                    let over = dot(p, p) * &whole - &s_whole * &s + &t_whole * &pv;
                    some(over, &whole);
                }
            }
        }
    }
    least
}

/// Compares the length of a sum of points, each times a factor, with x, exactly.
///
/// # Panics
///
/// If a number is not finite, or x is negative.
pub fn compare_length(sum: &[(f64, [f64; 3])], x: f64) -> Ordering {
    assert!(x >= 0.0);
    let factors: Vec<f64> = sum.iter().map(|term| term.0).chain([1.0]).collect();
    let coordinates: Vec<f64> = sum.iter().flat_map(|term| term.1).chain([x]).collect();
    let (factors, coordinates) = (integers(&factors), integers(&coordinates));
    let along = |axis: usize| {
        let terms = factors.iter().zip(coordinates.chunks_exact(3));
        terms.fold(IBig::ZERO, |total, (factor, point)| {
            total + factor * &point[axis]
        })
    };
    let total: Vector<IBig> = [0, 1, 2].map(along);
    // The last factor is one, in the units of the factors.
    let x = factors[sum.len()].clone() * &coordinates[3 * sum.len()];
    dot(&total, &total).cmp(&(&x * &x))
}

/// Compares direction . (p - q) with x, exactly.
///
/// # Panics
///
/// If a number is not finite.
pub fn compare_dot(direction: [f64; 3], p: [f64; 3], q: [f64; 3], x: f64) -> Ordering {
    let [x0, y0, z0] = direction;
    let n = integers(&[x0, y0, z0, 1.0]);
    let points = integers(&[p[0], p[1], p[2], q[0], q[1], q[2], x]);
    let total = (0..3).fold(IBig::ZERO, |total, axis| {
        total + &n[axis] * (&points[axis] - &points[3 + axis])
    });
    total.cmp(&(&n[3] * &points[6]))
}

fn dot(p: &Vector<IBig>, q: &Vector<IBig>) -> IBig {
    &p[0] * &q[0] + &p[1] * &q[1] + &p[2] * &q[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_that_are_known() {
        let triangle = [[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
        for (point, expected) in [
            ([1.0, 1.0, 3.0], 3.0),
            ([1.0, 1.0, 0.0], 0.0),
            ([-3.0, -4.0, 12.0], 13.0),
            ([2.0, -3.0, 4.0], 5.0),
            // Beyond the long side, whose middle is (2, 2).
            ([5.0, 5.0, 0.0], 18f64.sqrt()),
        ] {
            let is = |x: f64| compare_distance(&[point], &triangle, x);
            assert_ne!(is(expected * (1.0 - 1e-15)), Ordering::Less);
            assert_eq!(is(expected + 1e-15), Ordering::Less);
            if expected.fract() == 0.0 {
                assert_eq!(is(expected), Ordering::Equal, "{point:?}");
            }
        }
        let edge = [[0.0; 3], [4.0, 0.0, 0.0]];
        for (other, expected) in [
            ([[1.0, -1.0, 2.0], [1.0, 1.0, 2.0]], 2.0),
            ([[1.0, 3.0, 0.0], [3.0, 3.0, 0.0]], 3.0),
            ([[7.0, 4.0, 0.0], [9.0, 4.0, 0.0]], 5.0),
            ([[1.0, 1.0, 0.0], [1.0, -1.0, 0.0]], 0.0),
            ([[2.0, 0.0, 6.0]; 2], 6.0),
        ] {
            assert_eq!(compare_distance(&edge, &other, expected), Ordering::Equal);
            assert_eq!(
                compare_distance(&other, &edge, expected.next_up()),
                Ordering::Less
            );
        }
        let above = |z: f64| [[1.0, 1.0, z], [1.0, 1.5, z + 2.0], [1.5, 1.0, z + 3.0]];
        for (other, expected) in [(above(2.0), 2.0), (above(0.0), 0.0), (above(-1.0), 0.0)] {
            let is = |x: f64| compare_distance(&triangle, &other, x);
            assert_eq!(is(expected), Ordering::Equal);
            assert_eq!(is(expected.next_up()), Ordering::Less);
        }
        assert_eq!(
            compare_length(&[(0.5, [2.0, 0.0, 0.0]), (2.0, [1.0, 2.0, 0.0])], 5.0),
            Ordering::Equal
        );
        assert_eq!(
            compare_dot([0.0, 0.5, 0.0], [9.0, 3.0, 1.0], [1.0; 3], 1.0),
            Ordering::Equal
        );
    }
}
