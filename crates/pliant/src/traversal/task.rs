//! A task of a descent: some of its pairs of nodes, and all that comes of them.
//!
//! A task goes on by itself, depth first, on a stack and lists of its own, for as long as the boxes it asks for are valid.

use super::context::Context;
use super::leaf_pairs::{Cursor, LeafTests};
use super::tree_pair::{Side, TreePair};
use super::walk::{Rules, Walk};
use crate::held::Held;
use crate::queries::{Kind, Leaves};
use crate::tree::{BoxSource, Neighbours};
use std::ops::Range;

/// Pairs of blocks that are tested before a task looks at what it has found.
const BLOCK_PAIRS_BEFORE_LOOK: usize = 128;
/// The same of runs: two may have nine times as many elements near each other as two blocks have triangles.
const RUN_PAIRS_BEFORE_LOOK: usize = 32;

/// A task, and its buffers, kept from query to query.
#[derive(Debug)]
pub(super) struct Task<K: Kind> {
    /// The way down: its stack, and pairs of leaves that are to be tested.
    pub(super) walk: Walk,
    /// Up to where the pairs of leaves were tested.
    cursor: Cursor,
    /// Leaves that are still to be tested with themselves and their neighbours, where the descent leaves these out.
    pub(super) run: Range<u32>,
    /// What was found among the pairs of leaves that were tested last.
    pub(super) tests: LeafTests<K>,
}

impl<K: Kind> Default for Task<K> {
    fn default() -> Self {
        Self {
            walk: Walk::default(),
            cursor: Cursor::default(),
            run: 0..0,
            tests: LeafTests::default(),
        }
    }
}

/// Whether all boxes that the kind reads are known to be valid because they were completed at once, so that tasks need not wait for any,
/// and pairs of leaves can be tested as soon as they are found.
pub(super) fn are_free<K: Kind, B: BoxSource>(sides: [&Side<'_, B>; 2]) -> bool {
    let is_complete = |side: &&Side<B>| {
        side.boxes.are_nodes_complete() && (K::HAS_RUNS || side.boxes.are_leaves_complete())
    };
    sides.iter().all(is_complete)
}

/// The neighbours in a body that meets itself, if the descent leaves them out: where they are known, leaves are blocks, and all boxes are
/// valid. They overlap in any shape, so nothing is gained by looking for them.
pub(super) fn left_out<K: Kind, P: TreePair>(pair: &P) -> Option<&Neighbours> {
    let sides = pair.sides();
    let are_left_out = P::ITSELF
        && K::LEAVES == Leaves::Triangles
        && sides[0].tree.leaves.are_blocks()
        && are_free::<K, _>(sides);
    sides[0].tree.neighbours().filter(|_| are_left_out)
}

/// How many pairs are tested before a task looks at what it has found.
const fn before_look<K: Kind>() -> usize {
    if K::HAS_RUNS {
        RUN_PAIRS_BEFORE_LOOK
    } else {
        BLOCK_PAIRS_BEFORE_LOOK
    }
}

impl<K: Kind> Task<K> {
    /// Forgets what it was about.
    pub(super) fn clear(&mut self) {
        self.tests.clear();
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
    pub(super) fn advance<P>(&mut self, context: &Context<K, P>)
    where
        P: TreePair,
        P::Source: BoxSource<Scalar = K::Scalar>,
    {
        self.walk.found.node_pairs = 0;
        self.tests.clear();
        if !are_free::<K, _>(context.pair.sides()) {
            return self.walk(context);
        }
        let budget = context.budget;
        let mut tested = 0;
        while tested < budget.block_pairs && self.tests.have_room() && !context.interrupt.is_set() {
            if self.all_tested() {
                self.forget_leaves();
                self.walk(context);
            }
            let blocks = budget.leaf_pairs.min(before_look::<K>());
            self.test(context, blocks);
            tested += blocks;
            let stack = self.walk.found.nodes.len();
            if self.all_tested() && (stack == 0 || stack >= budget.stack) {
                break;
            }
        }
        self.tests.collect(context);
    }

    /// Walks down until it asks for boxes that are stale, has found enough, or no pair of nodes is left.
    fn walk<P: TreePair>(&mut self, context: &Context<K, P>) {
        let sides = context.pair.sides();
        let trees = [sides[0].boxed_tree(), sides[1].boxed_tree()];
        let rules = Rules {
            instructions: context.instructions,
            interrupt: context.interrupt,
            budget: context.budget,
            left_out: left_out::<K, P>(context.pair),
            notes_leaves: !K::HAS_RUNS && !are_free::<K, _>(sides),
        };
        if const { P::ITSELF } {
            self.walk.go::<true>(trees, &rules);
        } else {
            self.walk.go::<false>(trees, &rules);
        }
    }

    /// Tests pairs of leaves until all were, or many, or enough was found.
    pub(super) fn test_some<P>(&mut self, context: &Context<K, P>)
    where
        P: TreePair,
        P::Source: BoxSource<Scalar = K::Scalar>,
    {
        self.tests.clear();
        let budget = context.budget;
        let blocks = budget.leaf_pairs.min(before_look::<K>());
        let mut tested = 0;
        while tested < budget.block_pairs
            && self.tests.have_room()
            && !self.all_tested()
            && !context.interrupt.is_set()
        {
            self.test(context, blocks);
            tested += blocks;
        }
        self.tests.collect(context);
    }

    /// Tests the next pairs of leaves, so many pairs of their blocks.
    fn test<P>(&mut self, context: &Context<K, P>, blocks: usize)
    where
        P: TreePair,
        P::Source: BoxSource<Scalar = K::Scalar>,
    {
        let leaves = self.walk.found.leaves.as_slice();
        self.cursor = self.tests.test::<P>(context, leaves, self.cursor, blocks);
    }

    /// Tests the next leaves of its run with themselves and their neighbours, until many were or enough was found.
    pub(super) fn test_neighbours<P>(&mut self, context: &Context<K, P>, neighbours: &Neighbours)
    where
        P: TreePair,
        P::Source: BoxSource<Scalar = K::Scalar>,
    {
        self.tests.clear();
        let most = context.budget.block_pairs;
        self.tests
            .test_neighbours::<P>(context, neighbours, &mut self.run, most);
        self.tests.collect(context);
    }

    /// Forgets the pairs of leaves, all of which were tested.
    pub(super) fn forget_leaves(&mut self) {
        self.walk.found.clear_leaves();
        self.cursor = Cursor::default();
    }
}

impl<K: Kind> Held for Task<K> {
    fn held(&self) -> usize {
        self.walk.held() + self.tests.held()
    }
}
