//! A task of a descent: some of its pairs of nodes, and all that comes of them.
//!
//! A task goes on by itself, depth first, on a stack and lists of its own, for as long as the boxes it asks for are valid. What becomes
//! of leaves that overlap its `LeafWork` knows; which that is depends on the kind of query.

use super::context::Context;
use super::leaf_pairs::{Cursor, LeafTests};
use super::share::{Item, Share};
use super::tree_pair::{TreePair, View};
use super::walk::{Rules, Walk};
use crate::held::held;
use crate::kernels::Coordinate;
use crate::queries::{LeafWork, Needs};
use crate::statistics::Statistics;
use crate::threads::{Exchange, Executor};
use crate::tree::{BoxSet, Neighbours};
use std::ops::{ControlFlow, Range};

/// Pairs of blocks that are tested before a task looks at what it has found.
const BLOCK_PAIRS_BEFORE_LOOK: usize = 128;
/// The same of runs: two may have nine times as many elements near each other as two blocks have triangles.
const RUN_PAIRS_BEFORE_LOOK: usize = 32;

/// A task, and its buffers, kept from query to query.
#[derive(Debug, Default)]
pub(crate) struct Task {
    /// The way down: its stack, and pairs of leaves that are to be tested.
    pub(super) walk: Walk,
    /// Up to where the pairs of leaves were tested.
    cursor: Cursor,
    /// Leaves that are still to be tested with themselves and their neighbours, where the descent leaves these out.
    pub(super) run: Range<u32>,
    /// The lists on the way from leaves to what the kind is shown.
    pub(super) tests: LeafTests,
    /// Its share of the rounds of many pairs of trees.
    pub(crate) share: Share,
}

/// What a task is to do, with what the kind of query makes of it.
pub(crate) type TaskWork<'w, S> = &'w (dyn Fn(&mut Task, &mut dyn LeafWork<S>) + Sync);

/// The tasks of a query of some kind, each with a [`LeafWork`] of its own; kept from query to query.
pub(crate) trait Tasks<S> {
    /// Whether all that is found is wanted, and in no order.
    fn wants_all(&self) -> bool;
    /// Forgets what tasks that were used before were about. One is used from now on, of as many as there may be.
    fn begin(&mut self, most: usize);
    /// So many are used from now on.
    fn use_all(&mut self, count: usize);
    /// One of them.
    fn one(&mut self, number: usize) -> &mut Task;
    /// Has the first `count` do something, side by side where there are threads.
    fn run(&mut self, executor: Executor, count: usize, work: TaskWork<S>);
    /// Shows what the first `count` have found to a visitor, and counts the work. Breaks if the visitor does, or if a collector has
    /// enough, which was shown it before.
    fn show(&mut self, count: usize, statistics: &mut Statistics) -> ControlFlow<()>;
}

/// Whether all boxes that the query reads are known to be valid because they were completed at once, so that tasks need not wait for any,
/// and pairs of leaves can be tested as soon as they are found.
pub(super) fn are_free<S: Coordinate>(needs: &Needs, sides: [&View<'_, S>; 2]) -> bool {
    let is_complete = |side: &&View<S>| {
        side.boxes.are_nodes_complete() && (!needs.triangles() || side.boxes.are_leaves_complete())
    };
    sides.iter().all(is_complete)
}

/// The neighbours in a body that meets itself, if the descent leaves them out: where they are known, leaves are blocks, and all boxes are
/// valid. They overlap in any shape, so nothing is gained by looking for them.
pub(super) fn left_out<'p, S: Coordinate>(
    needs: &Needs,
    pair: &'p TreePair<'p, S, &'p BoxSet>,
) -> Option<&'p Neighbours> {
    let TreePair::One(side) = pair else {
        return None;
    };
    let are_left_out =
        needs.triangles() && side.tree.leaves.are_blocks() && are_free(needs, [side; 2]);
    side.tree.neighbours().filter(|_| are_left_out)
}

/// How many pairs are tested before a task looks at what it has found.
fn before_look(needs: &Needs) -> usize {
    if needs.triangles() {
        BLOCK_PAIRS_BEFORE_LOOK
    } else {
        RUN_PAIRS_BEFORE_LOOK
    }
}

impl Task {
    /// Forgets what it was about.
    pub(crate) fn clear(&mut self) {
        self.walk.clear();
        self.cursor = Cursor::default();
        self.run = 0..0;
    }

    /// Whether no pair of nodes is left.
    pub(super) fn is_done(&self) -> bool {
        self.walk.is_done()
    }

    /// Whether all pairs of leaves were tested.
    pub(super) fn all_tested(&self) -> bool {
        self.cursor.pair == self.walk.found.leaves.len()
    }

    /// Goes on until it asks for boxes that are stale, has found enough, or nothing is left. What it asked for before is valid now.
    /// Where it is free, leaves are tested on the way.
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

    /// Walks down until it asks for boxes that are stale, has found enough, or no pair of nodes is left.
    fn walk<S: Coordinate>(&mut self, context: &Context<S>) {
        self.walk_on(context, None);
    }

    /// Walks down, for a round until nothing is left but what waits for boxes, or others want some.
    pub(super) fn walk_on<S: Coordinate>(
        &mut self,
        context: &Context<S>,
        exchange: Option<&Exchange<'_, Item>>,
    ) {
        let needs = &context.needs;
        let sides = context.pair.sides();
        let trees = sides.map(View::boxed_tree);
        let rules = Rules {
            instructions: context.instructions,
            interrupt: context.interrupt,
            limits: context.limits,
            left_out: left_out(needs, context.pair),
            is_one_tree: context.pair.is_one_tree(),
            defers: exchange.is_some(),
            is_wanted: &|| exchange.is_some_and(Exchange::is_wanted),
            notes_leaves: needs.triangles() && !are_free(needs, sides),
        };
        self.walk.go(trees, &rules);
    }

    /// Tests pairs of leaves until all were, or many, or enough was found.
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

    /// Tests the next pairs of leaves, before it looks at what it has found.
    pub(super) fn test_next<S: Coordinate>(
        &mut self,
        context: &Context<S>,
        work: &mut dyn LeafWork<S>,
    ) {
        self.test(context, work, before_look(&context.needs));
    }

    /// Tests the next pairs of leaves, so many pairs of their blocks.
    fn test<S: Coordinate>(
        &mut self,
        context: &Context<S>,
        work: &mut dyn LeafWork<S>,
        blocks: usize,
    ) {
        let leaves = self.walk.found.leaves.as_slice();
        self.cursor = self.tests.test(context, work, leaves, self.cursor, blocks);
    }

    /// Tests the next leaves of its run with themselves and their neighbours, until many were or enough was found.
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

    /// Forgets the pairs of leaves, all of which were tested.
    pub(super) fn forget_leaves(&mut self) {
        self.walk.found.clear_leaves();
        self.cursor = Cursor::default();
    }
}

held!(Task: walk, tests, share);
