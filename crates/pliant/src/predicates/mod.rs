//! Whether two triangles intersect, decided exactly, one pair at a time.
//!
//! `orientation` gives the sign of a determinant of four points: by a floating-point filter with a proven bound, and by exact
//! arithmetic where the filter is not certain; `lattice` is that arithmetic where integers of 128 bits are enough, which they are
//! for most exact contact, and `accumulator` for coordinates near the smallest there are. `triangles` decides on these signs alone,
//! so its answer is that of exact arithmetic: independent of scale, of the order of triangles and corners, of processor and
//! compiler.
//!
//! The paper uses the test of Möller (1997), which decides on rounded interval ends and a tolerance.

mod accumulator;
mod lattice;
mod orientation;
mod point;
mod triangles;

use crate::geometry::Real;
use lattice::{Lattice, on_lattice};
pub(crate) use orientation::Exact;
use orientation::Filtered;
pub(crate) use point::Triangle;
pub(crate) use triangles::triangles_intersect;

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
