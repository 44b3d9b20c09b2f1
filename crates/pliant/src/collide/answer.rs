//! What the tasks of a query of one kind find, and where it goes: what stands behind the doors `Tasks` and `LeafWork`.

use crate::held::{empty, held};
use crate::queries::{Batch, FoundBy, Kind, LeafTest, LeafWork};
use crate::statistics::Statistics;
use crate::threads::Executor;
use crate::traversal::{Collector, Sink, Task, TaskWork, Tasks};
use std::ops::ControlFlow;

/// With so many hits a task shows them to a collector, or stops until a visitor has seen them: what all tasks have found takes little memory.
const MOST_HITS: usize = 2048;

/// The tasks of a kind, kept from query to query.
#[derive(Debug)]
pub(crate) struct TaskList<K: Kind> {
    tasks: Vec<(Task, Results<K>)>,
    /// How many of them, from the first on, are in use.
    used: usize,
    /// The hit at which a query stopped, in tree order.
    pub(crate) broke_at: Option<K::TreeHit>,
}

/// Hits of one task, in tree order and as they are handed over.
#[derive(Debug)]
struct Results<K: Kind> {
    found: FoundBy<K>,
    /// The hits as the caller numbers things, for a collector; or as a visitor is shown them.
    of_caller: Vec<K::Hit>,
    shown: Vec<K::Shown>,
    /// Whether a collector does not take any more.
    are_too_many: bool,
}

/// A query on its way.
pub(crate) struct Answer<'q, 's, K: Kind> {
    kind: &'q K,
    list: &'q mut TaskList<K>,
    sink: SinkOf<'s, K>,
}

/// The sink of a kind's hits.
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
        // They are left as they were where a visitor stopped, or panicked.
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

/// What one task has found, with the kind that decides what it finds next.
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
    /// Forgets what was found.
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
