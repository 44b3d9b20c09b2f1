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

#[derive(Debug)]
pub(crate) struct Leaves {
    leaves: Vec<Leaf>,
    /// None where every leaf is one triangle.
    blocks: Option<Vec<BoxLanes<LEAF_LANES>>>,
}

impl Leaves {
    /// Leaves of up to `size` triangles, none yet.
    pub(crate) fn new(size: u32) -> Self {
        Self {
            leaves: Vec::new(),
            blocks: (size > 1).then(Vec::new),
        }
    }

    /// Adds a leaf and returns its number.
    pub(crate) fn push(&mut self, triangles: Range<u32>) -> u32 {
        let blocks = triangles.len().div_ceil(LEAF_LANES);
        let first_block = self.blocks.as_mut().map_or(0, |all| {
            let first = all.len();
            all.resize(first + blocks, BoxLanes::EMPTY);
            first
        });
        let leaf = Leaf {
            start: triangles.start,
            end: triangles.end,
            first_block: first_block as u32,
        };
        self.leaves.push(leaf);
        self.leaves.len() as u32 - 1
    }

    /// The triangles of a leaf, in tree order.
    #[inline]
    pub(crate) fn triangles(&self, leaf: u32) -> Range<u32> {
        let Leaf { start, end, .. } = self.leaves[leaf as usize];
        start..end
    }

    /// Whether triangles in leaves have boxes of their own.
    #[inline]
    pub(crate) fn have_boxes(&self) -> bool {
        self.blocks.is_some()
    }

    /// The boxes of a leaf's triangles, to be written.
    #[inline]
    pub(crate) fn boxes_mut(&mut self, leaf: u32) -> &mut [BoxLanes<LEAF_LANES>] {
        let blocks = self.blocks_of(leaf);
        self.blocks.as_mut().map_or(&mut [], |all| &mut all[blocks])
    }

    /// The boxes of a leaf's triangles, in order, by eights.
    #[inline]
    pub(crate) fn boxes(&self, leaf: u32) -> &[BoxLanes<LEAF_LANES>] {
        self.blocks
            .as_ref()
            .map_or(&[], |all| &all[self.blocks_of(leaf)])
    }

    #[inline]
    fn blocks_of(&self, leaf: u32) -> Range<usize> {
        let Leaf {
            start,
            end,
            first_block,
            ..
        } = self.leaves[leaf as usize];
        let first = first_block as usize;
        first..first + ((end - start) as usize).div_ceil(LEAF_LANES)
    }

    pub(crate) fn len(&self) -> usize {
        self.leaves.len()
    }
}
