//! Threads of a world: jobs for one thread or many. No other folder names a thread pool.
//!
//! Idea: work is cut into jobs by its size; rounds, rows and merges by the number of threads. A
//! part wakes as many as its work pays for (`grain`), the others sleep (`pool`). Invariant: a job
//! writes its own data, or sums and sets that all fill in any order. So answers, their order and
//! counters are the same for any number of threads.

mod budget;
mod exchange;
mod grain;
mod interrupt;
mod lock;
mod per_thread;
mod pool;
mod record;

pub(crate) use budget::Budget;
pub(crate) use exchange::Exchange;
pub(crate) use grain::Grain;
use grain::threads_for;
pub(crate) use interrupt::{Interrupt, Question};
use lock::locked;
pub(crate) use per_thread::PerThread;
pub use pool::Scheduler;
use pool::{Helpers, Workers};
use record::Recorder;
pub use record::{Clock, RecordedPart};
use std::num::NonZeroUsize;
use std::sync::{Arc, Mutex};

/// Most threads of a world: more than machines have.
const MOST: usize = 256;

/// Threads of a world.
#[derive(Debug)]
pub(crate) struct Threads {
    /// Helpers beside the calling thread, if there are any.
    helpers: Option<Helpers>,
    /// Recorder of the times of jobs; the calling thread then does all of them.
    recorder: Option<Recorder>,
}

impl Threads {
    /// The calling thread alone.
    pub(crate) const fn one() -> Self {
        Self {
            helpers: None,
            recorder: None,
        }
    }

    /// Makes a private pool of `count` threads in all, the calling one included, but at most
    /// [`MOST`]. If the system gives none, the calling thread does all work.
    pub(crate) fn private(count: NonZeroUsize) -> Self {
        let count = count.get().min(MOST) - 1;
        let pool = (count > 0).then(|| {
            rayon::ThreadPoolBuilder::new()
                .num_threads(count)
                .thread_name(|thread| format!("pliant {}", thread + 1))
                .build()
        });
        let pool = pool.and_then(Result::ok);
        let workers = pool.map(|pool| Workers::Private(Arc::new(pool), Arc::default()));
        Self::of(workers, count)
    }

    /// Uses a pool of the caller's: at most `count` threads in all, the calling one included.
    pub(crate) fn lent(count: NonZeroUsize, pool: Arc<rayon::ThreadPool>) -> Self {
        let count = (count.get().min(MOST) - 1).min(pool.current_num_threads());
        Self::of(Some(Workers::Lent(pool)), count)
    }

    /// Uses a scheduler of the caller's: at most `count` tasks at a time.
    pub(crate) fn scheduled(count: NonZeroUsize, scheduler: Arc<dyn Scheduler>) -> Self {
        let count = count.get().min(MOST) - 1;
        Self::of(Some(Workers::Scheduled(scheduler)), count)
    }

    /// `count` helpers beside the calling thread, if there are workers.
    fn of(workers: Option<Workers>, count: usize) -> Self {
        let workers = workers.filter(|_| count > 0);
        Self {
            helpers: workers.map(|workers| Helpers::of(workers, count)),
            recorder: None,
        }
    }

    /// The calling thread alone, with work cut as for `count` threads and a record of its times.
    pub(crate) fn recorded(count: NonZeroUsize, clock: Clock) -> Self {
        Self {
            helpers: None,
            recorder: Some(Recorder::new(count, clock)),
        }
    }

    /// Returns the record since the last call; empty if nothing is recorded.
    pub(crate) fn take_record(&self) -> Vec<RecordedPart> {
        self.recorder.as_ref().map_or_else(Vec::new, Recorder::take)
    }

    /// Threads for another world: private, unless this one has the application's.
    pub(crate) fn another(&self, count: NonZeroUsize) -> Self {
        match self.helpers.as_ref().map(|helpers| &helpers.workers) {
            Some(Workers::Lent(pool)) => Self::lent(count, Arc::clone(pool)),
            Some(Workers::Scheduled(it)) => Self::scheduled(count, Arc::clone(it)),
            Some(Workers::Private(..)) | None => Self::private(count),
        }
    }

    /// Threads of this process, which may be the child of a fork. There, the first query does its
    /// work alone, and the next has threads again.
    #[inline]
    pub(crate) fn here(&mut self) -> &Self {
        if let Some(helpers) = &mut self.helpers
            && helpers.are_here.take() == Some(false)
        {
            *self = Self::after_fork(helpers);
        }
        self
    }

    /// Threads for the child of a fork. Private threads are made anew. The state of a pool or
    /// scheduler of the application is unknown there, so the calling thread does all work.
    #[cold]
    fn after_fork(helpers: &Helpers) -> Self {
        match helpers.workers {
            Workers::Private(..) => Self::private(NonZeroUsize::MIN.saturating_add(helpers.count)),
            Workers::Lent(_) | Workers::Scheduled(_) => Self::one(),
        }
    }
}

/// Threads that work on a query, and its interrupt.
#[derive(Clone, Copy)]
pub(crate) struct Executor<'q> {
    pub(crate) threads: &'q Threads,
    pub(crate) interrupt: &'q Interrupt<'q>,
}

impl Executor<'_> {
    /// Whether there is any thread besides the calling one.
    pub(crate) fn are_many(&self) -> bool {
        self.count() > 1
    }

    /// Number of threads, the calling one included.
    pub(crate) fn count(&self) -> usize {
        let Threads { helpers, recorder } = self.threads;
        match recorder {
            Some(recorder) => recorder.count.get(),
            None => 1 + helpers.as_ref().map_or(0, |helpers| helpers.count),
        }
    }

    /// The calling thread alone, with the same interrupt.
    pub(crate) fn alone(self) -> Self {
        static ALONE: Threads = Threads::one();
        Self {
            threads: &ALONE,
            ..self
        }
    }

    /// Number of threads that work of `nanoseconds` pays for, at most as many as there are.
    pub(crate) fn threads_for(&self, nanoseconds: u64) -> usize {
        match self.count() {
            // Most parts of a small step: no square root for each.
            1 => 1,
            count => threads_for(nanoseconds).min(count),
        }
    }

    /// Whether work of `nanoseconds` pays for several threads, and there are several.
    pub(crate) fn pays(&self, nanoseconds: u64) -> bool {
        self.threads_for(nanoseconds) > 1
    }

    /// Whether to end early. After a yes, no result can be relied on.
    #[inline]
    pub(crate) fn is_interrupted(&self) -> bool {
        self.interrupt.is_set()
    }

    /// Runs all jobs, or some of them if interrupted, and returns when none is running. Together
    /// they take about `nanoseconds`.
    pub(crate) fn run<J: Send>(
        &self,
        jobs: &mut [J],
        nanoseconds: u64,
        work: impl Fn(usize, &mut J) + Sync,
    ) {
        self.run_any(jobs, nanoseconds, &work);
    }

    /// Runs jobs of very different sizes, which together take about `nanoseconds`. A large one is
    /// run on all threads, one after the other; the small ones side by side, each on one thread.
    pub(crate) fn run_uneven<J: Send>(
        &self,
        jobs: &mut [J],
        size: impl Fn(&J) -> usize,
        nanoseconds: u64,
        work: impl Fn(&mut J, Executor) + Sync,
    ) {
        let all: usize = jobs.iter().map(&size).sum();
        let threads = self.threads_for(nanoseconds);
        let is_large = |job: &J| size(job).saturating_mul(threads) > all;
        let mut small = Vec::with_capacity(jobs.len());
        for job in jobs {
            if !is_large(job) {
                small.push(job);
            } else if !self.is_interrupted() {
                work(job, *self);
            }
        }
        self.run(&mut small, nanoseconds, |_, job| work(job, self.alone()));
    }

    /// Runs work as one job, or cut into several where it pays for several threads. `done` then
    /// sees each job in its final state.
    pub(crate) fn run_cut<J: Send>(
        &self,
        whole: J,
        nanoseconds: u64,
        cut: impl FnOnce(J) -> Vec<J>,
        work: impl Fn(&mut J) + Sync,
        done: impl FnMut(&J),
    ) {
        let (mut alone, mut many);
        let jobs: &mut [J] = if self.pays(nanoseconds) {
            many = cut(whole);
            &mut many
        } else {
            alone = [whole];
            &mut alone
        };
        self.run(jobs, nanoseconds, |_, job| work(job));
        jobs.iter().for_each(done);
    }

    /// Runs jobs of a grain; `done` sees each in its final state. Where one thread does them, they
    /// are not collected in a list, so that a step allocates nothing.
    pub(crate) fn run_each<J: Send>(
        &self,
        jobs: impl Iterator<Item = J>,
        grain: Grain,
        work: impl Fn(&mut J) + Sync,
        mut done: impl FnMut(&J),
    ) {
        let may_pay = |most: usize| self.pays(grain.nanoseconds.saturating_mul(most as u64));
        if self.are_many() && jobs.size_hint().1.is_none_or(may_pay) {
            let mut jobs: Vec<J> = jobs.collect();
            let nanoseconds = grain.nanoseconds * jobs.len() as u64;
            self.run(&mut jobs, nanoseconds, |_, job| work(job));
            jobs.iter().for_each(done);
            return;
        }
        for mut job in jobs {
            if !self.is_interrupted() {
                work(&mut job);
            }
            done(&job);
        }
    }

    /// Runs jobs as [`run`](Self::run), but with a dynamic action. It is compiled once for each
    /// type of job, not for each action.
    fn run_any<J: Send>(
        &self,
        jobs: &mut [J],
        nanoseconds: u64,
        work: &(dyn Fn(usize, &mut J) + Sync),
    ) {
        let Some(threads) = self.sharing(jobs.len(), nanoseconds) else {
            for (number, job) in jobs.iter_mut().enumerate() {
                if !self.is_interrupted() {
                    work(number, job);
                }
            }
            return;
        };
        // Each is taken once, by whoever has its number.
        let jobs: Vec<_> = jobs.iter_mut().map(|job| Mutex::new(Some(job))).collect();
        self.share(jobs.len(), threads, &|number| {
            let job = locked(&jobs[number]).take();
            if let Some(job) = job.filter(|_| !self.is_interrupted()) {
                work(number, job);
            }
        });
    }

    /// Number of threads that share jobs, which take about `nanoseconds`, or would share them where
    /// they are recorded. None if the calling thread does them alone.
    fn sharing(&self, jobs: usize, nanoseconds: u64) -> Option<usize> {
        if self.threads.recorder.is_some() && jobs > 1 {
            return Some(threads_for(nanoseconds).min(jobs));
        }
        let threads = self.threads_for(nanoseconds).min(jobs);
        (self.threads.helpers.is_some() && threads > 1).then_some(threads)
    }

    /// Has threads share jobs by their numbers, or records them.
    fn share(&self, jobs: usize, threads: usize, work: &(dyn Fn(usize) + Sync)) {
        match self.threads {
            Threads {
                recorder: Some(recorder),
                ..
            } => recorder.run(jobs, threads, work),
            Threads {
                helpers: Some(helpers),
                ..
            } => helpers.share(jobs, threads, work),
            _ => (0..jobs).for_each(work),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::pool::AWAKE;
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    fn threads(count: usize) -> Threads {
        Threads::private(NonZeroUsize::new(count).unwrap())
    }

    /// Runs all jobs, with no interrupt.
    fn run<J: Send>(threads: &Threads, jobs: &mut [J], work: impl Fn(usize, &mut J) + Sync) {
        let interrupt = &Interrupt::default();
        Executor { threads, interrupt }.run(jobs, u64::MAX, work);
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
        let scheduled = |count, of| Threads::scheduled(NonZeroUsize::new(count).unwrap(), of);
        for threads in [
            threads(1),
            threads(2),
            threads(7),
            lent(1),
            lent(2),
            lent(9),
            scheduled(1, Arc::new(Some(1))),
            scheduled(4, Arc::new(Some(1))),
            scheduled(4, Arc::new(Some(2))),
            scheduled(4, Arc::new(None)),
        ] {
            check(&threads);
            // From a thread of the pool itself.
            pool.install(|| check(&threads));
        }
    }

    /// Runs each task, or each second one, from the last, on a thread of its own; or none.
    impl Scheduler for Option<usize> {
        fn run(&self, tasks: usize, task: &(dyn Fn(usize) + Sync)) {
            let Some(step) = *self else { return };
            std::thread::scope(|scope| {
                for number in (0..tasks).rev().step_by(step) {
                    scope.spawn(move || task(number));
                }
            });
        }
    }

    /// Simulates a fork by a changed process number, as a real one needs unsafe code. The tests of
    /// the Python package fork.
    #[test]
    fn the_child_of_a_fork_has_threads_of_its_own() {
        let pool = Arc::new(
            rayon::ThreadPoolBuilder::new()
                .num_threads(3)
                .build()
                .unwrap(),
        );
        let four = NonZeroUsize::new(4).unwrap();
        let lent = Threads::lent(four, Arc::clone(&pool));
        let scheduled = Threads::scheduled(four, Arc::new(Some(1)));
        let all = [(threads(4), true), (lent, false), (scheduled, false)];
        for (mut threads, many) in all.into_iter().chain([(threads(1), false)]) {
            if let Some(helpers) = &mut threads.helpers {
                helpers.process = helpers.process.wrapping_add(1);
            }
            for _ in 0..2 {
                let mut jobs = vec![0; 100];
                run(threads.here(), &mut jobs, |number, job| *job += number + 1);
                assert!(jobs.iter().copied().eq(1..=100));
            }
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
            executor.run(&mut [(); 1000], u64::MAX, |_, ()| {
                begun.fetch_add(1, Ordering::Relaxed);
            });
            assert!(executor.is_interrupted());
            assert!((10..=12).contains(&begun.load(Ordering::Relaxed)));
        }
    }
}
