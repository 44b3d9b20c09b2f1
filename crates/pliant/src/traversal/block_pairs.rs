//! Comparison of blocks, eight boxes by eight: pairs of triangles whose boxes overlap are
//! candidates.
//!
//! Within one body nearly all pairs of leaves are neighbours in the mesh, whose boxes overlap in
//! any shape. Their triangles that share no vertex are mostly apart. So all pairs of blocks of a
//! body are compared by quantized boxes first, which mostly leaves nothing. Nothing here depends on
//! the kind of query or on the trees' degree, so it is compiled once.

use crate::held::held;
use crate::ids::BlockId;
use crate::kernels::{
    Buffer, EightCapsules, Instructions, QuantizedRows, Simd, Volumes, cull_by_capsules, dispatch,
    overlap_mask,
};
use crate::mesh::Order;
use crate::queries::Candidate;
use crate::tree::BoxedTree;
use crate::tree::{BlockBoxes, FirstsOfBlocks, Neighbours, Quantized, STRICT_UPPER};
use std::ops::Range;

/// Pairs of neighbouring blocks that are filtered before the rest is compared by exact boxes.
const NEIGHBOURS_AT_ONCE: usize = 256;

/// Two blocks in leaves whose boxes overlap.
pub(super) type BlockPair = [BlockId; 2];

/// Two blocks, or one twice, and a mask of the pairs of triangles to be compared. Bit 8 i + j is
/// for triangles i and j, as in a mask of overlaps.
#[derive(Clone, Copy, Debug, Default)]
struct MaskedPair {
    blocks: BlockPair,
    pairs: u64,
}

/// Blocks of a tree: their first triangles, and the boxes of all.
#[derive(Clone, Copy)]
pub(super) struct Blocks<'b> {
    firsts: FirstsOfBlocks<'b>,
    boxes: BlockBoxes<'b>,
    capsules: Option<&'b [EightCapsules]>,
}

impl<'b> Blocks<'b> {
    pub(super) fn of(of: BoxedTree<'b>) -> Self {
        Self {
            firsts: of.tree.leaves.firsts_of_blocks(),
            boxes: of.boxes.blocks(),
            capsules: of.block_capsules(),
        }
    }

    /// Boxes of a block, and its capsules.
    #[inline(always)]
    fn volumes(self, block: BlockId) -> Volumes<'b, 8> {
        Volumes {
            boxes: self.boxes.of(block),
            capsules: self.capsules.map(|all| &all[block.index()]),
        }
    }
}

/// Blocks of one body: their boxes, and the adjacency of its mesh.
#[derive(Clone, Copy)]
pub(super) struct OneBody<'b> {
    pub(super) blocks: Blocks<'b>,
    pub(super) quantized: Option<&'b Quantized>,
    /// Vertices of triangles: pairs that share one are left out.
    pub(super) order: &'b Order,
    /// Adjacency of blocks, if it is known.
    pub(super) neighbours: Option<&'b Neighbours>,
}

/// Candidates, and the lists on the way to them.
#[derive(Debug, Default)]
pub(super) struct BlockTests {
    compared: Buffer<MaskedPair>,
    crowded: Vec<BlockPair>,
    pub(super) candidates: Buffer<Candidate>,
}

impl BlockTests {
    /// Finds the candidates in pairs of blocks of two trees. With an order, leaves out triangles
    /// that share a vertex by it.
    pub(super) fn of_two(
        &mut self,
        instructions: Instructions,
        boxes: [Blocks; 2],
        pairs: &[BlockPair],
        left_out: Option<&Order>,
    ) {
        let found = &mut self.candidates;
        found.clear();
        dispatch!(instructions, i => of_two(i, boxes, pairs, found));
        if let Some(order) = left_out {
            found.retain(|&[a, b]| !order.share_a_vertex(a, b));
        }
    }

    /// Finds the candidates in pairs of blocks of one tree.
    pub(super) fn of_one(
        &mut self,
        instructions: Instructions,
        body: OneBody,
        pairs: &[BlockPair],
    ) {
        let (found, crowded) = (&mut self.candidates, &mut self.crowded);
        found.clear();
        let (Some(neighbours), Some(quantized)) = (body.neighbours, body.quantized) else {
            dispatch!(instructions, i => of_one(i, body, pairs, found));
            return;
        };
        self.compared.clear();
        crowded.clear();
        dispatch!(instructions, i => {
            non_adjacent(i, quantized, neighbours, pairs, &mut self.compared, crowded);
            overlapping(i, body.blocks, &self.compared, found);
        });
        if !crowded.is_empty() {
            dispatch!(instructions, i => of_one(i, body, crowded, found));
        }
    }

    /// Finds the candidates in the next leaves of a run, each a block, with themselves and their
    /// later neighbours. Returns how many pairs of leaves were compared. That is at most `most`,
    /// plus the pairs of one more leaf.
    pub(super) fn of_neighbours(
        &mut self,
        instructions: Instructions,
        boxes: Blocks,
        quantized: Option<&Quantized>,
        neighbours: &Neighbours,
        run: &mut Range<u32>,
        most: usize,
    ) -> usize {
        let (compared, found) = (&mut self.compared, &mut self.candidates);
        compared.clear();
        found.clear();
        let some = NEIGHBOURS_AT_ONCE.min(most);
        dispatch!(instructions, i => {
            let looked_at = adjacent(i, quantized, neighbours, run, some, compared);
            overlapping(i, boxes, compared, found);
            looked_at
        })
    }
}

/// Pushes the candidates in pairs of blocks of two trees.
#[inline(always)]
fn of_two<I: Simd>(i: I, both: [Blocks; 2], pairs: &[BlockPair], found: &mut Buffer<Candidate>) {
    if both.iter().all(|blocks| blocks.capsules.is_none()) {
        for &blocks in pairs {
            push_overlapping::<I, false>(i, both, blocks, u64::MAX, found);
        }
    } else {
        for &blocks in pairs {
            push_overlapping::<I, true>(i, both, blocks, u64::MAX, found);
        }
    }
}

/// Pushes the pairs of triangles of two blocks whose boxes overlap and whose bit is set in a mask.
/// With `CAPSULES`, leaves out what capsules show to be apart.
#[inline(always)]
fn push_overlapping<I: Simd, const CAPSULES: bool>(
    i: I,
    [of_a, of_b]: [Blocks; 2],
    [a, b]: BlockPair,
    pairs: u64,
    found: &mut Buffer<Candidate>,
) {
    let (first_a, first_b) = (of_a.firsts.of(a), of_b.firsts.of(b));
    let room = found.room();
    let mut overlaps = overlap_mask(i, of_a.boxes.of(a), of_b.boxes.of(b)) & pairs;
    if CAPSULES {
        overlaps = cull_by_capsules(i, of_a.volumes(a), of_b.volumes(b), overlaps);
    }
    room.push_bits(overlaps, |bit| {
        [first_a.plus(bit / 8), first_b.plus(bit % 8)]
    });
}

/// Pushes the candidates in pairs of blocks of one body: triangles that share no vertex.
#[inline(always)]
fn of_one<I: Simd>(i: I, body: OneBody, pairs: &[BlockPair], found: &mut Buffer<Candidate>) {
    let (blocks, firsts) = (body.blocks, body.blocks.firsts);
    for &[a, b] in pairs {
        let (first_a, first_b) = (firsts.of(a), firsts.of(b));
        let candidate = |bit: u32| [first_a.plus(bit / 8), first_b.plus(bit % 8)];
        let room = found.room();
        let mut overlaps = overlap_mask(i, blocks.boxes.of(a), blocks.boxes.of(b));
        if a == b {
            // Within one block, each pair of triangles once, and none with itself.
            overlaps &= STRICT_UPPER;
        }
        if blocks.capsules.is_some() {
            overlaps = cull_by_capsules(i, blocks.volumes(a), blocks.volumes(b), overlaps);
        }
        if let Some(neighbours) = body.neighbours
            && let Some(compared) = neighbours.compared(i, a, b)
        {
            // Mostly none is left.
            if overlaps & compared != 0 {
                room.push_bits(overlaps & compared, candidate);
            }
        } else {
            let is_kept = |[a, b]: Candidate| !body.order.share_a_vertex(a, b);
            room.push_bits_if(overlaps, candidate, is_kept);
        }
    }
}

/// Filters the next leaves of a run with themselves and their neighbours. Keeps the pairs of
/// triangles that share no vertex and that quantized boxes, where there are any, do not separate.
/// Pairs of blocks without such triangles are dropped. Returns how many pairs of leaves were looked
/// at.
#[inline(always)]
fn adjacent<I: Simd>(
    i: I,
    quantized: Option<&Quantized>,
    neighbours: &Neighbours,
    run: &mut Range<u32>,
    enough: usize,
    compared: &mut Buffer<MaskedPair>,
) -> usize {
    let mut looked_at = 0;
    while run.start < run.end && looked_at < enough {
        let a = BlockId(run.start);
        run.start += 1;
        let (others, masks) = neighbours.of_block(a);
        looked_at += others.len();
        compared.make_room(others.len() + 1);
        let mut push = |b: u32, pairs: u64| {
            let blocks = [a, BlockId(b)];
            // Branch-free, since whether any is left cannot be predicted.
            compared.push_if(MaskedPair { blocks, pairs }, pairs != 0);
        };
        let all = others.iter().zip(masks);
        if let Some(quantized) = quantized {
            let rows = QuantizedRows::new(i, quantized.of(a));
            for (&b, &pairs) in all {
                push(b, pairs & !rows.apart(i, quantized.of(BlockId(b))));
            }
        } else {
            all.for_each(|(&b, &pairs)| push(b, pairs));
        }
    }
    looked_at
}

/// Filters pairs of blocks that are no neighbours. Keeps the pairs of triangles that quantized
/// boxes do not separate, and drops pairs of blocks without any. Crowded blocks have no known
/// adjacency; their pairs are put aside.
#[inline(always)]
fn non_adjacent<I: Simd>(
    i: I,
    quantized: &Quantized,
    neighbours: &Neighbours,
    pairs: &[BlockPair],
    compared: &mut Buffer<MaskedPair>,
    crowded: &mut Vec<BlockPair>,
) {
    compared.make_room(pairs.len() + 1);
    for &blocks in pairs {
        let [a, b] = blocks;
        if neighbours.is_crowded(a.min(b)) {
            crowded.push(blocks);
            continue;
        }
        let apart = QuantizedRows::new(i, quantized.of(a)).apart(i, quantized.of(b));
        let pairs = !apart;
        compared.push_if(MaskedPair { blocks, pairs }, pairs != 0);
    }
}

/// Pushes the pairs of triangles in masks whose exact boxes overlap.
#[inline(always)]
fn overlapping<I: Simd>(
    i: I,
    blocks: Blocks,
    compared: &Buffer<MaskedPair>,
    found: &mut Buffer<Candidate>,
) {
    for &MaskedPair {
        blocks: pair,
        pairs,
    } in compared.as_slice()
    {
        if blocks.capsules.is_none() {
            push_overlapping::<I, false>(i, [blocks; 2], pair, pairs, found);
        } else {
            push_overlapping::<I, true>(i, [blocks; 2], pair, pairs, found);
        }
    }
}

held!(BlockTests: compared, crowded[], candidates);
