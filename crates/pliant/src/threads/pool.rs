//! Threads beside the calling one: how they share jobs, wake, wait and fall asleep.
//!
//! A step is some dozens of parts, each shorter than it takes to wake a thread. So threads of a
//! private pool that were woken look for more for a while before they sleep; as many as the part
//! pays, and no others. Each begins with jobs side by side, and helps others from the back when
//! these are done: what a thread wrote in one part it is likely to read in the next. Threads of a
//! pool that an application has lent are not kept awake.

use super::lock::locked;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// How long a thread looks for more to do before it sleeps: longer than one thread alone works in
/// the middle of a query.
pub(super) const AWAKE: Duration = Duration::from_micros(200);
/// How often a thread that waits looks before it lets others have its core in between.
const LOOKS: u32 = 100;

/// Threads of a pool.
#[derive(Debug)]
pub(super) struct Helpers {
    pub(super) pool: Arc<rayon::ThreadPool>,
    /// The most of them that are used.
    pub(super) count: usize,
    /// How many threads of a private pool are awake; none for a pool that was lent.
    pub(super) awake: Option<Arc<AtomicUsize>>,
    /// The process that has them: the child of a fork has the pool, but none of its threads.
    pub(super) process: u32,
}

impl Drop for Helpers {
    fn drop(&mut self) {
        if self.are_elsewhere() {
            // What a thread of the parent had locked when it forked nobody will unlock. So the pool is left as it is.
            std::mem::forget(Arc::clone(&self.pool));
        }
    }
}

impl Helpers {
    pub(super) fn of(
        pool: Arc<rayon::ThreadPool>,
        count: usize,
        awake: Option<Arc<AtomicUsize>>,
    ) -> Self {
        Self {
            pool,
            count,
            awake,
            process: std::process::id(),
        }
    }

    pub(super) fn are_elsewhere(&self) -> bool {
        self.process != std::process::id()
    }

    /// Does all jobs together with the calling thread, by so many threads at most.
    pub(super) fn share<J: Send>(
        &self,
        jobs: &mut [J],
        threads: usize,
        work: &(dyn Fn(usize, &mut J) + Sync),
    ) {
        let size = jobs.len().div_ceil(threads);
        let shares: Vec<_> = jobs
            .chunks_mut(size)
            .enumerate()
            .map(|(which, jobs)| {
                Mutex::new(Share {
                    first: which * size,
                    jobs,
                })
            })
            .collect();
        self.help(shares.len() - 1, &|own| {
            do_all(&shares, own % shares.len(), work)
        });
    }

    /// Has so many helpers do something, and the calling thread too; tells each the number of its
    /// thread, which is 0 for this one. It knows no kind of job: scopes of a pool are much to compile.
    fn help(&self, helpers: usize, work: &(dyn Fn(usize) + Sync)) {
        self.wake(helpers);
        let done = AtomicUsize::new(0);
        self.pool.in_place_scope(|scope| {
            for _ in 0..helpers {
                scope.spawn(|_| {
                    work(rayon::current_thread_index().map_or(0, |thread| thread + 1));
                    done.fetch_add(1, Ordering::Release);
                });
            }
            work(0);
            // The end of the scope would put this thread to sleep at once.
            let mut backoff = Backoff::default();
            while done.load(Ordering::Acquire) < helpers && backoff.waits() {}
        });
    }

    /// Has so many threads of a private pool look for work from now on, unless they do.
    fn wake(&self, helpers: usize) {
        let Some(awake) = &self.awake else { return };
        let are = awake.load(Ordering::Acquire);
        for _ in are..helpers {
            awake.fetch_add(1, Ordering::Release);
            let awake = Arc::clone(awake);
            self.pool.spawn(move || {
                let mut backoff = Backoff::default();
                while backoff.waits() {
                    if rayon::yield_now() == Some(rayon::Yield::Executed) {
                        backoff = Backoff::default();
                    }
                }
                awake.fetch_sub(1, Ordering::Release);
            });
        }
    }
}

/// Jobs side by side: one thread takes them from the front, others from the back.
struct Share<'j, J> {
    first: usize,
    jobs: &'j mut [J],
}

impl<'j, J> Share<'j, J> {
    /// A job and its number.
    fn take(&mut self, from_front: bool) -> Option<(usize, &'j mut J)> {
        let jobs = std::mem::take(&mut self.jobs);
        let (job, rest) = if from_front {
            jobs.split_first_mut()?
        } else {
            jobs.split_last_mut()?
        };
        self.jobs = rest;
        let number = if from_front {
            self.first += 1;
            self.first - 1
        } else {
            self.first + self.jobs.len()
        };
        Some((number, job))
    }
}

/// Does the jobs of one share, and then of the others, until none is left.
fn do_all<J>(shares: &[Mutex<Share<'_, J>>], own: usize, work: &dyn Fn(usize, &mut J)) {
    let (before, after) = shares.split_at(own);
    for (which, share) in after.iter().chain(before).enumerate() {
        // Not in the condition of the loop: the lock would be held while the job is done.
        let take = || locked(share).take(which == 0);
        while let Some((number, job)) = take() {
            work(number, job);
        }
    }
}

/// Waiting for something that is about to happen: spinning at first, then giving way to other threads, and not for long.
#[derive(Default)]
pub(super) struct Backoff {
    looks: u32,
    since: Option<Instant>,
}

impl Backoff {
    /// Waits a moment; whether to go on waiting.
    pub(super) fn waits(&mut self) -> bool {
        self.looks += 1;
        if self.looks < LOOKS {
            std::hint::spin_loop();
            return true;
        }
        std::thread::yield_now();
        self.since.get_or_insert_with(Instant::now).elapsed() < AWAKE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_taken_from_both_ends() {
        let mut jobs = [10, 11, 12];
        let mut share = Share {
            first: 4,
            jobs: &mut jobs[..],
        };
        let mut take = |from_front| {
            share
                .take(from_front)
                .map(|(number, &mut job)| (number, job))
        };
        assert_eq!(take(false), Some((6, 12)));
        assert_eq!(take(true), Some((4, 10)));
        assert_eq!(take(false), Some((5, 11)));
        assert_eq!(take(true), None);
    }
}
