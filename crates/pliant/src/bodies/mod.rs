//! Deforming bodies: each a mesh, the trees over it, and the shape that it has now.
//!
//! A `body` joins things that do not know each other's fields: its `mesh`; its `shape`, in the
//! caller's order or in the tree's; its `motion`; its `parts`, each a tree over a run of triangles;
//! a `rebuild` of these when they have decayed; and a `filter`, which says what may meet. `checks`
//! refuse positions, and `build` makes the tree that the options ask for. `debug_view` is for those
//! who look at trees. All bodies of a world are a `list`.

mod body;
mod build;
mod checks;
mod debug_view;
mod filter;
mod list;
mod mesh;
mod motion;
mod part;
mod parts;
mod rebuild;
mod shape;

pub(crate) use body::Body;
pub(crate) use checks::validate;
pub use debug_view::{NodeBox, TreeShape};
pub(crate) use list::Bodies;
pub(crate) use mesh::Places;
pub(crate) use rebuild::Work;
