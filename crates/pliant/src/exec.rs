//! One thread or many: the only file that names a thread pool.
//!
//! Work is cut into jobs by its size, never by the number of threads; every job writes what is its own, and what the jobs have
//! found is put together in their order. So answers, their order and all counters are the same for any number of threads.

use std::num::NonZeroUsize;
use std::sync::{Mutex, PoisonError};

/// More than there are jobs in the largest of batches.
const MOST: usize = 256;

/// The threads of a world.
#[derive(Debug)]
pub(crate) struct Threads {
    /// The others beside the one that calls; none if that is all.
    others: Option<rayon::ThreadPool>,
}

impl Threads {
    /// `count` threads, the calling one included, but not more than [`MOST`]. Where the system gives none, the calling thread does all work.
    pub(crate) fn new(count: NonZeroUsize) -> Self {
        let others = (count.get() > 1).then(|| {
            rayon::ThreadPoolBuilder::new()
                .num_threads(count.get().min(MOST) - 1)
                .thread_name(|thread| format!("pliant {}", thread + 1))
                .build()
        });
        Self {
            others: others.and_then(Result::ok),
        }
    }

    /// Whether there are others than the calling thread.
    pub(crate) fn are_many(&self) -> bool {
        self.others.is_some()
    }

    /// Does all jobs; returns when all are done.
    pub(crate) fn run<J: Send>(&self, jobs: &mut [J], work: impl Fn(usize, &mut J) + Sync) {
        match &self.others {
            Some(others) if jobs.len() > 1 => {
                let helpers = others.current_num_threads().min(jobs.len() - 1);
                let rest = Mutex::new(jobs.iter_mut().enumerate());
                let take_jobs = || {
                    loop {
                        let next = rest.lock().unwrap_or_else(PoisonError::into_inner).next();
                        let Some((number, job)) = next else { break };
                        work(number, job);
                    }
                };
                others.in_place_scope(|scope| {
                    for _ in 0..helpers {
                        scope.spawn(|_| take_jobs());
                    }
                    take_jobs();
                });
            }
            _ => {
                for (number, job) in jobs.iter_mut().enumerate() {
                    work(number, job);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_job_is_done_once_and_knows_its_number() {
        for threads in [1, 2, 7] {
            let threads = Threads::new(NonZeroUsize::new(threads).unwrap());
            for count in [0, 1, 2, 100] {
                let mut jobs = vec![0; count];
                threads.run(&mut jobs, |number, job| *job += number + 1);
                assert!(jobs.iter().copied().eq(1..=count));
            }
        }
    }
}
