//! Triangle-triangle tests for all methods except ours, whose own test is shown to agree.

mod frozen;
mod moller;

pub use frozen::intersect as exact;
pub use moller::intersect as moller;

/// World positions of three corners.
pub type Triangle = [[f32; 3]; 3];

/// A triangle-triangle test: whether two triangles intersect.
pub type Decision = fn(&Triangle, &Triangle) -> bool;
