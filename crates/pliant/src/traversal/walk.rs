//! Walk of a task down two trees, or one twice, depth first: from pairs of nodes to pairs of
//! leaves.
//!
//! It has its own stack and lists, and knows no kind of query, only trees and boxes.

use super::context::TaskLimits;
use crate::held::held;
use crate::kernels::Instructions;
use crate::threads::Interrupt;
use crate::tree::{BoxedTree, NodePair, Worklists, expand};
use crate::tree::{Child, Neighbours};
use crate::update::DirtySet;

/// Rules of a walk.
#[derive(Clone, Copy)]
pub(super) struct Rules<'q> {
    pub(super) instructions: Instructions,
    pub(super) interrupt: &'q Interrupt<'q>,
    pub(super) limits: TaskLimits,
    /// Neighbouring leaves of one tree whose pairs are left out.
    pub(super) left_out: Option<&'q Neighbours>,
    /// Whether one tree is walked against itself.
    pub(super) is_one_tree: bool,
    /// Whether pairs of nodes that need stale boxes are deferred; otherwise the walk stops at them.
    pub(super) defers: bool,
    /// Whether to stop soon, so that pairs of nodes can be given to another task.
    pub(super) wants_short_pieces: &'q dyn Fn() -> bool,
    /// Whether the leaves that are reached are noted, since their triangles' boxes are still stale.
    pub(super) notes_leaves: bool,
}

/// State of a walk, and the pairs of leaves it has found; its buffers are kept from query to query.
#[derive(Debug, Default)]
pub(super) struct Walk {
    /// Pairs of nodes taken from the stack, to be expanded as soon as the boxes below are valid.
    batch: Vec<NodePair>,
    /// Stale wide nodes below the batch, of either tree.
    pub(super) stale: [DirtySet; 2],
    /// Stack of pairs of nodes, and list of pairs of leaves.
    pub(super) found: Worklists,
    /// Leaves in the pairs of leaves, of either tree.
    pub(super) reached: [DirtySet; 2],
    /// Pairs of nodes that need stale boxes and were deferred.
    pub(super) deferred: Vec<NodePair>,
}

impl Walk {
    /// Clears everything; buffers are kept.
    pub(super) fn clear(&mut self) {
        self.batch.clear();
        self.stale.iter_mut().for_each(DirtySet::clear);
        self.found.clear();
        self.reached.iter_mut().for_each(DirtySet::clear);
        self.deferred.clear();
    }

    /// Removes the first `count` pairs of the stack, which are the uppermost, and hands them to
    /// `give`.
    pub(super) fn give_first(&mut self, count: usize, give: &mut dyn FnMut(&[NodePair])) {
        let (nodes, rest) = (&mut self.found.nodes, &mut self.batch);
        nodes.take_last(nodes.len() - count, rest);
        give(nodes.as_slice());
        nodes.clear();
        nodes.extend(rest);
        rest.clear();
    }

    /// Whether no pair of nodes is left.
    pub(super) fn is_done(&self) -> bool {
        self.batch.is_empty() && self.found.nodes.is_empty()
    }

    /// Goes on until it needs stale boxes, has found enough, or has no pair of nodes left.
    pub(super) fn go(&mut self, trees: [BoxedTree<'_>; 2], rules: &Rules) {
        let (instructions, limits) = (rules.instructions, rules.limits);
        let (is_one_tree, left_out) = (rules.is_one_tree, rules.left_out);
        let complete = trees.iter().all(|tree| tree.boxes.are_nodes_complete());
        loop {
            let (batch, found) = (&self.batch, &mut self.found);
            let has_expanded = !batch.is_empty();
            expand(instructions, trees, is_one_tree, batch, left_out, found);
            self.batch.clear();
            for (set, reached) in self.reached.iter_mut().zip(&mut self.found.reached) {
                if rules.notes_leaves {
                    for leaves in reached.as_slice() {
                        set.insert_eight(leaves.first.0, leaves.lanes);
                    }
                }
                reached.clear();
            }
            let stack = self.found.nodes.len();
            if stack == 0 || stack >= limits.stack || self.found.leaves.len() >= limits.leaf_pairs {
                return;
            }
            if rules.interrupt.is_set() || has_expanded && stack > 1 && (rules.wants_short_pieces)()
            {
                return;
            }
            self.found.nodes.take_last(limits.batch, &mut self.batch);
            if complete {
                continue;
            }
            if rules.defers {
                self.defer_stale(trees);
            } else if self.asks_for_stale(trees) {
                return;
            }
        }
    }

    /// Notes the stale wide nodes below the batch, and returns whether there are any.
    fn asks_for_stale(&mut self, trees: [BoxedTree<'_>; 2]) -> bool {
        for &pair in &self.batch {
            note_stale(trees, pair, &mut self.stale);
        }
        !self.stale.iter().all(DirtySet::is_empty)
    }

    /// Notes the stale wide nodes below the batch, and defers the pairs that need them.
    fn defer_stale(&mut self, trees: [BoxedTree<'_>; 2]) {
        let Self { batch, stale, .. } = self;
        let needed = batch.extract_if(.., |&mut pair| note_stale(trees, pair, stale));
        self.deferred.extend(needed);
    }
}

/// Notes the stale wide nodes below a pair, and returns whether there are any.
#[inline(always)]
fn note_stale(trees: [BoxedTree<'_>; 2], pair: NodePair, stale: &mut [DirtySet; 2]) -> bool {
    let mut is_any = false;
    for which in 0..2 {
        let BoxedTree { tree, boxes, .. } = trees[which];
        if let Child::Inner(below) = tree.child(pair[which])
            && !boxes.is_valid(below)
        {
            stale[which].insert(below.0);
            is_any = true;
        }
    }
    is_any
}

held!(Walk: batch[], stale, found, reached, deferred[]);
