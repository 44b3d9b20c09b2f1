//! Main loop of the traversal, for two trees or one, and for every kind of query.

use super::context::{Context, TaskLimits};
use super::task::{Tasks, are_free, left_out};
use super::tree_pair::TreePair;
use crate::held::{self, held};
use crate::ids::{NodeId, WideNodeId};
use crate::kernels::{Buffer, Coordinate};
use crate::queries::Needs;
use crate::statistics::Statistics;
use crate::tree::NodePair;
use crate::update::{DirtySet, Refit};
use std::ops::ControlFlow;

/// First batch for a visitor, in pairs of nodes; batches double. If it stops at the first hit, few
/// boxes were made that it did not need. On the two spheres from contact on, 16 made 1,841 boxes
/// where 1 makes 520, and took 1.8 times as long.
const FIRST_BATCH: usize = 1;
/// Most pairs of nodes that a task takes at once: few enough that their wide nodes stay in cache.
const LONGEST_BATCH: usize = 256;
/// Pairs of leaves of a task from which it tests them, after the batch at hand.
const MOST_LEAF_PAIRS: usize = 512;
/// Most pairs of blocks, or a few more, that a task tests before a visitor is shown hits. This
/// bounds memory for any leaf size.
const MOST_BEFORE_SHOWN: usize = 8192;
/// Pairs of nodes from which they are distributed to several tasks, for any number of threads. Not
/// used where one thread wants all hits and waits for no boxes.
const ENOUGH_TO_DISTRIBUTE: usize = 128;
/// Number of tasks where boxes may be stale: few, so that all work in about one place of the trees.
const TASKS: usize = 8;
/// Number of tasks where all boxes are known to be valid: many, so that none waits long for
/// another.
const FREE_TASKS: usize = 32;
/// Fewest leaves of a task that tests them with their neighbours: fewer are not worth a task.
const FEWEST_LEAVES: usize = 64;
/// Most pairs of nodes that are distributed at once.
const DISTRIBUTED: usize = 512;

/// Buffers of a descent, kept from query to query.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    /// Lists of wide nodes, for the update.
    pub(crate) wide_nodes: [Vec<WideNodeId>; 2],
    /// Wide nodes or leaves that are to be refitted, of all tasks together: of the first or only
    /// tree, and of the second.
    pub(crate) reached: [DirtySet; 2],
    /// Pairs of nodes that are not distributed yet. `distributed` holds pairs on their way to
    /// tasks.
    reserve: Buffer<NodePair>,
    distributed: Vec<NodePair>,
    sizes: Sizes,
}

impl Scratch {
    /// Begins a query, which wants all hits or not: sets the sizes of its first batches.
    pub(crate) fn begin(&mut self, wants_all: bool) {
        self.reached.iter_mut().for_each(DirtySet::clear);
        self.sizes = if wants_all {
            Sizes::LARGEST
        } else {
            Sizes::SMALLEST
        };
    }
}

/// Sizes of a task's batches, in pairs. For a visitor they double over a query, whatever earlier
/// queries did.
#[derive(Clone, Copy, Debug)]
struct Sizes {
    batch: usize,
    blocks: usize,
}

impl Default for Sizes {
    fn default() -> Self {
        Self::LARGEST
    }
}

impl Sizes {
    const SMALLEST: Self = Self {
        batch: FIRST_BATCH,
        blocks: FIRST_BATCH,
    };
    const LARGEST: Self = Self {
        batch: LONGEST_BATCH,
        blocks: MOST_BEFORE_SHOWN,
    };

    /// Limits of a task, with at most `leaves` pairs of leaves on its list.
    fn limits(&self, leaves: usize) -> TaskLimits {
        TaskLimits {
            batch: self.batch,
            leaf_pairs: self.blocks.min(leaves),
            block_pairs: self.blocks,
            stack: usize::MAX,
        }
    }

    fn double_batch(&mut self) {
        self.batch = (2 * self.batch).min(LONGEST_BATCH);
    }

    fn double_blocks(&mut self) {
        self.blocks = (2 * self.blocks).min(MOST_BEFORE_SHOWN);
    }
}

/// Tests all pairs of leaves that overlap, and shows the hits, until a visitor breaks. A visitor
/// sees hits in a deterministic order, which is not sorted. An interrupt breaks as well, at no hit.
pub(crate) fn descend<S: Coordinate>(
    refit: Refit,
    needs: Needs,
    pair: &mut TreePair<S>,
    tasks: &mut dyn Tasks<S>,
    scratch: &mut Scratch,
    statistics: &mut Statistics,
) -> ControlFlow<()> {
    let executor = refit.executor;
    let are_free = are_free(&needs, pair.views().sides());
    let most_tasks = task_count(are_free, tasks.wants_all());
    scratch.reserve.clear();
    tasks.begin(most_tasks);
    tasks.one(0).walk.found.nodes.push([NodeId::ROOT; 2]);
    let mut used = 1;
    loop {
        if most_tasks > 1 && is_to_be_distributed(tasks, used, &scratch.reserve) {
            used = most_tasks;
            tasks.use_all(used);
            distribute(tasks, used, scratch);
        }
        let mut limits = scratch.sizes.limits(MOST_LEAF_PAIRS);
        if used < most_tasks {
            limits.stack = ENOUGH_TO_DISTRIBUTE;
        }
        let now = context(refit, needs, pair, limits);
        tasks.run(executor, used, &|task, work| task.advance(&now, work));
        // A task that was not run still has its earlier hits, which must not be shown again.
        if executor.is_interrupted() {
            return ControlFlow::Break(());
        }
        scratch.sizes.double_batch();
        let round = gather(tasks, used, pair.views().is_one_tree(), scratch);
        statistics.node_pairs += round.node_pairs;
        let mut last = scratch.reserve.is_empty() && round.working == 0;
        if are_free {
            last &= round.are_all_tested;
            tasks.show(used, statistics)?;
            scratch.sizes.double_blocks();
        } else {
            refit_stale(refit, pair, scratch, statistics);
            if last || round.leaves >= limits.leaf_pairs * round.working.max(1) {
                refit_leaves(refit, pair, tasks, used, scratch, statistics);
                while !are_all_tested(tasks, used) {
                    let limits = scratch.sizes.limits(MOST_LEAF_PAIRS);
                    let now = context(refit, needs, pair, limits);
                    tasks.run(executor, used, &|task, work| task.test_some(&now, work));
                    if executor.is_interrupted() {
                        return ControlFlow::Break(());
                    }
                    scratch.sizes.double_blocks();
                    tasks.show(used, statistics)?;
                }
                for number in 0..used {
                    tasks.one(number).forget_leaves();
                }
            }
        }
        if executor.is_interrupted() {
            return ControlFlow::Break(());
        }
        if last {
            break;
        }
    }
    test_neighbours(refit, needs, pair, tasks, most_tasks, scratch, statistics)?;
    if executor.is_interrupted() {
        return ControlFlow::Break(());
    }
    ControlFlow::Continue(())
}

/// Sum over all tasks after each has gone as far as it could.
#[derive(Default)]
struct Round {
    node_pairs: u64,
    /// Number of tasks that have pairs of nodes left.
    working: usize,
    /// Number of pairs of leaves of all tasks.
    leaves: usize,
    are_all_tested: bool,
}

/// Takes the stale wide nodes that tasks need, and sums up the rest. For one tree, both sides go to
/// the same set.
fn gather<S>(
    tasks: &mut dyn Tasks<S>,
    used: usize,
    is_one_tree: bool,
    scratch: &mut Scratch,
) -> Round {
    let mut round = Round {
        are_all_tested: true,
        ..Round::default()
    };
    for number in 0..used {
        let task = tasks.one(number);
        round.node_pairs += task.walk.found.node_pairs;
        round.working += usize::from(!task.is_done());
        round.leaves += task.walk.found.leaves.len();
        round.are_all_tested &= task.all_tested();
        for (which, stale) in task.walk.stale.iter_mut().enumerate() {
            scratch.reached[which * usize::from(!is_one_tree)].take(stale);
        }
    }
    round
}

/// Whether all tasks have tested all their pairs of leaves.
fn are_all_tested<S>(tasks: &mut dyn Tasks<S>, used: usize) -> bool {
    (0..used).all(|number| tasks.one(number).all_tested())
}

/// Tests all leaves of a body with themselves and their neighbours, if the descent leaves these
/// out.
fn test_neighbours<S: Coordinate>(
    refit: Refit,
    needs: Needs,
    pair: &TreePair<S>,
    tasks: &mut dyn Tasks<S>,
    most_tasks: usize,
    scratch: &mut Scratch,
    statistics: &mut Statistics,
) -> ControlFlow<()> {
    let Some(neighbours) = left_out(&needs, &pair.views()) else {
        return ControlFlow::Continue(());
    };
    let leaves = pair.views().sides()[0].read.tree.leaves.len();
    let each = leaves.div_ceil(most_tasks).max(FEWEST_LEAVES);
    let used = leaves.div_ceil(each);
    for number in 0..used {
        let run = number * each..((number + 1) * each).min(leaves);
        tasks.one(number).run = run.start as u32..run.end as u32;
    }
    let executor = refit.executor;
    let are_left = |tasks: &mut dyn Tasks<S>| {
        (0..used).any(|number| {
            let run = &tasks.one(number).run;
            run.start < run.end
        })
    };
    while are_left(tasks) && !executor.is_interrupted() {
        let limits = scratch.sizes.limits(usize::MAX);
        let now = context(refit, needs, pair, limits);
        tasks.run(executor, used, &|task, work| {
            task.test_neighbours(&now, work, neighbours);
        });
        if executor.is_interrupted() {
            break;
        }
        tasks.show(used, statistics)?;
        scratch.sizes.double_blocks();
    }
    ControlFlow::Continue(())
}

fn context<'q, S: Coordinate>(
    refit: Refit<'q>,
    needs: Needs,
    pair: &'q TreePair<S>,
    limits: TaskLimits,
) -> Context<'q, S> {
    Context {
        needs,
        pair: pair.views(),
        instructions: refit.instructions,
        interrupt: refit.executor.interrupt,
        limits,
    }
}

/// Number of tasks that a pair of trees is distributed to.
fn task_count(are_free: bool, wants_all: bool) -> usize {
    match (are_free, wants_all) {
        // The hits are the same in any order, and one task has longer lists than many.
        (true, true) => 1,
        (true, false) => FREE_TASKS,
        (false, _) => TASKS,
    }
}

/// Whether a task is idle while others have work, or a single task has enough to share.
fn is_to_be_distributed<S>(
    tasks: &mut dyn Tasks<S>,
    used: usize,
    reserve: &Buffer<NodePair>,
) -> bool {
    let (mut all, mut is_any_done) = (0, false);
    for number in 0..used {
        let task = tasks.one(number);
        all += task.walk.found.nodes.len();
        is_any_done |= task.is_done();
    }
    if used == 1 {
        return all >= ENOUGH_TO_DISTRIBUTE;
    }
    (!reserve.is_empty() || all >= used) && is_any_done
}

/// Distributes the last of all pairs of nodes to all tasks, in order and in equal parts.
fn distribute<S>(tasks: &mut dyn Tasks<S>, used: usize, scratch: &mut Scratch) {
    let (reserve, distributed) = (&mut scratch.reserve, &mut scratch.distributed);
    for number in 0..used {
        let nodes = &mut tasks.one(number).walk.found.nodes;
        reserve.extend(nodes.as_slice());
        nodes.clear();
    }
    reserve.take_last(DISTRIBUTED, distributed);
    let each = distributed.len().div_ceil(used);
    for (number, pairs) in distributed.chunks(each).enumerate() {
        tasks.one(number).walk.found.nodes.extend(pairs);
    }
}

/// Refits the wide nodes that tasks have asked for.
fn refit_stale<S: Coordinate>(
    refit: Refit,
    pair: &mut TreePair<S>,
    scratch: &mut Scratch,
    statistics: &mut Statistics,
) {
    let lists = &mut scratch.wide_nodes;
    for (which, reached) in scratch.reached.iter_mut().enumerate() {
        if !reached.is_empty() {
            refit.reached(&mut pair.refitted(which), reached, lists, statistics);
        }
    }
}

/// Makes the boxes of the triangles in leaves that are to be tested.
fn refit_leaves<S: Coordinate>(
    refit: Refit,
    pair: &mut TreePair<S>,
    tasks: &mut dyn Tasks<S>,
    used: usize,
    scratch: &mut Scratch,
    statistics: &mut Statistics,
) {
    let is_one_tree = pair.views().is_one_tree();
    for number in 0..used {
        let of_task = &mut tasks.one(number).walk.reached;
        for (which, leaves) in of_task.iter_mut().enumerate() {
            scratch.reached[which * usize::from(!is_one_tree)].take(leaves);
        }
    }
    for (which, reached) in scratch.reached.iter_mut().enumerate() {
        if !reached.is_empty() {
            refit.reached_leaves(&mut pair.refitted(which), reached, statistics);
        }
    }
}

held!(Scratch: reached, reserve, distributed[];
    |scratch| scratch.wide_nodes.iter().map(held::list).sum::<usize>());
