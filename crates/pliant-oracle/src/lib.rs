//! Test oracle: an independent, exact judge of the library's geometric decisions.
//!
//! It computes in integers of any size, from a definition that the library does not use, and shares
//! no code with it.
//!
//! - [`intersect`], [`contact_kind`], [`orientation`] and [`compare_distance`] decide about
//!   triangles and points at rest.
//! - [`meet_until`], [`first_contact`] and [`compare_first`] decide about elements in motion.
//! - [`winding_number`] decides whether a point is inside a closed surface.
//! - [`Class`] generates hard pairs of triangles, and [`MotionClass`] hard motions. Both give the
//!   same ones on every machine.
//! - [`subnormals_flushed`] runs code in a thread whose caller has switched subnormal numbers off.
//!
//! ```
//! use pliant_oracle::{Class, Random, intersect};
//!
//! let mut random = Random::new(1);
//! let [a, b] = Class::Lattice.pair(&mut random);
//! assert_eq!(intersect(&a, &b), intersect(&b, &a));
//! ```

mod adjacent;
mod distance;
mod environment;
mod hull;
mod integers;
mod intersection;
mod motion;
mod pairs;
mod winding;

pub use adjacent::adjacent_contact;
pub use distance::{compare_distance, compare_dot, compare_length};
pub use environment::subnormals_flushed;
pub use intersection::intersection;
pub use motion::{
    Elements, FirstContact, MotionClass, Moving, compare_first, first_contact, meet_until,
    motion_fits_f32,
};
pub use pairs::{Class, Random, element_pairs, fits_f32};
pub use winding::winding_number;

use hull::{cross, determinant, minus, zero_in_hull, zero_inside, zero_inside_of_plane};
use integers::{Exact, Scaled, Vector, scale};

/// A triangle, by its three corners.
pub type Triangle = [[f64; 3]; 3];

/// Whether two closed triangles intersect, exactly, for any finite coordinates.
///
/// A degenerate triangle is the segment or point that it is. Two triangles intersect if and only if
/// the origin is a difference of their points. The differences of their points are the convex hull
/// of the nine differences of their corners.
///
/// # Panics
///
/// If a coordinate is not finite.
pub fn intersect(a: &Triangle, b: &Triangle) -> bool {
    match scale(&[a[0], a[1], a[2], b[0], b[1], b[2]]) {
        Scaled::Small(corners) => zero_is_a_difference(&corners),
        Scaled::Big(corners) => zero_is_a_difference(&corners),
    }
}

/// Kind of contact of two closed triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ContactKind {
    /// No point in common.
    Apart,
    /// Points in common, but neither overlapping nor crossing.
    Touching,
    /// In one plane, with an area in common.
    Overlapping,
    /// Points in common after every small enough move of their corners.
    Crossing,
}

/// Kind of contact of two closed triangles, exactly.
///
/// The origin is outside the set of differences of their points, inside it, inside it in a plane,
/// or on its boundary.
///
/// # Panics
///
/// If a coordinate is not finite.
pub fn contact_kind(a: &Triangle, b: &Triangle) -> ContactKind {
    match scale(&[a[0], a[1], a[2], b[0], b[1], b[2]]) {
        Scaled::Small(corners) => kind_of(&corners),
        Scaled::Big(corners) => kind_of(&corners),
    }
}

fn kind_of<I: Exact>(corners: &[Vector<I>]) -> ContactKind {
    let differences: [Vector<I>; 9] =
        std::array::from_fn(|i| minus(&corners[i / 3], &corners[3 + i % 3]));
    let normal = |a: usize| {
        let [e, f] = [a + 1, a + 2].map(|i| minus(&corners[i], &corners[a]));
        cross(&e, &f)
    };
    if !zero_is_a_difference(corners) {
        ContactKind::Apart
    } else if zero_inside(&differences) {
        ContactKind::Crossing
    } else if zero_inside_of_plane(&differences, &normal(0))
        && zero_inside_of_plane(&differences, &normal(3))
    {
        ContactKind::Overlapping
    } else {
        ContactKind::Touching
    }
}

/// Whether the hulls of the first three corners and of the other three have a point in common.
fn zero_is_a_difference<I: Exact>(corners: &[Vector<I>]) -> bool {
    zero_in_hull::<9, I>(&std::array::from_fn(|i| {
        minus(&corners[i / 3], &corners[3 + i % 3])
    }))
}

/// Orientation of four points: the sign of the determinant of b - a, c - a, d - a.
///
/// # Panics
///
/// If a coordinate is not finite.
pub fn orientation(a: &[f64; 3], b: &[f64; 3], c: &[f64; 3], d: &[f64; 3]) -> i8 {
    match scale(&[*a, *b, *c, *d]) {
        Scaled::Small(points) => side(&points),
        Scaled::Big(points) => side(&points),
    }
}

/// Side of the plane of the first three points on which the fourth lies.
fn side<I: Exact>(points: &[Vector<I>]) -> i8 {
    let [b, c, d] = [1, 2, 3].map(|i| minus(&points[i], &points[0]));
    determinant(&b, &c, &d).sign()
}

/// Orientation of three points in the plane: the sign of the determinant of b - a, c - a.
///
/// # Panics
///
/// If a coordinate is not finite.
pub fn orientation_2d(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> i8 {
    let [p, q, r] = [a, b, c].map(|[x, y]| [x, y, 0.0]);
    // Seen from above a.
    orientation(&p, &q, &r, &[a[0], a[1], 1.0])
}

/// Sign of the exact sum of numbers.
///
/// # Panics
///
/// If a number is not finite.
pub fn sign_of_sum(numbers: &[f64]) -> i8 {
    let points: Vec<[f64; 3]> = numbers.iter().map(|&x| [x, 0.0, 0.0]).collect();
    match scale(&points) {
        Scaled::Small(points) => sum_of_first(&points),
        Scaled::Big(points) => sum_of_first(&points),
    }
}

/// Sign of the sum of first coordinates.
fn sum_of_first<I: Exact>(points: &[Vector<I>]) -> i8 {
    let sum = points
        .iter()
        .map(|point| point[0].clone())
        .reduce(|sum, x| sum.plus(&x));
    sum.map_or(0, |sum| sum.sign())
}

#[cfg(test)]
mod tests {
    use super::*;
    use dashu_int::IBig;

    #[test]
    fn kinds_of_contact() {
        let a = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
        for (b, kind) in [
            (
                [[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [9.0, 9.0, 1.0]],
                ContactKind::Crossing,
            ),
            // A segment through the inside, through an edge, and up to the plane.
            (
                [[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [1.0, 1.0, 0.5]],
                ContactKind::Crossing,
            ),
            (
                [[2.0, 0.0, -1.0], [2.0, 0.0, 1.0], [2.0, 0.0, 0.5]],
                ContactKind::Touching,
            ),
            (
                [[1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [1.0, 1.0, 0.5]],
                ContactKind::Touching,
            ),
            // The common segment ends on two edges of `a`: it passes through the very edges.
            (
                [[2.0, 0.0, -1.0], [2.0, 0.0, 1.0], [-2.0, 4.0, 0.0]],
                ContactKind::Crossing,
            ),
            (a, ContactKind::Overlapping),
            (
                [[4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [4.0, 4.0, 0.0]],
                ContactKind::Touching,
            ),
            (
                [[3.0, 0.5, 0.0], [9.0, 0.0, 0.0], [9.0, 1.0, 0.0]],
                ContactKind::Overlapping,
            ),
            (
                [[1.0, 1.0, 1.0], [4.0, 0.0, 1.0], [0.0, 4.0, 1.0]],
                ContactKind::Apart,
            ),
        ] {
            assert_eq!(contact_kind(&a, &b), kind, "{b:?}");
            assert_eq!(contact_kind(&b, &a), kind, "{b:?}");
        }
    }

    #[test]
    fn small_and_big_integers_say_the_same() {
        let mut random = Random::new(3);
        let mut meeting = 0;
        for round in 0..20_000 {
            let class = Class::ALL[round % Class::ALL.len()];
            let [a, b] = class.pair(&mut random);
            let corners = [a, b].concat();
            if let Scaled::Small(small) = scale(&corners) {
                let big: Vec<Vector<IBig>> = small
                    .iter()
                    .map(|p| p.map(|x: i128| IBig::from(x)))
                    .collect();
                let expected = zero_is_a_difference(&big);
                assert_eq!(zero_is_a_difference(&small), expected, "{a:?} {b:?}");
                assert_eq!(side(&small[..4]), side(&big[..4]), "{a:?} {b:?}");
                meeting += u32::from(expected);
            }
        }
        assert!(meeting > 2_000, "{meeting}");
    }

    #[test]
    fn the_largest_small_integers_do_not_overflow() {
        // The largest differences and determinants that `SMALL` allows; an overflow would panic
        // here.
        let m = 2f64.powi(40) - 1.0;
        let a = [[m, m, -m], [-m, m, m], [m, -m, m]];
        let b = a.map(|p| p.map(|x: f64| -x));
        assert!(matches!(scale(&[a, b].concat()), Scaled::Small(_)));
        assert!(!intersect(&a, &b));
        assert!(intersect(&a, &[b[0], b[1], [m, m, m]]));
        assert_eq!(
            orientation(&a[0], &a[1], &a[2], &b[0]),
            -orientation(&a[0], &a[2], &a[1], &b[0])
        );
    }
}
