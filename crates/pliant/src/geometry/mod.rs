//! Coordinates, boxes, and how the first become the second. No loop over a mesh is here: those are `kernels`.

mod aabb;
mod element_pairs;
mod points;
mod real;
mod shape;

pub(crate) use aabb::Aabb;
pub(crate) use element_pairs::{
    ELEMENT_PAIRS, FIRST_OF_EDGES, barycentric, four_corners, is_swapped, on_edge,
};
pub(crate) use points::{IN_A_ROW, Points, RowBounds};
pub(crate) use real::{OUTWARD, Real, denormals_are_kept, larger, smaller};
pub(crate) use shape::{Bounds, Origin, Shape};
