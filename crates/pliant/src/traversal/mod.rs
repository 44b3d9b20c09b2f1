//! From pairs of nodes to candidate pairs of triangles: tree against tree, and a tree against itself.
//!
//! ```text
//! stack = [(root, root)]                                    boxes true and overlapping
//! while the stack is not empty:
//!     take a batch from its top                             1 pair, then 2, 4, ... up to thousands
//!     reach:   make true the groups below the batch         only reaching writes boxes
//!     expand:  children whose boxes overlap onto the stack, pairs of leaves onto a list
//!     when the list is long, or the stack empty:
//!         reach:  make true the boxes of the triangles in these leaves
//!         meet:   triangles whose boxes overlap: candidates; these are decided
//!         show:   what intersects, in order
//! ```
//!
//! Reaching, expanding and meeting take turns. Each is cut into jobs by size, and every job writes lists, or boxes, of its own,
//! so threads share the work, and neither the work nor the order of what is found depends on how many there are. Batches come
//! from the top of one stack, which bounds memory by depth x batch whatever the input is (all triangles in one place included),
//! and needs no recursion. Batches start small, so that a visitor that wants the first pair gets it after a few nodes, and
//! double, so that a visitor that wants all pairs soon works in long runs.
//!
//! Differs from the paper, which descends pair by pair; the boxes it reaches are the same but for the order.

mod descent;
mod expand;
mod meet;
mod one_tree;
mod two_trees;

use crate::geometry::Shape;
use crate::mesh::Mesh;
use crate::tree::Tree;
pub(crate) use descent::{Scratch, Show, descend};
pub(crate) use one_tree::OneTree;
pub(crate) use two_trees::TwoTrees;

/// One body as the traversal sees it.
pub(crate) struct Side<'t, const N: usize, S> {
    pub(crate) tree: &'t mut Tree<N>,
    pub(crate) mesh: &'t Mesh,
    pub(crate) shape: Shape<'t, S>,
}
