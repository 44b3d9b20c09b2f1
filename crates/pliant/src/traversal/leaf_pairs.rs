//! Leaves that overlap: which of their triangles are candidates, and what the kind of query makes of these.
//!
//! A leaf is one block of up to eight triangles, or several. Pairs of blocks are compared (`block_pairs`); what they leave, candidates,
//! is decided some thousands at a time. Of a body with itself every pair of triangles comes up once, and none with itself. Where leaves are
//! blocks, neighbours in the mesh are not found by the descent but gone through list by list.

use super::block_pairs::{BlockPair, BlockTests, Boxes, OneBody};
use super::context::Context;
use super::tree_pair::TreePair;
use crate::held::{self, Held};
use crate::ids::BlockId;
use crate::kernels::Buffer;
use crate::queries::{Kind, LeafTest, Leaves as Shown};
use crate::statistics::Statistics;
use crate::tree::LeafPair;
use crate::tree::{BoxSource, Leaves, Neighbours};
use std::ops::Range;

/// Pairs of blocks compared before their candidates are decided: at most 64 candidates each.
const BLOCK_PAIRS_AT_ONCE: usize = 64;
/// With so many hits a task shows them to a collector, or stops until a visitor has seen them: what all tasks have found takes little memory.
const MOST_HITS: usize = 2048;

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
    block_pairs: Vec<BlockPair>,
    runs: Vec<[u32; 2]>,
    blocks: BlockTests,
    buffers: K::Buffers,
    /// What was found, in tree order.
    pub(super) hits: Buffer<K::TreeHit>,
    /// The same hits as the caller numbers things.
    pub(super) of_caller: Vec<K::Hit>,
    /// Whether a collector does not take any more.
    pub(super) are_too_many: bool,
    pub(super) statistics: Statistics,
}

impl<K: Kind> Default for LeafTests<K> {
    fn default() -> Self {
        Self {
            block_pairs: Vec::new(),
            runs: Vec::new(),
            blocks: BlockTests::default(),
            buffers: K::Buffers::default(),
            hits: Buffer::default(),
            of_caller: Vec::new(),
            are_too_many: false,
            statistics: Statistics::default(),
        }
    }
}

impl<K: Kind> LeafTests<K> {
    /// Forgets what was found.
    pub(super) fn clear(&mut self) {
        self.hits.clear();
        self.of_caller.clear();
        self.are_too_many = false;
        self.statistics = Statistics::default();
    }

    /// Whether to go on before what was found is shown.
    pub(super) fn have_room(&self) -> bool {
        self.hits.len() < MOST_HITS && !self.are_too_many
    }

    /// Shows what was found to a collector, if there is one.
    pub(super) fn collect<P>(&mut self, context: &Context<K, P>) {
        if let Some(collector) = context.collector
            && !self.of_caller.is_empty()
        {
            self.are_too_many |= collector(&self.of_caller).is_break();
            self.hits.clear();
            self.of_caller.clear();
        }
    }

    /// Tests pairs of leaves from a cursor on, up to `most` pairs of their blocks; returns the cursor where it stopped. The boxes of the
    /// triangles in them are valid.
    pub(super) fn test<P>(
        &mut self,
        context: &Context<K, P>,
        leaf_pairs: &[LeafPair],
        mut cursor: Cursor,
        most: usize,
    ) -> Cursor
    where
        P: TreePair,
        P::Source: BoxSource<Scalar = K::Scalar>,
    {
        let [a, b] = context.pair.sides();
        let leaf_test = leaf_test(context);
        if const { K::HAS_RUNS } {
            cursor = self.test_runs::<P>(context, leaf_pairs, cursor, most, &leaf_test);
        } else if a.tree.leaves.have_blocks() && b.tree.leaves.have_blocks() {
            cursor = self.test_blocks::<P>(context, leaf_pairs, cursor, most, &leaf_test);
        } else {
            let end = leaf_pairs.len().min(cursor.pair + most);
            self.test_triangles::<P>(context, &leaf_pairs[cursor.pair..end], &leaf_test);
            cursor.pair = end;
        }
        self.number_new(context, &leaf_test);
        cursor
    }

    /// Tests pairs of leaves block by block.
    fn test_blocks<P: TreePair>(
        &mut self,
        context: &Context<K, P>,
        leaf_pairs: &[LeafPair],
        cursor: Cursor,
        most: usize,
        leaf_test: &LeafTest<K::Scalar>,
    ) -> Cursor {
        let instructions = context.instructions;
        let [a, b] = context.pair.sides();
        let leaves = [&a.tree.leaves, &b.tree.leaves];
        let shares_left_out = K::LEAVES == Shown::Triangles;
        let cursor = block_pairs(
            P::ITSELF,
            leaves,
            leaf_pairs,
            cursor,
            most,
            &mut self.block_pairs,
        );
        for start in (0..self.block_pairs.len()).step_by(BLOCK_PAIRS_AT_ONCE) {
            let end = self.block_pairs.len().min(start + BLOCK_PAIRS_AT_ONCE);
            let pairs = &self.block_pairs[start..end];
            let boxes = Boxes::of(a.boxed_tree());
            if P::ITSELF {
                let body = OneBody {
                    boxes,
                    quantized: a.boxes.quantized(),
                    left_out: shares_left_out.then_some((a.order, a.tree.neighbours())),
                };
                self.blocks.of_one(instructions, body, pairs);
            } else {
                let both = [boxes, Boxes::of(b.boxed_tree())];
                let is_left_out = shares_left_out && context.pair.is_one_body();
                let left_out = is_left_out.then_some(a.order);
                self.blocks.of_two(instructions, both, pairs, left_out);
            }
            self.decide(context, leaf_test);
        }
        cursor
    }

    /// Tests pairs of leaves of one triangle: its box is the leaf's, which overlaps.
    fn test_triangles<P: TreePair>(
        &mut self,
        context: &Context<K, P>,
        leaf_pairs: &[LeafPair],
        leaf_test: &LeafTest<K::Scalar>,
    ) {
        let [a, b] = context.pair.sides();
        for pairs in leaf_pairs.chunks(64 * BLOCK_PAIRS_AT_ONCE) {
            self.blocks.candidates.clear();
            for &[leaf_a, leaf_b] in pairs {
                let pair = [
                    a.tree.leaves.first_triangle(leaf_a),
                    b.tree.leaves.first_triangle(leaf_b),
                ];
                let left_out = context.pair.is_one_body()
                    && (pair[0] == pair[1]
                        || K::LEAVES == Shown::Triangles
                            && a.order.share_a_vertex(pair[0], pair[1]));
                if !left_out {
                    self.blocks.candidates.push(pair);
                }
            }
            self.decide(context, leaf_test);
        }
    }

    /// Tests pairs of leaves run by run: of the blocks in them, or of their single triangles.
    fn test_runs<P: TreePair>(
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
            cursor = block_pairs(
                P::ITSELF,
                leaves,
                leaf_pairs,
                cursor,
                most,
                &mut self.block_pairs,
            );
            let runs = self.block_pairs.iter().map(|[a, b]| [a.0, b.0]);
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
    /// until so many pairs of leaves were looked at or enough was found. Takes these leaves from the run.
    pub(super) fn test_neighbours<P>(
        &mut self,
        context: &Context<K, P>,
        neighbours: &Neighbours,
        run: &mut Range<u32>,
        most: usize,
    ) where
        P: TreePair,
        P::Source: BoxSource<Scalar = K::Scalar>,
    {
        let [side, _] = context.pair.sides();
        let leaf_test = leaf_test(context);
        let boxes = Boxes::of(side.boxed_tree());
        let quantized = side.boxes.quantized();
        let mut tested = 0;
        while run.start < run.end
            && tested < most
            && self.have_room()
            && !context.interrupt.is_set()
        {
            tested += self.blocks.of_neighbours(
                context.instructions,
                boxes,
                quantized,
                neighbours,
                run,
                most - tested,
            );
            self.decide(context, &leaf_test);
            self.number_new(context, &leaf_test);
        }
    }

    /// Gives what was found the caller's numbers.
    fn number_new<P>(&mut self, context: &Context<K, P>, leaves: &LeafTest<K::Scalar>) {
        let new = &self.hits.as_slice()[self.of_caller.len()..];
        let kind = context.kind;
        kind.to_callers(leaves, &leaves.ids, new, &mut self.of_caller);
        if !self.have_room() {
            self.collect(context);
        }
    }

    /// Has the kind decide candidates, without those that were taken out of their mesh.
    fn decide<P: TreePair>(&mut self, context: &Context<K, P>, leaf_test: &LeafTest<K::Scalar>) {
        for (which, side) in context.pair.sides().into_iter().enumerate() {
            if let Some(removed) = side.removed {
                self.blocks
                    .candidates
                    .retain(|pair| !removed.has(pair[which]));
            }
        }
        context.kind.test(
            leaf_test,
            &mut self.blocks.candidates,
            &mut self.buffers,
            &mut self.hits,
            &mut self.statistics,
        );
    }
}

/// What a kind works with.
fn leaf_test<'q, K: Kind, P>(context: &Context<'q, K, P>) -> LeafTest<'q, K::Scalar>
where
    P: TreePair,
    P::Source: BoxSource<Scalar = K::Scalar>,
{
    let [a, b] = context.pair.sides();
    LeafTest {
        instructions: context.instructions,
        interrupt: context.interrupt,
        shapes: [a.source.shape(), b.source.shape()],
        ends: [a.end(), b.end()],
        motions: [a.motion, b.motion],
        ids: context.pair.caller_ids(),
        elements: [a.elements, b.elements],
        is_one_body: context.pair.is_one_body(),
        is_one_tree: P::ITSELF,
    }
}

/// Pairs of blocks of pairs of leaves, from a cursor on, up to `most` of them; returns the cursor where it stopped.
fn block_pairs(
    itself: bool,
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
        if !itself || leaf_a != leaf_b || pair[0] <= pair[1] {
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

impl<K: Kind> Held for LeafTests<K> {
    fn held(&self) -> usize {
        held::list(&self.block_pairs)
            + held::list(&self.runs)
            + self.blocks.held()
            + self.buffers.held()
            + self.hits.held()
            + held::list(&self.of_caller)
    }
}
