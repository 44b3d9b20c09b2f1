//! Coordinates, boxes, and how the first become the second.

mod aabb;
mod points;
mod scalar;
mod shape;

pub(crate) use aabb::Aabb;
pub(crate) use points::{POINTS_JOB, POINTS_SHARED, Points};
pub use scalar::Scalar;
pub(crate) use scalar::{OUTWARD, denormals_are_kept, larger, smaller};
pub(crate) use shape::{Bounds, Origin, Shape};
