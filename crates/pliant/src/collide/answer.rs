//! What the tasks of a query of one kind find, and where it goes: what stands behind the doors `Tasks` and `LeafWork`.

use crate::held::{empty, held};
use crate::kernels::Buffer;
use crate::queries::{Batch, Kind, LeafTest, LeafWork};
use crate::statistics::Statistics;
use crate::threads::Executor;
use crate::traversal::{Collector, Sink, Task, TaskWork, Tasks};
use std::ops::ControlFlow;

/// With so many hits a task shows them to a collector, or stops until a visitor has seen them: what all tasks have found takes little memory.
const MOST_HITS: usize = 2048;

/// The tasks of a kind, kept from query to query.
#[derive(Debug)]
pub(crate) struct TaskList<K: Kind> {
    tasks: Vec<(Task, Found<K>)>,
    /// How many of them, from the first on, are in use.
    used: usize,
    /// The hit at which a query stopped, in tree order.
    pub(crate) broke_at: Option<K::TreeHit>,
}

/// What a task has found.
#[derive(Debug)]
struct Found<K: Kind> {
    buffers: K::Buffers,
    /// In tree order.
    hits: Buffer<K::TreeHit>,
    /// The same hits as the caller numbers things, for a collector; or as a visitor is shown them.
    of_caller: Vec<K::Hit>,
    shown: Vec<K::Shown>,
    /// Whether a collector does not take any more.
    are_too_many: bool,
    statistics: Statistics,
}

/// A query on its way.
pub(crate) struct Answer<'q, 's, K: Kind> {
    kind: &'q K,
    list: &'q mut TaskList<K>,
    sink: SinkOf<'s, K>,
}

/// Where what a kind finds goes.
pub(crate) type SinkOf<'s, K> = Sink<'s, <K as Kind>::Hit, <K as Kind>::Shown>;

impl<'q, 's, K: Kind> Answer<'q, 's, K> {
    pub(crate) fn new(kind: &'q K, list: &'q mut TaskList<K>, sink: SinkOf<'s, K>) -> Self {
        list.broke_at = None;
        Self { kind, list, sink }
    }

    pub(crate) fn kind(&self) -> &'q K {
        self.kind
    }
}

impl<K: Kind> Tasks<K::Scalar> for Answer<'_, '_, K> {
    fn wants_all(&self) -> bool {
        self.sink.collector().is_some()
    }

    fn begin(&mut self, most: usize) {
        let TaskList { tasks, used, .. } = &mut *self.list;
        // They are left as they were where a visitor stopped, or panicked.
        for (task, found) in &mut tasks[..*used] {
            task.clear();
            found.clear();
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
        executor.run(&mut self.list.tasks[..count], |_, (task, found)| {
            let mut bound = Bound {
                kind,
                collector,
                found,
            };
            work(task, &mut bound);
        });
    }

    fn show(&mut self, count: usize, statistics: &mut Statistics) -> ControlFlow<()> {
        let TaskList {
            tasks, broke_at, ..
        } = &mut *self.list;
        let tasks = &tasks[..count];
        for (_, found) in tasks {
            *statistics += found.statistics;
        }
        for (_, found) in tasks {
            if found.are_too_many {
                return ControlFlow::Break(());
            }
            if let Sink::Visitor(visitor) = &mut self.sink
                && let ControlFlow::Break(place) = visitor(&found.shown)
            {
                *broke_at = Some(found.hits.as_slice()[place]);
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
    found: &'q mut Found<K>,
}

impl<K: Kind> LeafWork<K::Scalar> for Bound<'_, K> {
    fn clear(&mut self) {
        self.found.clear();
    }

    fn test(&mut self, leaves: &LeafTest<K::Scalar>, batch: Batch) {
        let Found {
            buffers,
            hits,
            of_caller,
            shown,
            statistics,
            ..
        } = &mut *self.found;
        let before = hits.len();
        self.kind.test(leaves, batch, buffers, hits, statistics);
        let new = &hits.as_slice()[before..];
        if self.collector.is_some() {
            let kind = self.kind;
            of_caller.extend(new.iter().map(|&hit| kind.to_caller(&leaves.ids, hit)));
        } else {
            self.kind.show(leaves, new, shown);
        }
        if !self.has_room() {
            self.hand_over();
        }
    }

    fn has_room(&self) -> bool {
        self.found.hits.len() < MOST_HITS && !self.found.are_too_many
    }

    fn hand_over(&mut self) {
        let found = &mut *self.found;
        if let Some(collector) = self.collector
            && !found.of_caller.is_empty()
        {
            found.are_too_many |= collector(&found.of_caller).is_break();
            found.hits.clear();
            found.of_caller.clear();
        }
    }
}

impl<K: Kind> Found<K> {
    /// Forgets what was found.
    fn clear(&mut self) {
        self.hits.clear();
        self.of_caller.clear();
        self.shown.clear();
        self.are_too_many = false;
        self.statistics = Statistics::default();
    }
}

empty!(Found<K: Kind>: buffers, hits, of_caller, shown, are_too_many, statistics);

held!(Found<K: Kind>: buffers, hits, of_caller[], shown[]);

empty!(TaskList<K: Kind>: tasks, used, broke_at);

held!(TaskList<K: Kind>: tasks);
