//! The scheduler of pairs of bodies: many at once, each on one thread, no two of them with a body in common.
//!
//! Where bodies are small there is little to share within one pair of them. So, for a query that wants all there is, every thread
//! takes pairs whose bodies no other has at that moment. Bodies with themselves go first; then which boxes are made does not depend on the
//! order in which bodies meet, so neither do the counters; and what was found is put together in the order of the pairs. A pair that is
//! much of all the work is met by all threads together.

use super::bodies::Bodies;
use super::body::Body;
use super::body_pairs::BodyPair;
use super::step::Step;
use crate::held::{self, Held};
use crate::ids::Place;
use crate::kernels::Coordinate;
use crate::queries::Kind;
use crate::statistics::Statistics;
use crate::threads::{Executor, Threads, locked};
use crate::traversal::{Scratch, Wanted};
use crate::update::Refit;
use std::ops::{ControlFlow, Range};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Pairs of bodies of fewer triangles, all together, are not worth waking a thread.
const SHARED: usize = 1 << 16;
/// One thread meets pairs of at least so many triangles before it asks for more.
const JOB: usize = 1 << 13;
/// The most pairs that one thread takes at once.
const LONGEST_JOB: usize = 16;
/// A pair of more triangles than a thread's part of them all, divided by this, is met by all threads together.
const PARTS: usize = 4;

/// Buffers, kept from query to query.
#[derive(Debug)]
pub(super) struct Scheduler<K: Kind> {
    workers: Vec<Worker<K>>,
    /// The numbers of pairs that are met by all threads.
    large: Vec<usize>,
    /// The numbers of pairs that are met by one thread; the places of their bodies; and jobs, some of them in a row.
    small: Vec<usize>,
    places: Vec<[usize; 2]>,
    jobs: Vec<Range<usize>>,
    /// What all of them found: by worker.
    found: Vec<(usize, OfPair)>,
}

/// What one thread works with, and what it has found.
#[derive(Debug)]
struct Worker<K: Kind> {
    scratch: Scratch<K>,
    statistics: Statistics,
    /// What pairs of bodies have in common, one pair after the other.
    hits: Vec<K::Hit>,
    found: Vec<OfPair>,
}

/// A pair of bodies by its number, and where among the hits of a worker its are.
#[derive(Clone, Debug)]
struct OfPair {
    pair: usize,
    hits: Range<usize>,
}

impl<K: Kind> Default for Scheduler<K> {
    fn default() -> Self {
        Self {
            workers: Vec::new(),
            large: Vec::new(),
            small: Vec::new(),
            places: Vec::new(),
            jobs: Vec::new(),
            found: Vec::new(),
        }
    }
}

impl<K: Kind> Default for Worker<K> {
    fn default() -> Self {
        Self {
            scratch: Scratch::default(),
            statistics: Statistics::default(),
            hits: Vec::new(),
            found: Vec::new(),
        }
    }
}

impl<K: Kind> Worker<K> {
    fn begin(&mut self) {
        self.scratch.begin(Wanted::All);
        self.statistics = Statistics::default();
        self.hits.clear();
        self.found.clear();
    }
}

/// What was found, by worker, in the order of the pairs.
fn in_order_of_pairs(found: &mut [(usize, OfPair)]) {
    found.sort_unstable_by_key(|(_, of_pair)| of_pair.pair);
}

/// Whether pairs of bodies are worth it.
pub(super) fn is_worth_it<const N: usize, S: Coordinate>(
    executor: Executor,
    bodies: &Bodies<N, S>,
    pairs: &[BodyPair],
) -> bool {
    executor.are_many() && pairs.len() > 1 && triangles_of(bodies, pairs) >= SHARED
}

/// The triangles of both bodies of all pairs.
fn triangles_of<const N: usize, S: Coordinate>(bodies: &Bodies<N, S>, pairs: &[BodyPair]) -> usize {
    let places = pairs.as_flattened().iter();
    places
        .map(|place| bodies.list[place.index()].triangle_count())
        .sum()
}

impl<K: Kind> Scheduler<K> {
    /// Meets all pairs of bodies, unless it is interrupted. Returns false if there are more than `most` hits, of which it keeps some.
    pub(super) fn meet<const N: usize>(
        &mut self,
        step: &mut Step<K>,
        bodies: &mut Bodies<N, K::Scalar>,
        pairs: &[BodyPair],
        most: usize,
    ) -> bool {
        let executor = step.refit.executor;
        self.workers.resize_with(executor.count(), Worker::default);
        self.workers.iter_mut().for_each(Worker::begin);
        self.cut(bodies, pairs);
        let count = AtomicUsize::new(0);
        // Keeps hits, unless there are too many of them.
        let keep = |hits: &mut Vec<K::Hit>, new: &[K::Hit]| {
            if count.fetch_add(new.len(), Ordering::Relaxed) + new.len() > most {
                return ControlFlow::Break(0);
            }
            hits.extend_from_slice(new);
            ControlFlow::Continue(())
        };
        let Self {
            workers,
            large,
            small,
            places,
            jobs,
            found,
        } = self;
        let Worker {
            hits,
            found: of_first,
            ..
        } = &mut workers[0];
        for &pair in &*large {
            let first = hits.len();
            let _ = step.meet(bodies, pairs[pair], &mut |new| keep(hits, new));
            let hits = first..hits.len();
            of_first.push(OfPair { pair, hits });
        }

        let all: Vec<_> = bodies.list.iter_mut().map(Mutex::new).collect();
        let threads = &Threads::one();
        let (kind, refit, origin) = (step.kind, step.refit, step.origin);
        let bodies_of = &|job: usize| places[jobs[job].clone()].as_flattened();
        executor.run_conflict_free(jobs.len(), bodies_of, all.len(), workers, &|worker, job| {
            let alone = Executor {
                threads,
                interrupt: executor.interrupt,
            };
            let mut step = Step {
                kind,
                refit: Refit {
                    executor: alone,
                    ..refit
                },
                origin,
                scratch: &mut worker.scratch,
                statistics: &mut worker.statistics,
            };
            for at in jobs[job].clone() {
                let first = worker.hits.len();
                let sink = &mut |new: &[K::Hit]| keep(&mut worker.hits, new);
                // No other thread has these bodies: no lock is ever waited for.
                let [a, b] = places[at];
                let _ = if a == b {
                    step.meet_itself(&mut locked(&all[a]), sink)
                } else {
                    let [mut a, mut b] = [a, b].map(|place| locked(&all[place]));
                    let both: [&mut Body<N, K::Scalar>; 2] = [&mut a, &mut b];
                    step.meet_another(both, sink)
                };
                let hits = first..worker.hits.len();
                let pair = small[at];
                worker.found.push(OfPair { pair, hits });
            }
        });

        found.clear();
        for (number, worker) in workers.iter().enumerate() {
            *step.statistics += worker.statistics;
            let of_worker = worker.found.iter();
            found.extend(of_worker.map(|of_pair| (number, of_pair.clone())));
        }
        in_order_of_pairs(found);
        count.into_inner() <= most
    }

    /// Cuts small pairs into jobs. How it does changes no answer, so it may look at the number of threads.
    fn cut<const N: usize, S: Coordinate>(&mut self, bodies: &Bodies<N, S>, pairs: &[BodyPair]) {
        self.large.clear();
        self.small.clear();
        self.places.clear();
        self.jobs.clear();
        let much = triangles_of(bodies, pairs) / (PARTS * self.workers.len());
        let mut in_job = 0;
        for (pair, &places) in pairs.iter().enumerate() {
            let triangles = triangles_of(bodies, &[places]);
            if triangles >= much {
                self.large.push(pair);
                continue;
            }
            let at = self.small.len();
            match self.jobs.last_mut() {
                Some(job) if in_job < JOB && job.len() < LONGEST_JOB => job.end += 1,
                _ => {
                    self.jobs.push(at..at + 1);
                    in_job = 0;
                }
            }
            in_job += triangles;
            self.small.push(pair);
            self.places.push(places.map(Place::index));
        }
    }

    /// What was found then, in the order of the pairs.
    pub(super) fn found(&self) -> impl Iterator<Item = &[K::Hit]> {
        let hits_of = |(worker, of_pair): &(usize, OfPair)| {
            let hits = of_pair.hits.clone();
            &self.workers[*worker].hits[hits]
        };
        self.found.iter().map(hits_of)
    }
}

impl<K: Kind> Held for Scheduler<K> {
    fn held(&self) -> usize {
        held::lists(&self.workers)
            + held::list(&self.large)
            + held::list(&self.small)
            + held::list(&self.places)
            + held::list(&self.jobs)
            + held::list(&self.found)
    }
}

impl<K: Kind> Held for Worker<K> {
    fn held(&self) -> usize {
        self.scratch.held() + held::list(&self.hits) + held::list(&self.found)
    }
}
