//! Hits of a query of one kind, and their way to a sink: implements `Tasks` and `LeafWork`.

use crate::held::{empty, held};
use crate::queries::{Batch, FoundBy, Kind, LeafTest, LeafWork};
use crate::statistics::Statistics;
use crate::threads::Executor;
use crate::traversal::{Collector, Sink, Task, TaskWork, Tasks};
use std::ops::ControlFlow;

/// Most hits of a task before it shows them to a collector, or stops until a visitor has seen them.
/// This bounds the memory of all tasks' hits.
const MOST_HITS: usize = 2048;

/// Tasks of a kind, kept from query to query.
#[derive(Debug)]
pub(crate) struct TaskList<K: Kind> {
    tasks: Vec<(Task, Results<K>)>,
    /// Number of tasks in use, from the first on.
    used: usize,
    /// Hit at which a query stopped, in tree order.
    pub(crate) broke_at: Option<K::TreeHit>,
}

/// Hits of one task, in tree order and as they are handed over.
#[derive(Debug)]
struct Results<K: Kind> {
    found: FoundBy<K>,
    /// Hits in the caller's numbering, for a collector. `shown` holds them as a visitor sees them.
    of_caller: Vec<K::Hit>,
    shown: Vec<K::Shown>,
    /// Whether the collector takes no more hits.
    are_too_many: bool,
}

/// Query in progress: its kind, its tasks, and the sink of its hits.
pub(crate) struct Answer<'q, 's, K: Kind> {
    kind: &'q K,
    list: &'q mut TaskList<K>,
    sink: SinkOf<'s, K>,
}

/// Sink of a kind's hits.
pub(crate) type SinkOf<'s, K> = Sink<'s, <K as Kind>::Hit, <K as Kind>::Shown>;

impl<'q, 's, K: Kind> Answer<'q, 's, K> {
    pub(crate) fn new(kind: &'q K, list: &'q mut TaskList<K>, sink: SinkOf<'s, K>) -> Self {
        list.broke_at = None;
        Self { kind, list, sink }
    }
}

impl<K: Kind> Tasks<K::Scalar> for Answer<'_, '_, K> {
    fn wants_all(&self) -> bool {
        self.sink.collector().is_some()
    }

    fn begin(&mut self, most: usize) {
        let TaskList { tasks, used, .. } = &mut *self.list;
        // Tasks are left as they were where a visitor stopped, or panicked.
        for (task, results) in &mut tasks[..*used] {
            task.clear();
            results.clear();
        }
        tasks.resize_with(most.max(tasks.len()), Default::default);
        *used = 1;
    }

    fn use_all(&mut self, count: usize) {
        self.list.used = count;
    }

    #[inline]
    fn one(&mut self, number: usize) -> &mut Task {
        &mut self.list.tasks[number].0
    }

    fn run(&mut self, executor: Executor, count: usize, work: TaskWork<K::Scalar>) {
        let (kind, collector) = (self.kind, self.sink.collector());
        executor.run(
            &mut self.list.tasks[..count],
            u64::MAX,
            |_, (task, results)| {
                let mut bound = Bound {
                    kind,
                    collector,
                    results,
                };
                work(task, &mut bound);
            },
        );
    }

    fn show(&mut self, count: usize, statistics: &mut Statistics) -> ControlFlow<()> {
        let TaskList {
            tasks, broke_at, ..
        } = &mut *self.list;
        let tasks = &tasks[..count];
        for (_, results) in tasks {
            *statistics += results.found.statistics;
        }
        for (_, results) in tasks {
            if results.are_too_many {
                return ControlFlow::Break(());
            }
            if let Sink::Visitor(visitor) = &mut self.sink
                && let ControlFlow::Break(place) = visitor(&results.shown)
            {
                *broke_at = Some(results.found.hits.as_slice()[place]);
                return ControlFlow::Break(());
            }
        }
        ControlFlow::Continue(())
    }
}

/// Hits of one task, bound to the kind that tests its leaves.
struct Bound<'q, K: Kind> {
    kind: &'q K,
    collector: Option<Collector<'q, K::Hit>>,
    results: &'q mut Results<K>,
}

impl<K: Kind> LeafWork<K::Scalar> for Bound<'_, K> {
    fn clear(&mut self) {
        self.results.clear();
    }

    fn test(&mut self, leaves: &LeafTest<K::Scalar>, batch: Batch) {
        let (kind, results) = (self.kind, &mut *self.results);
        let before = results.found.hits.len();
        kind.test(leaves, batch, &mut results.found);
        let new = &results.found.hits.as_slice()[before..];
        if self.collector.is_some() {
            let hits = new.iter().map(|&hit| kind.to_caller(&leaves.ids, hit));
            results.of_caller.extend(hits);
        } else {
            kind.show(leaves, new, &mut results.shown);
        }
        if !self.has_room() {
            self.hand_over();
        }
    }

    fn candidates(&self) -> u64 {
        self.results.found.statistics.candidate_pairs
    }

    fn has_room(&self) -> bool {
        self.results.found.hits.len() < MOST_HITS && !self.results.are_too_many
    }

    fn hand_over(&mut self) {
        let results = &mut *self.results;
        if let Some(collector) = self.collector
            && !results.of_caller.is_empty()
        {
            results.are_too_many |= collector(&results.of_caller).is_break();
            results.found.hits.clear();
            results.of_caller.clear();
        }
    }
}

impl<K: Kind> Results<K> {
    /// Clears hits and counters; buffers are kept.
    fn clear(&mut self) {
        self.found.hits.clear();
        self.found.statistics = Statistics::default();
        self.of_caller.clear();
        self.shown.clear();
        self.are_too_many = false;
    }
}

empty!(Results<K: Kind>: found, of_caller, shown, are_too_many);

held!(Results<K: Kind>: found, of_caller[], shown[]);

empty!(TaskList<K: Kind>: tasks, used, broke_at);

held!(TaskList<K: Kind>: tasks);
