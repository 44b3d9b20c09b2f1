//! A branch of a descent: some of its pairs of nodes, and all that comes of them.
//!
//! A branch goes on by itself, depth first, on a stack and lists of its own, for as long as the boxes it asks for are true.

use super::Side;
use super::descent::Meeting;
use super::expand::{Found, expand};
use super::meet::{Meet, Place, block_pairs};
use crate::kernels::Level;
use crate::pairs::{BlockPair, NodePair};
use crate::tree::Below;
use crate::update::Noted;
use fearless_simd::dispatch;

/// Pairs of blocks that meet before a branch looks at what it has found,
const BLOCKS_BEFORE_LOOK: usize = 128;
/// and how many hits are enough: what all branches have found and not yet shown is to take little memory.
const MOST_HITS: usize = 2048;

/// Buffers, kept from query to query.
#[derive(Debug, Default)]
pub(super) struct Branch {
    /// Taken from the stack, to be expanded when all below them is true.
    batch: Vec<NodePair>,
    /// Groups below the batch that are not true, of either tree.
    pub(super) untrue: [Noted; 2],
    /// The stack, and pairs of leaves that are to meet.
    pub(super) found: Found,
    /// The leaves in these pairs, of either tree.
    pub(super) wanted: [Noted; 2],
    /// Up to where these have met.
    place: Place,
    blocks: Vec<BlockPair>,
    /// What intersects among those that met last.
    pub(super) met: Meet,
}

/// How far a branch goes before it looks up.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stride {
    /// Pairs of nodes that are taken at once.
    pub(super) nodes: usize,
    /// Pairs of leaves that are enough,
    pub(super) leaves: usize,
    /// pairs of their blocks that are when they have met,
    pub(super) met: usize,
    /// and pairs of nodes on the stack that are.
    pub(super) stack: usize,
}

/// Whether all boxes are true, so that branches need not wait for any, and pairs of leaves can meet as soon as they are found.
pub(super) fn are_free<const N: usize, S>(sides: [&Side<'_, N, S>; 2]) -> bool {
    sides.iter().all(|Side { tree, shape, .. }| {
        tree.complete == shape.epoch && tree.leaves.complete == shape.epoch
    })
}

impl Branch {
    /// Forgets what it was about.
    pub(super) fn clear(&mut self) {
        self.batch.clear();
        self.untrue.iter_mut().for_each(Noted::clear);
        self.found.clear();
        self.wanted.iter_mut().for_each(Noted::clear);
        self.place = Place::default();
    }

    /// Whether no pair of nodes is left.
    pub(super) fn is_done(&self) -> bool {
        self.batch.is_empty() && self.found.nodes.is_empty()
    }

    /// Goes on until it asks for boxes that are not true, has found enough, or nothing is left. What it asked for before is true now.
    /// Where it is free, leaves meet on the way.
    pub(super) fn advance<const N: usize, M: Meeting<N>>(
        &mut self,
        level: Level,
        meeting: &M,
        stride: Stride,
    ) {
        self.found.node_pairs = 0;
        self.met.clear();
        if !are_free(meeting.sides()) {
            return self.descend(level, meeting, stride);
        }
        let mut met = 0;
        while met < stride.met && self.met.hits.len() < MOST_HITS {
            if self.all_met() {
                self.forget_leaves();
                self.descend(level, meeting, stride);
            }
            let blocks = stride.leaves.min(BLOCKS_BEFORE_LOOK);
            self.meet::<N, M>(level, meeting, blocks);
            met += blocks;
            let stack = self.found.nodes.len();
            if self.all_met() && (stack == 0 || stack >= stride.stack) {
                return;
            }
        }
    }

    /// Goes on until it asks for boxes that are not true, has found enough, or no pair of nodes is left.
    fn descend<const N: usize, M: Meeting<N>>(
        &mut self,
        level: Level,
        meeting: &M,
        stride: Stride,
    ) {
        let sides = meeting.sides();
        let trees = sides.map(|side| &*side.tree);
        let free = are_free(sides);
        let complete = sides
            .iter()
            .all(|side| side.tree.complete == side.shape.epoch);
        loop {
            let (batch, found) = (&self.batch, &mut self.found);
            dispatch!(level, i => if M::ITSELF {
                expand::<_, N, true>(i, trees, batch, found);
            } else {
                expand::<_, N, false>(i, trees, batch, found);
            });
            self.batch.clear();
            for (noted, wanted) in self.wanted.iter_mut().zip(&mut self.found.wanted) {
                let asked_for = if free { &[] } else { wanted.as_slice() };
                for leaves in asked_for {
                    noted.note_eight(leaves.first, leaves.lanes);
                }
                wanted.clear();
            }
            let stack = self.found.nodes.len();
            if stack == 0 || stack >= stride.stack || self.found.leaves.len() >= stride.leaves {
                return;
            }
            self.found.nodes.take_last(stride.nodes, &mut self.batch);
            if !complete && self.asks_for_untrue(sides) {
                return;
            }
        }
    }

    /// Notes the groups below the batch that are not true; whether there are any.
    fn asks_for_untrue<const N: usize, S>(&mut self, sides: [&Side<'_, N, S>; 2]) -> bool {
        for pair in &self.batch {
            for which in 0..2 {
                let Side { tree, shape, .. } = sides[which];
                if let Below::Group(below) = tree.child(pair[which]).below()
                    && tree.groups[below as usize].epoch != shape.epoch
                {
                    self.untrue[which].note(below);
                }
            }
        }
        !self.untrue.iter().all(Noted::is_empty)
    }

    /// Whether all pairs of leaves have met.
    pub(super) fn all_met(&self) -> bool {
        self.place.pair == self.found.leaves.len()
    }

    /// Lets pairs of leaves meet until all have, or many, or enough was found.
    pub(super) fn meet_some<const N: usize, M: Meeting<N>>(
        &mut self,
        level: Level,
        meeting: &M,
        stride: Stride,
    ) {
        self.met.clear();
        let blocks = stride.leaves.min(BLOCKS_BEFORE_LOOK);
        let mut met = 0;
        while met < stride.met && self.met.hits.len() < MOST_HITS && !self.all_met() {
            self.meet(level, meeting, blocks);
            met += blocks;
        }
    }

    /// Lets pairs of leaves meet, or the next so many of their blocks. The boxes of the triangles in them are true.
    fn meet<const N: usize, M: Meeting<N>>(&mut self, level: Level, meeting: &M, blocks: usize) {
        let sides = meeting.sides();
        let trees = sides.map(|side| &side.tree.leaves);
        let leaves = self.found.leaves.as_slice();
        let place = &mut self.place;
        let pairs = if trees.iter().all(|leaves| leaves.are_blocks()) {
            let end = leaves.len().min(place.pair + blocks);
            &leaves[std::mem::replace(&mut place.pair, end)..end]
        } else {
            *place = if M::ITSELF {
                block_pairs::<true>(trees, leaves, *place, blocks, &mut self.blocks)
            } else {
                block_pairs::<false>(trees, leaves, *place, blocks, &mut self.blocks)
            };
            &self.blocks
        };
        if M::ITSELF {
            self.met.meet::<N, M::Coordinate, true>(level, sides, pairs);
        } else {
            self.met
                .meet::<N, M::Coordinate, false>(level, sides, pairs);
        }
        let Meet { hits, named, .. } = &mut self.met;
        let new = &hits.as_slice()[named.len()..];
        named.extend(new.iter().map(|&hit| meeting.name(hit)));
    }

    /// Forgets the pairs of leaves, all of which have met.
    pub(super) fn forget_leaves(&mut self) {
        self.found.clear_leaves();
        self.place = Place::default();
    }
}
