//! The loop of the traversal, the same for two trees and for one.

use crate::pairs::{Candidate, LeafPair, NodePair};
use crate::statistics::Statistics;
use std::ops::ControlFlow;

/// The first batch is one pair, and batches double: a visitor that stops at the first pair has then made few boxes that it did
/// not need (on the two spheres from contact on, 16 instead made 1,841 boxes where this makes 520, and took 1.8 times as long),
/// and one that wants all pairs loses nothing.
const FIRST_BATCH: usize = 1;
/// The longest batch: long enough that changing between the phases costs nothing, short enough that its groups stay in cache.
const LONGEST_BATCH: usize = 1024;
/// Candidates are decided when there are so many, even within a pair of leaves: this bounds memory whatever the leaf size is.
const MOST_CANDIDATES: usize = 4096;

/// What is descended: two trees, or one against itself.
pub(crate) trait Meeting {
    /// Where to begin; the boxes of these nodes are true and overlap.
    fn start(&self) -> NodePair;
    /// Makes true what [`Meeting::expand`] will read.
    fn reach(&mut self, pair: NodePair, scratch: &mut Vec<u32>, statistics: &mut Statistics);
    /// Pairs of children that overlap, and of leaves.
    fn expand(&self, pair: NodePair, nodes: &mut Vec<NodePair>, leaves: &mut Vec<LeafPair>);
    /// Makes true what [`Meeting::candidates`] will read.
    fn reach_leaves(&mut self, pair: LeafPair, statistics: &mut Statistics);
    /// How many blocks of triangles the first leaf has: candidates come a block at a time.
    fn blocks(&self, pair: LeafPair) -> usize;
    /// Triangles of a block of the first leaf and of the second leaf whose boxes overlap.
    fn candidates(&self, pair: LeafPair, block: usize, candidates: &mut Vec<Candidate>);
    /// Whether two triangles intersect, and if so, the caller's numbers of them.
    fn decide(&self, candidate: Candidate, statistics: &mut Statistics) -> Option<[u32; 2]>;
}

/// Buffers, kept from query to query.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    pub(crate) groups: Vec<u32>,
    nodes: Vec<NodePair>,
    batch: Vec<NodePair>,
    leaves: Vec<LeafPair>,
    candidates: Vec<Candidate>,
}

/// Shows the visitor every intersecting pair, until it breaks. The order is deterministic, not sorted.
pub(crate) fn descend(
    meeting: &mut impl Meeting,
    scratch: &mut Scratch,
    statistics: &mut Statistics,
    visit: &mut dyn FnMut([u32; 2]) -> ControlFlow<()>,
) -> ControlFlow<()> {
    let Scratch {
        groups,
        nodes,
        batch,
        leaves,
        candidates,
    } = scratch;
    nodes.clear();
    nodes.push(meeting.start());
    let mut longest = FIRST_BATCH;
    while !nodes.is_empty() {
        batch.clear();
        batch.extend(nodes.drain(nodes.len().saturating_sub(longest)..));
        longest = (longest * 2).min(LONGEST_BATCH);
        statistics.node_pairs += batch.len() as u64;

        for &pair in &*batch {
            meeting.reach(pair, groups, statistics);
        }
        leaves.clear();
        for &pair in &*batch {
            meeting.expand(pair, nodes, leaves);
        }

        for &pair in &*leaves {
            meeting.reach_leaves(pair, statistics);
        }
        candidates.clear();
        for &pair in &*leaves {
            for block in 0..meeting.blocks(pair) {
                meeting.candidates(pair, block, candidates);
                if candidates.len() >= MOST_CANDIDATES {
                    decide(meeting, candidates, statistics, visit)?;
                }
            }
        }
        decide(meeting, candidates, statistics, visit)?;
    }
    ControlFlow::Continue(())
}

/// Decides the candidates and empties their list.
fn decide(
    meeting: &impl Meeting,
    candidates: &mut Vec<Candidate>,
    statistics: &mut Statistics,
    visit: &mut dyn FnMut([u32; 2]) -> ControlFlow<()>,
) -> ControlFlow<()> {
    for candidate in candidates.drain(..) {
        statistics.candidate_pairs += 1;
        if let Some(pair) = meeting.decide(candidate, statistics) {
            statistics.pairs += 1;
            visit(pair)?;
        }
    }
    ControlFlow::Continue(())
}
