//! The world: bodies, their shapes, and the questions that users ask.
//!
//! `World` is a `handle` of a `state`. What takes long to compile is behind the trait of `verbs`, which is compiled here, once for `f32`
//! and once for `f64` (`scalar`). Questions for hits, each a `query`, are a folder a kind in `kinds`,
//! which has the registry; what is `kept` for each comes from that. All else that users call is a
//! file a topic: `shapes`, `distance`, `clearance`, `motion`, `free_step`, `filters`, `meshes` and
//! `pieces`, `looking`, `writing`, and what is `interruptible`.

mod handle;

// In the order in which documentation shows what they say of a world.
mod shapes;

#[macro_use]
mod kinds;

mod distance;

mod clearance;

mod interruptible;

mod motion;

mod free_step;

mod filters;

mod meshes;

mod pieces;

mod looking;

mod writing;

mod kept;
mod query;
mod scalar;
mod state;
mod verbs;

pub use free_step::{FreeStep, InContact};
pub use handle::World;
pub use interruptible::Interruptible;
pub use kinds::impacts::pairs::{edge_edge_impacts, pair_impacts, vertex_triangle_impacts};
pub(crate) use kinds::reference;
pub use pieces::{Fused, Piece};
pub use query::Query;
pub use scalar::Scalar;
