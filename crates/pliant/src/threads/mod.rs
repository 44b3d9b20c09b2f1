//! One thread or many: the only folder that names a thread pool.
//!
//! Work is cut into jobs by its size, never by the number of threads; every job writes what is its
//! own, and what jobs find is put together in their order or sorted. So answers, their order and
//! counters are the same for any number of threads. A part takes as many threads as its work pays
//! (`grain`), and the others sleep (`pool`). The child of a fork has none of these threads: see
//! [`Threads::here`].

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
pub(crate) use lock::locked;
pub(crate) use per_thread::PerThread;
use pool::Helpers;
use record::Recorder;
pub use record::{Clock, RecordedPart};
use std::num::NonZeroUsize;
use std::sync::Arc;

/// More threads than anyone has.
const MOST: usize = 256;

/// The threads of a world.
#[derive(Debug)]
pub(crate) struct Threads {
    /// The others beside the one that calls; none if that is all.
    helpers: Option<Helpers>,
    /// Takes the times of jobs, all of which the calling thread does then.
    recorder: Option<Recorder>,
}

impl Threads {
    /// The calling thread alone.
    pub(crate) const fn one() -> Self {
        Self::of(None)
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
        Self::of(helpers)
    }

    /// At most `count` threads, the calling one included; the others are of a pool of the caller's.
    pub(crate) fn lent(count: NonZeroUsize, pool: Arc<rayon::ThreadPool>) -> Self {
        let count = (count.get().min(MOST) - 1).min(pool.current_num_threads());
        Self::of((count > 0).then(|| Helpers::of(pool, count, None)))
    }

    const fn of(helpers: Option<Helpers>) -> Self {
        Self {
            helpers,
            recorder: None,
        }
    }

    /// The calling thread alone, which does work cut as for `count` threads and takes its times.
    pub(crate) fn recorded(count: NonZeroUsize, clock: Clock) -> Self {
        Self {
            helpers: None,
            recorder: Some(Recorder::new(count, clock)),
        }
    }

    /// What was recorded since the last call; nothing if nothing is recorded.
    pub(crate) fn take_record(&self) -> Vec<RecordedPart> {
        self.recorder.as_ref().map_or_else(Vec::new, Recorder::take)
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
        self.count() > 1
    }

    /// How many threads there are, the calling one included.
    pub(crate) fn count(&self) -> usize {
        let Threads { helpers, recorder } = self.threads;
        match recorder {
            Some(recorder) => recorder.count.get(),
            None => 1 + helpers.as_ref().map_or(0, |helpers| helpers.count),
        }
    }

    /// The calling thread alone.
    pub(crate) fn alone(self) -> Self {
        static ALONE: Threads = Threads::one();
        Self {
            threads: &ALONE,
            ..self
        }
    }

    /// How many threads work of so many nanoseconds pays, of those that there are.
    pub(crate) fn threads_for(&self, nanoseconds: u64) -> usize {
        threads_for(nanoseconds).min(self.count())
    }

    /// Whether work of so many nanoseconds pays more than one thread, and there are several.
    pub(crate) fn pays(&self, nanoseconds: u64) -> bool {
        self.threads_for(nanoseconds) > 1
    }

    /// Whether to end early. After a yes nothing that was computed can be relied on.
    #[inline]
    pub(crate) fn is_interrupted(&self) -> bool {
        self.interrupt.is_set()
    }

    /// Does all jobs, or, interrupted, some of them; returns when nothing is under way. All together
    /// take about so many nanoseconds.
    pub(crate) fn run<J: Send>(
        &self,
        jobs: &mut [J],
        nanoseconds: u64,
        work: impl Fn(usize, &mut J) + Sync,
    ) {
        self.run_any(jobs, nanoseconds, &work);
    }

    /// Does work as one job, or, where it pays several threads, cut into several. `done` is then shown
    /// each as it was left.
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

    /// Does jobs of a grain, and shows `done` each as it was left. They are listed only if there are
    /// several threads, for on one a step allocates nothing.
    pub(crate) fn run_each<J: Send>(
        &self,
        jobs: impl Iterator<Item = J>,
        grain: Grain,
        work: impl Fn(&mut J) + Sync,
        mut done: impl FnMut(&J),
    ) {
        if self.are_many() {
            let mut jobs: Vec<J> = jobs.collect();
            let nanoseconds = grain.nanoseconds * jobs.len() as u64;
            self.run(&mut jobs, nanoseconds, |_, job| work(job));
            jobs.iter().for_each(done);
            return;
        }
        for mut job in jobs {
            self.run(std::slice::from_mut(&mut job), 0, |_, job| work(job));
            done(&job);
        }
    }

    /// The same as [`run`](Self::run) for any work: it is compiled for each kind of job, but not for
    /// everything that is done with one.
    fn run_any<J: Send>(
        &self,
        jobs: &mut [J],
        nanoseconds: u64,
        work: &(dyn Fn(usize, &mut J) + Sync),
    ) {
        let work: &(dyn Fn(usize, &mut J) + Sync) = &|number, job| {
            if !self.is_interrupted() {
                work(number, job);
            }
        };
        let most_threads = threads_for(nanoseconds).min(jobs.len());
        let threads = most_threads.min(self.count());
        match self.threads {
            Threads {
                recorder: Some(recorder),
                ..
            } if jobs.len() > 1 => recorder.run(jobs, most_threads, work),
            Threads {
                helpers: Some(helpers),
                ..
            } if threads > 1 => helpers.share(jobs, threads, work),
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
    use super::pool::AWAKE;
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    fn threads(count: usize) -> Threads {
        Threads::private(NonZeroUsize::new(count).unwrap())
    }

    /// All jobs, by threads that nothing interrupts.
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
            executor.run(&mut [(); 1000], u64::MAX, |_, ()| {
                begun.fetch_add(1, Ordering::Relaxed);
            });
            assert!(executor.is_interrupted());
            assert!((10..=12).contains(&begun.load(Ordering::Relaxed)));
        }
    }
}
