//! Triangle against triangle: the same for every method but ours, whose own is tested to agree.

mod frozen;
mod moller;

pub use frozen::intersect as exact;
pub use moller::intersect as moller;

/// Three corners in the world.
pub type Triangle = [[f32; 3]; 3];

/// Whether two triangles intersect.
pub type Decision = fn(&Triangle, &Triangle) -> bool;
