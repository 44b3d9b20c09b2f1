//! Whether two triangles intersect, decided exactly.
//!
//! `eight` decides candidates eight at a time, by signs that single precision makes certain, and leaves few to the other two.
//! `orientation` gives the sign of a determinant of four points: by a floating-point filter with a proven bound, and by exact
//! arithmetic where the filter is not certain; `lattice` is that arithmetic where integers of 128 bits are enough, which they are
//! for most exact contact, and `wide` for coordinates near the smallest there are. `triangles` decides on these signs alone, so
//! its answer is that of exact arithmetic: independent of scale, of the order of triangles and corners, of processor and
//! compiler.
//!
//! The paper uses the test of Möller (1997), which decides on rounded interval ends and a tolerance.

mod eight;
mod lattice;
mod orientation;
mod triangles;
mod wide;

use crate::geometry::Scalar;
use crate::statistics::Statistics;
pub(crate) use eight::{Undecided, decide};
use lattice::{Lattice, on_lattice};
pub(crate) use orientation::Exact;
use orientation::Filtered;
pub(crate) use triangles::{Triangle, triangles_intersect};

/// Whether two closed triangles have a point in common; a degenerate triangle is the segment or point that it is. What single
/// precision is not certain of comes here: mostly exact contact, which integers decide before floating point is asked again.
#[inline]
pub(crate) fn intersect<S: Scalar>(
    a: &Triangle,
    b: &Triangle,
    statistics: &mut Statistics,
) -> bool {
    if let Some([a, b]) = on_lattice(a, b) {
        statistics.exact_decisions += 1;
        return triangles_intersect(&a, &b, &mut Lattice);
    }
    let mut filtered = Filtered::new(S::UNDERFLOW);
    let intersect = triangles_intersect(a, b, &mut filtered);
    statistics.exact_decisions += u64::from(filtered.was_uncertain());
    intersect
}
