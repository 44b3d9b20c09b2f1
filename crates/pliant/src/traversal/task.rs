//! Task of a descent: some pairs of nodes, and everything found below them.
//!
//! A task goes on alone, depth first, on its own stack and lists, as long as the boxes it needs are
//! valid. At a stale box it stops until that box is refitted. Its `LeafWork`, made by the kind of
//! query, processes leaves that overlap.

use super::context::Context;
use super::leaf_pairs::{Cursor, LeafTests};
use super::share::{Item, Share};
use super::tree_pair::{View, Views};
use super::walk::{Rules, Walk};
use crate::held::held;
use crate::kernels::Coordinate;
use crate::queries::{LeafWork, Needs};
use crate::statistics::Statistics;
use crate::threads::{Exchange, Executor};
use crate::tree::{LeafPair, Neighbours};
use std::ops::{ControlFlow, Range};

/// Pairs of blocks of triangles that are tested before a task checks whether it has found enough.
const BLOCK_PAIRS_BEFORE_LOOK: usize = 128;
/// Pairs of runs that are tested before a task checks whether it has found enough. These are fewer
/// than pairs of blocks: two runs may have nine times as many near elements as two blocks have
/// triangles.
const RUN_PAIRS_BEFORE_LOOK: usize = 32;

/// A task, and its buffers, kept from query to query.
#[derive(Debug, Default)]
pub(crate) struct Task {
    /// Walk down the trees: its stack, and the pairs of leaves that are to be tested.
    pub(super) walk: Walk,
    /// Position up to which the pairs of leaves were tested.
    cursor: Cursor,
    /// Leaves still to be tested with themselves and their neighbours, where the descent omits
    /// these pairs.
    pub(super) run: Range<u32>,
    /// Scratch: pairs of leaves on their way to another task.
    untested: Vec<LeafPair>,
    /// Lists on the way from pairs of leaves to the kind of query.
    pub(super) tests: LeafTests,
    /// Share of this task in the rounds of many pairs of trees.
    pub(crate) share: Share,
}

/// Step of a task, run with the `LeafWork` that the kind of query has for it.
pub(crate) type TaskWork<'w, S> = &'w (dyn Fn(&mut Task, &mut dyn LeafWork<S>) + Sync);

/// Tasks of a query of some kind, each with a [`LeafWork`] of its own; kept from query to query.
pub(crate) trait Tasks<S> {
    /// Whether the query wants all hits, in any order.
    fn wants_all(&self) -> bool;
    /// Clears tasks used before, and begins with a single one; later at most `most` are used.
    fn begin(&mut self, most: usize);
    /// Uses `count` tasks from this call on.
    fn use_all(&mut self, count: usize);
    /// Task of a number.
    fn one(&mut self, number: usize) -> &mut Task;
    /// Runs a step of each of the first `count` tasks, in parallel where there are threads.
    fn run(&mut self, executor: Executor, count: usize, work: TaskWork<S>);
    /// Shows the hits of the first `count` tasks to a visitor, and adds up their counters. Breaks
    /// if the visitor does, or if a collector, which has seen its hits before, has enough.
    fn show(&mut self, count: usize, statistics: &mut Statistics) -> ControlFlow<()>;
}

/// Whether all boxes that the query reads are known to be valid, since an update completed them.
/// Tasks then wait for no boxes, and test pairs of leaves as soon as they are found.
pub(super) fn are_free<S: Coordinate>(needs: &Needs, sides: [View<'_, S>; 2]) -> bool {
    let is_complete = |side: &View<S>| {
        side.boxes.are_nodes_complete() && (!needs.triangles() || side.boxes.are_leaves_complete())
    };
    sides.iter().all(is_complete)
}

/// Neighbours of a body that meets itself, if the descent leaves them out. It does where they are
/// known, leaves are blocks, and all boxes are valid. Neighbours overlap in any shape, so a descent
/// to them gains nothing.
pub(super) fn left_out<'p, S: Coordinate>(
    needs: &Needs,
    pair: &Views<'p, S>,
) -> Option<&'p Neighbours> {
    let [side, _] = pair.sides();
    let tree = side.read.tree;
    let are_left_out = pair.is_one_tree()
        && needs.triangles()
        && tree.leaves.are_blocks()
        && are_free(needs, [side; 2]);
    tree.neighbours().filter(|_| are_left_out)
}

/// Number of pairs that are tested before a task checks whether it has found enough.
fn before_look(needs: &Needs) -> usize {
    if needs.triangles() {
        BLOCK_PAIRS_BEFORE_LOOK
    } else {
        RUN_PAIRS_BEFORE_LOOK
    }
}

impl Task {
    /// Clears the walk, the cursor and the run; buffers are kept.
    pub(crate) fn clear(&mut self) {
        self.walk.clear();
        self.cursor = Cursor::default();
        self.run = 0..0;
        self.share.clear();
    }

    /// Whether no pair of nodes is left.
    pub(super) fn is_done(&self) -> bool {
        self.walk.is_done()
    }

    /// Whether all pairs of leaves were tested.
    pub(super) fn all_tested(&self) -> bool {
        self.cursor.pair == self.walk.found.leaves.len()
    }

    /// Goes on until it needs stale boxes, has found enough, or has no pair of nodes left. Boxes
    /// that it needed before are valid now. A free task tests leaves on the way.
    pub(super) fn advance<S: Coordinate>(
        &mut self,
        context: &Context<S>,
        work: &mut dyn LeafWork<S>,
    ) {
        self.walk.found.node_pairs = 0;
        work.clear();
        if !are_free(&context.needs, context.pair.sides()) {
            return self.walk(context);
        }
        let limits = context.limits;
        let mut tested = 0;
        while tested < limits.block_pairs && work.has_room() && !context.interrupt.is_set() {
            if self.all_tested() {
                self.forget_leaves();
                self.walk(context);
            }
            let blocks = limits.leaf_pairs.min(before_look(&context.needs));
            self.test(context, work, blocks);
            tested += blocks;
            let stack = self.walk.found.nodes.len();
            if self.all_tested() && (stack == 0 || stack >= limits.stack) {
                break;
            }
        }
        work.hand_over();
    }

    /// Walks down until it needs stale boxes, has found enough, or has no pair of nodes left.
    fn walk<S: Coordinate>(&mut self, context: &Context<S>) {
        self.walk_on(context, None);
    }

    /// Walks down. With an exchange, defers pairs of nodes that need stale boxes, and stops if
    /// another task waits for work.
    pub(super) fn walk_on<S: Coordinate>(
        &mut self,
        context: &Context<S>,
        exchange: Option<&Exchange<'_, Item>>,
    ) {
        let needs = &context.needs;
        let sides = context.pair.sides();
        let trees = sides.map(|side| side.boxed_tree(needs));
        let rules = Rules {
            instructions: context.instructions,
            interrupt: context.interrupt,
            limits: context.limits,
            left_out: left_out(needs, &context.pair),
            is_one_tree: context.pair.is_one_tree(),
            defers: exchange.is_some(),
            wants_short_pieces: &|| exchange.is_some_and(Exchange::wants_short_pieces),
            notes_leaves: needs.triangles() && !are_free(needs, sides),
        };
        self.walk.go(trees, &rules);
    }

    /// Tests pairs of leaves until none is left, the limit of pairs of blocks is reached, or enough
    /// was found.
    pub(super) fn test_some<S: Coordinate>(
        &mut self,
        context: &Context<S>,
        work: &mut dyn LeafWork<S>,
    ) {
        work.clear();
        let limits = context.limits;
        let blocks = limits.leaf_pairs.min(before_look(&context.needs));
        let mut tested = 0;
        while tested < limits.block_pairs
            && work.has_room()
            && !self.all_tested()
            && !context.interrupt.is_set()
        {
            self.test(context, work, blocks);
            tested += blocks;
        }
        work.hand_over();
    }

    /// Tests the next pairs of leaves, up to the next check of whether enough was found.
    pub(super) fn test_next<S: Coordinate>(
        &mut self,
        context: &Context<S>,
        work: &mut dyn LeafWork<S>,
    ) {
        self.test(context, work, before_look(&context.needs));
    }

    /// Tests the next pairs of leaves, up to `blocks` pairs of their blocks.
    fn test<S: Coordinate>(
        &mut self,
        context: &Context<S>,
        work: &mut dyn LeafWork<S>,
        blocks: usize,
    ) {
        let leaves = self.walk.found.leaves.as_slice();
        self.cursor = self.tests.test(context, work, leaves, self.cursor, blocks);
    }

    /// Tests the next leaves of the run with themselves and their neighbours, until the limit is
    /// reached or enough was found.
    pub(super) fn test_neighbours<S: Coordinate>(
        &mut self,
        context: &Context<S>,
        work: &mut dyn LeafWork<S>,
        neighbours: &Neighbours,
    ) {
        work.clear();
        self.tests
            .test_neighbours(context, work, neighbours, &mut self.run);
        work.hand_over();
    }

    /// Takes half of the pairs of leaves that were not yet begun off the list.
    pub(super) fn take_untested(&mut self) -> &[LeafPair] {
        let leaves = &mut self.walk.found.leaves;
        let untested = leaves.len().saturating_sub(self.cursor.pair + 1);
        leaves.take_last(untested.div_ceil(2), &mut self.untested);
        &self.untested
    }

    /// Clears the list of pairs of leaves, all of which were tested.
    pub(super) fn forget_leaves(&mut self) {
        self.walk.found.clear_leaves();
        self.cursor = Cursor::default();
    }
}

held!(Task: walk, untested[], tests, share);
