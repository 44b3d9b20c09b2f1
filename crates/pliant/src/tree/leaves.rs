//! The triangles in every leaf and, where leaves hold several, the boxes of these triangles.
//!
//! With one triangle a leaf, as in the paper, the leaf's box is the triangle's and nothing else is kept. With more, each leaf
//! owns as many blocks of eight boxes as its triangles need. They are made with the leaf's own box, and true if that is.

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
}

/// What does not change when boxes do.
#[derive(Clone, Copy)]
pub(crate) struct LeafRuns<'t> {
    runs: &'t [Leaf],
    have_boxes: bool,
}

impl Leaves {
    /// Leaves of up to `size` triangles, none yet.
    pub(crate) fn new(size: u32) -> Self {
        Self {
            runs: Vec::new(),
            have_boxes: size > 1,
            blocks: Vec::new(),
            firsts: Vec::new(),
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

    /// What is read and what is written when boxes are made.
    pub(crate) fn split(&mut self) -> (LeafRuns<'_>, &mut [Block]) {
        let runs = LeafRuns {
            runs: &self.runs,
            have_boxes: self.have_boxes,
        };
        (runs, &mut self.blocks)
    }

    pub(crate) fn len(&self) -> usize {
        self.runs.len()
    }
}

impl LeafRuns<'_> {
    /// The triangles of a leaf, and its first block, if it has blocks.
    #[inline(always)]
    pub(crate) fn get(&self, leaf: u32) -> (Range<usize>, Option<usize>) {
        let Leaf {
            start,
            end,
            first_block,
        } = self.runs[leaf as usize];
        let first_block = self.have_boxes.then_some(first_block as usize);
        (start as usize..end as usize, first_block)
    }
}
