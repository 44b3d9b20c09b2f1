//! The scheduler of pairs of bodies: many at once, each on one thread, no two of them with a body in common.
//!
//! Where bodies are small there is little to share within one pair of them. So, for a query that wants all there is, every thread
//! takes pairs whose bodies no other has at that moment. Bodies with themselves go first; then which boxes are made does not depend on the
//! order in which bodies meet, so neither do the counters. A pair that is much of all the work is met by all threads together.

use super::answer::{Answer, TaskList};
use super::body_pairs::BodyPair;
use super::step::Step;
use crate::bodies::Bodies;
use crate::bodies::Body;
use crate::held::{empty, held};
use crate::ids::Place;
use crate::kernels::Coordinate;
use crate::queries::Kind;
use crate::statistics::Statistics;
use crate::threads::{Executor, Threads, locked};
use crate::traversal::{Collector, Scratch, Sink};
use crate::update::Refit;
use std::ops::{ControlFlow, Range};
use std::sync::Mutex;

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
pub(crate) struct Scheduler<K: Kind> {
    workers: Vec<Worker<K>>,
    /// The places of the bodies of pairs that are met by all threads, and of those that are met by one.
    large: Vec<BodyPair>,
    small: Vec<[usize; 2]>,
    /// Some of the small pairs in a row.
    jobs: Vec<Range<usize>>,
}

/// What one thread works with.
#[derive(Debug)]
struct Worker<K: Kind> {
    scratch: Scratch,
    tasks: TaskList<K>,
    statistics: Statistics,
}

/// Whether pairs of bodies are worth it.
pub(crate) fn is_worth_it<S: Coordinate>(
    executor: Executor,
    bodies: &Bodies<S>,
    pairs: &[BodyPair],
) -> bool {
    executor.are_many() && pairs.len() > 1 && triangles_of(bodies, pairs) >= SHARED
}

/// The triangles of both bodies of all pairs.
fn triangles_of<S: Coordinate>(bodies: &Bodies<S>, pairs: &[BodyPair]) -> usize {
    let places = pairs.as_flattened().iter();
    places.map(|&place| bodies.at(place).triangle_count()).sum()
}

impl<K: Kind> Scheduler<K> {
    /// Meets all pairs of bodies, unless it is interrupted or there are too many hits for the collector.
    pub(crate) fn meet(
        &mut self,
        step: &mut Step,
        answer: &mut Answer<K>,
        bodies: &mut Bodies<K::Scalar>,
        pairs: &[BodyPair],
        collector: Collector<K::Hit>,
    ) -> ControlFlow<()> {
        let executor = step.refit.executor;
        self.workers.resize_with(executor.count(), Worker::default);
        self.cut(bodies, pairs);
        for &pair in &self.large {
            step.meet(bodies, pair, answer)?;
        }
        for worker in &mut self.workers {
            worker.scratch.begin(true);
            worker.statistics = Statistics::default();
        }
        let (small, jobs) = (&self.small, &self.jobs);
        let all: Vec<_> = bodies.all_mut().map(Mutex::new).collect();
        let threads = &Threads::one();
        let kind = answer.kind();
        let (needs, refit, origin) = (step.needs, step.refit, step.origin);
        let bodies_of = &|job: usize| small[jobs[job].clone()].as_flattened();
        let workers = &mut self.workers;
        executor.run_conflict_free(jobs.len(), bodies_of, all.len(), workers, &|worker, job| {
            let alone = Executor {
                threads,
                interrupt: executor.interrupt,
            };
            let mut step = Step {
                needs,
                refit: Refit {
                    executor: alone,
                    ..refit
                },
                origin,
                scratch: &mut worker.scratch,
                statistics: &mut worker.statistics,
            };
            let answer = &mut Answer::new(kind, &mut worker.tasks, Sink::Collector(collector));
            for &[a, b] in &small[jobs[job].clone()] {
                // No other thread has these bodies: no lock is ever waited for.
                let _ = if a == b {
                    step.meet_itself(&mut locked(&all[a]), answer)
                } else {
                    let [mut a, mut b] = [a, b].map(|place| locked(&all[place]));
                    let both: [&mut Body<K::Scalar>; 2] = [&mut a, &mut b];
                    step.meet_another(both, answer)
                };
            }
        });
        for worker in &self.workers {
            *step.statistics += worker.statistics;
        }
        // Shown nothing, it says whether there were too many.
        collector(&[])
    }

    /// Cuts small pairs into jobs. How it does changes no answer, so it may look at the number of threads.
    fn cut<S: Coordinate>(&mut self, bodies: &Bodies<S>, pairs: &[BodyPair]) {
        self.large.clear();
        self.small.clear();
        self.jobs.clear();
        let much = triangles_of(bodies, pairs) / (PARTS * self.workers.len());
        let mut in_job = 0;
        for &pair in pairs {
            let triangles = triangles_of(bodies, &[pair]);
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
            self.small.push(pair.map(Place::index));
        }
    }
}

empty!(Scheduler<K: Kind>: workers, large, small, jobs);

held!(Scheduler<K: Kind>: workers, large[], small[], jobs[]);

empty!(Worker<K: Kind>: scratch, tasks, statistics);

held!(Worker<K: Kind>: scratch, tasks);
