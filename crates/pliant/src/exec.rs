//! One thread or many: the only file that names a thread pool.
//!
//! Work is cut into jobs by its size, never by the number of threads; every job writes what is its own, and what the jobs have
//! found is put together in their order. So answers, their order and all counters are the same for any number of threads.

use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// More than there are jobs in the largest of batches.
const MOST: usize = 256;
/// How often a thread looks for something before it lets others have its core.
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
    /// Odd while they are to stay awake; another number each time.
    awake: Arc<AtomicU64>,
}

/// As long as it lives, the others, once there was work for them, look for more instead of falling asleep: to be woken takes a
/// thread longer than most of what is done here.
#[derive(Debug)]
pub(crate) struct Busy<'t>(&'t Threads);

impl Drop for Busy<'_> {
    fn drop(&mut self) {
        if let Some(others) = &self.0.others {
            others.rest();
        }
    }
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

    /// There is going to be work again and again.
    pub(crate) fn busy(&self) -> Busy<'_> {
        Busy(self)
    }

    /// Does all jobs; returns when all are done.
    pub(crate) fn run<J: Send>(&self, jobs: &mut [J], work: impl Fn(usize, &mut J) + Sync) {
        match &self.others {
            Some(others) if jobs.len() > 1 => {
                others.wake();
                let helpers = others.pool.current_num_threads().min(jobs.len() - 1);
                let done = AtomicUsize::new(0);
                let rest = Mutex::new(jobs.iter_mut().enumerate());
                let take_jobs = || {
                    loop {
                        let next = rest.lock().unwrap_or_else(PoisonError::into_inner).next();
                        let Some((number, job)) = next else { break };
                        work(number, job);
                    }
                };
                others.pool.in_place_scope(|scope| {
                    for _ in 0..helpers {
                        scope.spawn(|_| {
                            take_jobs();
                            done.fetch_add(1, Ordering::Release);
                        });
                    }
                    take_jobs();
                    // The scope's own end would put this thread to sleep at once.
                    for look in 0..100 * LOOKS {
                        if done.load(Ordering::Acquire) == helpers {
                            break;
                        }
                        wait(look);
                    }
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

impl Others {
    /// Every thread of the pool looks for work from now on, until they may rest.
    fn wake(&self) {
        let now = self.awake.load(Ordering::Relaxed);
        if now % 2 == 1 {
            return;
        }
        let now = now + 1;
        self.awake.store(now, Ordering::Relaxed);
        let awake = Arc::clone(&self.awake);
        self.pool.spawn_broadcast(move |_| {
            let mut look = 0;
            while awake.load(Ordering::Relaxed) == now {
                match rayon::yield_now() {
                    Some(rayon::Yield::Executed) => look = 0,
                    _ => {
                        wait(look);
                        look += 1;
                    }
                }
            }
        });
    }

    /// They may sleep again.
    fn rest(&self) {
        let now = self.awake.load(Ordering::Relaxed);
        self.awake.store(now + now % 2, Ordering::Relaxed);
    }
}

/// A moment, or a turn for others after many.
fn wait(look: u32) {
    if look < LOOKS {
        std::hint::spin_loop();
    } else {
        std::thread::yield_now();
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
