//! From pairs of nodes to candidate pairs of triangles: tree against tree, and a tree against itself.
//!
//! ```text
//! one branch, its stack = [(root, root)]                    boxes true and overlapping
//! while some branch has pairs of nodes:
//!     deal:   if one has none, or there is only one yet and it has many: the last of all pairs to all branches
//!     every branch, until it asks for boxes that are not true, or its list of leaves is long:
//!         take a batch from the top of its stack            hundreds; of a visitor 1 pair, then 2, 4, ...
//!         expand it: children whose boxes overlap onto the stack, pairs of leaves onto the list
//!     reach:  make true the groups that they ask for        only reaching writes boxes
//!     when the lists are long, or the stacks empty:
//!         reach:  make true the boxes of the triangles in these leaves
//!         every branch: meet: triangles whose boxes overlap: candidates; these are decided
//!         show:   what intersects, in order
//! ```
//!
//! Where all boxes are true, those of triangles too, branches are *free*: leaves meet on the way, and nothing is waited for. So it is
//! for a body with itself, of which all boxes are made ahead.
//!
//! Branches, and jobs of reaching, are cut by size, and each writes lists, or boxes, of its own; so threads share the work, and
//! neither the work nor the order of what a visitor is shown depends on how many there are. Branches are dealt what is last of all,
//! so that together they are at work in one place of the trees: dealt all there is, they would read from everywhere at once. Batches
//! come from the top of a stack, which bounds memory by depth x batch whatever the input is (all triangles in one place
//! included), and needs no recursion. Batches are long from the beginning where all pairs are wanted: each ends in waiting for
//! the last branch. For a visitor they start small, so that one that wants the first pair gets it after a few nodes, and double.
//!
//! Differs from the paper, which descends pair by pair; the boxes it reaches are the same but for the order.

mod branch;
mod descent;
mod expand;
mod meet;
mod one_tree;
mod two_trees;

use crate::geometry::Shape;
use crate::mesh::Mesh;
use crate::tree::Tree;
pub(crate) use descent::{Scratch, Show, Wanted, descend};
pub(crate) use one_tree::OneTree;
pub(crate) use two_trees::TwoTrees;

/// One body as the traversal sees it.
pub(crate) struct Side<'t, const N: usize, S> {
    pub(crate) tree: &'t mut Tree<N>,
    pub(crate) mesh: &'t Mesh,
    pub(crate) shape: Shape<'t, S>,
}
