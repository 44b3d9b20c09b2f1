//! Leaves of a tree, and the blocks of eight triangles within them.
//!
//! With one triangle a leaf, as in the paper, the leaf's box is the triangle's, and nothing else is
//! kept. With more, each leaf owns as many *blocks* of up to eight triangles as it needs. The boxes
//! of a block's triangles lie side by side (`BoxSet`).

use crate::held::held;
use crate::ids::{BlockId, LeafId, TreeTriangle};
use crate::mesh::TriangleRun;
use std::ops::Range;

/// Most triangles of a block, whatever the degree: the lanes of the registers that compare boxes.
pub(crate) const BLOCK_LANES: usize = 8;

/// Run of triangles of a leaf, and its first block.
#[derive(Clone, Copy, Debug)]
struct Leaf {
    start: u32,
    end: u32,
    first_block: u32,
}

/// Triangles and blocks of all leaves.
#[derive(Clone, Debug)]
pub(crate) struct Leaves {
    runs: Vec<Leaf>,
    /// First triangle of the tree.
    first: TreeTriangle,
    /// Whether leaves have blocks; they have none where every leaf is one triangle.
    have_blocks: bool,
    /// First triangle of each block.
    first_triangles: Vec<TreeTriangle>,
    /// How many triangles each block has.
    counts: Vec<u8>,
}

impl Leaves {
    /// Begins a list of leaves of up to `size` triangles; `first` is the tree's first triangle.
    pub(super) fn new(size: u32, first: TreeTriangle) -> Self {
        Self {
            runs: Vec::new(),
            first,
            have_blocks: size > 1,
            first_triangles: Vec::new(),
            counts: Vec::new(),
        }
    }

    /// Appends a leaf over a run of triangles.
    pub(super) fn push(&mut self, triangles: Range<u32>) -> LeafId {
        self.runs.push(Leaf {
            start: triangles.start,
            end: triangles.end,
            first_block: self.first_triangles.len() as u32,
        });
        if self.have_blocks {
            for first in triangles.clone().step_by(BLOCK_LANES) {
                self.first_triangles.push(TreeTriangle(first));
                let count = BLOCK_LANES.min((triangles.end - first) as usize);
                self.counts.push(count as u8);
            }
        }
        LeafId(self.runs.len() as u32 - 1)
    }

    /// Gives back the memory that no more leaves will need.
    pub(super) fn shrink_to_fit(&mut self) {
        self.runs.shrink_to_fit();
        self.first_triangles.shrink_to_fit();
        self.counts.shrink_to_fit();
    }

    /// Returns how many leaves there are.
    pub(crate) fn len(&self) -> usize {
        self.runs.len()
    }

    /// Returns the triangles of a leaf, as places in tree order.
    #[inline]
    pub(crate) fn triangles(&self, leaf: LeafId) -> Range<usize> {
        let Leaf { start, end, .. } = self.runs[leaf.index()];
        start as usize..end as usize
    }

    /// Returns the triangles of all leaves, as places in tree order.
    pub(crate) fn all_triangles(&self) -> Range<usize> {
        let end = self.runs.last().map_or(self.first.0, |leaf| leaf.end);
        self.first.index()..end as usize
    }

    /// Returns the first triangle of a leaf.
    #[inline]
    pub(crate) fn first_triangle(&self, leaf: LeafId) -> TreeTriangle {
        TreeTriangle(self.runs[leaf.index()].start)
    }

    /// Returns how many runs of triangles the elements are grouped by: blocks, or single triangles.
    pub(crate) fn run_count(&self) -> usize {
        if self.have_blocks {
            self.block_count()
        } else {
            self.runs.len()
        }
    }

    /// Returns the triangles of such a run: `number` is the block's, or the triangle's from the
    /// tree's first on.
    pub(crate) fn run(&self, number: u32) -> TriangleRun {
        if self.have_blocks {
            self.run_of_block(BlockId(number))
        } else {
            TriangleRun {
                first: self.first.plus(number),
                count: 1,
            }
        }
    }

    /// Returns the number of the run that a leaf of one triangle is.
    #[inline]
    pub(crate) fn run_of_leaf(&self, leaf: LeafId) -> u32 {
        self.first_triangle(leaf).0 - self.first.0
    }

    /// Whether leaves have blocks, whose triangles have boxes of their own.
    #[inline]
    pub(crate) fn have_blocks(&self) -> bool {
        self.have_blocks
    }

    /// Whether every leaf is one block, which then has the leaf's number.
    #[inline]
    pub(crate) fn are_blocks(&self) -> bool {
        self.have_blocks && self.first_triangles.len() == self.runs.len()
    }

    /// Returns how many blocks all leaves have.
    pub(crate) fn block_count(&self) -> usize {
        self.first_triangles.len()
    }

    /// Returns the triangles of a leaf, and its first block.
    #[inline(always)]
    pub(crate) fn triangles_and_block(&self, leaf: LeafId) -> (Range<usize>, BlockId) {
        let first_block = self.runs[leaf.index()].first_block;
        (self.triangles(leaf), BlockId(first_block))
    }

    /// Returns the numbers of the blocks of a leaf.
    #[inline]
    pub(crate) fn blocks(&self, leaf: LeafId) -> Range<u32> {
        let run = self.runs[leaf.index()];
        run.first_block..run.first_block + (run.end - run.start).div_ceil(BLOCK_LANES as u32)
    }

    /// Returns the first triangle of a block.
    #[inline]
    pub(crate) fn first_of_block(&self, block: BlockId) -> TreeTriangle {
        self.firsts_of_blocks().of(block)
    }

    /// Returns the triangles of a block.
    #[inline]
    pub(crate) fn run_of_block(&self, block: BlockId) -> TriangleRun {
        TriangleRun {
            first: self.first_triangles[block.index()],
            count: self.counts[block.index()].into(),
        }
    }

    /// Returns the first triangles of all blocks, for a loop over many.
    #[inline(always)]
    pub(crate) fn firsts_of_blocks(&self) -> FirstsOfBlocks<'_> {
        FirstsOfBlocks(&self.first_triangles)
    }
}

/// First triangle of every block.
#[derive(Clone, Copy)]
pub(crate) struct FirstsOfBlocks<'l>(&'l [TreeTriangle]);

impl FirstsOfBlocks<'_> {
    /// Returns the first triangle of a block.
    #[inline(always)]
    pub(crate) fn of(self, block: BlockId) -> TreeTriangle {
        self.0[block.index()]
    }
}

held!(Leaves: runs[], first_triangles[], counts[]);
