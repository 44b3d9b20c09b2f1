//! Tests of overlapping leaves: which of their triangles are candidates, or which runs the kind is
//! shown.
//!
//! A leaf is one block of up to eight triangles, or several. Pairs of blocks are compared
//! (`block_pairs`), and their candidates decided some thousands at a time. Invariant: in a body
//! with itself every pair of triangles comes up once, and none with itself. Where leaves are
//! blocks, neighbours in the mesh are not found by the descent but gone through list by list.

use super::block_pairs::{BlockPair, BlockTests, Blocks, OneBody};
use super::context::Context;
use crate::held::held;
use crate::ids::BlockId;
use crate::kernels::Coordinate;
use crate::queries::{Batch, LeafTest, LeafWork, Thicknesses};
use crate::tree::{LeafPair, Leaves, Neighbours};
use std::ops::Range;

/// Pairs of blocks compared before their candidates are decided: at most 64 candidates each.
const BLOCK_PAIRS_AT_ONCE: usize = 64;

/// Position in a list of pairs of leaves: a pair, a block of its first leaf, a block of its second.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Cursor {
    pub(super) pair: usize,
    a: u32,
    b: u32,
}

/// Lists on the way from pairs of leaves to the kind of query.
#[derive(Debug, Default)]
pub(super) struct LeafTests {
    block_pairs: Vec<BlockPair>,
    runs: Vec<[u32; 2]>,
    blocks: BlockTests,
}

impl LeafTests {
    /// Tests pairs of leaves from a cursor on, up to `most` pairs of their blocks. Returns the
    /// cursor where it stopped. The boxes of the triangles in them must be valid.
    pub(super) fn test<S: Coordinate>(
        &mut self,
        context: &Context<S>,
        work: &mut dyn LeafWork<S>,
        leaf_pairs: &[LeafPair],
        mut cursor: Cursor,
        most: usize,
    ) -> Cursor {
        let leaf_test = &leaf_test(context);
        let [a, b] = context.pair.sides().map(|side| &side.read.tree.leaves);
        let are_triangles = context.needs.triangles();
        self.runs.clear();
        if a.have_blocks() && b.have_blocks() {
            let blocks = &mut self.block_pairs;
            let is_one_tree = context.pair.is_one_tree();
            cursor = block_pairs(is_one_tree, [a, b], leaf_pairs, cursor, most, blocks);
            if are_triangles {
                self.test_blocks(context, work, leaf_test);
            } else {
                self.runs.extend(blocks.iter().map(|[a, b]| [a.0, b.0]));
            }
        } else {
            let end = leaf_pairs.len().min(cursor.pair + most);
            let leaf_pairs = &leaf_pairs[cursor.pair..end];
            cursor.pair = end;
            if are_triangles {
                self.test_triangles(context, work, leaf_pairs, leaf_test);
            } else {
                let runs = leaf_pairs.iter();
                let runs = runs.map(|&[of_a, of_b]| [a.run_of_leaf(of_a), b.run_of_leaf(of_b)]);
                self.runs.extend(runs);
            }
        }
        if !are_triangles {
            work.test(leaf_test, Batch::Runs(&self.runs));
        }
        cursor
    }

    /// Compares the listed pairs of blocks, and has their candidates decided.
    fn test_blocks<S: Coordinate>(
        &mut self,
        context: &Context<S>,
        work: &mut dyn LeafWork<S>,
        leaf_test: &LeafTest<S>,
    ) {
        let instructions = context.instructions;
        let [a, b] = context.pair.sides();
        for start in (0..self.block_pairs.len()).step_by(BLOCK_PAIRS_AT_ONCE) {
            let end = self.block_pairs.len().min(start + BLOCK_PAIRS_AT_ONCE);
            let pairs = &self.block_pairs[start..end];
            let blocks = Blocks::of(a.boxed_tree(&context.needs));
            if context.pair.is_one_tree() {
                let body = OneBody {
                    blocks,
                    quantized: a.boxes.quantized(),
                    order: a.read.order,
                    neighbours: a.read.tree.neighbours(),
                };
                self.blocks.of_one(instructions, body, pairs);
            } else {
                let both = [blocks, Blocks::of(b.boxed_tree(&context.needs))];
                let left_out = context.pair.is_one_body().then_some(a.read.order);
                self.blocks.of_two(instructions, both, pairs, left_out);
            }
            self.decide(context, work, leaf_test);
        }
    }

    /// Tests pairs of leaves of one triangle each, whose box is the leaf's and overlaps.
    fn test_triangles<S: Coordinate>(
        &mut self,
        context: &Context<S>,
        work: &mut dyn LeafWork<S>,
        leaf_pairs: &[LeafPair],
        leaf_test: &LeafTest<S>,
    ) {
        let [a, b] = context.pair.sides().map(|side| side.read);
        let is_one_body = context.pair.is_one_body();
        for pairs in leaf_pairs.chunks(64 * BLOCK_PAIRS_AT_ONCE) {
            self.blocks.candidates.clear();
            for &[leaf_a, leaf_b] in pairs {
                let pair = [
                    a.tree.leaves.first_triangle(leaf_a),
                    b.tree.leaves.first_triangle(leaf_b),
                ];
                let left_out =
                    is_one_body && (pair[0] == pair[1] || a.order.share_a_vertex(pair[0], pair[1]));
                if !left_out {
                    self.blocks.candidates.push(pair);
                }
            }
            self.decide(context, work, leaf_test);
        }
    }

    /// Tests the next leaves of a run, each a block, with themselves and their later neighbours.
    /// Stops when the limit of pairs is reached or enough was found. Takes the tested leaves from
    /// the run.
    pub(super) fn test_neighbours<S: Coordinate>(
        &mut self,
        context: &Context<S>,
        work: &mut dyn LeafWork<S>,
        neighbours: &Neighbours,
        run: &mut Range<u32>,
    ) {
        let [side, _] = context.pair.sides();
        let leaf_test = leaf_test(context);
        let blocks = Blocks::of(side.boxed_tree(&context.needs));
        let quantized = side.boxes.quantized();
        let most = context.limits.block_pairs;
        let mut tested = 0;
        while run.start < run.end && tested < most && work.has_room() && !context.interrupt.is_set()
        {
            tested += self.blocks.of_neighbours(
                context.instructions,
                blocks,
                quantized,
                neighbours,
                run,
                most - tested,
            );
            self.decide(context, work, &leaf_test);
        }
    }

    /// Has the kind decide the candidates, without triangles that were removed from their mesh, and
    /// pairs that labels leave out.
    fn decide<S: Coordinate>(
        &mut self,
        context: &Context<S>,
        work: &mut dyn LeafWork<S>,
        leaf_test: &LeafTest<S>,
    ) {
        let candidates = &mut self.blocks.candidates;
        for (which, side) in context.pair.sides().into_iter().enumerate() {
            if let Some(removed) = side.read.removed {
                candidates.retain(|pair| !removed.has(pair[which]));
            }
        }
        if let Some(labels) = leaf_test.labels {
            let order = leaf_test.ids.orders[0];
            candidates.retain(|&pair| !labels.leave_out(order, pair));
        }
        work.test(leaf_test, Batch::Triangles(candidates));
    }
}

/// Context of a test of leaves, for the kind of query.
fn leaf_test<'q, S: Coordinate>(context: &Context<'q, S>) -> LeafTest<'q, S> {
    let [a, b] = context.pair.sides().map(|side| side.read);
    let leaves_out = context.needs.leaves_out && context.pair.is_one_body();
    LeafTest {
        instructions: context.instructions,
        interrupt: context.interrupt,
        shapes: [a.source.shape(), b.source.shape()],
        ends: [a.end(), b.end()],
        motions: [a.motion, b.motion],
        ids: context.pair.caller_ids(),
        elements: [a.elements, b.elements],
        thickness: Thicknesses {
            sides: [a.thickness, b.thickness],
            counts: context.needs.counts_thickness,
        },
        rest: a.rest.filter(|_| leaves_out),
        labels: a.labels.filter(|_| leaves_out),
        is_one_body: context.pair.is_one_body(),
        is_one_tree: context.pair.is_one_tree(),
    }
}

/// Lists the pairs of blocks in pairs of leaves, from a cursor on, up to `most`. Returns the cursor
/// where it stopped.
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

held!(LeafTests: block_pairs[], runs[], blocks);
