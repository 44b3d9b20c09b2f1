//! Capsules beside the boxes of nodes and triangles, for a tree of long thin triangles.
//!
//! Boxes of long thin triangles are mostly empty, whatever tree is over them. So where there are
//! many (`build::thin`), each box over few vertices has a capsule beside it. They are made with the
//! boxes, and valid when these are.

use super::BoxSource;
use crate::geometry::Capsule;
use crate::held::held;
use crate::ids::{TreeVertex, WideNodeId};
use crate::kernels::EightCapsules;
use crate::tree::{BLOCK_LANES, Tree};

/// Most vertices of a node that has a capsule.
const MOST_VERTICES: usize = 512;

/// Capsules of the nodes of every wide node, and of the triangles of every block.
#[derive(Debug)]
pub(crate) struct Capsules {
    pub(crate) nodes: Vec<EightCapsules>,
    pub(crate) blocks: Vec<EightCapsules>,
}

impl Capsules {
    /// Allocates capsules for a tree.
    pub(super) fn new(tree: &Tree) -> Self {
        Self {
            nodes: vec![EightCapsules::EVERYTHING; tree.wide_nodes.len()],
            blocks: vec![EightCapsules::EVERYTHING; tree.leaves.block_count()],
        }
    }
}

/// Makes the capsules of the triangles of a block.
#[inline(never)]
pub(crate) fn make_block_capsules<B: BoxSource>(
    capsules: &mut EightCapsules,
    triangles: &[[TreeVertex; 3]],
    source: &B,
) {
    for (lane, corners) in triangles.iter().enumerate().take(BLOCK_LANES) {
        capsules.set(lane, &source.capsule(3, &|which| corners[which]));
    }
}

/// Makes the capsules of the nodes of a wide node.
#[inline(never)]
pub(crate) fn make_node_capsules<B: BoxSource>(
    capsules: &mut EightCapsules,
    tree: &Tree,
    wide_node: WideNodeId,
    source: &B,
) {
    let structure = tree.wide_node(wide_node);
    for lane in 0..structure.len() {
        let node = structure.first_node as usize + lane;
        capsules.set(lane, &capsule_of_node(tree, node, source));
    }
}

/// Capsule round the vertices below a node, unless they are many.
pub(crate) fn capsule_of_node<B: BoxSource>(tree: &Tree, node: usize, source: &B) -> Capsule {
    let (run, border) = tree.vertices.run_and_border(node);
    let count = run.len() + border.len();
    if count > MOST_VERTICES {
        return Capsule::EVERYTHING;
    }
    let vertex = |which: usize| match usize::checked_sub(which, border.len()) {
        Some(which) => TreeVertex((run.start + which) as u32),
        None => border[which],
    };
    source.capsule(count, &vertex)
}

held!(Capsules: nodes[], blocks[]);
