//! Rounds of a traversal over many pairs of trees at once, for queries that several threads share.
//!
//! Idea: breadth first over all pairs of trees. In a round, tasks go on until all pairs of nodes
//! left wait for stale boxes, which are then refitted together. Invariant: a round makes the same
//! boxes and compares the same pairs as a single task would. So neither hits nor counters depend on
//! the number of threads. Difference from `descent`, which keeps an order for visitors: busy tasks
//! give work to idle ones.

use super::context::{Context, TaskLimits};
use super::share::{Item, Piece};
use super::task::{Task, are_free, left_out};
use super::tree_pair::Views;
use crate::kernels::{Coordinate, Instructions};
use crate::queries::{LeafWork, Needs};
use crate::threads::{Exchange, Interrupt};
use crate::tree::{LeafPair, NodePair};
use crate::update::DirtySets;
use std::mem::discriminant;

/// Most items of one pair of trees that a task takes at once; the rest can be given to others.
const AT_ONCE: usize = 512;
/// Runs of leaves that a task takes at once.
const RUNS_AT_ONCE: usize = 4;
/// Pairs of leaves on the list of a task at which it stops, so that they are tested: they bound
/// memory.
const MOST_LEAVES: usize = 1 << 16;
/// Limits after which a task looks at its hits, and at whether another task waits for work.
const LIMITS: TaskLimits = TaskLimits {
    batch: 256,
    leaf_pairs: 512,
    block_pairs: 512,
    stack: usize::MAX,
};

/// Context that all tasks of a round share.
pub(crate) struct Round<'q, S> {
    pub(crate) needs: Needs,
    pub(crate) instructions: Instructions,
    pub(crate) interrupt: &'q Interrupt<'q>,
    pub(crate) exchange: &'q Exchange<'q, Item>,
    /// Lookup of pairs of trees.
    pub(crate) pairs: &'q (dyn Pairs<S> + Sync),
    /// Stale wide nodes that were reached, by tree. `reached` holds leaves likewise.
    pub(crate) stale: &'q DirtySets,
    pub(crate) reached: &'q DirtySets,
}

/// Pairs of trees by their numbers.
pub(crate) trait Pairs<S> {
    /// Shows the views of a pair of trees, and the numbers of these trees.
    fn show(&self, pair: u32, see: &mut dyn FnMut(Views<S>, [u32; 2]));
    /// Counts what was looked at of a pair of trees: pairs of nodes, and candidates.
    fn count(&self, pair: u32, looked_at: [u64; 2]);
}

impl Task {
    /// Runs this task's share of a round, and items that others give it meanwhile.
    pub(crate) fn run_round<S: Coordinate>(
        &mut self,
        round: &Round<S>,
        work: &mut dyn LeafWork<S>,
    ) {
        work.clear();
        round.exchange.begin();
        while !self.share.todo.is_empty() || round.exchange.take(&mut self.share.todo) {
            let todo = &mut self.share.todo;
            if todo.len() > 1 && round.exchange.is_anyone_idle() {
                round.exchange.give(todo.drain(..todo.len() / 2));
            }
            let Some(&Item { pair, piece }) = todo.last() else {
                continue;
            };
            let is_other = |item: &Item| {
                item.pair != pair || discriminant(&item.piece) != discriminant(&piece)
            };
            let others = todo.iter().rposition(is_other);
            let first = others.map_or(0, |last| last + 1);
            let at_once = match piece {
                Piece::Neighbours(_) => RUNS_AT_ONCE,
                Piece::Nodes(_) | Piece::Leaves(_) => AT_ONCE,
            };
            let first = first.max(todo.len().saturating_sub(at_once));
            round.pairs.show(pair, &mut |pair, trees| {
                let context = &Context {
                    needs: round.needs,
                    pair,
                    instructions: round.instructions,
                    interrupt: round.interrupt,
                    limits: LIMITS,
                };
                self.process(context, round, work, first, trees);
            });
            round.exchange.mark();
            if self.share.leaves.len() >= MOST_LEAVES {
                // They are tested before it goes on.
                self.share.waiting.append(&mut self.share.todo);
                break;
            }
            if !work.has_room() || round.interrupt.is_set() {
                // There are too many hits, or the query is interrupted.
                self.share.todo.clear();
                break;
            }
        }
        work.hand_over();
    }

    /// Processes the items in `todo[first..]`, which are of one kind and of one pair of trees.
    fn process<S: Coordinate>(
        &mut self,
        context: &Context<S>,
        round: &Round<S>,
        work: &mut dyn LeafWork<S>,
        first: usize,
        trees: [u32; 2],
    ) {
        let Item { pair, piece } = self.share.todo[first];
        self.walk.found.node_pairs = 0;
        let before = work.candidates();
        match piece {
            Piece::Nodes(_) => self.expand_all_below(context, round, work, first, trees),
            Piece::Leaves(_) => self.test_leaves(context, round, work, first),
            Piece::Neighbours(_) => self.test_runs(context, work, first),
        }
        let looked_at = [self.walk.found.node_pairs, work.candidates() - before];
        round.pairs.count(pair, looked_at);
    }

    /// Expands the pairs of nodes of one pair of trees in `todo[first..]`, and all pairs of nodes
    /// below them.
    fn expand_all_below<S: Coordinate>(
        &mut self,
        context: &Context<S>,
        round: &Round<S>,
        work: &mut dyn LeafWork<S>,
        first: usize,
        trees: [u32; 2],
    ) {
        let pair = self.share.todo[first].pair;
        let is_free = are_free(&context.needs, context.pair.sides());
        let item = |nodes: NodePair| Item {
            pair,
            piece: Piece::Nodes(nodes),
        };
        for item in self.share.todo.drain(first..) {
            if let Piece::Nodes(nodes) = item.piece {
                self.walk.found.nodes.push(nodes);
            }
        }
        loop {
            self.walk_on(context, Some(round.exchange));
            if is_free {
                self.test_all(context, round, work, pair);
            } else {
                let leaves = self.walk.found.leaves.as_slice().iter();
                let item = |&leaves: &LeafPair| Item {
                    pair,
                    piece: Piece::Leaves(leaves),
                };
                self.share.leaves.extend(leaves.map(item));
                self.forget_leaves();
            }
            round.exchange.mark();
            let nodes = &mut self.walk.found.nodes;
            let stack = nodes.len();
            if stack == 0 || context.interrupt.is_set() || !work.has_room() {
                nodes.clear();
                break;
            }
            if self.share.leaves.len() >= MOST_LEAVES {
                let waiting = nodes.as_slice().iter().copied().map(item);
                self.share.waiting.extend(waiting);
                nodes.clear();
                break;
            }
            if stack > 1 && round.exchange.is_anyone_idle() {
                // The first are the uppermost: most work lies below them.
                let give = &mut |given: &[NodePair]| {
                    round.exchange.give(given.iter().copied().map(item));
                };
                self.walk.give_first(stack / 2, give);
            }
        }
        let deferred = self.walk.deferred.drain(..);
        self.share.waiting.extend(deferred.map(item));
        let walk = &mut self.walk;
        for (sets, noted) in [
            (round.stale, &mut walk.stale),
            (round.reached, &mut walk.reached),
        ] {
            for (tree, noted) in trees.into_iter().zip(noted) {
                sets.note(tree as usize, noted);
            }
        }
    }

    /// Tests the pairs of leaves of one pair of trees in `todo[first..]`.
    fn test_leaves<S: Coordinate>(
        &mut self,
        context: &Context<S>,
        round: &Round<S>,
        work: &mut dyn LeafWork<S>,
        first: usize,
    ) {
        let pair = self.share.todo[first].pair;
        for item in self.share.todo.drain(first..) {
            if let Piece::Leaves(leaves) = item.piece {
                self.walk.found.leaves.push(leaves);
            }
        }
        self.test_all(context, round, work, pair);
    }

    /// Tests all pairs of leaves on the list, unless there are too many hits, and empties it. Gives
    /// some to tasks that wait.
    fn test_all<S: Coordinate>(
        &mut self,
        context: &Context<S>,
        round: &Round<S>,
        work: &mut dyn LeafWork<S>,
        pair: u32,
    ) {
        while !self.all_tested() && work.has_room() && !context.interrupt.is_set() {
            self.test_next(context, work);
            round.exchange.mark();
            if round.exchange.is_anyone_idle() {
                let given = self.take_untested();
                let items = given.iter().map(|&leaves| Item {
                    pair,
                    piece: Piece::Leaves(leaves),
                });
                round.exchange.give(items);
            }
        }
        self.forget_leaves();
    }

    /// Tests the runs of leaves of one tree in `todo[first..]`, with themselves and their
    /// neighbours.
    fn test_runs<S: Coordinate>(
        &mut self,
        context: &Context<S>,
        work: &mut dyn LeafWork<S>,
        first: usize,
    ) {
        let neighbours = left_out(&context.needs, &context.pair);
        let [side, _] = context.pair.sides();
        let leaves = side.read.tree.leaves.len() as u32;
        while self.share.todo.len() > first {
            let Some(Piece::Neighbours([start, end])) =
                self.share.todo.pop().map(|item| item.piece)
            else {
                continue;
            };
            let Some(neighbours) = neighbours else {
                continue;
            };
            let mut run = start..end.min(leaves);
            while run.start < run.end && work.has_room() && !context.interrupt.is_set() {
                self.tests
                    .test_neighbours(context, work, neighbours, &mut run);
            }
        }
    }
}
