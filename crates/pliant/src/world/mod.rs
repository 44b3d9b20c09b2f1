//! World: bodies, their shapes, and the questions that users ask.
//!
//! `World` (`handle`) is a box of the `Verbs` trait (`verbs`), behind which `State` (`state`) does
//! the work. So everything that takes long to compile is compiled here, once for `f32` and once for
//! `f64` (`scalar`). Each kind of question for hits is a folder in `kinds/`, which has the
//! registry; `kept` has the buffers that the registry lists. Everything else that users call is a
//! file a topic.

mod handle;

// Modules in the order in which documentation shows their sections of `World`: new, bodies,
// questions, motions, change, settings, looking inside. A test holds it.
mod shapes;

#[macro_use]
mod kinds;

mod distance;

mod inside;

mod contained;

mod closest;

mod depth;

mod clearance;

mod interruptible;

mod motion;

mod free_step;

mod meshes;

mod pieces;

mod filters;

mod looking;

mod writing;

mod kept;
mod named;
mod query;
mod scalar;
mod state;
mod verbs;

pub use contained::{Contained, Containment};
pub use depth::Depth;
pub use free_step::{FreeStep, InContact};
pub use handle::World;
pub use interruptible::Interruptible;
pub(crate) use kinds::reference;
pub(crate) use named::NamedBodies;
pub use pieces::{Fused, Piece};
pub use query::Query;
pub use scalar::Scalar;
