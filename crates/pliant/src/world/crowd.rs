//! Many pairs of bodies at once, each met by one thread.
//!
//! Where bodies are small there is little to share within one pair of them. So, for a query that wants all there is, every thread
//! takes pairs whose bodies no other has at that moment. Which boxes a step needs does not depend on the order in which bodies
//! meet, so neither do the counters; and what was found is shown in the order of the pairs. A pair that is much of all the work is
//! met by all threads together.

use super::body::Body;
use super::step::{Planted, Step};
use crate::exec::{Threads, locked};
use crate::geometry::Scalar;
use crate::statistics::Statistics;
use crate::traversal::{Scratch, Wanted};
use crate::tree::Tree;
use std::ops::{ControlFlow, Range};
use std::sync::Mutex;

/// Pairs of bodies of fewer triangles, all together, are not worth waking a thread.
const SHARED: usize = 1 << 16;
/// One thread meets pairs of at least so many triangles before it asks for more,
const JOB: usize = 1 << 13;
/// but not more pairs than this.
const LONGEST_JOB: usize = 16;
/// A pair of more triangles than a thread's part of them all, divided by this, is met by all threads together.
const PARTS: usize = 4;

/// Buffers, kept from query to query.
#[derive(Debug, Default)]
pub(super) struct Crowd {
    workers: Vec<Worker>,
    /// The numbers of pairs that are met by all threads,
    large: Vec<usize>,
    /// and of those that are met by one; the places of their bodies; and some of them in a row.
    small: Vec<usize>,
    places: Vec<[usize; 2]>,
    jobs: Vec<Range<usize>>,
    /// What all of them found: by worker.
    met: Vec<(usize, Met)>,
}

/// What one thread works with, and what it has found.
#[derive(Debug, Default)]
struct Worker {
    scratch: Scratch,
    statistics: Statistics,
    found: Found,
}

/// What pairs of bodies have in common, one after the other.
#[derive(Debug, Default)]
struct Found {
    triangles: Vec<[u32; 2]>,
    met: Vec<Met>,
}

/// A pair of bodies by its number, and where among the pairs of triangles those of these bodies are.
#[derive(Clone, Debug)]
struct Met {
    pair: usize,
    triangles: Range<usize>,
}

impl Worker {
    fn begin(&mut self) {
        self.scratch.begin(Wanted::All);
        self.statistics = Statistics::default();
        self.found.triangles.clear();
        self.found.met.clear();
    }
}

impl Found {
    /// Meets a pair of bodies and keeps what is found.
    fn meet<const N: usize, S: Scalar>(
        &mut self,
        step: &mut Step,
        pair: usize,
        both: [Planted<N, S>; 2],
    ) {
        let first = self.triangles.len();
        let _ = step.meet(both, &mut |found| {
            self.triangles.extend_from_slice(found);
            ControlFlow::Continue(())
        });
        let triangles = first..self.triangles.len();
        self.met.push(Met { pair, triangles });
    }
}

/// Whether pairs of bodies, by their places, are worth it.
pub(super) fn is_worth_it<S: Scalar>(
    threads: &Threads,
    bodies: &[Body<S>],
    pairs: &[[usize; 2]],
) -> bool {
    threads.are_many() && pairs.len() > 1 && triangles_of(bodies, pairs) >= SHARED
}

/// The triangles of both bodies of all pairs.
fn triangles_of<S: Scalar>(bodies: &[Body<S>], pairs: &[[usize; 2]]) -> usize {
    let places = pairs.as_flattened().iter();
    places.map(|&place| bodies[place].triangle_count()).sum()
}

impl Crowd {
    /// Meets all pairs of bodies, given by their places.
    pub(super) fn meet<const N: usize, S: Scalar>(
        &mut self,
        step: &mut Step,
        bodies: &mut [Body<S>],
        trees: &mut [Tree<N>],
        pairs: &[[usize; 2]],
    ) {
        let threads = step.threads;
        self.workers.resize_with(threads.count(), Worker::default);
        self.workers.iter_mut().for_each(Worker::begin);
        self.cut(bodies, pairs);
        let Self {
            workers,
            large,
            small,
            places,
            jobs,
            met,
        } = self;
        for &pair in &*large {
            let both = Planted::both(bodies, trees, pairs[pair]);
            workers[0].found.meet(step, pair, both);
        }

        let all = bodies.iter_mut().zip(trees);
        let all: Vec<_> = all
            .map(|(body, tree)| Mutex::new(Planted { body, tree }))
            .collect();
        let alone = Threads::one();
        let (update, level, origin) = (step.update, step.level, step.origin);
        let bodies_of = |job: &Range<usize>| places[job.clone()].as_flattened();
        threads.run_apart(jobs, bodies_of, all.len(), workers, |worker, job| {
            let mut step = Step {
                update,
                level,
                threads: &alone,
                origin,
                scratch: &mut worker.scratch,
                statistics: &mut worker.statistics,
            };
            for at in job.clone() {
                // No other thread has these bodies: it never waits.
                let mut both = places[at].map(|place| locked(&all[place]));
                let both = both.each_mut().map(|one| one.again());
                worker.found.meet(&mut step, small[at], both);
            }
        });

        met.clear();
        for (number, worker) in workers.iter().enumerate() {
            *step.statistics += worker.statistics;
            met.extend(worker.found.met.iter().map(|met| (number, met.clone())));
        }
        met.sort_unstable_by_key(|(_, met)| met.pair);
    }

    /// Cuts small pairs into jobs. How it does changes no answer, so it may look at the number of threads.
    fn cut<S: Scalar>(&mut self, bodies: &[Body<S>], pairs: &[[usize; 2]]) {
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
            self.places.push(places);
        }
    }

    /// What was found then: a pair of bodies by its number, and the pairs of triangles of these; in the order of the pairs.
    pub(super) fn found(&self) -> impl Iterator<Item = (usize, &[[u32; 2]])> {
        let found = |(worker, met): &(usize, Met)| {
            let triangles = met.triangles.clone();
            (met.pair, &self.workers[*worker].found.triangles[triangles])
        };
        self.met.iter().map(found)
    }
}
