//! Share of a task in a round: its items of work, over many pairs of trees, and its results.

use crate::held::held;
use crate::tree::{LeafPair, NodePair};
use crate::update::DirtySet;

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

/// Bits of a set of wide nodes or leaves of a tree: 64 numbers from 64 times `number` on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Word {
    /// Number of the tree.
    pub(crate) tree: u32,
    pub(crate) number: u32,
    pub(crate) bits: u64,
}

/// Items of a task in a round, and the items and stale nodes it leaves for the next.
#[derive(Debug, Default)]
pub(crate) struct Share {
    /// Items of this round that are not yet processed.
    pub(crate) todo: Vec<Item>,
    /// Pairs of nodes that wait, since boxes below them are stale.
    pub(crate) waiting: Vec<Item>,
    /// Pairs of leaves that are to be tested.
    pub(crate) leaves: Vec<Item>,
    /// Stale wide nodes that were reached, by the number of the tree. `reached` holds leaves
    /// likewise.
    pub(crate) stale: Vec<Word>,
    pub(crate) reached: Vec<Word>,
    /// Counters by the number of a pair of trees: pairs of nodes, and candidates.
    pub(crate) looked_at: Vec<(u32, [u64; 2])>,
}

impl Share {
    /// Forgets everything: an interrupted query leaves shares as they are.
    pub(super) fn clear(&mut self) {
        for items in [&mut self.todo, &mut self.waiting, &mut self.leaves] {
            items.clear();
        }
        for words in [&mut self.stale, &mut self.reached] {
            words.clear();
        }
        self.looked_at.clear();
    }

    /// Moves what a walk has noted of two trees to a list of the words that have bits.
    pub(super) fn note(words: &mut Vec<Word>, noted: &mut [DirtySet; 2], trees: [u32; 2]) {
        for (tree, noted) in trees.into_iter().zip(noted) {
            let bits = noted.bits_by_word();
            words.extend(bits.map(|(number, bits)| Word { tree, number, bits }));
            noted.clear();
        }
    }
}

held!(Share: todo[], waiting[], leaves[], stale[], reached[], looked_at[]);
