//! State of a world for one kind of query, and the ways to ask one: a sorted list, or a sink until
//! it breaks.

use super::answer::{Answer, SinkOf, TaskList};
use super::body_pairs::{BodyPair, BodyPairs};
use super::origin::FloatingOrigin;
use super::request::Request;
use super::step::Step;
use super::together::Together;
use crate::bodies::{Bodies, Body};
use crate::error::{Error, ErrorKind};
use crate::held::{self, empty, held};
use crate::kernels::{Coordinate, Instructions};
use crate::options::Options;
use crate::queries::{Kind, Needs};
use crate::sort::{Hit, Numbered, Sorter, sort_lists};
use crate::statistics::Statistics;
use crate::threads::{Executor, Interrupt, PerThread, Threads};
use crate::traversal::{Scratch, Sink, Visitor};
use crate::update::{Partner, Refit};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

/// State of a world that queries of every kind share.
pub(crate) struct Common<S> {
    pub(crate) options: Options,
    pub(crate) instructions: Instructions,
    pub(crate) threads: Threads,
    pub(crate) bodies: Bodies<S>,
    pub(crate) body_pairs: BodyPairs,
    pub(crate) origin: FloatingOrigin,
    /// Buffers of the descent.
    pub(crate) scratch: Scratch,
    /// Counters of the last query.
    pub(crate) statistics: Statistics,
    /// Counters of work done early since the last query.
    pub(crate) done_early: Statistics,
}

/// Buffers of one kind, kept from query to query.
#[derive(Debug)]
pub(crate) struct Asked<K: Kind> {
    pub(crate) tasks: TaskList<K>,
    together: Together,
    pub(super) sorter: Sorter<K::Hit>,
    /// Hits of every thread, for kinds whose hits are more than numbers. With one thread the first
    /// list holds all hits in the end, otherwise `listed`.
    lists: PerThread<Vec<K::Hit>>,
    listed: Vec<K::Hit>,
    /// All hits, measured, in sorted order.
    pub(super) measured: Vec<K::Shown>,
}

impl<K: Kind<Hit: Hit>> Asked<K> {
    /// Returns all hits, sorted.
    pub(crate) fn all(
        &mut self,
        kind: &K,
        common: &mut Common<K::Scalar>,
        request: &Request,
    ) -> Result<&[K::Hit], Error> {
        let interrupt = Interrupt::new(request.question);
        self.sorter.begin(common.executor(&interrupt));
        let keep = &|found: &[K::Hit]| self.sorter.push(found);
        let buffers = (&mut self.tasks, &mut self.together);
        collect(buffers, kind, common, request, &interrupt, keep)?;
        let instructions = common.instructions;
        let executor = common.executor(&interrupt);
        self.sorter.sort(executor, instructions);
        common.end(&interrupt)?;
        Ok(self.sorter.hits())
    }
}

impl<K: Kind> Asked<K> {
    /// Returns all hits, sorted; for kinds whose hits are more than numbers.
    pub(crate) fn all_listed(
        &mut self,
        kind: &K,
        common: &mut Common<K::Scalar>,
        request: &Request,
    ) -> Result<&[K::Hit], Error>
    where
        K::Hit: Numbered,
    {
        let interrupt = Interrupt::new(request.question);
        self.lists.for_threads(common.executor(&interrupt).count());
        self.lists.iter_mut().for_each(Vec::clear);
        let keep = &|found: &[K::Hit]| self.lists.own().extend_from_slice(found);
        let buffers = (&mut self.tasks, &mut self.together);
        collect(buffers, kind, common, request, &interrupt, keep)?;
        let executor = common.executor(&interrupt);
        let all = sort_lists(&mut self.lists, executor, &mut self.listed);
        common.end(&interrupt)?;
        Ok(all)
    }

    /// Tests all candidates, for a kind that stores its results itself.
    pub(crate) fn search(
        &mut self,
        kind: &K,
        common: &mut Common<K::Scalar>,
        request: &Request,
    ) -> Result<(), Error> {
        let interrupt = Interrupt::new(request.question);
        let buffers = (&mut self.tasks, &mut self.together);
        collect(buffers, kind, common, request, &interrupt, &|_| {})
    }

    /// Shows every hit once, until the visitor breaks.
    pub(crate) fn visit(
        &mut self,
        kind: &K,
        common: &mut Common<K::Scalar>,
        request: &Request,
        visitor: Visitor<K::Shown>,
    ) -> Result<(), Error> {
        let interrupt = Interrupt::new(request.question);
        let buffers = (&mut self.tasks, &mut self.together);
        let sink = Sink::Visitor(visitor);
        ask(buffers, kind, common, request, &interrupt, sink)
    }
}

/// Has every thread keep its hits, some at a time. Fails if there are more than the request allows.
fn collect<K: Kind>(
    buffers: (&mut TaskList<K>, &mut Together),
    kind: &K,
    common: &mut Common<K::Scalar>,
    request: &Request,
    interrupt: &Interrupt,
    keep: &(dyn Fn(&[K::Hit]) + Sync),
) -> Result<(), Error> {
    let count = AtomicUsize::new(0);
    let collector = &|found: &[K::Hit]| {
        let before = count.fetch_add(found.len(), Ordering::Relaxed);
        if before.saturating_add(found.len()) > request.most {
            return ControlFlow::Break(());
        }
        keep(found);
        ControlFlow::Continue(())
    };
    let sink = Sink::Collector(collector);
    ask(buffers, kind, common, request, interrupt, sink)?;
    if count.into_inner() > request.most {
        let limit = request.most;
        return Err(ErrorKind::TooManyHits { limit }.of_query());
    }
    Ok(())
}

/// Answers a query: passes its hits to a sink, until that breaks.
fn ask<K: Kind>(
    (tasks, together): (&mut TaskList<K>, &mut Together),
    kind: &K,
    common: &mut Common<K::Scalar>,
    request: &Request,
    interrupt: &Interrupt,
    sink: SinkOf<K>,
) -> Result<(), Error> {
    common.begin(request)?;
    let wants_all = sink.collector().is_some();
    together.begin();
    let mut answer = Answer::new(kind, tasks, sink);
    common.scratch.begin(wants_all);
    let meet: Meet<K::Scalar> = &mut |step, bodies, pairs| {
        let executor = step.refit.executor;
        if !together.pays_for_threads(executor, bodies, pairs) {
            step.refit.executor = executor.alone();
        } else if wants_all {
            return together.meet(step, bodies, pairs, &mut answer);
        }
        let mut pairs = pairs.iter();
        let met = pairs.try_for_each(|&pair| step.meet(bodies, pair, &mut answer));
        step.refit.executor = executor;
        met
    };
    let done = common.for_each_batch(kind.needs(), request, interrupt, false, meet);
    if wants_all && done.is_ok() {
        together.note_cost(&kind.needs(), &common.statistics);
    }
    done
}

/// Processes a batch of pairs of bodies.
type Meet<'m, S> = &'m mut dyn FnMut(&mut Step, &mut Bodies<S>, &[BodyPair]) -> ControlFlow<()>;

impl<S: Coordinate> Common<S> {
    /// Executor of a query: its threads, and its interrupt.
    pub(crate) fn executor<'q>(&'q mut self, interrupt: &'q Interrupt<'q>) -> Executor<'q> {
        Executor {
            threads: self.threads.here(),
            interrupt,
        }
    }

    /// Begins a query: validates its bodies, settles the origin, resets the counters.
    pub(crate) fn begin(&mut self, request: &Request) -> Result<(), Error> {
        self.bodies.validate(request.of)?;
        self.settle_origin();
        self.statistics = std::mem::take(&mut self.done_early);
        Ok(())
    }

    /// Step of a query, or of work done early, with the bodies it works on and the finder of pairs.
    pub(crate) fn step<'q>(
        &'q mut self,
        needs: Needs,
        interrupt: &'q Interrupt<'q>,
        early: bool,
    ) -> (Step<'q>, &'q mut Bodies<S>, &'q mut BodyPairs) {
        let refit = Refit {
            executor: Executor {
                threads: self.threads.here(),
                interrupt,
            },
            instructions: self.instructions,
            update: self.options.update,
        };
        let step = Step {
            needs,
            refit,
            origin: self.origin.point,
            scratch: &mut self.scratch,
            statistics: if early {
                &mut self.done_early
            } else {
                &mut self.statistics
            },
        };
        (step, &mut self.bodies, &mut self.body_pairs)
    }

    /// Processes the pairs of bodies of a query, batch by batch, until one breaks.
    fn for_each_batch(
        &mut self,
        needs: Needs,
        request: &Request,
        interrupt: &Interrupt,
        early: bool,
        meet: Meet<S>,
    ) -> Result<(), Error> {
        let (mut step, bodies, body_pairs) = self.step(needs, interrupt, early);
        let (boxes, origin) = (needs.body_boxes(), step.origin);
        let threads = (step.refit.executor, step.refit.instructions);
        body_pairs.begin(request.of, bodies, boxes, origin, threads.0)?;
        // Bodies with themselves are a batch of their own, the first. What is refitted then does
        // not depend on the order in which threads take the others.
        while let Some(pairs) = body_pairs.next(bodies, threads) {
            if meet(&mut step, bodies, pairs).is_break() {
                break;
            }
        }
        self.end(interrupt)
    }

    /// Does early what a query does first: finds the bodies that may meet, and refits the upper
    /// levels of their trees.
    pub(crate) fn prepare(&mut self, needs: Needs, request: &Request) -> Result<(), Error> {
        let interrupt = Interrupt::new(request.question);
        self.bodies.validate(request.of)?;
        self.settle_origin();
        let meet: Meet<S> = &mut |step, bodies, pairs| {
            for &[a, b] in pairs {
                let partner = if a == b {
                    Partner::Itself
                } else {
                    Partner::Another
                };
                for place in [a, b] {
                    step.prepare(bodies.at_mut(place), partner)?;
                }
            }
            ControlFlow::Continue(())
        };
        self.for_each_batch(needs, request, &interrupt, true, meet)
    }

    /// Ends a query. After an interrupt, drops all state that may be half done, and fails.
    pub(crate) fn end(&mut self, interrupt: &Interrupt) -> Result<(), Error> {
        if !interrupt.is_set() {
            return Ok(());
        }
        self.bodies.all_mut().for_each(Body::forget_boxes);
        self.body_pairs.forget();
        Err(ErrorKind::Interrupted.of_query())
    }

    pub(crate) fn settle_origin(&mut self) {
        if self.origin.settle(&mut self.bodies) {
            self.body_pairs.forget();
        }
    }

    /// Notes that a body has a new shape or box.
    pub(crate) fn note_movement(&mut self) {
        self.origin.note_movement();
        self.body_pairs.forget();
    }
}

empty!(Asked<K: Kind>: tasks, together, sorter, lists, listed, measured);

held!(Asked<K: Kind>: tasks, together, sorter, listed[], measured[];
    |asked| asked.lists.held_by(held::list));
