//! Coordinates, boxes, and how the first become the second. No loop over a mesh is here: those are `kernels`.

mod bounds;
mod points;
mod real;
mod shape;

pub(crate) use bounds::{Aabb, Bounds, Origin};
pub(crate) use points::{IN_A_ROW, Points, RowBounds};
pub(crate) use real::{OUTWARD, Real, larger, smaller};
pub(crate) use shape::Shape;
