//! The loop of the traversal, the same for two trees and for one.

use super::Side;
use super::expand::{Found, expand};
use super::meet::{Meet, Place, block_pairs};
use crate::geometry::{Scalar, Shape};
use crate::pairs::{BlockPair, Candidate, NodePair};
use crate::statistics::Statistics;
use crate::tree::{Below, NodeId, Tree};
use crate::update::{Reached, Updates};
use fearless_simd::dispatch;
use std::ops::ControlFlow;

/// The first batch is one pair, and batches double: a visitor that stops at the first pair has then made few boxes that it did
/// not need (on the two spheres from contact on, 16 instead made 1,841 boxes where this makes 520, and took 1.8 times as long),
/// and one that wants all pairs loses nothing.
const FIRST_BATCH: usize = 1;
/// The longest batch of pairs of nodes: long enough for several threads, short enough that its groups stay in cache.
const LONGEST_BATCH: usize = 2048;
/// The most pairs of blocks that meet before their hits are shown: this bounds memory whatever the leaf size is.
const MOST_BLOCKS: usize = 4096;
/// Pairs of nodes in a job, and pairs of blocks in a job: some tens of microseconds of work.
const EXPAND_JOB: usize = 512;
const MEET_JOB: usize = 256;

/// What is descended: two trees, or one against itself.
pub(crate) trait Meeting<const N: usize>: Sync {
    /// Of the positions.
    type Coordinate: Scalar;
    /// Whether it is one tree against itself.
    const ITSELF: bool;
    /// Both bodies, or the one twice.
    fn sides(&self) -> [&Side<'_, N, Self::Coordinate>; 2];
    /// The first or the second tree, and the shape of its body.
    fn tree_mut(&mut self, which: usize) -> (&mut Tree<N>, &Shape<'_, Self::Coordinate>);
    /// The caller's numbers of two triangles.
    fn name(&self, candidate: Candidate) -> [u32; 2];
}

/// Buffers, kept from query to query.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    /// Of refreshing ahead.
    pub(crate) groups: Vec<u32>,
    reached: Reached,
    batch: Vec<NodePair>,
    untrue: Vec<Untrue>,
    /// The stack, and pairs of leaves that are to meet.
    found: Found,
    expanded: Vec<Found>,
    blocks: Vec<BlockPair>,
    met: Vec<Meet>,
    sizes: Sizes,
    /// The pair at which a query stopped, in tree order.
    pub(crate) broke_at: Option<Candidate>,
}

/// How many pairs are taken at once. They double over a query, whatever it has asked before.
#[derive(Clone, Copy, Debug)]
struct Sizes {
    nodes: usize,
    blocks: usize,
}

impl Default for Sizes {
    fn default() -> Self {
        Self {
            nodes: FIRST_BATCH,
            blocks: FIRST_BATCH,
        }
    }
}

impl Scratch {
    /// At the beginning of every query.
    pub(crate) fn begin(&mut self) {
        self.sizes = Sizes::default();
    }
}

/// What a job of looking found not true in either tree, some perhaps more than once.
type Untrue = [Vec<u32>; 2];

/// What is shown every pair once, some at a time, as the caller numbers triangles, until it breaks with the place of the one at
/// which it stops.
pub(crate) type Show<'s> = &'s mut dyn FnMut(&[[u32; 2]]) -> ControlFlow<usize>;

/// Shows every intersecting pair, until `show` breaks. The order is deterministic, not sorted.
pub(crate) fn descend<const N: usize, M: Meeting<N>>(
    updates: Updates,
    meeting: &mut M,
    scratch: &mut Scratch,
    statistics: &mut Statistics,
    show: Show,
) -> ControlFlow<()> {
    scratch.found.clear();
    scratch.found.nodes.push([NodeId::ROOT; 2]);
    loop {
        let Scratch {
            found,
            batch,
            sizes,
            ..
        } = scratch;
        found.nodes.take_last(sizes.nodes, batch);
        sizes.nodes = (sizes.nodes * 2).min(LONGEST_BATCH);
        reach_groups(updates, meeting, scratch, statistics);
        expand_batch(updates, meeting, scratch);
        let straight = std::mem::take(&mut scratch.found.straight);
        statistics.node_pairs += scratch.batch.len() as u64 + straight;

        let last = scratch.found.nodes.is_empty();
        if last || scratch.found.leaves.len() >= scratch.sizes.blocks {
            meet_leaves(updates, meeting, scratch, statistics, show)?;
        }
        if last {
            return ControlFlow::Continue(());
        }
    }
}

/// Makes true what is below the nodes of a batch.
fn reach_groups<const N: usize, M: Meeting<N>>(
    updates: Updates,
    meeting: &mut M,
    scratch: &mut Scratch,
    statistics: &mut Statistics,
) {
    let Scratch {
        batch,
        untrue,
        reached,
        ..
    } = scratch;
    let sides = meeting.sides();
    if sides
        .iter()
        .all(|side| side.tree.complete == side.shape.epoch)
    {
        return;
    }
    let jobs = in_use(untrue, batch.len().div_ceil(EXPAND_JOB));
    updates.threads.run(jobs, |number, found| {
        found.iter_mut().for_each(Vec::clear);
        for pair in part(batch, number, EXPAND_JOB) {
            for which in 0..2 {
                let Side { tree, shape, .. } = sides[which];
                if let Below::Group(below) = tree.child(pair[which]).below()
                    && tree.groups[below as usize].epoch != shape.epoch
                {
                    found[which].push(below);
                }
            }
        }
    });
    for which in 0..2 {
        for &group in jobs.iter().flat_map(|found| &found[which]) {
            reached.note(group);
        }
        // Of one tree, both are noted before.
        if !M::ITSELF || which == 1 {
            let (tree, shape) = meeting.tree_mut(which);
            updates.reach(tree, shape, reached, statistics);
        }
    }
}

/// Makes true the boxes of the triangles in leaves that are to meet.
fn reach_leaves<const N: usize, M: Meeting<N>>(
    updates: Updates,
    meeting: &mut M,
    scratch: &mut Scratch,
    statistics: &mut Statistics,
) {
    let Scratch { found, reached, .. } = scratch;
    for which in 0..2 {
        for wanted in found.wanted[which].as_slice() {
            reached.note_eight(wanted.first, wanted.lanes);
        }
        if !M::ITSELF || which == 1 {
            let (tree, shape) = meeting.tree_mut(which);
            updates.reach_leaves(tree, shape, reached, statistics);
        }
    }
}

/// Pairs of children onto the stack, pairs of leaves onto their list.
fn expand_batch<const N: usize, M: Meeting<N>>(
    updates: Updates,
    meeting: &M,
    scratch: &mut Scratch,
) {
    let trees = meeting.sides().map(|side| &*side.tree);
    let expand_some = |batch: &[NodePair], found: &mut Found| {
        dispatch!(updates.level, i => if M::ITSELF {
            expand::<_, N, true>(i, trees, batch, found);
        } else {
            expand::<_, N, false>(i, trees, batch, found);
        });
    };
    let Scratch {
        batch,
        found,
        expanded,
        ..
    } = scratch;
    if batch.len() <= EXPAND_JOB || !updates.threads.are_many() {
        return expand_some(batch, found);
    }
    let jobs = in_use(expanded, batch.len().div_ceil(EXPAND_JOB));
    updates.threads.run(jobs, |number, found| {
        found.clear();
        expand_some(part(batch, number, EXPAND_JOB), found);
    });
    for job in &*jobs {
        found.append(job);
    }
}

/// Decides all pairs of leaves on the list, and shows what intersects.
fn meet_leaves<const N: usize, M: Meeting<N>>(
    updates: Updates,
    meeting: &mut M,
    scratch: &mut Scratch,
    statistics: &mut Statistics,
    show: Show,
) -> ControlFlow<()> {
    reach_leaves(updates, meeting, scratch, statistics);
    let Scratch {
        found,
        blocks,
        met,
        sizes,
        broke_at,
        ..
    } = scratch;
    let sides = meeting.sides();
    let trees = sides.map(|side| &side.tree.leaves);
    let leaves = found.leaves.as_slice();
    let mut place = Place::default();
    while place.pair < leaves.len() {
        let pairs = if trees.iter().all(|leaves| leaves.are_blocks()) {
            let end = leaves.len().min(place.pair + sizes.blocks);
            &leaves[std::mem::replace(&mut place.pair, end)..end]
        } else {
            place = if M::ITSELF {
                block_pairs::<true>(trees, leaves, place, sizes.blocks, blocks)
            } else {
                block_pairs::<false>(trees, leaves, place, sizes.blocks, blocks)
            };
            &*blocks
        };
        sizes.blocks = (sizes.blocks * 2).min(MOST_BLOCKS);
        let jobs = in_use(met, pairs.len().div_ceil(MEET_JOB));
        updates.threads.run(jobs, |number, job| {
            let pairs = part(pairs, number, MEET_JOB);
            if M::ITSELF {
                job.meet::<N, M::Coordinate, true>(updates.level, sides, pairs);
            } else {
                job.meet::<N, M::Coordinate, false>(updates.level, sides, pairs);
            }
            job.named.clear();
            job.named
                .extend(job.hits.as_slice().iter().map(|&hit| meeting.name(hit)));
        });
        for job in &*jobs {
            *statistics += job.statistics;
        }
        for job in &*jobs {
            if let ControlFlow::Break(place) = show(&job.named) {
                *broke_at = Some(job.hits.as_slice()[place]);
                return ControlFlow::Break(());
            }
        }
    }
    found.clear_leaves();
    ControlFlow::Continue(())
}

/// The first `count` of some jobs, made if there are fewer.
fn in_use<J: Default>(jobs: &mut Vec<J>, count: usize) -> &mut [J] {
    if jobs.len() < count {
        jobs.resize_with(count, J::default);
    }
    &mut jobs[..count]
}

/// The part of a list that a job does.
fn part<T>(list: &[T], number: usize, size: usize) -> &[T] {
    &list[number * size..list.len().min((number + 1) * size)]
}
