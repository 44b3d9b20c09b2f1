//! The triangles in every leaf and, where leaves hold several, the boxes of these triangles.
//!
//! With one triangle a leaf, as in the paper, the leaf's box is the triangle's and nothing else is kept. With more, each leaf
//! owns as many blocks of eight boxes as its triangles need. They are made when the leaf is about to meet another, and are true if
//! the leaf's epoch is the body's; then the leaf's own box is true as well.

use crate::kernels::BoxLanes;
use std::ops::Range;

/// Triangle boxes are kept by eights whatever the degree of the tree is: the width of the registers they are tested in.
pub(crate) const LEAF_LANES: usize = 8;

#[derive(Clone, Copy, Debug)]
pub(crate) struct Leaf {
    start: u32,
    end: u32,
    first_block: u32,
}

/// The boxes of eight triangles.
pub(crate) type Block = BoxLanes<LEAF_LANES>;

#[derive(Debug)]
pub(crate) struct Leaves {
    runs: Vec<Leaf>,
    /// Whether there are blocks: not where every leaf is one triangle.
    have_boxes: bool,
    blocks: Vec<Block>,
    /// The first triangle of each block.
    firsts: Vec<u32>,
    /// For each leaf the epoch of the body in which the boxes of its triangles were made; 0 is before every epoch.
    epochs: Vec<u64>,
    /// The epoch in which all of them were last made at once: in that epoch none is untrue.
    pub(crate) complete: u64,
    /// How many of them were made since this was last asked.
    reached: usize,
}

/// Boxes of triangles as they are made: what is read, and what is written.
pub(crate) struct LeafBoxes<'t> {
    runs: &'t [Leaf],
    first_leaf: usize,
    epochs: &'t mut [u64],
    first_block: usize,
    blocks: &'t mut [Block],
}

impl Leaves {
    /// Leaves of up to `size` triangles, none yet.
    pub(crate) fn new(size: u32) -> Self {
        Self {
            runs: Vec::new(),
            have_boxes: size > 1,
            blocks: Vec::new(),
            firsts: Vec::new(),
            epochs: Vec::new(),
            complete: 0,
            reached: 0,
        }
    }

    /// Adds a leaf and returns its number.
    pub(crate) fn push(&mut self, triangles: Range<u32>) -> u32 {
        self.runs.push(Leaf {
            start: triangles.start,
            end: triangles.end,
            first_block: self.blocks.len() as u32,
        });
        if self.have_boxes {
            self.epochs.push(0);
            for first in triangles.step_by(LEAF_LANES) {
                self.blocks.push(Block::EMPTY);
                self.firsts.push(first);
            }
        }
        self.runs.len() as u32 - 1
    }

    /// No more leaves come: gives back the memory that was for them.
    pub(crate) fn shrink_to_fit(&mut self) {
        self.runs.shrink_to_fit();
        self.blocks.shrink_to_fit();
        self.firsts.shrink_to_fit();
        self.epochs.shrink_to_fit();
    }

    /// The triangles of a leaf, in tree order.
    #[inline]
    pub(crate) fn triangles(&self, leaf: u32) -> Range<u32> {
        let Leaf { start, end, .. } = self.runs[leaf as usize];
        start..end
    }

    /// Whether triangles in leaves have boxes of their own.
    #[inline]
    pub(crate) fn have_boxes(&self) -> bool {
        self.have_boxes
    }

    /// Whether every leaf is one block, which then has its number.
    #[inline]
    pub(crate) fn are_blocks(&self) -> bool {
        self.have_boxes && self.blocks.len() == self.runs.len()
    }

    /// The numbers of the blocks of a leaf.
    #[inline]
    pub(crate) fn blocks_of(&self, leaf: u32) -> Range<u32> {
        let Leaf {
            start,
            end,
            first_block,
        } = self.runs[leaf as usize];
        first_block..first_block + (end - start).div_ceil(LEAF_LANES as u32)
    }

    /// All blocks, in the order of their triangles.
    #[inline]
    pub(crate) fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    /// The first triangle of each block.
    #[inline]
    pub(crate) fn firsts(&self) -> &[u32] {
        &self.firsts
    }

    /// Whether the boxes of a leaf's triangles are those of this epoch, if there are any.
    #[inline]
    pub(crate) fn are_true(&self, leaf: u32, epoch: u64) -> bool {
        !self.have_boxes || self.epochs[leaf as usize] == epoch
    }

    /// Notes that triangles of so many leaves have new boxes.
    pub(crate) fn note_reached(&mut self, leaves: usize) {
        self.reached += leaves;
    }

    /// How many that were since this was last asked.
    pub(crate) fn take_reached(&mut self) -> usize {
        std::mem::take(&mut self.reached)
    }

    /// All boxes, to make some of them.
    pub(crate) fn boxes(&mut self) -> LeafBoxes<'_> {
        LeafBoxes {
            runs: &self.runs,
            first_leaf: 0,
            epochs: &mut self.epochs,
            first_block: 0,
            blocks: &mut self.blocks,
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.runs.len()
    }
}

impl LeafBoxes<'_> {
    /// Cuts them in two before a leaf.
    pub(crate) fn split_before(self, leaf: u32) -> [Self; 2] {
        let block = self.runs[leaf as usize].first_block as usize;
        let (epochs, later_epochs) = self.epochs.split_at_mut(leaf as usize - self.first_leaf);
        let (blocks, later_blocks) = self.blocks.split_at_mut(block - self.first_block);
        let later = Self {
            first_leaf: leaf as usize,
            epochs: later_epochs,
            first_block: block,
            blocks: later_blocks,
            ..self
        };
        [
            Self {
                epochs,
                blocks,
                ..self
            },
            later,
        ]
    }

    /// The triangles of a leaf, the epoch of their boxes, and their blocks.
    #[inline(always)]
    pub(crate) fn of(&mut self, leaf: u32) -> (Range<usize>, &mut u64, &mut [Block]) {
        let Leaf {
            start,
            end,
            first_block,
        } = self.runs[leaf as usize];
        let triangles = start as usize..end as usize;
        let first = first_block as usize - self.first_block;
        let blocks = &mut self.blocks[first..first + triangles.len().div_ceil(LEAF_LANES)];
        (
            triangles,
            &mut self.epochs[leaf as usize - self.first_leaf],
            blocks,
        )
    }
}
