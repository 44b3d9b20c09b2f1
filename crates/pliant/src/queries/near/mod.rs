//! Boxes of elements, beside the boxes of the tree: vertices, edges and triangles, by runs of up to
//! eight triangles.

pub(super) mod groups;
mod near_boxes;
mod removed;
pub(super) mod runs;
mod thickness;

pub(crate) use groups::Groups;
pub(crate) use near_boxes::{NearBoxes, NearElements, Which};
pub(crate) use removed::Removed;
pub(crate) use thickness::{Thickness, Thicknesses, most};
