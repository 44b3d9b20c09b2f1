//! From pairs of nodes to candidate pairs of triangles: tree against tree, and a tree against itself.
//!
//! ```text
//! stack = [(root, root)]                                    boxes true and overlapping
//! while the stack is not empty:
//!     take a batch from its top                             1 pair, then 2, 4, ... up to 1024
//!     reach:   make true the groups below the batch         the only step that writes boxes
//!     expand:  children whose boxes overlap onto the stack, pairs of leaves aside
//!     leaves:  reach them too, then triangle against triangle: candidates
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
mod one_tree;
mod two_trees;

use crate::geometry::Shape;
use crate::kernels::bits_of;
use crate::mesh::Mesh;
use crate::pairs::{Candidate, LeafPair, NodePair};
use crate::tree::{Below, LEAF_LANES, Leaves, NodeId, Tree};
pub(crate) use descent::{Scratch, descend};
pub(crate) use one_tree::OneTree;
pub(crate) use two_trees::TwoTrees;

/// One body as the traversal sees it.
pub(crate) struct Side<'t, const N: usize, S> {
    pub(crate) tree: &'t mut Tree<N>,
    pub(crate) mesh: &'t Mesh,
    pub(crate) shape: Shape<'t, S>,
}

/// The children of two nodes that overlap, of one tree or of two.
#[inline]
fn expand<const N: usize>(
    a: &Tree<N>,
    b: &Tree<N>,
    [node_a, node_b]: NodePair,
    nodes: &mut Vec<NodePair>,
    leaves: &mut Vec<LeafPair>,
) {
    match (a.child(node_a).below(), b.child(node_b).below()) {
        (Below::Leaf(leaf_a), Below::Leaf(leaf_b)) => leaves.push([leaf_a, leaf_b]),
        (Below::Leaf(_), Below::Group(below)) => {
            let mask = b.groups[below as usize].boxes.overlaps(&a.box_of(node_a));
            nodes.extend(bits_of(mask).map(|lane| [node_a, NodeId::new::<N>(below, lane)]));
        }
        (Below::Group(below), Below::Leaf(_)) => {
            let mask = a.groups[below as usize].boxes.overlaps(&b.box_of(node_b));
            nodes.extend(bits_of(mask).map(|lane| [NodeId::new::<N>(below, lane), node_b]));
        }
        (Below::Group(below_a), Below::Group(below_b)) => {
            let (group_a, group_b) = (&a.groups[below_a as usize], &b.groups[below_b as usize]);
            for lane_a in 0..group_a.len() {
                let child_a = NodeId::new::<N>(below_a, lane_a);
                let mask = group_b.boxes.overlaps(&group_a.boxes.get(lane_a));
                nodes.extend(
                    bits_of(mask).map(|lane_b| [child_a, NodeId::new::<N>(below_b, lane_b)]),
                );
            }
        }
    }
}

/// The pairs of triangles of a leaf's block and of another leaf whose boxes overlap, of one tree or of two. `keep` may take
/// bits (8 i + j: triangles i and j) out of the mask of each block of the second leaf.
#[inline]
fn overlapping_triangles<'l>(
    a: &'l Leaves,
    (leaf_a, block_a): (u32, usize),
    b: &'l Leaves,
    leaf_b: u32,
    keep: impl Fn(usize) -> u64 + 'l,
) -> impl Iterator<Item = Candidate> + 'l {
    let block = &a.boxes(leaf_a)[block_a];
    let first_a = a.triangles(leaf_a).start + (block_a * LEAF_LANES) as u32;
    let first_b = b.triangles(leaf_b).start;
    b.boxes(leaf_b)
        .iter()
        .enumerate()
        .flat_map(move |(block_b, other)| {
            let first_b = first_b + (block_b * LEAF_LANES) as u32;
            let mask = block.overlaps_all(other) & keep(block_b);
            bits_of(mask).map(move |bit| [first_a + (bit / 8) as u32, first_b + (bit % 8) as u32])
        })
}
