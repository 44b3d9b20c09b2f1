//! Refit: making boxes valid for the current shape of a body (paper, 3.3).
//!
//! One mechanism serves all three strategies of the paper. Boxes down to some level are made
//! *ahead* of a traversal, all at once, bottom-up. Deeper ones are made top-down, when they are
//! *reached*.
//!
//! | strategy | boxes made ahead |
//! |---|---|
//! | bottom-up | down to level n, the level of the deepest leaf |
//! | top-down | the root's |
//! | hybrid | down to level floor(n / 2), or a given one |
//! | hybrid, no level given | all, if much was reached the last time or the body meets itself |
//!
//! | file | what |
//! |---|---|
//! | `hybrid` | decides how far ahead |
//! | `bottom_up` | refits several levels below a wide node |
//! | `top_down` | refits the wide nodes that a traversal reached |
//! | `refit` | makes the boxes of wide nodes, for all of these |
//! | `leaves` | makes the boxes of single triangles |
//! | `whole` | makes all boxes of a body that meets itself |
//! | `quantize` | quantizes boxes of triangles |
//! | `dirty_set`, `dirty_sets` | the set of what was reached; sets that threads fill together |
//!
//! Boxes made are counted, so that strategies can be compared by their work. The source of boxes
//! (`Source`) and the degree are types here, matched on once a batch.

mod bottom_up;
mod dirty_set;
mod dirty_sets;
mod hybrid;
mod leaves;
mod quantize;
mod refit;
mod refitted;
mod top_down;
mod whole;

pub(crate) use dirty_set::DirtySet;
pub(crate) use dirty_sets::DirtySets;
pub(crate) use refitted::{Partner, Refit, Refitted};
