//! What is decided exactly, one pair at a time, and says the last word wherever lanes are not certain.
//!
//! **Triangles.** `orientation` gives the sign of a determinant of four points: by a floating-point
//! filter with a proven bound, and by exact arithmetic where the filter is not certain. `lattice` is
//! that arithmetic where integers of 128 bits are enough, which they are for most exact contact;
//! `accumulator` is for coordinates near the smallest there are. `triangles` decides on these signs
//! alone whether two triangles intersect, `contact_kind` how they do. So the answer is that of exact
//! arithmetic: independent of scale, of the order of triangles and corners, of processor and compiler.
//!
//! **Elements.** `gap` decides whether boxes of elements are near each other (candidates), `distance`
//! how far elements are apart and whether that is at most so far (close pairs), and `motion` whether
//! and when they meet that move (impacts): each in double precision where that is certain, else in the
//! integers of any length of `integer`.
//!
//! The paper uses the test of Möller (1997), which decides on rounded interval ends and a tolerance.

mod accumulator;
mod contact_kind;
pub(crate) mod distance;
mod gap;
mod integer;
mod lattice;
pub(crate) mod motion;
mod orientation;
mod point;
mod triangles;

use crate::contacts::ContactKind;
use crate::geometry::Real;
pub(crate) use contact_kind::contact_kind;
pub(crate) use gap::are_within;
use lattice::{Lattice, on_lattice};
pub(crate) use orientation::Exact;
use orientation::{Filtered, Orientation};
use point::Point;
pub(crate) use point::Triangle;
use std::cmp::Ordering;
pub(crate) use triangles::triangles_intersect;

/// Whether a triangle has no area: its corners lie on a line, or in a point. Exact, for coordinates that a body may have: finite and at
/// most `f32::MAX` in magnitude; with others the answer is false. Single precision, widened, is as good.
///
/// ```
/// use pliant::exact::is_degenerate;
///
/// assert!(is_degenerate([[0.0; 3], [1.0; 3], [3.0; 3]]));
/// assert!(!is_degenerate([[0.0; 3], [1.0; 3], [3.0, 3.0, 3.0 + 1e-15]]));
/// ```
pub fn is_degenerate([a, b, c]: [[f64; 3]; 3]) -> bool {
    if ![a, b, c].iter().all(is_in_range) {
        return false;
    }
    // Two corners in one place need no arithmetic, and are most of what there is.
    a == b
        || b == c
        || c == a
        || (0..3).all(|axis| {
            let flat = |point: Point| [point[(axis + 1) % 3], point[(axis + 2) % 3]];
            orientation::orientation_2d(flat(a), flat(b), flat(c)) == 0
        })
}

/// On which side of a triangle's plane a point lies: `Greater` where its normal (b - a) x (c - a) points to, `Less` behind it, `Equal` in the
/// plane, and of a triangle without area always. Exact, for coordinates that a body may have: finite and at most `f32::MAX` in
/// magnitude; with others the answer is `Equal`. Single precision, widened, is as good.
///
/// ```
/// use std::cmp::Ordering::{Equal, Greater, Less};
///
/// let floor = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let sides = [1e-300, 0.0, -1e-300].map(|z| pliant::exact::side_of_plane(floor, [5.0, 7.0, z]));
/// assert_eq!(sides, [Greater, Equal, Less]);
/// ```
pub fn side_of_plane([a, b, c]: [[f64; 3]; 3], point: [f64; 3]) -> Ordering {
    if [a, b, c, point].iter().all(is_in_range) {
        let mut filtered = Filtered::new(f64::UNDERFLOW);
        filtered.sign(&a, &b, &c, &point).cmp(&0)
    } else {
        Ordering::Equal
    }
}

/// Whether predicates are exact on a point: its coordinates are those that a body may have.
fn is_in_range(point: &Point) -> bool {
    point.iter().all(|x| x.abs() <= f64::from(f32::MAX))
}

/// Whether two closed triangles have a point in common; a degenerate triangle is the segment or point that it is. `S` is the type
/// that their coordinates came in. What single precision is not certain of comes here: mostly exact contact, which integers
/// decide before floating point is asked again. Adds one to `exact` if a sign needed exact arithmetic.
#[inline]
pub(crate) fn intersect<S: Real>(a: &Triangle, b: &Triangle, exact: &mut u64) -> bool {
    if let Some([a, b]) = on_lattice(a, b) {
        *exact += 1;
        return triangles_intersect(&a, &b, &mut Lattice);
    }
    let mut filtered = Filtered::new(S::UNDERFLOW);
    let intersect = triangles_intersect(a, b, &mut filtered);
    *exact += u64::from(filtered.was_uncertain());
    intersect
}

/// How two triangles that intersect do so; as [`intersect`] computes.
pub(crate) fn kind_of<S: Real>(a: &Triangle, b: &Triangle) -> ContactKind {
    match on_lattice(a, b) {
        Some([a, b]) => contact_kind(&a, &b, &mut Lattice),
        None => contact_kind(a, b, &mut Filtered::new(S::UNDERFLOW)),
    }
}
