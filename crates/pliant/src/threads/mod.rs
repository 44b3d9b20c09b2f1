//! One thread or many: the only folder that names a thread pool.
//!
//! Work is cut into jobs by its size, never by the number of threads; every job writes what is its own, and what the jobs have
//! found is put together in their order. So answers, their order and all counters are the same for any number of threads. Only
//! jobs whose result depends on no order may be cut as the threads are: those of `conflict_free`, tasks of a descent of which all
//! hits are wanted, which are then sorted, and runs of what is sorted.
//!
//! A step is some dozens of such parts, each shorter than it takes to wake a thread. So threads of a private pool that were woken
//! stay awake from one part to the next, and a little longer. Each begins with jobs of its own, side by side, and helps others when
//! these are done: what a thread wrote in one part it is likely to read in the next. The threads of a pool that an application has
//! lent are not kept awake: they have other things to do. The child of a fork has none of these threads: see [`Threads::here`].

mod budget;
mod conflict_free;
mod interrupt;
mod per_thread;

pub(crate) use budget::Budget;
pub(crate) use interrupt::{Interrupt, Question};
pub(crate) use per_thread::PerThread;
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// More threads than anyone has.
const MOST: usize = 256;
/// How long a thread looks for more to do before it sleeps: longer than what one thread alone does in the middle of a query.
const AWAKE: Duration = Duration::from_micros(200);
/// How often a thread that waits looks before it lets others have its core in between.
const LOOKS: u32 = 100;

/// The threads of a world.
#[derive(Debug)]
pub(crate) struct Threads {
    /// The others beside the one that calls; none if that is all.
    helpers: Option<Helpers>,
}

#[derive(Debug)]
struct Helpers {
    pool: Arc<rayon::ThreadPool>,
    /// The most of them that are used.
    count: usize,
    /// How many threads of a private pool are awake; none for a pool that was lent.
    awake: Option<Arc<AtomicUsize>>,
    /// The process that has them: the child of a fork has the pool, but none of its threads.
    process: u32,
}

impl Drop for Helpers {
    fn drop(&mut self) {
        if self.are_elsewhere() {
            // What a thread of the parent had locked when it forked nobody will unlock. So the pool is left as it is.
            std::mem::forget(Arc::clone(&self.pool));
        }
    }
}

impl Threads {
    /// The calling thread alone.
    pub(crate) fn one() -> Self {
        Self { helpers: None }
    }

    /// `count` threads, the calling one included, but not more than [`MOST`]. Where the system gives none, the calling thread does
    /// all work.
    pub(crate) fn private(count: NonZeroUsize) -> Self {
        let count = count.get().min(MOST) - 1;
        let pool = (count > 0).then(|| {
            rayon::ThreadPoolBuilder::new()
                .num_threads(count)
                .thread_name(|thread| format!("pliant {}", thread + 1))
                .build()
        });
        let pool = pool.and_then(Result::ok);
        let helpers = pool.map(|pool| Helpers::of(Arc::new(pool), count, Some(Arc::default())));
        Self { helpers }
    }

    /// At most `count` threads, the calling one included; the others are of a pool of the caller's.
    pub(crate) fn lent(count: NonZeroUsize, pool: Arc<rayon::ThreadPool>) -> Self {
        let count = (count.get().min(MOST) - 1).min(pool.current_num_threads());
        let helpers = (count > 0).then(|| Helpers::of(pool, count, None));
        Self { helpers }
    }

    /// Threads for another world: of the same pool, if that was lent, or else private ones of its own.
    pub(crate) fn another(&self, count: NonZeroUsize) -> Self {
        let lent = self.helpers.as_ref().filter(|it| it.awake.is_none());
        match lent {
            Some(helpers) => Self::lent(count, Arc::clone(&helpers.pool)),
            None => Self::private(count),
        }
    }

    /// The threads that this process has. In the child of a fork, private ones are made anew; of a pool that was lent, nobody can say
    /// what became of it, so the calling thread does all work.
    pub(crate) fn here(&mut self) -> &Self {
        if let Some(helpers) = self
            .helpers
            .as_ref()
            .filter(|helpers| helpers.are_elsewhere())
        {
            let count = NonZeroUsize::MIN.saturating_add(helpers.count);
            *self = match helpers.awake {
                Some(_) => Self::private(count),
                None => Self::one(),
            };
        }
        self
    }
}

/// The threads that work on a query, and what may interrupt them.
#[derive(Clone, Copy)]
pub(crate) struct Executor<'q> {
    pub(crate) threads: &'q Threads,
    pub(crate) interrupt: &'q Interrupt<'q>,
}

impl Executor<'_> {
    /// Whether there are others than the calling thread.
    pub(crate) fn are_many(&self) -> bool {
        self.threads.helpers.is_some()
    }

    /// How many threads there are, the calling one included.
    pub(crate) fn count(&self) -> usize {
        1 + self
            .threads
            .helpers
            .as_ref()
            .map_or(0, |helpers| helpers.count)
    }

    /// Whether to end early. After a yes nothing that was computed can be relied on.
    #[inline]
    pub(crate) fn is_interrupted(&self) -> bool {
        self.interrupt.is_set()
    }

    /// Does all jobs, or, interrupted, some of them; returns when nothing is under way.
    pub(crate) fn run<J: Send>(&self, jobs: &mut [J], work: impl Fn(usize, &mut J) + Sync) {
        self.run_any(jobs, &work);
    }

    /// Does work as one job, or, where it is worth waking threads, cut into several. `done` is then shown each as it was left.
    pub(crate) fn run_cut<J: Send>(
        &self,
        whole: J,
        is_worth_it: bool,
        cut: impl FnOnce(J) -> Vec<J>,
        work: impl Fn(&mut J) + Sync,
        done: impl FnMut(&J),
    ) {
        let (mut alone, mut many);
        let jobs: &mut [J] = if is_worth_it {
            many = cut(whole);
            &mut many
        } else {
            alone = [whole];
            &mut alone
        };
        self.run(jobs, |_, job| work(job));
        jobs.iter().for_each(done);
    }

    /// Does jobs, and shows `done` each as it was left. They are listed only if there are threads
    /// for them: a step would allocate that list.
    pub(crate) fn run_each<J: Send>(
        &self,
        jobs: impl Iterator<Item = J>,
        work: impl Fn(&mut J) + Sync,
        mut done: impl FnMut(&J),
    ) {
        if self.are_many() {
            let mut jobs: Vec<J> = jobs.collect();
            self.run(&mut jobs, |_, job| work(job));
            jobs.iter().for_each(done);
            return;
        }
        for mut job in jobs {
            self.run(std::slice::from_mut(&mut job), |_, job| work(job));
            done(&job);
        }
    }

    /// The same as [`run`](Self::run) for any work: it is compiled for each kind of job, but not for everything that is done with one.
    fn run_any<J: Send>(&self, jobs: &mut [J], work: &(dyn Fn(usize, &mut J) + Sync)) {
        let work: &(dyn Fn(usize, &mut J) + Sync) = &|number, job| {
            if !self.is_interrupted() {
                work(number, job);
            }
        };
        match &self.threads.helpers {
            Some(helpers) if jobs.len() > 1 => helpers.share(jobs, work),
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

impl Helpers {
    fn of(pool: Arc<rayon::ThreadPool>, count: usize, awake: Option<Arc<AtomicUsize>>) -> Self {
        Self {
            pool,
            count,
            awake,
            process: std::process::id(),
        }
    }

    fn are_elsewhere(&self) -> bool {
        self.process != std::process::id()
    }

    /// Does all jobs together with the calling thread.
    fn share<J: Send>(&self, jobs: &mut [J], work: &(dyn Fn(usize, &mut J) + Sync)) {
        let helpers = self.count.min(jobs.len() - 1);
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
        self.help(helpers, &|own| do_all(&shares, own % shares.len(), work));
    }

    /// Has so many helpers do something, and the calling thread too; tells each the number of its thread, which is 0 for this one. It knows
    /// no kind of job: scopes of a pool are much to compile for each.
    fn help(&self, helpers: usize, work: &(dyn Fn(usize) + Sync)) {
        self.wake();
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

    /// Has every thread of a private pool look for work from now on, unless they do.
    fn wake(&self) {
        let Some(awake) = &self.awake else { return };
        if awake.load(Ordering::Acquire) > 0 {
            return;
        }
        awake.store(self.pool.current_num_threads(), Ordering::Release);
        let awake = Arc::clone(awake);
        self.pool.spawn_broadcast(move |_| {
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
struct Backoff {
    looks: u32,
    since: Option<Instant>,
}

impl Backoff {
    /// Waits a moment; whether to go on waiting.
    fn waits(&mut self) -> bool {
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

    fn threads(count: usize) -> Threads {
        Threads::private(NonZeroUsize::new(count).unwrap())
    }

    /// All jobs, by threads that nothing interrupts.
    fn run<J: Send>(threads: &Threads, jobs: &mut [J], work: impl Fn(usize, &mut J) + Sync) {
        let interrupt = &Interrupt::default();
        Executor { threads, interrupt }.run(jobs, work);
    }

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
        let threads = threads(3);
        let mut jobs = [0_u64; 17];
        for round in 0..2_000 {
            run(&threads, &mut jobs, |number, job| *job += number as u64);
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
        let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build();
        let pool = Arc::new(pool.unwrap());
        let lent = |count| Threads::lent(NonZeroUsize::new(count).unwrap(), Arc::clone(&pool));
        let check = |threads: &Threads| {
            for count in [0, 1, 2, 100] {
                let mut jobs = vec![0; count];
                run(threads, &mut jobs, |number, job| *job += number + 1);
                assert!(jobs.iter().copied().eq(1..=count));
            }
        };
        for threads in [
            threads(1),
            threads(2),
            threads(7),
            lent(1),
            lent(2),
            lent(9),
        ] {
            check(&threads);
            // From a thread of the pool itself.
            pool.install(|| check(&threads));
        }
    }

    /// A fork itself needs code that is not safe: the tests of the Python package have one.
    #[test]
    fn the_child_of_a_fork_has_threads_of_its_own() {
        let pool = Arc::new(
            rayon::ThreadPoolBuilder::new()
                .num_threads(3)
                .build()
                .unwrap(),
        );
        let lent = Threads::lent(NonZeroUsize::new(4).unwrap(), Arc::clone(&pool));
        for (mut threads, many) in [(threads(4), true), (lent, false), (threads(1), false)] {
            if let Some(helpers) = &mut threads.helpers {
                helpers.process = helpers.process.wrapping_add(1);
            }
            let mut jobs = vec![0; 100];
            run(threads.here(), &mut jobs, |number, job| *job += number + 1);
            assert!(jobs.iter().copied().eq(1..=100));
            assert_eq!(threads.helpers.is_some(), many);
            assert!(threads.helpers.is_none_or(|helpers| helpers.count == 3));
        }
    }

    #[test]
    fn interrupted_threads_begin_no_more_jobs() {
        for threads in [threads(1), threads(3)] {
            let begun = AtomicUsize::new(0);
            let question = || begun.load(Ordering::Relaxed) >= 10;
            let interrupt = &Interrupt::new(Some(&question));
            let threads = &threads;
            let executor = Executor { threads, interrupt };
            executor.run(&mut [(); 1000], |_, ()| {
                begun.fetch_add(1, Ordering::Relaxed);
            });
            assert!(executor.is_interrupted());
            assert!((10..=12).contains(&begun.load(Ordering::Relaxed)));
        }
    }
}
