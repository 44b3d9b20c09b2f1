//! Points, triangles and signs, as every exact decision sees them.

/// A point; the conversion from f32 or f64 is exact.
pub type Point = [f64; 3];

/// Three corners.
pub type Triangle = [Point; 3];

/// Which side: -1, 0 or 1. Only products and comparisons of signs are ever used, so which side is which does not matter, as
/// long as it is the same everywhere.
pub(super) type Sign = i8;
