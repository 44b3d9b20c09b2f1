//! From pairs of nodes to candidate pairs of triangles: tree against tree, and a tree against itself.
//!
//! ```text
//! stack = [(root, root)]                                    boxes true and overlapping
//! while the stack is not empty:
//!     take a batch from its top                             1 pair, then 2, 4, ... up to 1024
//!     reach:   make true the groups below the batch         the only step that writes boxes
//!     expand:  children whose boxes overlap onto the stack, pairs of leaves aside
//!     leaves:  triangle against triangle, whose boxes are true with the leaf's: candidates
//!     decide the candidates, hand what intersects to the visitor
//! ```
//!
//! Reaching and expanding take turns, a batch at a time, so that lazy updates may be shared among threads without two of them
//! writing one box, and the work done does not depend on how many there are. Batches come from the top of one stack, which
//! bounds memory by depth x batch whatever the input is (all triangles in one place included), and needs no recursion.
//! Batches start small, so that a visitor that wants the first pair gets it after a few nodes, and double, so that a visitor
//! that wants all pairs soon works in long runs.
//!
//! Differs from the paper, which descends pair by pair; the boxes it reaches are the same but for the order.

mod descent;
mod expand;
mod one_tree;
mod two_trees;

use crate::geometry::{Scalar, Shape};
use crate::kernels::Level;
use crate::mesh::Mesh;
use crate::statistics::Statistics;
use crate::tree::{Below, NodeId, Tree};
use crate::update::reach_groups;
pub(crate) use descent::{Scratch, descend};
pub(crate) use one_tree::OneTree;
pub(crate) use two_trees::TwoTrees;

/// One body as the traversal sees it.
pub(crate) struct Side<'t, const N: usize, S> {
    pub(crate) tree: &'t mut Tree<N>,
    pub(crate) mesh: &'t Mesh,
    pub(crate) shape: Shape<'t, S>,
}

/// Makes true what is below some nodes.
fn reach<const N: usize, S: Scalar>(
    level: Level,
    side: &mut Side<'_, N, S>,
    nodes: impl Iterator<Item = NodeId>,
    levels: u32,
    [reached, groups]: &mut [Vec<u32>; 2],
    statistics: &mut Statistics,
) {
    reached.clear();
    let tree = &*side.tree;
    reached.extend(nodes.filter_map(|node| match tree.child(node).below() {
        Below::Group(below) if tree.groups[below as usize].epoch != side.shape.epoch => Some(below),
        _ => None,
    }));
    if !reached.is_empty() {
        let boxes = reach_groups(
            level,
            side.tree,
            reached,
            levels,
            &side.shape,
            groups,
            statistics,
        );
        statistics.boxes_top_down += boxes;
    }
}
