//! The loop of the traversal, the same for two trees and for one.

use super::Side;
use super::expand::{candidates, expand};
use crate::geometry::Scalar;
use crate::kernels::{Level, bits::Batch};
use crate::narrow_phase::{self, Undecided};
use crate::pairs::{Candidate, LeafPair, NodePair};
use crate::statistics::Statistics;
use crate::tree::NodeId;
use fearless_simd::dispatch;
use std::ops::ControlFlow;

/// The first batch is one pair, and batches double: a visitor that stops at the first pair has then made few boxes that it did
/// not need (on the two spheres from contact on, 16 instead made 1,841 boxes where this makes 520, and took 1.8 times as long),
/// and one that wants all pairs loses nothing.
const FIRST_BATCH: usize = 1;
/// The longest batch: long enough that changing between the phases costs nothing, short enough that its groups stay in cache.
const LONGEST_BATCH: usize = 1024;
/// Candidates are decided when there are so many, even within a pair of leaves, which bounds memory whatever the leaf size is.
/// It begins with one block of triangles against another and doubles, like batches.
const MOST_CANDIDATES: usize = 4096;

/// What is descended: two trees, or one against itself.
pub(crate) trait Meeting<const N: usize> {
    /// Of the positions.
    type Coordinate: Scalar;
    /// Whether it is one tree against itself.
    const ITSELF: bool;
    /// Both bodies, or the one twice.
    fn sides(&self) -> [&Side<'_, N, Self::Coordinate>; 2];
    /// Makes true what is below the nodes of a batch.
    fn reach(
        &mut self,
        level: Level,
        batch: &[NodePair],
        groups: &mut [Vec<u32>; 2],
        statistics: &mut Statistics,
    );
    /// The caller's numbers of two triangles.
    fn name(&self, candidate: Candidate) -> [u32; 2];
}

/// Buffers, kept from query to query.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    pub(crate) groups: [Vec<u32>; 2],
    nodes: Batch<NodePair>,
    batch: Vec<NodePair>,
    leaves: Vec<LeafPair>,
    candidates: Batch<Candidate>,
    undecided: Batch<Undecided>,
    hits: Vec<Candidate>,
    /// The pair at which a visitor broke, in tree order.
    pub(crate) broke_at: Option<Candidate>,
}

/// Shows the visitor every intersecting pair, until it breaks. The order is deterministic, not sorted.
pub(crate) fn descend<const N: usize, M: Meeting<N>>(
    level: Level,
    meeting: &mut M,
    scratch: &mut Scratch,
    statistics: &mut Statistics,
    visit: &mut dyn FnMut([u32; 2]) -> ControlFlow<()>,
) -> ControlFlow<()> {
    let Scratch {
        groups,
        nodes,
        batch,
        leaves,
        candidates: found,
        undecided,
        hits,
        broke_at,
    } = scratch;
    let mut decide = |meeting: &M, found: &mut Batch<Candidate>, statistics: &mut Statistics| {
        let shapes = meeting.sides().map(|side| &side.shape);
        narrow_phase::decide(level, found, shapes, undecided, hits, statistics);
        found.clear();
        hits.iter().try_for_each(|&hit| {
            let flow = visit(meeting.name(hit));
            if flow.is_break() {
                *broke_at = Some(hit);
            }
            flow
        })
    };
    nodes.clear();
    found.clear();
    nodes.push([NodeId::ROOT; 2]);
    let (mut longest, mut enough) = (FIRST_BATCH, 1);
    while nodes.len() > 0 {
        nodes.take_last(longest, batch);
        longest = (longest * 2).min(LONGEST_BATCH);
        statistics.node_pairs += batch.len() as u64;

        meeting.reach(level, batch, groups, statistics);
        leaves.clear();
        let trees = meeting.sides().map(|side| &*side.tree);
        dispatch!(level, i => if M::ITSELF {
            expand::<_, N, true>(i, trees, batch, nodes, leaves);
        } else {
            expand::<_, N, false>(i, trees, batch, nodes, leaves);
        });
        let (mesh, trees) = (meeting.sides()[0].mesh, trees.map(|tree| &tree.leaves));
        let mut next = (0, 0, 0);
        while next.0 < leaves.len() {
            next = dispatch!(level, i => if M::ITSELF {
                candidates::<_, true>(i, trees, mesh, leaves, next, found, enough)
            } else {
                candidates::<_, false>(i, trees, mesh, leaves, next, found, enough)
            });
            enough = (2 * enough).min(MOST_CANDIDATES);
            decide(meeting, found, statistics)?;
        }
    }
    ControlFlow::Continue(())
}
