//! Deforming bodies: each a mesh, the trees over it, and its present shape.
//!
//! A `body` joins items that do not know each other's fields.
//!
//! | module | item |
//! |---|---|
//! | `mesh` | mesh of a body, in the caller's numbers and in tree order |
//! | `shape` | positions, in the caller's order, in tree order, or both |
//! | `motion` | straight lines from the present shape to the next |
//! | `parts` | trees, each over a run of triangles |
//! | `rebuild` | fresh trees for bodies whose tree has decayed |
//! | `filter` | filters: which bodies and vertices may meet |
//! | `labels` | labels of the triangles, which leave pairs out |
//! | `thickness` | thickness of the vertices |
//! | `per_vertex` | values that the caller gives vertices, through edits and new orders |
//! | `checks` | refusal of bad positions |
//! | `build` | the tree that the options ask for |
//! | `debug_view` | trees for drawing |
//! | `list` | all bodies of a world |

mod body;
mod build;
mod checks;
mod debug_view;
mod filter;
mod labels;
mod list;
mod mesh;
mod motion;
mod part;
mod parts;
mod per_vertex;
mod rebuild;
mod shape;
mod thickness;

pub(crate) use body::Body;
pub(crate) use checks::validate;
pub use debug_view::{NodeBox, TreeShape};
pub(crate) use list::Bodies;
pub(crate) use mesh::{BodyMesh, Places};
pub(crate) use rebuild::Work;
