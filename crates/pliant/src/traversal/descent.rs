//! The loop of the traversal, the same for two trees and for one, and for every kind of query.

use super::context::{Budget, Context};
use super::leaf_pairs::LeafTests;
use super::sink::{Collector, Sink};
use super::task::{Task, are_free, left_out};
use super::tree_pair::TreePair;
use crate::held::{self, Held};
use crate::ids::{NodeId, WideNodeId};
use crate::kernels::Buffer;
use crate::queries::Kind;
use crate::statistics::Statistics;
use crate::threads::Executor;
use crate::tree::BoxSource;
use crate::tree::NodePair;
use crate::update::{DirtySet, Refit};
use std::ops::ControlFlow;

/// Of a visitor, the first batch is one pair of nodes, and batches double: if it stops at the first hit, few boxes were made that it
/// did not need. On the two spheres from contact on, 16 instead made 1,841 boxes where this makes 520, and took 1.8 times as long.
const FIRST_BATCH: usize = 1;
/// The most pairs of nodes that a task takes at once. It is so short that their wide nodes stay in cache.
const LONGEST_BATCH: usize = 256;
/// When a task has this many pairs of leaves, it tests them after the batch at hand.
const MOST_LEAF_PAIRS: usize = 512;
/// The same where threads share the tasks. It is more, because each thread has a cache of its own, and all wait for the last.
const MOST_LEAF_PAIRS_SHARED: usize = 2048;
/// The most pairs of blocks that a task tests, or a few more, before a visitor is shown hits. This bounds memory whatever the leaf size is.
const MOST_BEFORE_SHOWN: usize = 8192;
/// As soon as there are this many pairs of nodes they are distributed to several tasks, whatever the number of threads is; but not where
/// one thread wants all and waits for no boxes.
const ENOUGH_TO_DISTRIBUTE: usize = 128;
/// The number of tasks where they ask for boxes: few, so that all of them are at work in about one place of the trees.
const TASKS: usize = 8;
/// The number of tasks a thread, where they ask for boxes and all hits are wanted, if that makes more than [`TASKS`]. The hits found and
/// the boxes made are then the same in any order.
const TASKS_A_THREAD: usize = 2;
/// The number of tasks where all boxes are valid, and known to be: many, so that none waits long for another.
const FREE_TASKS: usize = 32;
/// So many leaves are worth a task of their own, to be tested with their neighbours.
const FEWEST_LEAVES: usize = 64;
/// The most pairs of nodes that are distributed at once.
const DISTRIBUTED: usize = 512;

/// Buffers, kept from query to query.
#[derive(Debug)]
pub(crate) struct Scratch<K: Kind> {
    /// Lists of wide nodes, for the update.
    pub(crate) wide_nodes: [Vec<WideNodeId>; 2],
    /// Wide nodes or leaves of one tree that are to be refitted, of all tasks together.
    pub(crate) reached: DirtySet,
    tasks: Vec<Task<K>>,
    /// How many of them, from the first on, are in use.
    used: usize,
    /// Pairs of nodes that were not distributed yet, and those that are being distributed.
    reserve: Buffer<NodePair>,
    distributed: Vec<NodePair>,
    sizes: Sizes,
    /// The hit at which a query stopped, in tree order.
    pub(crate) broke_at: Option<K::TreeHit>,
}

impl<K: Kind> Default for Scratch<K> {
    fn default() -> Self {
        Self {
            wide_nodes: Default::default(),
            reached: DirtySet::default(),
            tasks: Vec::new(),
            used: 0,
            reserve: Buffer::default(),
            distributed: Vec::new(),
            sizes: Sizes::LARGEST,
            broke_at: None,
        }
    }
}

impl<K: Kind> Scratch<K> {
    /// At the beginning of every query.
    pub(crate) fn begin(&mut self, sink: &Sink<K::Hit>) {
        self.sizes = match sink {
            Sink::Visitor(_) => Sizes::SMALLEST,
            Sink::Collector(_) => Sizes::LARGEST,
        };
        self.broke_at = None;
    }
}

/// How many pairs a task takes at once. For a visitor they double over a query, whatever it has asked before.
#[derive(Clone, Copy, Debug)]
struct Sizes {
    batch: usize,
    blocks: usize,
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

    /// A budget of at most so many pairs of leaves.
    fn budget(&self, leaves: usize) -> Budget {
        Budget {
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

/// Shows every hit, until `sink` breaks. The order in which a visitor sees them is deterministic, not sorted. Interrupted, it breaks as well,
/// at no hit.
pub(crate) fn descend<K, P>(
    refit: Refit,
    kind: &K,
    pair: &mut P,
    scratch: &mut Scratch<K>,
    statistics: &mut Statistics,
    sink: &mut Sink<K::Hit>,
) -> ControlFlow<()>
where
    K: Kind,
    P: TreePair,
    P::Source: BoxSource<Scalar = K::Scalar>,
{
    let Scratch {
        wide_nodes,
        reached,
        tasks,
        used,
        reserve,
        distributed,
        sizes,
        broke_at,
    } = scratch;
    let executor = refit.executor;
    let collector = sink.collector();
    // Tasks are left as they were where a visitor stopped, or panicked.
    tasks[..*used].iter_mut().for_each(Task::clear);
    reserve.clear();
    *used = 1;
    let are_free = are_free::<K, _>(pair.sides());
    let (most_tasks, most_leaf_pairs) = shares(are_free, collector.is_some(), executor);
    tasks.resize_with(most_tasks.max(tasks.len()), Task::default);
    tasks[0].walk.found.nodes.push([NodeId::ROOT; 2]);
    loop {
        if most_tasks > 1 && is_to_be_distributed(&tasks[..*used], reserve) {
            *used = most_tasks;
            distribute(&mut tasks[..*used], reserve, distributed);
        }
        let tasks = &mut tasks[..*used];
        let mut budget = sizes.budget(most_leaf_pairs);
        if tasks.len() < most_tasks {
            budget.stack = ENOUGH_TO_DISTRIBUTE;
        }
        let now = context(refit, kind, pair, collector, budget);
        executor.run(tasks, |_, task| task.advance(&now));
        // What a task that was not run found before is not to be shown again.
        if executor.is_interrupted() {
            return ControlFlow::Break(());
        }
        sizes.double_batch();
        for task in &*tasks {
            statistics.node_pairs += task.walk.found.node_pairs;
        }
        let working = tasks.iter().filter(|task| !task.is_done()).count();
        let mut last = reserve.is_empty() && working == 0;
        let mut shown = ControlFlow::Continue(());
        if are_free {
            last &= tasks.iter().all(Task::all_tested);
            shown = show_hits(tasks, statistics, sink);
            sizes.double_blocks();
        } else {
            let take = &mut |which: usize, reached: &mut DirtySet| {
                for task in &mut *tasks {
                    reached.take(&mut task.walk.stale[which]);
                }
            };
            refit_stale(refit, pair, take, reached, wide_nodes, statistics);
            let leaves = |task: &Task<K>| task.walk.found.leaves.len();
            let leaves = tasks.iter().map(leaves).sum::<usize>();
            if last || leaves >= budget.leaf_pairs * working.max(1) {
                let take = &mut |which: usize, reached: &mut DirtySet| {
                    for task in &mut *tasks {
                        reached.take(&mut task.walk.reached[which]);
                    }
                };
                refit_leaves(refit, pair, take, reached, statistics);
                if collector.is_some() && executor.are_many() {
                    // The same hits are found in any order.
                    rebalance(tasks);
                }
                while shown.is_continue() && !tasks.iter().all(Task::all_tested) {
                    let now = context(refit, kind, pair, collector, sizes.budget(most_leaf_pairs));
                    executor.run(tasks, |_, task| task.test_some(&now));
                    if executor.is_interrupted() {
                        return ControlFlow::Break(());
                    }
                    sizes.double_blocks();
                    shown = show_hits(tasks, statistics, sink);
                }
                tasks.iter_mut().for_each(Task::forget_leaves);
            }
        }
        if let ControlFlow::Break(hit) = shown {
            *broke_at = hit;
            return ControlFlow::Break(());
        }
        if executor.is_interrupted() {
            return ControlFlow::Break(());
        }
        if last {
            break;
        }
    }
    // Only a tree with itself, for a kind that is shown triangles, leaves neighbours out.
    if const { P::ITSELF && !K::HAS_RUNS } {
        let tasks = &mut tasks[..most_tasks];
        if let ControlFlow::Break(hit) =
            test_neighbours(refit, kind, &*pair, tasks, sizes, statistics, sink)
        {
            *broke_at = hit;
            return ControlFlow::Break(());
        }
    }
    if executor.is_interrupted() {
        return ControlFlow::Break(());
    }
    ControlFlow::Continue(())
}

/// Tests all leaves of a body with themselves and their neighbours, where the descent has left these out.
fn test_neighbours<K, P>(
    refit: Refit,
    kind: &K,
    pair: &P,
    tasks: &mut [Task<K>],
    sizes: &mut Sizes,
    statistics: &mut Statistics,
    sink: &mut Sink<K::Hit>,
) -> ControlFlow<Option<K::TreeHit>>
where
    K: Kind,
    P: TreePair,
    P::Source: BoxSource<Scalar = K::Scalar>,
{
    let Some(neighbours) = left_out::<K, P>(pair) else {
        return ControlFlow::Continue(());
    };
    let leaves = pair.sides()[0].tree.leaves.len();
    let each = leaves.div_ceil(tasks.len()).max(FEWEST_LEAVES);
    let used = leaves.div_ceil(each);
    let tasks = &mut tasks[..used];
    for (place, task) in tasks.iter_mut().enumerate() {
        let run = place * each..((place + 1) * each).min(leaves);
        task.run = run.start as u32..run.end as u32;
    }
    let executor = refit.executor;
    while tasks.iter().any(|task| task.run.start < task.run.end) && !executor.is_interrupted() {
        let budget = sizes.budget(usize::MAX);
        let now = context(refit, kind, pair, sink.collector(), budget);
        executor.run(tasks, |_, task| task.test_neighbours(&now, neighbours));
        if executor.is_interrupted() {
            break;
        }
        show_hits(tasks, statistics, sink)?;
        sizes.double_blocks();
    }
    ControlFlow::Continue(())
}

fn context<'q, K: Kind, P>(
    refit: Refit<'q>,
    kind: &'q K,
    pair: &'q P,
    collector: Option<Collector<'q, K::Hit>>,
    budget: Budget,
) -> Context<'q, K, P> {
    Context {
        kind,
        pair,
        collector,
        instructions: refit.instructions,
        interrupt: refit.executor.interrupt,
        budget,
    }
}

/// How many tasks a query is distributed to, and how many pairs of leaves of one are enough to test them.
fn shares(are_free: bool, wants_all: bool, executor: Executor) -> (usize, usize) {
    if are_free && wants_all && !executor.are_many() {
        // What is found is the same in any order, and lists of one task are longer than those of many.
        (1, MOST_LEAF_PAIRS)
    } else if are_free {
        (FREE_TASKS, MOST_LEAF_PAIRS)
    } else if wants_all && executor.are_many() {
        let for_threads = TASKS_A_THREAD * executor.count();
        (TASKS.max(for_threads), MOST_LEAF_PAIRS_SHARED)
    } else {
        (TASKS, MOST_LEAF_PAIRS)
    }
}

/// Whether a task is idle while others have work, or a single task has enough to share.
fn is_to_be_distributed<K: Kind>(tasks: &[Task<K>], reserve: &Buffer<NodePair>) -> bool {
    let stack = |task: &Task<K>| task.walk.found.nodes.len();
    let all: usize = tasks.iter().map(stack).sum();
    if tasks.len() == 1 {
        return all >= ENOUGH_TO_DISTRIBUTE;
    }
    (!reserve.is_empty() || all >= tasks.len()) && tasks.iter().any(Task::is_done)
}

/// Distributes the last of all pairs of nodes to all tasks, in order and in equal parts.
fn distribute<K: Kind>(
    tasks: &mut [Task<K>],
    reserve: &mut Buffer<NodePair>,
    distributed: &mut Vec<NodePair>,
) {
    for task in &mut *tasks {
        reserve.extend(task.walk.found.nodes.as_slice());
        task.walk.found.nodes.clear();
    }
    reserve.take_last(DISTRIBUTED, distributed);
    let each = distributed.len().div_ceil(tasks.len());
    for (task, pairs) in tasks.iter_mut().zip(distributed.chunks(each)) {
        task.walk.found.nodes.extend(pairs);
    }
}

/// Gives tasks that have found few pairs of leaves some of those of others that have found many.
fn rebalance<K: Kind>(tasks: &mut [Task<K>]) {
    let leaves = |task: &Task<K>| task.walk.found.leaves.len();
    let all: usize = tasks.iter().map(leaves).sum();
    let each = all.div_ceil(tasks.len());
    let mut more = Vec::new();
    for task in &mut *tasks {
        let leaves = &mut task.walk.found.leaves;
        more.extend_from_slice(leaves.as_slice().get(each..).unwrap_or_default());
        leaves.truncate(each);
    }
    for task in tasks {
        let rest = more.len().saturating_sub(each - leaves(task));
        task.walk.found.leaves.extend(&more[rest..]);
        more.truncate(rest);
    }
}

/// Moves what tasks ask for in the first tree, or the second, to a set.
type TakeAsked<'t> = &'t mut dyn FnMut(usize, &mut DirtySet);

/// Refits the wide nodes that tasks ask for.
fn refit_stale<P: TreePair>(
    refit: Refit,
    pair: &mut P,
    take: TakeAsked,
    reached: &mut DirtySet,
    lists: &mut [Vec<WideNodeId>; 2],
    statistics: &mut Statistics,
) {
    for which in 0..2 {
        take(which, reached);
        // Of one tree, what both sides ask for is refitted together.
        if (!P::ITSELF || which == 1) && !reached.is_empty() {
            refit.reached(&mut pair.refitted(which), reached, lists, statistics);
        }
    }
}

/// Makes the boxes of the triangles in leaves that are to be tested.
fn refit_leaves<P: TreePair>(
    refit: Refit,
    pair: &mut P,
    take: TakeAsked,
    reached: &mut DirtySet,
    statistics: &mut Statistics,
) {
    for which in 0..2 {
        take(which, reached);
        if !P::ITSELF || which == 1 {
            refit.reached_leaves(&mut pair.refitted(which), reached, statistics);
        }
    }
}

/// Shows what was found among the pairs that were tested, to a visitor; breaks with the hit at which that does. A collector was shown it.
fn show_hits<K: Kind>(
    tasks: &[Task<K>],
    statistics: &mut Statistics,
    sink: &mut Sink<K::Hit>,
) -> ControlFlow<Option<K::TreeHit>> {
    for task in tasks {
        *statistics += task.tests.statistics;
    }
    for LeafTests {
        hits,
        of_caller,
        are_too_many,
        ..
    } in tasks.iter().map(|task| &task.tests)
    {
        if *are_too_many {
            return ControlFlow::Break(None);
        }
        if let Sink::Visitor(visitor) = sink
            && let ControlFlow::Break(place) = visitor(of_caller)
        {
            return ControlFlow::Break(Some(hits.as_slice()[place]));
        }
    }
    ControlFlow::Continue(())
}

impl<K: Kind> Held for Scratch<K> {
    fn held(&self) -> usize {
        self.wide_nodes.iter().map(held::list).sum::<usize>()
            + self.reached.held()
            + held::lists(&self.tasks)
            + self.reserve.held()
            + held::list(&self.distributed)
    }
}
