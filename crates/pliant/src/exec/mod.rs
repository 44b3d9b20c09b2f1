//! One thread or many: the only folder that names a thread pool.
//!
//! Work is cut into jobs by its size, never by the number of threads; every job writes what is its own, and what the jobs have
//! found is put together in their order. So answers, their order and all counters are the same for any number of threads. Only
//! jobs whose result depends on no order may be cut as the threads are: those of `apart`, branches of a descent of which all
//! pairs are wanted, which are then sorted, and runs of what is sorted.
//!
//! A step is some dozens of such parts, each shorter than it takes to wake a thread. So threads that were woken stay awake from one
//! part to the next, and a little longer. Each begins with jobs of its own, side by side, and helps others when these are done:
//! what a thread wrote in one part it is likely to read in the next.

mod apart;

use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// More than anyone has.
const MOST: usize = 256;
/// How long a thread looks for more to do before it sleeps: longer than what one thread alone does in the middle of a query.
const AWAKE: Duration = Duration::from_micros(200);
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

/// Locks a mutex, whatever happened to others that had it.
pub(crate) fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
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
