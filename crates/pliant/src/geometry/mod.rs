//! Coordinates, boxes, and how the first become the second.

mod aabb;
mod scalar;
mod shape;

pub(crate) use aabb::Aabb;
pub use scalar::Scalar;
pub(crate) use scalar::{larger, smaller};
pub(crate) use shape::{Bounds, Shape};
