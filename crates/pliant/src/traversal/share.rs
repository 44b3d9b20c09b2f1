//! A task's share of a round: pieces of work of many pairs of trees, and what becomes of them.

use crate::held::held;
use crate::tree::{LeafPair, NodePair};
use crate::update::DirtySet;

/// Some work of one pair of trees.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Item {
    /// The number of the pair of trees.
    pub(crate) pair: u32,
    pub(crate) piece: Piece,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Piece {
    /// Two nodes, to be expanded.
    Nodes(NodePair),
    /// Two leaves, to be tested; all boxes in them are valid.
    Leaves(LeafPair),
    /// A run of leaves, from a first to before an end, to be tested with themselves and their neighbours.
    Run([u32; 2]),
}

/// What a task has of a round, and leaves for the next.
#[derive(Debug, Default)]
pub(crate) struct Share {
    /// What is still to be done.
    pub(crate) todo: Vec<Item>,
    /// Pairs of nodes below which boxes are stale.
    pub(crate) waiting: Vec<Item>,
    /// Pairs of leaves that are to be tested.
    pub(crate) leaves: Vec<Item>,
    /// Wide nodes that are stale, and leaves that were reached, by the numbers of trees.
    pub(crate) stale: Vec<DirtySet>,
    pub(crate) reached: Vec<DirtySet>,
    /// Pairs of nodes and candidates that were looked at, by the numbers of pairs.
    pub(crate) looked_at: Vec<(u32, [u64; 2])>,
}

impl Share {
    /// Takes what a task has noted of the two trees.
    pub(super) fn note(sets: &mut Vec<DirtySet>, noted: &mut [DirtySet; 2], trees: [u32; 2]) {
        for (tree, noted) in trees.into_iter().zip(noted) {
            if !noted.is_empty() {
                let tree = tree as usize;
                if sets.len() <= tree {
                    sets.resize_with(tree + 1, DirtySet::default);
                }
                sets[tree].take(noted);
            }
        }
    }
}

held!(Share: todo[], waiting[], leaves[], stale, reached, looked_at[]);
