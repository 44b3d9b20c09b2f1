//! What a world keeps for one kind of query, and how one is answered: all that is found, or shown to a sink until it breaks.

use super::bodies::Bodies;
use super::body_pairs::BodyPairs;
use super::origin::FloatingOrigin;
use super::query::Request;
use super::scheduler::{Scheduler, is_worth_it};
use super::step::Step;
use crate::error::{Error, ErrorKind};
use crate::held::{self, Held};
use crate::hits::{Hit, Numbered};
use crate::kernels::{Coordinate, Instructions};
use crate::options::Options;
use crate::queries::Kind;
use crate::sort::{Sorter, sort_by_numbers};
use crate::statistics::Statistics;
use crate::threads::{Executor, Interrupt, PerThread, Threads};
use crate::traversal::{Scratch, Sink, Visitor};
use crate::update::{Partner, Refit};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What queries of every kind work on: all of a world but what single kinds keep.
pub(super) struct Common<S> {
    pub(super) options: Options,
    pub(super) instructions: Instructions,
    pub(super) threads: Threads,
    pub(super) bodies: Bodies<S>,
    pub(super) body_pairs: BodyPairs,
    pub(super) origin: FloatingOrigin,
    /// The work of the last query.
    pub(super) statistics: Statistics,
    /// The work that was done early since the last query.
    pub(super) done_early: Statistics,
}

/// Buffers of one kind, kept from query to query.
#[derive(Debug)]
pub(super) struct Asked<K: Kind> {
    pub(super) scratch: Scratch<K>,
    scheduler: Scheduler<K>,
    sorter: Sorter<K::Hit>,
    /// Hits that are more than their numbers, of every thread; the first of these lists is that of all in the end.
    lists: PerThread<Vec<K::Hit>>,
}

impl<K: Kind> Default for Asked<K> {
    fn default() -> Self {
        Self {
            scratch: Scratch::default(),
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
    pub(super) fn all(
        &mut self,
        kind: &K,
        common: &mut Common<K::Scalar>,
        request: &Request,
    ) -> Result<&[K::Hit], Error> {
        let interrupt = Interrupt::new(request.question);
        self.sorter.begin(common.executor(&interrupt));
        let keep = &|found: &[K::Hit]| self.sorter.push(found);
        let buffers = (&mut self.scratch, &mut self.scheduler);
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
        (scratch, scheduler): (&mut Scratch<K>, &mut Scheduler<K>),
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
        let mut sink = Sink::Collector(collector);
        scratch.begin(&sink);
        let (mut step, bodies, body_pairs) =
            Self::step(scratch, kind, common, request, interrupt, false)?;
        let instructions = step.refit.instructions;
        // Bodies with themselves are a batch of their own, the first: what is refitted then does not depend on the order in which
        // threads take the others.
        'batches: while let Some(pairs) = body_pairs.next(bodies, instructions, interrupt) {
            if is_worth_it(step.refit.executor, bodies, pairs) {
                if scheduler
                    .meet(&mut step, bodies, pairs, collector)
                    .is_break()
                {
                    break;
                }
                continue;
            }
            for &pair in pairs {
                if step.meet(bodies, pair, &mut sink).is_break() {
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
    pub(super) fn all_listed(
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
        let buffers = (&mut self.scratch, &mut self.scheduler);
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
    pub(super) fn search(
        &mut self,
        kind: &K,
        common: &mut Common<K::Scalar>,
        request: &Request,
    ) -> Result<(), Error> {
        let interrupt = Interrupt::new(request.question);
        let buffers = (&mut self.scratch, &mut self.scheduler);
        Self::collect(buffers, kind, common, request, &interrupt, &|_| {})
    }

    /// Shows every hit once, until the visitor breaks.
    pub(super) fn visit(
        &mut self,
        kind: &K,
        common: &mut Common<K::Scalar>,
        request: &Request,
        visitor: Visitor<K::Hit>,
    ) -> Result<(), Error> {
        let interrupt = Interrupt::new(request.question);
        common.begin(request)?;
        let mut sink = Sink::Visitor(visitor);
        self.scratch.begin(&sink);
        let (mut step, bodies, body_pairs) =
            Self::step(&mut self.scratch, kind, common, request, &interrupt, false)?;
        let instructions = step.refit.instructions;
        'batches: while let Some(pairs) = body_pairs.next(bodies, instructions, &interrupt) {
            for &pair in pairs {
                if step.meet(bodies, pair, &mut sink).is_break() {
                    break 'batches;
                }
            }
        }
        common.end(&interrupt)
    }

    /// Does early what a query would do first: finds the bodies that may meet and refits the upper levels of their trees.
    pub(super) fn prepare(
        &mut self,
        kind: &K,
        common: &mut Common<K::Scalar>,
        request: &Request,
    ) -> Result<(), Error> {
        let interrupt = Interrupt::new(request.question);
        common.bodies.validate(request.of)?;
        common.settle_origin();
        let (mut step, bodies, body_pairs) =
            Self::step(&mut self.scratch, kind, common, request, &interrupt, true)?;
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
        common.end(&interrupt)
    }

    /// A query that begins, the bodies it works on, and which of them meet.
    fn step<'q>(
        scratch: &'q mut Scratch<K>,
        kind: &'q K,
        common: &'q mut Common<K::Scalar>,
        request: &Request,
        interrupt: &'q Interrupt<'q>,
        early: bool,
    ) -> Result<(Step<'q, K>, &'q mut Bodies<K::Scalar>, &'q mut BodyPairs), Error> {
        let Common {
            options,
            instructions,
            threads,
            bodies,
            body_pairs,
            origin,
            statistics,
            done_early,
        } = common;
        let refit = Refit {
            executor: Executor {
                threads: threads.here(),
                interrupt,
            },
            instructions: *instructions,
            update: options.update,
        };
        let boxes = kind.body_boxes();
        body_pairs.begin(request.of, bodies, boxes, origin.point, interrupt)?;
        let step = Step {
            kind,
            refit,
            origin: origin.point,
            scratch,
            statistics: if early { done_early } else { statistics },
        };
        Ok((step, bodies, body_pairs))
    }
}

impl<S: Coordinate> Common<S> {
    /// The threads that work on a query.
    pub(super) fn executor<'q>(&'q mut self, interrupt: &'q Interrupt<'q>) -> Executor<'q> {
        Executor {
            threads: self.threads.here(),
            interrupt,
        }
    }

    /// At the beginning of every query.
    pub(super) fn begin(&mut self, request: &Request) -> Result<(), Error> {
        self.bodies.validate(request.of)?;
        self.settle_origin();
        self.statistics = std::mem::take(&mut self.done_early);
        Ok(())
    }

    /// At the end of every query: if it was interrupted, nothing that it left half done is believed.
    pub(super) fn end(&mut self, interrupt: &Interrupt) -> Result<(), Error> {
        if !interrupt.is_set() {
            return Ok(());
        }
        for body in &mut self.bodies.list {
            body.forget_boxes();
        }
        self.body_pairs.forget();
        Err(ErrorKind::Interrupted.of_query())
    }

    pub(super) fn settle_origin(&mut self) {
        if self.origin.settle(&mut self.bodies.list) {
            self.body_pairs.forget();
        }
    }

    /// A body has a new shape or box.
    pub(super) fn note_movement(&mut self) {
        self.origin.note_movement();
        self.body_pairs.forget();
    }
}

impl<K: Kind> Held for Asked<K> {
    fn held(&self) -> usize {
        self.scratch.held()
            + self.scheduler.held()
            + self.sorter.held()
            + self.lists.held_by(held::list)
    }
}
