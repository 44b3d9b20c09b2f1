//! Helper threads: how they share jobs with the calling thread, wake, wait and fall asleep.
//!
//! A step has some dozens of parts, each shorter than waking a thread takes. So threads of a
//! private pool stay awake for a while after a part and look for more work. Only as many are woken
//! as the part pays for. Each begins with adjacent jobs, then steals from the back of others' jobs;
//! so it mostly reads what it wrote in the part before. Threads of an application's pool or
//! scheduler are not kept awake.

use super::lock::locked;
use std::fmt;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock};
use std::time::{Duration, Instant};

/// Time that an idle thread looks for work before it sleeps: longer than one thread alone works in
/// the middle of a query.
pub(super) const AWAKE: Duration = Duration::from_micros(200);
/// Checks of a waiting thread before it yields its core between checks.
const LOOKS: u32 = 100;

/// Scheduler of an application, which runs tasks on threads that it has: TBB, OpenMP, or its own.
///
/// For [`World::with_scheduler`](crate::World::with_scheduler).
pub trait Scheduler: Send + Sync {
    /// Runs `task` for every number below `tasks`, and returns when all have ended.
    ///
    /// Any thread may run any of them, side by side or one after the other. The calling thread does
    /// what is left undone.
    fn run(&self, tasks: usize, task: &(dyn Fn(usize) + Sync));
}

/// Whose threads the helpers are.
#[derive(Clone)]
pub(super) enum Workers {
    /// Threads of this world alone, and how many of them are awake.
    Private(Arc<rayon::ThreadPool>, Arc<AtomicUsize>),
    /// Threads of a pool that the application has lent.
    Lent(Arc<rayon::ThreadPool>),
    /// Threads that a scheduler of the application has.
    Scheduled(Arc<dyn Scheduler>),
}

/// Helper threads, beside the calling thread.
pub(super) struct Helpers {
    pub(super) workers: Workers,
    /// Most threads that are used.
    pub(super) count: usize,
    /// Process that has the threads: the child of a fork has none of them.
    pub(super) process: u32,
    /// Whether this is known to be that process. It is asked once a query, and only by queries that
    /// share work, since it is a call of the system.
    pub(super) are_here: OnceLock<bool>,
}

impl fmt::Debug for Helpers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Helpers")
            .field("count", &self.count)
            .finish_non_exhaustive()
    }
}

impl Drop for Helpers {
    fn drop(&mut self) {
        if self.are_elsewhere() {
            // Nobody will unlock what a thread of the parent had locked at the fork. So the pool is
            // leaked.
            std::mem::forget(self.workers.clone());
        }
    }
}

impl Helpers {
    pub(super) fn of(workers: Workers, count: usize) -> Self {
        Self {
            workers,
            count,
            process: std::process::id(),
            are_here: OnceLock::new(),
        }
    }

    pub(super) fn are_elsewhere(&self) -> bool {
        self.process != std::process::id()
    }

    /// Runs jobs together with the calling thread, on at most `threads` threads: calls `work` with
    /// each number below `jobs`.
    pub(super) fn share(&self, jobs: usize, threads: usize, work: &(dyn Fn(usize) + Sync)) {
        if !*self.are_here.get_or_init(|| !self.are_elsewhere()) {
            (0..jobs).for_each(work);
            return;
        }
        let size = jobs.div_ceil(threads);
        let shares = (0..jobs).step_by(size);
        let shares: Vec<Share> = shares
            .map(|first| Mutex::new(first..jobs.min(first + size)))
            .collect();
        let work_from = |own: usize| do_all(&shares, own % shares.len(), work);
        match &self.workers {
            Workers::Private(pool, awake) => {
                wake(pool, awake, shares.len() - 1);
                help(pool, shares.len() - 1, &work_from);
            }
            Workers::Lent(pool) => help(pool, shares.len() - 1, &work_from),
            Workers::Scheduled(scheduler) => {
                scheduler.run(shares.len(), &work_from);
                // Whatever the scheduler has left out.
                work_from(0);
            }
        }
    }
}

/// Runs `work` on `helpers` threads of a pool and on the calling thread. It gets the number of its
/// thread, which is 0 for the calling one.
fn help(pool: &rayon::ThreadPool, helpers: usize, work: &(dyn Fn(usize) + Sync)) {
    let done = AtomicUsize::new(0);
    pool.in_place_scope(|scope| {
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

/// Wakes threads of a private pool until `helpers` of them look for work.
fn wake(pool: &rayon::ThreadPool, awake: &Arc<AtomicUsize>, helpers: usize) {
    let are = awake.load(Ordering::Acquire);
    for _ in are..helpers {
        awake.fetch_add(1, Ordering::Release);
        let awake = Arc::clone(awake);
        pool.spawn(move || {
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

/// Numbers of adjacent jobs: their owner takes them from the front, other threads from the back.
type Share = Mutex<Range<usize>>;

/// Takes the number of a job.
fn take(share: &Share, from_front: bool) -> Option<usize> {
    let numbers = &mut *locked(share);
    if from_front {
        numbers.next()
    } else {
        numbers.next_back()
    }
}

/// Runs the jobs of one share, and then of the others, until none is left.
fn do_all(shares: &[Share], own: usize, work: &dyn Fn(usize)) {
    let (before, after) = shares.split_at(own);
    for (which, share) in after.iter().chain(before).enumerate() {
        while let Some(number) = take(share, which == 0) {
            work(number);
        }
    }
}

/// Backoff of a thread that waits for an imminent event: spins, then yields, and gives up after
/// [`AWAKE`].
#[derive(Default)]
pub(super) struct Backoff {
    looks: u32,
    since: Option<Instant>,
}

impl Backoff {
    /// Waits a moment. Returns whether to go on waiting.
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
        let share = Mutex::new(4..7);
        assert_eq!(take(&share, false), Some(6));
        assert_eq!(take(&share, true), Some(4));
        assert_eq!(take(&share, false), Some(5));
        assert_eq!(take(&share, true), None);
    }
}
