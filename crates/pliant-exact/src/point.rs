//! Points, triangles and signs, as every exact decision sees them.

/// A point; the conversion from f32 or f64 is exact.
pub type Point = [f64; 3];

/// Three corners.
pub type Triangle = [Point; 3];

/// Which side: -1, 0 or 1. Only products and comparisons of signs are ever used, so which side is
/// which does not matter, as long as it is the same everywhere.
pub(super) type Sign = i8;

/// A point of a plane.
pub(super) type Point2 = [f64; 2];

/// The planes of two axes each.
pub(super) const PLANES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

/// A triangle as it is seen in the plane of two axes.
#[inline]
pub(super) fn projected(triangle: &Triangle, [x, y]: [usize; 2]) -> [Point2; 3] {
    triangle.map(|point| [point[x], point[y]])
}
