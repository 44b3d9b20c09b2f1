//! What a world keeps for one kind of query, and how one is answered: all that is found, or shown to a sink until it breaks.

use super::answer::{Answer, TaskList};
use super::body_pairs::BodyPairs;
use super::origin::FloatingOrigin;
use super::request::Request;
use super::scheduler::{Scheduler, is_worth_it};
use super::step::Step;
use crate::bodies::Bodies;
use crate::error::{Error, ErrorKind};
use crate::held::{self, Held};
use crate::kernels::{Coordinate, Instructions};
use crate::options::Options;
use crate::queries::{Kind, Needs};
use crate::sort::{Hit, Numbered, Sorter, sort_by_numbers};
use crate::statistics::Statistics;
use crate::threads::{Executor, Interrupt, PerThread, Threads};
use crate::traversal::{Scratch, Sink, Visitor};
use crate::update::{Partner, Refit};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What queries of every kind work on: all of a world but what single kinds keep.
pub(crate) struct Common<S> {
    pub(crate) options: Options,
    pub(crate) instructions: Instructions,
    pub(crate) threads: Threads,
    pub(crate) bodies: Bodies<S>,
    pub(crate) body_pairs: BodyPairs,
    pub(crate) origin: FloatingOrigin,
    /// Buffers of the descent.
    pub(crate) scratch: Scratch,
    /// The work of the last query.
    pub(crate) statistics: Statistics,
    /// The work that was done early since the last query.
    pub(crate) done_early: Statistics,
}

/// Buffers of one kind, kept from query to query.
#[derive(Debug)]
pub(crate) struct Asked<K: Kind> {
    pub(crate) tasks: TaskList<K>,
    scheduler: Scheduler<K>,
    sorter: Sorter<K::Hit>,
    /// Hits that are more than their numbers, of every thread; the first of these lists is that of all in the end.
    lists: PerThread<Vec<K::Hit>>,
}

impl<K: Kind> Default for Asked<K> {
    fn default() -> Self {
        Self {
            tasks: TaskList::default(),
            scheduler: Scheduler::default(),
            sorter: Sorter::default(),
            lists: PerThread::default(),
        }
    }
}

impl<K: Kind<Hit: Hit>> Asked<K>
where
    K::Scalar: Coordinate,
{
    /// All hits, sorted.
    pub(crate) fn all(
        &mut self,
        kind: &K,
        common: &mut Common<K::Scalar>,
        request: &Request,
    ) -> Result<&[K::Hit], Error> {
        let interrupt = Interrupt::new(request.question);
        self.sorter.begin(common.executor(&interrupt));
        let keep = &|found: &[K::Hit]| self.sorter.push(found);
        let buffers = (&mut self.tasks, &mut self.scheduler);
        Self::collect(buffers, kind, common, request, &interrupt, keep)?;
        let instructions = common.instructions;
        let executor = common.executor(&interrupt);
        self.sorter.sort(executor, instructions);
        common.end(&interrupt)?;
        Ok(self.sorter.hits())
    }
}

impl<K: Kind> Asked<K>
where
    K::Scalar: Coordinate,
{
    /// Has every thread keep what it finds, some hits at a time. It is an error if there are more than the request allows.
    fn collect(
        (tasks, scheduler): (&mut TaskList<K>, &mut Scheduler<K>),
        kind: &K,
        common: &mut Common<K::Scalar>,
        request: &Request,
        interrupt: &Interrupt,
        keep: &(dyn Fn(&[K::Hit]) + Sync),
    ) -> Result<(), Error> {
        common.begin(request)?;
        let count = AtomicUsize::new(0);
        let collector = &|found: &[K::Hit]| {
            let before = count.fetch_add(found.len(), Ordering::Relaxed);
            if before.saturating_add(found.len()) > request.most {
                return ControlFlow::Break(());
            }
            keep(found);
            ControlFlow::Continue(())
        };
        let mut answer = Answer::new(kind, tasks, Sink::Collector(collector));
        common.scratch.begin(true);
        let (mut step, bodies, body_pairs) =
            common.step(kind.needs(), request, interrupt, false)?;
        let instructions = step.refit.instructions;
        // Bodies with themselves are a batch of their own, the first: what is refitted then does not depend on the order in which
        // threads take the others.
        'batches: while let Some(pairs) = body_pairs.next(bodies, instructions, interrupt) {
            if is_worth_it(step.refit.executor, bodies, pairs) {
                if scheduler
                    .meet(&mut step, &mut answer, bodies, pairs, collector)
                    .is_break()
                {
                    break;
                }
                continue;
            }
            for &pair in pairs {
                if step.meet(bodies, pair, &mut answer).is_break() {
                    break 'batches;
                }
            }
        }
        common.end(interrupt)?;
        if count.into_inner() > request.most {
            let limit = request.most;
            return Err(ErrorKind::TooManyHits { limit }.of_query());
        }
        Ok(())
    }

    /// All hits, sorted; for kinds whose hits are more than their numbers.
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
        let buffers = (&mut self.tasks, &mut self.scheduler);
        Self::collect(buffers, kind, common, request, &interrupt, keep)?;
        let mut lists = self.lists.iter_mut();
        let Some(all) = lists.next() else {
            return Ok(&[]);
        };
        lists.for_each(|list| all.append(list));
        sort_by_numbers(all);
        Ok(all)
    }

    /// Goes through all candidates of a kind that keeps to itself what it finds.
    pub(crate) fn search(
        &mut self,
        kind: &K,
        common: &mut Common<K::Scalar>,
        request: &Request,
    ) -> Result<(), Error> {
        let interrupt = Interrupt::new(request.question);
        let buffers = (&mut self.tasks, &mut self.scheduler);
        Self::collect(buffers, kind, common, request, &interrupt, &|_| {})
    }

    /// Shows every hit once, until the visitor breaks.
    pub(crate) fn visit(
        &mut self,
        kind: &K,
        common: &mut Common<K::Scalar>,
        request: &Request,
        visitor: Visitor<K::Hit>,
    ) -> Result<(), Error> {
        let interrupt = Interrupt::new(request.question);
        common.begin(request)?;
        let mut answer = Answer::new(kind, &mut self.tasks, Sink::Visitor(visitor));
        common.scratch.begin(false);
        let (mut step, bodies, body_pairs) =
            common.step(kind.needs(), request, &interrupt, false)?;
        let instructions = step.refit.instructions;
        'batches: while let Some(pairs) = body_pairs.next(bodies, instructions, &interrupt) {
            for &pair in pairs {
                if step.meet(bodies, pair, &mut answer).is_break() {
                    break 'batches;
                }
            }
        }
        common.end(&interrupt)
    }
}

impl<S: Coordinate> Common<S> {
    /// The threads that work on a query.
    pub(crate) fn executor<'q>(&'q mut self, interrupt: &'q Interrupt<'q>) -> Executor<'q> {
        Executor {
            threads: self.threads.here(),
            interrupt,
        }
    }

    /// At the beginning of every query.
    pub(crate) fn begin(&mut self, request: &Request) -> Result<(), Error> {
        self.bodies.validate(request.of)?;
        self.settle_origin();
        self.statistics = std::mem::take(&mut self.done_early);
        Ok(())
    }

    /// A query that begins, the bodies it works on, and which of them meet.
    fn step<'q>(
        &'q mut self,
        needs: Needs,
        request: &Request,
        interrupt: &'q Interrupt<'q>,
        early: bool,
    ) -> Result<(Step<'q>, &'q mut Bodies<S>, &'q mut BodyPairs), Error> {
        let Self {
            options,
            instructions,
            threads,
            bodies,
            body_pairs,
            origin,
            scratch,
            statistics,
            done_early,
        } = self;
        let refit = Refit {
            executor: Executor {
                threads: threads.here(),
                interrupt,
            },
            instructions: *instructions,
            update: options.update,
        };
        let boxes = needs.body_boxes();
        body_pairs.begin(request.of, bodies, boxes, origin.point, interrupt)?;
        let step = Step {
            needs,
            refit,
            origin: origin.point,
            scratch,
            statistics: if early { done_early } else { statistics },
        };
        Ok((step, bodies, body_pairs))
    }

    /// Does early what a query would do first: finds the bodies that may meet and refits the upper levels of their trees.
    pub(crate) fn prepare(&mut self, needs: Needs, request: &Request) -> Result<(), Error> {
        let interrupt = Interrupt::new(request.question);
        self.bodies.validate(request.of)?;
        self.settle_origin();
        let (mut step, bodies, body_pairs) = self.step(needs, request, &interrupt, true)?;
        let instructions = step.refit.instructions;
        'batches: while let Some(pairs) = body_pairs.next(bodies, instructions, &interrupt) {
            for &[a, b] in pairs {
                let partner = if a == b {
                    Partner::Itself
                } else {
                    Partner::Another
                };
                for place in [a, b] {
                    let body = &mut bodies.list[place.index()];
                    if step.prepare(body, partner).is_break() {
                        break 'batches;
                    }
                }
            }
        }
        self.end(&interrupt)
    }

    /// At the end of every query: if it was interrupted, nothing that it left half done is believed.
    pub(crate) fn end(&mut self, interrupt: &Interrupt) -> Result<(), Error> {
        if !interrupt.is_set() {
            return Ok(());
        }
        for body in &mut self.bodies.list {
            body.forget_boxes();
        }
        self.body_pairs.forget();
        Err(ErrorKind::Interrupted.of_query())
    }

    pub(crate) fn settle_origin(&mut self) {
        if self.origin.settle(&mut self.bodies.list) {
            self.body_pairs.forget();
        }
    }

    /// A body has a new shape or box.
    pub(crate) fn note_movement(&mut self) {
        self.origin.note_movement();
        self.body_pairs.forget();
    }
}

impl<K: Kind> Held for Asked<K> {
    fn held(&self) -> usize {
        self.tasks.held()
            + self.scheduler.held()
            + self.sorter.held()
            + self.lists.held_by(held::list)
    }
}
