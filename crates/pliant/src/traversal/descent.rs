//! The loop of the traversal, the same for two trees and for one.

use super::Side;
use super::branch::{Branch, Stride, are_free};
use crate::exec::Threads;
use crate::geometry::{Scalar, Shape};
use crate::kernels::bits::Batch;
use crate::pairs::{Candidate, NodePair};
use crate::statistics::Statistics;
use crate::tree::{NodeId, Tree};
use crate::update::{Noted, Updates};
use std::ops::ControlFlow;

/// How much of what intersects a query wants.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Wanted {
    /// All of it.
    All,
    /// As much as its visitor looks at, which may be the first pair.
    #[default]
    UntilBreak,
}

/// Of a visitor, the first batch is one pair, and batches double: if it stops at the first pair, few boxes were made that it did
/// not need (on the two spheres from contact on, 16 instead made 1,841 boxes where this makes 520, and took 1.8 times as long).
const FIRST_BATCH: usize = 1;
/// The most pairs of nodes that a branch takes at once: short enough that their groups stay in cache.
const LONGEST_BATCH: usize = 256;
/// So many pairs of leaves of a branch, or a few more, are enough to let them meet,
const MOST_LEAVES: usize = 512;
/// (more where threads share branches: each has a cache of its own, and all wait for the last)
const MOST_LEAVES_SHARED: usize = 2048;
/// and the most pairs of their blocks before their hits are shown. This bounds memory whatever the leaf size is.
const MOST_BEFORE_SHOWN: usize = 8192;
/// As soon as there are so many pairs of nodes, branches share them, whatever the number of threads is:
const ENOUGH: usize = 128;
/// so many branches if boxes will be made in turn with them, so that all are at work in about one place,
const BRANCHES: usize = 8;
/// (and so many a thread, if that is more, where all pairs are wanted: the same are found and the same boxes made in any order)
const BRANCHES_A_THREAD: usize = 2;
/// or else so many, so that none waits long for another.
const FREE_BRANCHES: usize = 32;
/// So many pairs of nodes are dealt at once.
const DEALT: usize = 512;

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
    /// Lists of groups, for the update.
    pub(crate) groups: [Vec<u32>; 2],
    /// Groups or leaves of one tree that are to be made true, of all branches together.
    pub(crate) reached: Noted,
    branches: Vec<Branch>,
    /// How many of them, from the first on, are in use.
    used: usize,
    /// Pairs of nodes that were not dealt yet, and those that are being dealt.
    reserve: Batch<NodePair>,
    dealt: Vec<NodePair>,
    wanted: Wanted,
    sizes: Sizes,
    /// The pair at which a query stopped, in tree order.
    pub(crate) broke_at: Option<Candidate>,
}

/// How many pairs a branch takes at once. For a visitor they double over a query, whatever it has asked before.
#[derive(Clone, Copy, Debug)]
struct Sizes {
    nodes: usize,
    blocks: usize,
}

impl Sizes {
    fn new(wanted: Wanted) -> Self {
        let [nodes, blocks] = match wanted {
            Wanted::All => [LONGEST_BATCH, MOST_BEFORE_SHOWN],
            Wanted::UntilBreak => [FIRST_BATCH; 2],
        };
        Self { nodes, blocks }
    }

    /// Of at most so many pairs of leaves.
    fn stride(&self, leaves: usize) -> Stride {
        Stride {
            nodes: self.nodes,
            leaves: self.blocks.min(leaves),
            met: self.blocks,
            stack: usize::MAX,
        }
    }

    fn double_nodes(&mut self) {
        self.nodes = (2 * self.nodes).min(LONGEST_BATCH);
    }

    fn double_blocks(&mut self) {
        self.blocks = (2 * self.blocks).min(MOST_BEFORE_SHOWN);
    }
}

impl Default for Sizes {
    fn default() -> Self {
        Self::new(Wanted::default())
    }
}

impl Scratch {
    /// At the beginning of every query.
    pub(crate) fn begin(&mut self, wanted: Wanted) {
        self.wanted = wanted;
        self.sizes = Sizes::new(wanted);
    }
}

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
    let Scratch {
        groups,
        reached,
        branches,
        used,
        reserve,
        dealt,
        wanted,
        sizes,
        broke_at,
    } = scratch;
    // Some are left as they were if a visitor stopped, or panicked.
    branches[..*used].iter_mut().for_each(Branch::clear);
    reserve.clear();
    *used = 1;
    let are_free = are_free(meeting.sides());
    let (most_branches, most_leaves) = shares(are_free, *wanted, updates.threads);
    branches.resize_with(most_branches.max(branches.len()), Branch::default);
    branches[0].found.nodes.push([NodeId::ROOT; 2]);
    loop {
        if is_to_be_dealt(&branches[..*used], reserve) {
            *used = most_branches;
            deal(&mut branches[..*used], reserve, dealt);
        }
        let branches = &mut branches[..*used];
        let mut stride = sizes.stride(most_leaves);
        if branches.len() == 1 {
            stride.stack = ENOUGH;
        }
        updates.threads.run(branches, |_, branch| {
            branch.advance(updates.level, meeting, stride);
        });
        sizes.double_nodes();
        for branch in &*branches {
            statistics.node_pairs += branch.found.node_pairs;
        }
        let working = branches.iter().filter(|branch| !branch.is_done()).count();
        let mut last = reserve.is_empty() && working == 0;
        let mut shown = ControlFlow::Continue(());
        if are_free {
            last &= branches.iter().all(Branch::all_met);
            shown = show_hits(branches, statistics, show);
            sizes.double_blocks();
        } else {
            reach_groups(updates, meeting, branches, reached, groups, statistics);
            let leaves = |branch: &Branch| branch.found.leaves.len();
            let leaves = branches.iter().map(leaves).sum::<usize>();
            if last || leaves >= stride.leaves * working.max(1) {
                reach_leaves(updates, meeting, branches, reached, statistics);
                if *wanted == Wanted::All && updates.threads.are_many() {
                    // The same are found in any order.
                    even_out(branches);
                }
                while shown.is_continue() && !branches.iter().all(Branch::all_met) {
                    meet_leaves(updates, meeting, branches, sizes.stride(most_leaves));
                    sizes.double_blocks();
                    shown = show_hits(branches, statistics, show);
                }
                branches.iter_mut().for_each(Branch::forget_leaves);
            }
        }
        if let ControlFlow::Break(hit) = shown {
            *broke_at = Some(hit);
            return ControlFlow::Break(());
        }
        if last {
            return ControlFlow::Continue(());
        }
    }
}

/// How many branches a query is dealt to, and how many pairs of leaves of one are enough to let them meet.
fn shares(are_free: bool, wanted: Wanted, threads: &Threads) -> (usize, usize) {
    if are_free {
        (FREE_BRANCHES, MOST_LEAVES)
    } else if wanted == Wanted::All && threads.are_many() {
        let for_threads = BRANCHES_A_THREAD * threads.count();
        (BRANCHES.max(for_threads), MOST_LEAVES_SHARED)
    } else {
        (BRANCHES, MOST_LEAVES)
    }
}

/// Whether some branch has nothing left that another could give.
fn is_to_be_dealt(branches: &[Branch], reserve: &Batch<NodePair>) -> bool {
    let stack = |branch: &Branch| branch.found.nodes.len();
    let all: usize = branches.iter().map(stack).sum();
    if branches.len() == 1 {
        return all >= ENOUGH;
    }
    (!reserve.is_empty() || all >= branches.len()) && branches.iter().any(Branch::is_done)
}

/// Deals the last of all pairs to all branches, in order and in equal parts.
fn deal(branches: &mut [Branch], reserve: &mut Batch<NodePair>, dealt: &mut Vec<NodePair>) {
    for branch in &mut *branches {
        reserve.extend(branch.found.nodes.as_slice());
        branch.found.nodes.clear();
    }
    reserve.take_last(DEALT, dealt);
    let each = dealt.len().div_ceil(branches.len());
    for (branch, pairs) in branches.iter_mut().zip(dealt.chunks(each)) {
        branch.found.nodes.extend(pairs);
    }
}

/// Gives branches that have found few pairs of leaves some of those of others that have found many.
fn even_out(branches: &mut [Branch]) {
    let leaves = |branch: &Branch| branch.found.leaves.len();
    let all: usize = branches.iter().map(leaves).sum();
    let each = all.div_ceil(branches.len());
    let mut more = Vec::new();
    for branch in &mut *branches {
        let leaves = &mut branch.found.leaves;
        more.extend_from_slice(leaves.as_slice().get(each..).unwrap_or_default());
        leaves.truncate(each);
    }
    for branch in branches {
        let rest = more.len().saturating_sub(each - leaves(branch));
        branch.found.leaves.extend(&more[rest..]);
        more.truncate(rest);
    }
}

/// Makes true the groups that branches ask for.
fn reach_groups<const N: usize, M: Meeting<N>>(
    updates: Updates,
    meeting: &mut M,
    branches: &mut [Branch],
    reached: &mut Noted,
    lists: &mut [Vec<u32>; 2],
    statistics: &mut Statistics,
) {
    for which in 0..2 {
        for branch in &mut *branches {
            reached.take(&mut branch.untrue[which]);
        }
        // Of one tree, both are noted before.
        if (!M::ITSELF || which == 1) && !reached.is_empty() {
            let (tree, shape) = meeting.tree_mut(which);
            updates.reach(tree, shape, reached, lists, statistics);
        }
    }
}

/// Makes true the boxes of the triangles in leaves that are to meet.
fn reach_leaves<const N: usize, M: Meeting<N>>(
    updates: Updates,
    meeting: &mut M,
    branches: &mut [Branch],
    reached: &mut Noted,
    statistics: &mut Statistics,
) {
    for which in 0..2 {
        for branch in &mut *branches {
            reached.take(&mut branch.wanted[which]);
        }
        if !M::ITSELF || which == 1 {
            let (tree, shape) = meeting.tree_mut(which);
            updates.reach_leaves(tree, shape, reached, statistics);
        }
    }
}

/// Lets the next pairs of leaves meet.
fn meet_leaves<const N: usize, M: Meeting<N>>(
    updates: Updates,
    meeting: &M,
    branches: &mut [Branch],
    stride: Stride,
) {
    updates.threads.run(branches, |_, branch| {
        branch.meet_some(updates.level, meeting, stride);
    });
}

/// Shows what intersects among the pairs that have met; breaks with the pair at which `show` does.
fn show_hits(
    branches: &[Branch],
    statistics: &mut Statistics,
    show: Show,
) -> ControlFlow<Candidate> {
    for branch in branches {
        *statistics += branch.met.statistics;
    }
    for branch in branches {
        if let ControlFlow::Break(place) = show(&branch.met.named) {
            return ControlFlow::Break(branch.met.hits.as_slice()[place]);
        }
    }
    ControlFlow::Continue(())
}
