//! Sets of boxes: a tree's boxes of nodes and triangles from one source, each valid or stale.
//!
//! A tree may have several sets, each from a [`BoxSource`] of its own: the current shape, or that
//! shape grown by a distance. A set knows the [`Version`] of its source that it was last asked for,
//! and begins a new *stamp* when this changes. A box is **valid** if it was made with the set's
//! stamp, else **stale**. Two rules hold at all times: no stale box is read, and above a valid box
//! all are valid. `update` makes boxes valid, `traversal` asks for it, `validate` checks it.

mod lanes;
mod source;

use super::Tree;
use crate::held::{self, held};
use crate::ids::{BlockId, LeafId, WideNodeId};
use crate::kernels::{BoxLanes, EightBoxes, QuantizedLanes};
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
}

/// Mutable run of the boxes and stamps of leaves: blocks from `first_block` on, stamps from
/// `first_leaf` on.
pub(crate) struct LeavesMut<'b> {
    pub(crate) first_leaf: usize,
    pub(crate) stamps: &'b mut [u64],
    pub(crate) first_block: usize,
    pub(crate) blocks: &'b mut [EightBoxes],
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

    /// Returns the boxes of nodes and the stamps of wide nodes, to write.
    pub(crate) fn nodes_mut(&mut self) -> (&mut NodeLanes, &mut [u64]) {
        (&mut self.nodes, &mut self.node_stamps)
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

    /// Returns everything to write: boxes and stamps of nodes, leaves, and quantized boxes.
    pub(crate) fn all_mut(
        &mut self,
    ) -> (&mut NodeLanes, &mut [u64], LeavesMut<'_>, &mut Quantized) {
        let leaves = LeavesMut::all(&mut self.leaf_stamps, &mut self.blocks);
        (
            &mut self.nodes,
            &mut self.node_stamps,
            leaves,
            &mut self.quantized,
        )
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
        LeavesMut::all(&mut self.leaf_stamps, &mut self.blocks)
    }
}

impl<'b, const N: usize> NodesMut<'b, N> {
    /// Returns all wide nodes before `end` to write, and the boxes from `end` on to read.
    pub(crate) fn before(
        boxes: &'b mut [BoxLanes<N>],
        stamps: &'b mut [u64],
        end: usize,
    ) -> (Self, &'b [BoxLanes<N>]) {
        let (boxes, below) = boxes.split_at_mut(end);
        let nodes = Self {
            first: 0,
            boxes,
            stamps: &mut stamps[..end],
        };
        (nodes, below)
    }

    /// Cuts the run in two before a wide node.
    pub(crate) fn split_before(self, wide_node: WideNodeId) -> [Self; 2] {
        let place = wide_node.index() - self.first;
        let (boxes, later_boxes) = self.boxes.split_at_mut(place);
        let (stamps, later_stamps) = self.stamps.split_at_mut(place);
        let run = |first, boxes, stamps| Self {
            first,
            boxes,
            stamps,
        };
        [
            run(self.first, boxes, stamps),
            run(wide_node.index(), later_boxes, later_stamps),
        ]
    }
}

impl<'b> LeavesMut<'b> {
    /// The run of all leaves.
    fn all(stamps: &'b mut [u64], blocks: &'b mut [EightBoxes]) -> Self {
        Self {
            first_leaf: 0,
            stamps,
            first_block: 0,
            blocks,
        }
    }

    /// Cuts the run in two before a leaf whose first block is `block`.
    pub(crate) fn split_before(self, leaf: LeafId, block: BlockId) -> [Self; 2] {
        let (stamps, later_stamps) = self.stamps.split_at_mut(leaf.index() - self.first_leaf);
        let (blocks, later_blocks) = self.blocks.split_at_mut(block.index() - self.first_block);
        let later = Self {
            first_leaf: leaf.index(),
            stamps: later_stamps,
            first_block: block.index(),
            blocks: later_blocks,
        };
        [
            Self {
                stamps,
                blocks,
                ..self
            },
            later,
        ]
    }
}

held!(BoxSet: node_stamps[], blocks[], leaf_stamps[];
    |set| of_degree!(&set.nodes, nodes => held::list(nodes)) + held::list(&set.quantized.blocks));
