//! One thread or many: the only file that names a thread pool.
//!
//! Work is cut into jobs by its size, never by the number of threads; every job writes what is its own, and what the jobs have
//! found is put together in their order. So answers, their order and all counters are the same for any number of threads.
//!
//! A step is some dozens of such parts, each shorter than it takes to wake a thread. So threads that were woken stay awake from one
//! part to the next, and a little longer. Each begins with jobs of its own, side by side, and helps others when these are done:
//! what a thread wrote in one part it is likely to read in the next.

use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// More than there are jobs in the largest of batches.
const MOST: usize = 256;
/// How long a thread looks for more to do before it sleeps: longer than what one thread alone does in the middle of a query.
const AWAKE: Duration = Duration::from_micros(200);
/// How many jobs are looked at for one whose things are not busy.
const LOOKED_AT: usize = 64;
/// How often it looks before it lets others have its core in between.
const LOOKS: u32 = 100;

/// The threads of a world.
#[derive(Debug)]
pub(crate) struct Threads {
    /// The others beside the one that calls; none if that is all.
    others: Option<Others>,
}

#[derive(Debug)]
struct Others {
    pool: rayon::ThreadPool,
    /// How many of them are awake.
    awake: Arc<AtomicUsize>,
}

impl Threads {
    /// The calling thread alone.
    pub(crate) fn one() -> Self {
        Self { others: None }
    }

    /// `count` threads, the calling one included, but not more than [`MOST`]. Where the system gives none, the calling thread does all work.
    pub(crate) fn new(count: NonZeroUsize) -> Self {
        let others = (count.get() > 1).then(|| {
            rayon::ThreadPoolBuilder::new()
                .num_threads(count.get().min(MOST) - 1)
                .thread_name(|thread| format!("pliant {}", thread + 1))
                .build()
        });
        Self {
            others: others.and_then(Result::ok).map(|pool| Others {
                pool,
                awake: Arc::default(),
            }),
        }
    }

    /// Whether there are others than the calling thread.
    pub(crate) fn are_many(&self) -> bool {
        self.others.is_some()
    }

    /// How many there are, the calling one included.
    pub(crate) fn count(&self) -> usize {
        let others = self.others.as_ref();
        1 + others.map_or(0, |others| others.pool.current_num_threads())
    }

    /// Does all jobs; returns when all are done.
    pub(crate) fn run<J: Send>(&self, jobs: &mut [J], work: impl Fn(usize, &mut J) + Sync) {
        match &self.others {
            Some(others) if jobs.len() > 1 => others.share(jobs, &work),
            _ => {
                for (number, job) in jobs.iter_mut().enumerate() {
                    work(number, job);
                }
            }
        }
    }
}

impl Threads {
    /// Does all jobs, each of which needs some things, such that no thing is in two jobs at once. Every worker does one after the
    /// other; which it does, nobody knows.
    pub(crate) fn run_apart<'t, J: Sync, W: Send>(
        &self,
        jobs: &[J],
        things_of: impl Fn(&J) -> &'t [usize] + Sync,
        things: usize,
        workers: &mut [W],
        work: impl Fn(&mut W, &J) + Sync,
    ) {
        let apart = Mutex::new(Apart {
            is_taken: vec![false; jobs.len()],
            first: 0,
            is_busy: vec![false; things],
        });
        self.run(workers, |_, worker| {
            let mut busy = Busy {
                apart: &apart,
                things: &[],
            };
            let mut patience = Patience::default();
            loop {
                let next = {
                    let mut apart = locked(&apart);
                    apart.set_busy(std::mem::take(&mut busy.things), false);
                    apart.take(jobs, &things_of)
                };
                match next {
                    Next::Job(job) => {
                        busy.things = things_of(job);
                        work(worker, job);
                        patience = Patience::default();
                    }
                    Next::Later => {
                        patience.is_left();
                    }
                    Next::Nothing => break,
                }
            }
        });
    }
}

/// Which jobs are taken, and which things are in one that is not done.
struct Apart {
    is_taken: Vec<bool>,
    /// Before it, all are taken.
    first: usize,
    is_busy: Vec<bool>,
}

enum Next<'j, J> {
    Job(&'j J),
    /// What is left must wait for things that are busy.
    Later,
    Nothing,
}

impl Apart {
    /// The next job whose things are not busy; they are then.
    fn take<'j, 't, J>(
        &mut self,
        jobs: &'j [J],
        things_of: &impl Fn(&J) -> &'t [usize],
    ) -> Next<'j, J> {
        while self.first < jobs.len() && self.is_taken[self.first] {
            self.first += 1;
        }
        if self.first == jobs.len() {
            return Next::Nothing;
        }
        let last = jobs.len().min(self.first + LOOKED_AT);
        let is_free = |&job: &usize| {
            !self.is_taken[job]
                && things_of(&jobs[job])
                    .iter()
                    .all(|&thing| !self.is_busy[thing])
        };
        let Some(job) = (self.first..last).find(is_free) else {
            return Next::Later;
        };
        self.is_taken[job] = true;
        self.set_busy(things_of(&jobs[job]), true);
        Next::Job(&jobs[job])
    }

    fn set_busy(&mut self, things: &[usize], are: bool) {
        for &thing in things {
            self.is_busy[thing] = are;
        }
    }
}

/// The things of a job that is being done. If it panics they are let go, because others wait for them.
struct Busy<'a, 't> {
    apart: &'a Mutex<Apart>,
    things: &'t [usize],
}

impl Drop for Busy<'_, '_> {
    fn drop(&mut self) {
        locked(self.apart).set_busy(self.things, false);
    }
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Others {
    /// Does all jobs together with the calling thread.
    fn share<J: Send>(&self, jobs: &mut [J], work: &(impl Fn(usize, &mut J) + Sync)) {
        self.wake();
        let helpers = self.pool.current_num_threads().min(jobs.len() - 1);
        let size = jobs.len().div_ceil(helpers + 1);
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
        let done = AtomicUsize::new(0);
        self.pool.in_place_scope(|scope| {
            for _ in 0..helpers {
                scope.spawn(|_| {
                    let own = rayon::current_thread_index().map_or(0, |thread| thread + 1);
                    do_all(&shares, own, work);
                    done.fetch_add(1, Ordering::Release);
                });
            }
            do_all(&shares, 0, work);
            // The end of the scope would put this thread to sleep at once.
            let mut patience = Patience::default();
            while done.load(Ordering::Acquire) < helpers && patience.is_left() {}
        });
    }

    /// Has every thread look for work from now on, unless they do.
    fn wake(&self) {
        if self.awake.load(Ordering::Acquire) > 0 {
            return;
        }
        self.awake
            .store(self.pool.current_num_threads(), Ordering::Release);
        let awake = Arc::clone(&self.awake);
        self.pool.spawn_broadcast(move |_| {
            let mut patience = Patience::default();
            while patience.is_left() {
                if rayon::yield_now() == Some(rayon::Yield::Executed) {
                    patience = Patience::default();
                }
            }
            awake.fetch_sub(1, Ordering::Release);
        });
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
fn do_all<J>(shares: &[Mutex<Share<'_, J>>], own: usize, work: &impl Fn(usize, &mut J)) {
    let (before, after) = shares.split_at(own.min(shares.len()));
    for (which, share) in after.iter().chain(before).enumerate() {
        // Not in the condition of the loop: the lock would be held while the job is done.
        let take = || locked(share).take(which == 0);
        while let Some((number, job)) = take() {
            work(number, job);
        }
    }
}

/// Waiting for something that is about to happen.
#[derive(Default)]
struct Patience {
    looks: u32,
    since: Option<Instant>,
}

impl Patience {
    /// Waits a moment; whether to go on.
    fn is_left(&mut self) -> bool {
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

    /// Many short parts one after the other, with pauses in which threads fall asleep.
    #[test]
    fn threads_wake_and_sleep_and_lose_nothing() {
        let threads = Threads::new(NonZeroUsize::new(3).unwrap());
        let mut jobs = [0_u64; 17];
        for round in 0..2_000 {
            threads.run(&mut jobs, |number, job| *job += number as u64);
            if round % 500 == 0 {
                std::thread::sleep(2 * AWAKE);
            }
        }
        assert!(
            jobs.iter()
                .enumerate()
                .all(|(number, &job)| job == 2_000 * number as u64)
        );
    }

    #[test]
    fn no_thing_is_in_two_jobs_at_once() {
        // One thing in a third of all pairs, and pairs in rows.
        let pairs: Vec<[usize; 2]> = (1..600)
            .map(|at| if at % 3 == 0 { [0, at] } else { [at, at + 1] })
            .collect();
        let mut sorted = pairs.clone();
        sorted.sort_unstable();
        for count in [1, 2, 7] {
            let threads = Threads::new(NonZeroUsize::new(count).unwrap());
            assert_eq!(threads.count(), count);
            let things: Vec<Mutex<u32>> = (0..601).map(|_| Mutex::new(0)).collect();
            let mut workers = vec![Vec::new(); count];
            let work = |done: &mut Vec<_>, pair: &[usize; 2]| {
                let mut both = pair.map(|thing| things[thing].try_lock().unwrap());
                both.iter_mut().for_each(|thing| **thing += 1);
                std::thread::yield_now();
                done.push(*pair);
            };
            let jobs: Vec<_> = pairs.iter().collect();
            threads.run_apart(
                &jobs,
                |pair| &pair[..],
                things.len(),
                &mut workers,
                |done, pair| work(done, pair),
            );
            let mut done = workers.concat();
            done.sort_unstable();
            assert!(done.iter().eq(&sorted), "{count} threads");
        }
    }

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
