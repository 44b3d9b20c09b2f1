//! Sets of boxes: a tree's boxes of nodes and triangles from one source, each valid or stale.
//!
//! A tree may have several sets, each from a [`BoxSource`] of its own: the current shape, or that
//! shape grown by a distance. A set knows the [`Version`] of its source that it was last asked for,
//! and begins a new *stamp* when this changes. A box is **valid** if it was made with the set's
//! stamp, else **stale**. Two rules hold at all times: no stale box is read, and above a valid box
//! all are valid. `update` makes boxes valid, `traversal` asks for it, `validate` checks it.

mod capsules;
mod lanes;
mod source;

use super::Tree;
use crate::held::{self, held};
use crate::ids::{BlockId, LeafId, WideNodeId};
use crate::kernels::{BoxLanes, EightBoxes, EightCapsules, QuantizedLanes};
use capsules::Capsules;
pub(crate) use capsules::{capsule_of_node, make_block_capsules, make_node_capsules};
pub(crate) use lanes::{NodeLanes, of_degree};
pub(crate) use source::{BoxSource, Grown, Over, Source, Version, of_source};

/// Stamp before every stamp of a set: a box that was never made.
const NEVER: u64 = 0;

/// Boxes of one tree from one source, with the stamps with which they were made.
///
/// Stamps are of a wide node, for the boxes of its nodes, and of a leaf, for the boxes of its
/// triangles.
#[derive(Debug)]
pub(crate) struct BoxSet {
    version: Option<Version>,
    stamp: u64,
    /// Boxes of the nodes of every wide node.
    nodes: NodeLanes,
    /// Stamp of every wide node.
    node_stamps: Vec<u64>,
    /// Boxes of the triangles of every block; none where every leaf is one triangle.
    blocks: Vec<EightBoxes>,
    /// Stamp of every leaf, for all its blocks.
    leaf_stamps: Vec<u64>,
    /// Stamp with which the nodes of all wide nodes were last made at once.
    complete_nodes: u64,
    /// Stamp with which the triangles of all leaves were last made at once.
    complete_leaves: u64,
    /// How many leaves had the boxes of their triangles made since this was last asked.
    reached: usize,
    /// Quantized boxes of triangles, for a body that meets itself and whose leaves are blocks; else
    /// none.
    quantized: Quantized,
    /// Capsules beside the boxes, for a tree of long thin triangles.
    capsules: Option<Box<Capsules>>,
}

/// Quantized boxes of the triangles in leaves that are blocks.
#[derive(Debug, Default)]
pub(crate) struct Quantized {
    pub(crate) blocks: Vec<QuantizedLanes>,
    /// Units to a length of one; kept for the next step.
    pub(crate) units: f32,
    /// Stamp with which all of them were made.
    stamp: u64,
}

impl Quantized {
    /// Returns the quantized boxes of a block.
    #[inline(always)]
    pub(crate) fn of(&self, block: BlockId) -> &QuantizedLanes {
        &self.blocks[block.index()]
    }
}

/// Boxes of the triangles of all blocks.
#[derive(Clone, Copy)]
pub(crate) struct BlockBoxes<'b>(&'b [EightBoxes]);

impl<'b> BlockBoxes<'b> {
    /// Returns the boxes of a block.
    #[inline(always)]
    pub(crate) fn of(self, block: BlockId) -> &'b EightBoxes {
        &self.0[block.index()]
    }
}

/// Mutable run of the boxes and stamps of wide nodes, from the wide node `first` on.
pub(crate) struct NodesMut<'b, const N: usize> {
    pub(crate) first: usize,
    pub(crate) boxes: &'b mut [BoxLanes<N>],
    pub(crate) stamps: &'b mut [u64],
    /// Capsules of the same wide nodes, or none at all.
    pub(crate) capsules: &'b mut [EightCapsules],
}

/// Mutable run of the boxes and stamps of leaves: blocks from `first_block` on, stamps from
/// `first_leaf` on.
pub(crate) struct LeavesMut<'b> {
    pub(crate) first_leaf: usize,
    pub(crate) stamps: &'b mut [u64],
    pub(crate) first_block: usize,
    pub(crate) blocks: &'b mut [EightBoxes],
    /// Capsules of the same blocks, or none at all.
    pub(crate) capsules: &'b mut [EightCapsules],
}

impl BoxSet {
    /// Allocates boxes for a tree, all stale.
    pub(crate) fn new(tree: &Tree) -> Self {
        let blocks = tree.leaves.block_count();
        let leaves = if blocks > 0 { tree.leaves.len() } else { 0 };
        Self {
            version: None,
            stamp: NEVER + 1,
            nodes: NodeLanes::new(tree.degree, tree.wide_nodes.len()),
            node_stamps: vec![NEVER; tree.wide_nodes.len()],
            blocks: vec![EightBoxes::EMPTY; blocks],
            leaf_stamps: vec![NEVER; leaves],
            complete_nodes: NEVER,
            complete_leaves: NEVER,
            reached: 0,
            quantized: Quantized::default(),
            capsules: tree.has_thin.then(|| Box::new(Capsules::new(tree))),
        }
    }

    /// Makes only boxes from this version of the source valid from now on.
    pub(crate) fn expect(&mut self, version: Version) {
        if self.version != Some(version) {
            self.version = Some(version);
            self.stamp += 1;
        }
    }

    /// Makes all boxes stale, whatever is expected next: an interrupted query may have left some
    /// half made.
    pub(crate) fn forget(&mut self) {
        self.version = None;
    }

    /// Returns the stamp of boxes that are made now.
    #[inline]
    pub(crate) fn stamp(&self) -> u64 {
        self.stamp
    }

    /// Returns the distance by which valid boxes are grown.
    pub(crate) fn grown_by(&self) -> f32 {
        self.version.map_or(0.0, Version::grown_by)
    }

    /// Whether only boxes of this version are valid.
    pub(crate) fn expects(&self, version: Version) -> bool {
        self.version == Some(version)
    }

    /// Whether the boxes of a wide node are valid and of this version.
    pub(crate) fn holds(&self, wide_node: WideNodeId, version: Version) -> bool {
        self.expects(version) && self.is_valid(wide_node)
    }

    /// Whether the boxes of a wide node are valid.
    #[inline(always)]
    pub(crate) fn is_valid(&self, wide_node: WideNodeId) -> bool {
        self.node_stamps[wide_node.index()] == self.stamp
    }

    /// Whether the boxes of a leaf's triangles are valid; also true if there are none.
    pub(crate) fn is_leaf_valid(&self, leaf: LeafId) -> bool {
        self.blocks.is_empty() || self.leaf_stamps[leaf.index()] == self.stamp
    }

    /// Whether the boxes of all nodes were made at once and are valid.
    #[inline]
    pub(crate) fn are_nodes_complete(&self) -> bool {
        self.complete_nodes == self.stamp
    }

    /// Whether the boxes of the triangles in all leaves were made at once and are valid.
    #[inline]
    pub(crate) fn are_leaves_complete(&self) -> bool {
        self.complete_leaves == self.stamp
    }

    /// Notes that all nodes are valid.
    pub(crate) fn complete_nodes(&mut self) {
        self.complete_nodes = self.stamp;
    }

    /// Notes that all leaves are valid.
    pub(crate) fn complete_leaves(&mut self) {
        self.complete_leaves = self.stamp;
    }

    /// Returns the boxes of nodes, to read valid ones.
    #[inline(always)]
    pub(crate) fn nodes(&self) -> &NodeLanes {
        &self.nodes
    }

    /// Returns the boxes, stamps and capsules of wide nodes, to write.
    pub(crate) fn nodes_mut(&mut self) -> (&mut NodeLanes, &mut [u64], &mut [EightCapsules]) {
        self.all_mut().0
    }

    /// Returns the capsules of the nodes of every wide node, if there are any.
    #[inline(always)]
    pub(crate) fn node_capsules(&self) -> Option<&[EightCapsules]> {
        self.capsules
            .as_ref()
            .map(|capsules| capsules.nodes.as_slice())
    }

    /// Returns the capsules of the triangles of every block, if there are any.
    #[inline(always)]
    pub(crate) fn block_capsules(&self) -> Option<&[EightCapsules]> {
        self.capsules
            .as_ref()
            .map(|capsules| capsules.blocks.as_slice())
    }

    /// Returns the boxes of triangles, to read valid ones.
    #[inline(always)]
    pub(crate) fn blocks(&self) -> BlockBoxes<'_> {
        BlockBoxes(&self.blocks)
    }

    /// Returns the quantized boxes of triangles, if all are valid.
    #[inline]
    pub(crate) fn quantized(&self) -> Option<&Quantized> {
        (self.quantized.stamp == self.stamp).then_some(&self.quantized)
    }

    /// Returns the boxes of triangles to read, and the quantized boxes to write.
    pub(crate) fn blocks_and_quantized(&mut self) -> (&[EightBoxes], &mut Quantized) {
        (&self.blocks, &mut self.quantized)
    }

    /// Notes that all quantized boxes are valid.
    pub(crate) fn complete_quantized(&mut self) {
        self.quantized.stamp = self.stamp;
    }

    /// Returns everything to write: of nodes, of leaves, and quantized boxes.
    pub(crate) fn all_mut(
        &mut self,
    ) -> (
        (&mut NodeLanes, &mut [u64], &mut [EightCapsules]),
        LeavesMut<'_>,
        &mut Quantized,
    ) {
        let (of_nodes, of_blocks) = match &mut self.capsules {
            Some(capsules) => (
                capsules.nodes.as_mut_slice(),
                capsules.blocks.as_mut_slice(),
            ),
            None => Default::default(),
        };
        let leaves = LeavesMut {
            first_leaf: 0,
            stamps: &mut self.leaf_stamps,
            first_block: 0,
            blocks: &mut self.blocks,
            capsules: of_blocks,
        };
        let nodes = (&mut self.nodes, self.node_stamps.as_mut_slice(), of_nodes);
        (nodes, leaves, &mut self.quantized)
    }

    /// Counts leaves whose triangles had boxes made.
    pub(crate) fn count_reached(&mut self, leaves: usize) {
        self.reached += leaves;
    }

    /// Returns how many leaves were counted since this was last asked.
    pub(crate) fn take_reached(&mut self) -> usize {
        std::mem::take(&mut self.reached)
    }

    /// Returns all leaves, to write.
    pub(crate) fn leaves_mut(&mut self) -> LeavesMut<'_> {
        self.all_mut().1
    }
}

impl<'b, const N: usize> NodesMut<'b, N> {
    /// Returns all wide nodes before `end` to write, and the boxes from `end` on to read.
    pub(crate) fn before(
        boxes: &'b mut [BoxLanes<N>],
        stamps: &'b mut [u64],
        capsules: &'b mut [EightCapsules],
        end: usize,
    ) -> (Self, &'b [BoxLanes<N>]) {
        let (boxes, below) = boxes.split_at_mut(end);
        let nodes = Self {
            first: 0,
            boxes,
            stamps: &mut stamps[..end],
            capsules,
        };
        (nodes, below)
    }

    /// Cuts the run in two before a wide node.
    pub(crate) fn split_before(self, wide_node: WideNodeId) -> [Self; 2] {
        let place = wide_node.index() - self.first;
        let (boxes, later_boxes) = self.boxes.split_at_mut(place);
        let (stamps, later_stamps) = self.stamps.split_at_mut(place);
        let (capsules, later_capsules) = self.capsules.split_at_mut(place.min(self.capsules.len()));
        let run = |first, boxes, stamps, capsules| Self {
            first,
            boxes,
            stamps,
            capsules,
        };
        [
            run(self.first, boxes, stamps, capsules),
            run(wide_node.index(), later_boxes, later_stamps, later_capsules),
        ]
    }
}

impl LeavesMut<'_> {
    /// Cuts the run in two before a leaf whose first block is `block`.
    pub(crate) fn split_before(self, leaf: LeafId, block: BlockId) -> [Self; 2] {
        let (stamps, later_stamps) = self.stamps.split_at_mut(leaf.index() - self.first_leaf);
        let place = block.index() - self.first_block;
        let (blocks, later_blocks) = self.blocks.split_at_mut(place);
        let (capsules, later_capsules) = self.capsules.split_at_mut(place.min(self.capsules.len()));
        let later = Self {
            first_leaf: leaf.index(),
            stamps: later_stamps,
            first_block: block.index(),
            blocks: later_blocks,
            capsules: later_capsules,
        };
        [
            Self {
                stamps,
                blocks,
                capsules,
                ..self
            },
            later,
        ]
    }
}

held!(BoxSet: node_stamps[], blocks[], leaf_stamps[];
    |set| of_degree!(&set.nodes, nodes => held::list(nodes))
        + held::list(&set.quantized.blocks)
        + held::boxes(&set.capsules));
