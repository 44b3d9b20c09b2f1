//! Share of a task in a round: its items of work, over many pairs of trees, and its results.

use crate::held::held;
use crate::tree::{LeafPair, NodePair};

/// Item of work of one pair of trees.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Item {
    /// Number of the pair of trees.
    pub(crate) pair: u32,
    pub(crate) piece: Piece,
}

/// Piece of work, within one pair of trees.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Piece {
    /// Pair of nodes that is to be expanded.
    Nodes(NodePair),
    /// Pair of leaves that is to be tested; all boxes in both are valid.
    Leaves(LeafPair),
    /// Leaves, as start and end, that are to be tested with themselves and their neighbours.
    Neighbours([u32; 2]),
}

/// Items of a task in a round, and the items it leaves for the next.
#[derive(Debug, Default)]
pub(crate) struct Share {
    /// Items of this round that are not yet processed.
    pub(crate) todo: Vec<Item>,
    /// Pairs of nodes that wait, since boxes below them are stale.
    pub(crate) waiting: Vec<Item>,
    /// Pairs of leaves that are to be tested.
    pub(crate) leaves: Vec<Item>,
}

impl Share {
    /// Forgets everything: an interrupted query leaves shares as they are.
    pub(super) fn clear(&mut self) {
        for items in [&mut self.todo, &mut self.waiting, &mut self.leaves] {
            items.clear();
        }
    }
}

held!(Share: todo[], waiting[], leaves[]);
