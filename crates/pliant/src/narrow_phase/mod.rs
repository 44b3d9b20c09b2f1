//! Whether two triangles intersect, decided exactly.
//!
//! `eight` decides candidates eight at a time, by signs that single precision makes certain, and leaves few to the other two.
//! `orientation` gives the sign of a determinant of four points: by a floating-point filter with a proven bound, and by exact
//! arithmetic where the filter is not certain; `wide` is that arithmetic for coordinates near the smallest there are. `triangles` decides on these signs alone, so its answer is that of exact
//! arithmetic: independent of scale, of the order of triangles and corners, of processor and compiler.
//!
//! The paper uses the test of Möller (1997), which decides on rounded interval ends and a tolerance.

mod eight;
mod orientation;
mod triangles;
mod wide;

use crate::geometry::Scalar;
use crate::statistics::Statistics;
pub(crate) use eight::{Undecided, decide};
pub(crate) use orientation::Exact;
use orientation::Filtered;
pub(crate) use triangles::{Triangle, triangles_intersect};

/// Whether two closed triangles have a point in common; a degenerate triangle is the segment or point that it is.
#[inline]
pub(crate) fn intersect<S: Scalar>(
    a: &Triangle,
    b: &Triangle,
    statistics: &mut Statistics,
) -> bool {
    let mut filtered = Filtered::new(S::UNDERFLOW);
    let intersect = triangles_intersect(a, b, &mut filtered);
    statistics.exact_decisions += u64::from(filtered.was_uncertain());
    intersect
}
