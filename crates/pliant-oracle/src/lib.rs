//! An independent judge of the library's decisions, for tests only.
//!
//! [`intersect`] and [`orientation`] compute in integers of any size, from a definition that the library does not use, and share no
//! code with it. [`Class`] makes pairs of triangles on which the answer is hard to get right: the same ones on every machine.
//! [`subnormals_flushed`] runs code as a thread runs it in which the caller has switched subnormal numbers off.
//!
//! ```
//! use pliant_oracle::{Class, Random, intersect};
//!
//! let mut random = Random::new(1);
//! let [a, b] = Class::Lattice.pair(&mut random);
//! assert_eq!(intersect(&a, &b), intersect(&b, &a));
//! ```

mod environment;
mod hull;
mod integers;
mod pairs;

pub use environment::subnormals_flushed;
pub use pairs::{Class, Random, fits_f32};

use hull::{Vector, determinant, minus, zero_in_hull};
use integers::{Integer, Scaled, scale};

/// Three corners.
pub type Triangle = [[f64; 3]; 3];

/// Whether two closed triangles have a point in common, whatever their coordinates; a degenerate triangle is the segment or
/// point that it is.
///
/// They have if and only if the origin is a difference of their points; the differences of their points are the convex hull of the
/// nine differences of their corners.
///
/// # Panics
///
/// If a coordinate is not finite.
pub fn intersect(a: &Triangle, b: &Triangle) -> bool {
    fn decide<I: Integer>(corners: &[Vector<I>]) -> bool {
        zero_in_hull(&std::array::from_fn(|i| {
            minus(&corners[i / 3], &corners[3 + i % 3])
        }))
    }
    match scale(&[a[0], a[1], a[2], b[0], b[1], b[2]]) {
        Scaled::Small(corners) => decide(&corners),
        Scaled::Big(corners) => decide(&corners),
    }
}

/// The sign of the determinant of b - a, c - a, d - a.
///
/// # Panics
///
/// If a coordinate is not finite.
pub fn orientation(a: &[f64; 3], b: &[f64; 3], c: &[f64; 3], d: &[f64; 3]) -> i8 {
    fn sign<I: Integer>(p: &[Vector<I>]) -> i8 {
        let [b, c, d] = [1, 2, 3].map(|i| minus(&p[i], &p[0]));
        determinant(&b, &c, &d).sign()
    }
    match scale(&[*a, *b, *c, *d]) {
        Scaled::Small(points) => sign(&points),
        Scaled::Big(points) => sign(&points),
    }
}

/// The sign of the determinant of b - a, c - a in the plane.
///
/// # Panics
///
/// If a coordinate is not finite.
pub fn orientation_2d(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> i8 {
    let [p, q, r] = [a, b, c].map(|[x, y]| [x, y, 0.0]);
    // Seen from above a.
    orientation(&p, &q, &r, &[a[0], a[1], 1.0])
}
