//! The world: bodies, their shapes, and the questions that users ask.
//!
//! `World` is a `handle` of a `state`. What takes long to compile is behind the trait of `verbs`, which is compiled here, once for `f32`
//! and once for `f64` (`scalar`); `kinds` is the registry of kinds, `asks` how each is asked. What users call is a file a topic: `shapes`, `asking` (a `query`),
//! `motion`, `filters`, `meshes` and `pieces`, `looking`, `writing`; `clearance`, `free_step`, and what is `interruptible`.

mod handle;

// In the order in which documentation shows what they say of a world.
mod shapes;

mod asking;

mod clearance;

mod interruptible;

mod motion;

mod free_step;

mod filters;

mod meshes;

mod pieces;

mod looking;

mod writing;

mod asks;
mod kinds;
mod query;
mod scalar;
mod state;
mod verbs;

pub use free_step::{FreeStep, InContact};
pub use handle::World;
pub use interruptible::Interruptible;
pub use pieces::{Fused, Piece};
pub use query::Query;
pub use scalar::Scalar;
