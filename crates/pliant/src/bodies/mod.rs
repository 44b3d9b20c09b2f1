//! Deforming bodies: each a mesh, the trees over it, and the shape that it has now.
//!
//! A `body` is of one `part` or several, trees over runs of its triangles; its `positions` are in the caller's order or in the tree's.
//! Meshes change by `edits`, which need an `edit_state`. How far a tree has decayed is counted in `decay`, and `mending` builds another
//! (`mending_state`). `debug_view` and `tree_cut` are for those who look at trees, `validate` looks at every invariant. All bodies of a
//! world are a `list`.

mod body;
mod debug_view;
mod decay;
mod edit_state;
mod edits;
mod list;
mod mending;
mod mending_state;
mod part;
mod positions;
mod tree_cut;
mod validate;

pub(crate) use body::{Body, Places, validate};
pub use debug_view::{NodeBox, TreeShape};
pub(crate) use decay::Work;
pub(crate) use list::Bodies;
