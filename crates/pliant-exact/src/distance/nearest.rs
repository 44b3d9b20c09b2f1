//! Which of some triangles is the nearest to a point, exactly.

use super::{Primitives, closest_of};
use crate::{Point, Triangle};

/// The number of the triangle that is nearest to a point: exactly, and of equally near ones the
/// first. 0 if there are none.
///
/// Coordinates are [in range](crate::is_in_range). Cost: microseconds for each triangle.
///
/// ```
/// use pliant_exact::distance::nearest_triangle;
///
/// let left = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]];
/// let right = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let nearest = |x: f64| nearest_triangle(&[x, 0.25, 1.0], &[left, right]);
/// assert_eq!([-1e-300, 0.0, 1e-300].map(nearest), [0, 0, 1]);
/// ```
#[cold]
pub fn nearest_triangle(point: &Point, triangles: &[Triangle]) -> usize {
    let elements = |[a, b, c]: &Triangle| Primitives::VertexTriangle([*point, *a, *b, *c]);
    closest_of(&triangles.iter().map(elements).collect::<Vec<_>>()).0
}
