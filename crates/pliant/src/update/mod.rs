//! Refitting: making boxes valid for the shape a body has now (paper, 3.3).
//!
//! One idea carries all three strategies of the paper: the boxes down to some level are made *ahead*, all at once and
//! bottom-up; what lies deeper is made top-down, when it is *reached*.
//!
//! ```text
//! bottom-up   ahead: down to the deepest leaf
//! top-down    ahead: the root only
//! hybrid      ahead: down to level floor(n / 2), or a given one, where n is the level of the deepest leaf;
//!             all levels, if none is given and much of the tree was reached the last time, or a body meets itself
//! ```
//!
//! `hybrid` decides how far ahead, `bottom_up` refits some levels below a wide node, `top_down` what a traversal reaches, and `refit`
//! makes the boxes, for all of them; `leaves` makes those of single triangles, `whole` all
//! of a body that meets itself, `quantize` quantizes them; a `DirtySet` is what was reached. Boxes made are
//! counted, so that the strategies can be compared by their work. What boxes are made of (`Source`) and
//! the degree are types where boxes are made, and matched on once a batch.

mod bottom_up;
mod dirty_set;
mod hybrid;
mod leaves;
mod quantize;
mod refit;
mod refitted;
mod top_down;
mod whole;

pub(crate) use dirty_set::DirtySet;
pub(crate) use refitted::{Partner, Refit, Refitted};
