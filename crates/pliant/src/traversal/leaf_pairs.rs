//! Leaves that overlap: which of their triangles are candidates, and what the kind of query makes of these.
//!
//! A leaf is one block of up to eight triangles, or several. Pairs of blocks are compared, all boxes of one with all of the
//! other; pairs of triangles whose boxes overlap are candidates, and are decided some thousands at a time. Of a body with itself every
//! pair of triangles comes up once, and none with itself.
//!
//! In a body with itself nearly all pairs of leaves are neighbours in the mesh, whose boxes overlap whatever the shape is, and of whose
//! triangles those that share no vertex are mostly apart. Where leaves are blocks, neighbours are not found by the descent but gone
//! through list by list, and all pairs of blocks are compared by quantized boxes first: mostly nothing is left.

use super::context::Context;
use super::expand::LeafPair;
use super::tree_pair::{Side, TreePair};
use crate::held::{self, Held};
use crate::ids::BlockId;
use crate::kernels::{Buffer, QuantizedRows, Simd, dispatch, overlap_mask};
use crate::mesh::Order;
use crate::queries::{Candidate, Kind, LeafTest, Leaves as Shown};
use crate::statistics::Statistics;
use crate::tree::{
    BlockBoxes, BoxSource, FirstsOfBlocks, Leaves, Neighbours, Quantized, STRICT_UPPER,
};
use std::ops::Range;

/// Pairs of blocks compared before their candidates are decided: at most 64 candidates each.
const BLOCK_PAIRS_AT_ONCE: usize = 64;

/// Pairs of neighbouring blocks looked at before what is left of them is compared.
const NEIGHBOURS_AT_ONCE: usize = 256;

/// Two blocks in leaves whose boxes overlap.
type BlockPair = [BlockId; 2];

/// Two blocks, or one and itself, and the pairs of their triangles that are to be compared: bit 8 i + j, as in a mask of overlaps.
#[derive(Clone, Copy, Debug, Default)]
struct MaskedPair {
    blocks: BlockPair,
    pairs: u64,
}

/// Where in a list of pairs of leaves: a pair, a block of its first leaf, a block of its second.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Cursor {
    pub(super) pair: usize,
    a: u32,
    b: u32,
}

/// What a task tests, and what it has found.
#[derive(Debug)]
pub(super) struct LeafTests<K: Kind> {
    blocks: Vec<BlockPair>,
    runs: Vec<[u32; 2]>,
    compared: Buffer<MaskedPair>,
    crowded: Vec<BlockPair>,
    candidates: Buffer<Candidate>,
    buffers: K::Buffers,
    /// What was found, in tree order.
    pub(super) hits: Buffer<K::TreeHit>,
    /// The same hits as the caller numbers things.
    pub(super) of_caller: Vec<K::Hit>,
    pub(super) statistics: Statistics,
}

impl<K: Kind> Default for LeafTests<K> {
    fn default() -> Self {
        Self {
            blocks: Vec::new(),
            runs: Vec::new(),
            compared: Buffer::default(),
            crowded: Vec::new(),
            candidates: Buffer::default(),
            buffers: K::Buffers::default(),
            hits: Buffer::default(),
            of_caller: Vec::new(),
            statistics: Statistics::default(),
        }
    }
}

impl<K: Kind> LeafTests<K> {
    /// Forgets what was found.
    pub(super) fn clear(&mut self) {
        self.hits.clear();
        self.of_caller.clear();
        self.statistics = Statistics::default();
    }

    /// Tests pairs of leaves from a cursor on, up to `most` pairs of their blocks; returns the cursor where it stopped. The boxes of the
    /// triangles in them are valid.
    pub(super) fn test<const N: usize, P>(
        &mut self,
        context: &Context<K, P>,
        leaf_pairs: &[LeafPair],
        mut cursor: Cursor,
        most: usize,
    ) -> Cursor
    where
        P: TreePair<N>,
        P::Source: BoxSource<Scalar = K::Scalar>,
    {
        let instructions = context.instructions;
        let sides = context.pair.sides();
        let leaves = [&sides[0].tree.leaves, &sides[1].tree.leaves];
        let neighbours = sides[0].tree.neighbours();
        let leaf_test = leaf_test(context);
        if K::LEAVES.elements().is_some() {
            cursor = self.test_runs::<N, P>(context, leaf_pairs, cursor, most, &leaf_test);
        } else if leaves.iter().all(|leaves| leaves.have_blocks()) {
            let boxes = [Boxes::of(sides[0]), Boxes::of(sides[1])];
            cursor = block_pairs::<N, P>(leaves, leaf_pairs, cursor, most, &mut self.blocks);
            for start in (0..self.blocks.len()).step_by(BLOCK_PAIRS_AT_ONCE) {
                let end = self.blocks.len().min(start + BLOCK_PAIRS_AT_ONCE);
                let blocks = &self.blocks[start..end];
                let found = &mut self.candidates;
                found.clear();
                let left_out =
                    (K::LEAVES == Shown::Triangles).then_some((sides[0].order, neighbours));
                match (left_out, sides[0].boxes.quantized()) {
                    _ if !P::ITSELF => {
                        dispatch!(instructions, i => of_two(i, boxes, blocks, found));
                        if let Some((order, _)) = left_out
                            && context.pair.is_one_body()
                        {
                            found.retain(|&[a, b]| !order.share_a_vertex(a, b));
                        }
                    }
                    (Some((_, Some(neighbours))), Some(quantized)) => {
                        self.compared.clear();
                        self.crowded.clear();
                        let (compared, crowded) = (&mut self.compared, &mut self.crowded);
                        dispatch!(instructions, i => {
                            non_adjacent(i, quantized, neighbours, blocks, compared, crowded);
                            overlapping(i, boxes[0], compared, found);
                        });
                        if !crowded.is_empty() {
                            dispatch!(instructions, i => of_one(i, boxes[0], left_out, crowded, found));
                        }
                    }
                    _ => dispatch!(instructions, i => of_one(i, boxes[0], left_out, blocks, found)),
                }
                self.decide(context, &leaf_test);
            }
        } else {
            // One triangle a leaf: its box is the leaf's, which overlaps.
            let end = leaf_pairs.len().min(cursor.pair + most);
            for pairs in leaf_pairs[cursor.pair..end].chunks(64 * BLOCK_PAIRS_AT_ONCE) {
                self.candidates.clear();
                for &[leaf_a, leaf_b] in pairs {
                    let a = leaves[0].first_triangle(leaf_a);
                    let b = leaves[1].first_triangle(leaf_b);
                    let order = sides[0].order;
                    let left_out = context.pair.is_one_body()
                        && (a == b || K::LEAVES == Shown::Triangles && order.share_a_vertex(a, b));
                    if !left_out {
                        self.candidates.push([a, b]);
                    }
                }
                self.decide(context, &leaf_test);
            }
            cursor.pair = end;
        }
        self.number_new(context);
        cursor
    }

    /// Tests pairs of leaves run by run: of the blocks in them, or of their single triangles.
    fn test_runs<const N: usize, P: TreePair<N>>(
        &mut self,
        context: &Context<K, P>,
        leaf_pairs: &[LeafPair],
        mut cursor: Cursor,
        most: usize,
        leaf_test: &LeafTest<K::Scalar>,
    ) -> Cursor {
        let [a, b] = context.pair.sides();
        let leaves = [&a.tree.leaves, &b.tree.leaves];
        self.runs.clear();
        if leaves.iter().all(|leaves| leaves.have_blocks()) {
            cursor = block_pairs::<N, P>(leaves, leaf_pairs, cursor, most, &mut self.blocks);
            let runs = self.blocks.iter().map(|[a, b]| [a.0, b.0]);
            self.runs.extend(runs);
        } else {
            let end = leaf_pairs.len().min(cursor.pair + most);
            let pairs = leaf_pairs[cursor.pair..end].iter();
            let runs = |&[a, b]: &LeafPair| [leaves[0].run_of_leaf(a), leaves[1].run_of_leaf(b)];
            self.runs.extend(pairs.map(runs));
            cursor.pair = end;
        }
        context.kind.test_runs(
            leaf_test,
            &self.runs,
            &mut self.buffers,
            &mut self.hits,
            &mut self.statistics,
        );
        cursor
    }

    /// Tests leaves, each a block, that are neighbours, and each with itself: the next of a run of leaves and their later neighbours,
    /// until so many pairs of leaves were looked at or `enough` hits found. Takes these leaves from the run.
    pub(super) fn test_neighbours<const N: usize, P>(
        &mut self,
        context: &Context<K, P>,
        neighbours: &Neighbours,
        run: &mut Range<u32>,
        (most, enough): (usize, usize),
    ) where
        P: TreePair<N>,
        P::Source: BoxSource<Scalar = K::Scalar>,
    {
        let [side, _] = context.pair.sides();
        let leaf_test = leaf_test(context);
        let boxes = Boxes::of(side);
        let quantized = side.boxes.quantized();
        let mut tested = 0;
        while run.start < run.end
            && tested < most
            && self.hits.len() < enough
            && !context.interrupt.is_set()
        {
            let compared = &mut self.compared;
            compared.clear();
            let some = NEIGHBOURS_AT_ONCE.min(most - tested);
            tested += dispatch!(context.instructions, i => match quantized {
                Some(quantized) => adjacent(i, quantized, neighbours, run, some, compared),
                None => all_adjacent(neighbours, run, some, compared),
            });
            self.candidates.clear();
            let found = &mut self.candidates;
            dispatch!(context.instructions, i => overlapping(i, boxes, compared, found));
            self.decide(context, &leaf_test);
        }
        self.number_new(context);
    }

    /// Gives what was found the caller's numbers.
    fn number_new<const N: usize, P>(&mut self, context: &Context<K, P>)
    where
        P: TreePair<N>,
        P::Source: BoxSource<Scalar = K::Scalar>,
    {
        let ids = context.pair.caller_ids();
        let new = &self.hits.as_slice()[self.of_caller.len()..];
        let leaves = leaf_test(context);
        let kind = context.kind;
        kind.to_callers(&leaves, &ids, new, &mut self.of_caller);
    }

    /// Has the kind decide candidates, without those that were taken out of their mesh.
    fn decide<const N: usize, P: TreePair<N>>(
        &mut self,
        context: &Context<K, P>,
        leaf_test: &LeafTest<K::Scalar>,
    ) {
        for (which, side) in context.pair.sides().into_iter().enumerate() {
            if let Some(removed) = side.removed {
                self.candidates.retain(|pair| !removed.has(pair[which]));
            }
        }
        context.kind.test(
            leaf_test,
            &mut self.candidates,
            &mut self.buffers,
            &mut self.hits,
            &mut self.statistics,
        );
    }
}

/// What a kind works with.
fn leaf_test<'q, const N: usize, K: Kind, P>(context: &Context<'q, K, P>) -> LeafTest<'q, K::Scalar>
where
    P: TreePair<N>,
    P::Source: BoxSource<Scalar = K::Scalar>,
{
    let [a, b] = context.pair.sides();
    LeafTest {
        instructions: context.instructions,
        interrupt: context.interrupt,
        shapes: [a.source.shape(), b.source.shape()],
        ends: [a.end(), b.end()],
        motions: [a.motion, b.motion],
        elements: [a.elements, b.elements],
        is_one_body: context.pair.is_one_body(),
        is_one_tree: P::ITSELF,
    }
}

/// Pairs of blocks of pairs of leaves, from a cursor on, up to `most` of them; returns the cursor where it stopped.
fn block_pairs<const N: usize, P: TreePair<N>>(
    [a, b]: [&Leaves; 2],
    pairs: &[LeafPair],
    mut cursor: Cursor,
    most: usize,
    blocks: &mut Vec<BlockPair>,
) -> Cursor {
    blocks.clear();
    if a.are_blocks() && b.are_blocks() {
        let end = pairs.len().min(cursor.pair + most);
        let pairs = pairs[cursor.pair..end].iter();
        blocks.extend(pairs.map(|[a, b]| [BlockId(a.0), BlockId(b.0)]));
        cursor.pair = end;
        return cursor;
    }
    while blocks.len() < most && cursor.pair < pairs.len() {
        let [leaf_a, leaf_b] = pairs[cursor.pair];
        let (of_a, of_b) = (a.blocks(leaf_a), b.blocks(leaf_b));
        let pair = [of_a.start + cursor.a, of_b.start + cursor.b].map(BlockId);
        // Within one leaf, each pair of blocks once.
        if !P::ITSELF || leaf_a != leaf_b || pair[0] <= pair[1] {
            blocks.push(pair);
        }
        cursor.b += 1;
        if of_b.start + cursor.b == of_b.end {
            (cursor.a, cursor.b) = (cursor.a + 1, 0);
        }
        if of_a.start + cursor.a == of_a.end {
            cursor = Cursor {
                pair: cursor.pair + 1,
                a: 0,
                b: 0,
            };
        }
    }
    cursor
}

/// The blocks of a body: their triangles and the boxes of these.
#[derive(Clone, Copy)]
struct Boxes<'b> {
    firsts: FirstsOfBlocks<'b>,
    boxes: BlockBoxes<'b>,
}

impl<'b> Boxes<'b> {
    fn of<const N: usize, B: BoxSource>(side: &'b Side<'_, N, B>) -> Self {
        Self {
            firsts: side.tree.leaves.firsts_of_blocks(),
            boxes: side.boxes.blocks(),
        }
    }
}

/// The candidates of pairs of blocks of two bodies.
#[inline(always)]
fn of_two<I: Simd>(
    i: I,
    [all_a, all_b]: [Boxes; 2],
    pairs: &[BlockPair],
    found: &mut Buffer<Candidate>,
) {
    for &[a, b] in pairs {
        let (first_a, first_b) = (all_a.firsts.of(a), all_b.firsts.of(b));
        let room = found.room();
        let overlaps = overlap_mask(i, all_a.boxes.of(a), all_b.boxes.of(b));
        room.push_bits(overlaps, |bit| {
            [first_a.plus(bit / 8), first_b.plus(bit % 8)]
        });
    }
}

/// The candidates of pairs of blocks of one body; if neighbours are left out, those that share no vertex.
#[inline(always)]
fn of_one<I: Simd>(
    i: I,
    Boxes { firsts, boxes }: Boxes,
    left_out: Option<(&Order, Option<&Neighbours>)>,
    pairs: &[BlockPair],
    found: &mut Buffer<Candidate>,
) {
    for &[a, b] in pairs {
        let (first_a, first_b) = (firsts.of(a), firsts.of(b));
        let candidate = |bit: u32| [first_a.plus(bit / 8), first_b.plus(bit % 8)];
        let room = found.room();
        let mut overlaps = overlap_mask(i, boxes.of(a), boxes.of(b));
        if a == b {
            // Within one block, each pair of triangles once, and none with itself.
            overlaps &= STRICT_UPPER;
        }
        let Some((order, neighbours)) = left_out else {
            room.push_bits(overlaps, candidate);
            continue;
        };
        match neighbours.and_then(|neighbours| neighbours.compared(i, a, b)) {
            Some(compared) => {
                // Mostly none is left.
                if overlaps & compared != 0 {
                    room.push_bits(overlaps & compared, candidate);
                }
            }
            None => room.push_bits_if(overlaps, candidate, |[a, b]| !order.share_a_vertex(a, b)),
        }
    }
}

/// The next of a run of leaves and their neighbours, with the pairs of triangles that share no vertex and are not surely apart;
/// those that have such pairs. Returns how many pairs of leaves it looked at.
#[inline(always)]
fn adjacent<I: Simd>(
    i: I,
    quantized: &Quantized,
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
        let rows = QuantizedRows::new(i, quantized.of(a));
        for (&b, &pairs) in others.iter().zip(masks) {
            let b = BlockId(b);
            let pairs = pairs & !rows.apart(i, quantized.of(b));
            let blocks = [a, b];
            // Whether any is left cannot be predicted.
            compared.push_if(MaskedPair { blocks, pairs }, pairs != 0);
        }
    }
    looked_at
}

/// The next of a run of leaves and their neighbours, with all pairs of triangles that share no vertex: where there are no quantized
/// boxes. Returns how many pairs of leaves it took.
fn all_adjacent(
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
        for (&b, &pairs) in others.iter().zip(masks) {
            let blocks = [a, BlockId(b)];
            compared.push(MaskedPair { blocks, pairs });
        }
    }
    looked_at
}

/// Keeps pairs of blocks that are no neighbours, with the pairs of triangles that are not surely apart; those that have such
/// pairs. Of crowded blocks nothing is known; their pairs are put aside.
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

/// The pairs of triangles that are to be compared whose boxes overlap.
#[inline(always)]
fn overlapping<I: Simd>(
    i: I,
    Boxes { firsts, boxes }: Boxes,
    compared: &Buffer<MaskedPair>,
    found: &mut Buffer<Candidate>,
) {
    for &MaskedPair {
        blocks: [a, b],
        pairs,
    } in compared.as_slice()
    {
        let (first_a, first_b) = (firsts.of(a), firsts.of(b));
        let room = found.room();
        let overlaps = overlap_mask(i, boxes.of(a), boxes.of(b)) & pairs;
        room.push_bits(overlaps, |bit| {
            [first_a.plus(bit / 8), first_b.plus(bit % 8)]
        });
    }
}

impl<K: Kind> Held for LeafTests<K> {
    fn held(&self) -> usize {
        held::list(&self.blocks)
            + held::list(&self.runs)
            + self.compared.held()
            + held::list(&self.crowded)
            + self.candidates.held()
            + self.buffers.held()
            + self.hits.held()
            + held::list(&self.of_caller)
    }
}
