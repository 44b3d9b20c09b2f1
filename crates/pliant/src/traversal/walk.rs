//! The walk of a task down the trees, depth first, on a stack and lists of its own: from pairs of nodes to pairs of leaves.
//!
//! It knows no kind of query, only trees and boxes.

use super::context::TaskLimits;
use crate::held::held;
use crate::kernels::Instructions;
use crate::threads::Interrupt;
use crate::tree::{BoxedTree, NodePair, Worklists, expand};
use crate::tree::{Child, Neighbours};
use crate::update::DirtySet;

/// How a walk goes.
#[derive(Clone, Copy)]
pub(super) struct Rules<'q> {
    pub(super) instructions: Instructions,
    pub(super) interrupt: &'q Interrupt<'q>,
    pub(super) limits: TaskLimits,
    /// Leaves of one tree that are left out.
    pub(super) left_out: Option<&'q Neighbours>,
    /// Whether it is one tree with itself.
    pub(super) is_one_tree: bool,
    /// Whether it notes the leaves it reaches, because boxes of their triangles are still to be made.
    pub(super) notes_leaves: bool,
}

/// Where a walk is, and what it has found; its buffers are kept from query to query.
#[derive(Debug, Default)]
pub(super) struct Walk {
    /// Pairs of nodes taken from the stack, to be expanded when what is below them is valid.
    batch: Vec<NodePair>,
    /// Wide nodes below the batch that are stale, of either tree.
    pub(super) stale: [DirtySet; 2],
    /// The stack, and pairs of leaves that are to be tested.
    pub(super) found: Worklists,
    /// The leaves in the pairs of leaves, of either tree.
    pub(super) reached: [DirtySet; 2],
}

impl Walk {
    /// Forgets where it was.
    pub(super) fn clear(&mut self) {
        self.batch.clear();
        self.stale.iter_mut().for_each(DirtySet::clear);
        self.found.clear();
        self.reached.iter_mut().for_each(DirtySet::clear);
    }

    /// Whether no pair of nodes is left.
    pub(super) fn is_done(&self) -> bool {
        self.batch.is_empty() && self.found.nodes.is_empty()
    }

    /// Goes on until it asks for boxes that are stale, has found enough, or no pair of nodes is left.
    pub(super) fn go(&mut self, trees: [BoxedTree<'_>; 2], rules: &Rules) {
        let (instructions, limits) = (rules.instructions, rules.limits);
        let (is_one_tree, left_out) = (rules.is_one_tree, rules.left_out);
        let complete = trees.iter().all(|tree| tree.boxes.are_nodes_complete());
        loop {
            let (batch, found) = (&self.batch, &mut self.found);
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
            if rules.interrupt.is_set() {
                return;
            }
            self.found.nodes.take_last(limits.batch, &mut self.batch);
            if !complete && self.asks_for_stale(trees) {
                return;
            }
        }
    }

    /// Notes the wide nodes below the batch that are stale; whether there are any.
    fn asks_for_stale(&mut self, trees: [BoxedTree<'_>; 2]) -> bool {
        for pair in &self.batch {
            for which in 0..2 {
                let BoxedTree { tree, boxes } = trees[which];
                if let Child::Inner(below) = tree.child(pair[which])
                    && !boxes.is_valid(below)
                {
                    self.stale[which].insert(below.0);
                }
            }
        }
        !self.stale.iter().all(DirtySet::is_empty)
    }
}

held!(Walk: batch[], stale, found, reached);
