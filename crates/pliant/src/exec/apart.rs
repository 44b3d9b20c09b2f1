//! Jobs that need things, no thing in two jobs at once.
//!
//! Which thread does a job, and when, is left open; so jobs are for work whose result does not depend on its order. Each thread begins
//! with jobs side by side, whose things it is likely to need again, and then takes what is left of others' from the back.

use super::{Patience, Threads, locked};
use std::sync::Mutex;

/// How many jobs are looked at for one whose things are not busy.
const LOOKED_AT: usize = 64;

impl Threads {
    /// Does all jobs, each of which needs some things, such that no thing is in two jobs at once. Every worker does one after the
    /// other; which it does is left open.
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
            passed: vec![0; workers.len()],
            is_busy: vec![false; things],
        });
        self.run(workers, |number, worker| {
            let mut busy = Busy {
                apart: &apart,
                things: &[],
            };
            let mut patience = Patience::default();
            loop {
                let next = {
                    let mut apart = locked(&apart);
                    apart.set_busy(std::mem::take(&mut busy.things), false);
                    apart.take(number, jobs, &things_of)
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
    /// How many jobs, in an order of its own, every worker has passed because they are taken.
    passed: Vec<usize>,
    is_busy: Vec<bool>,
}

enum Next<'j, J> {
    Job(&'j J),
    /// What is left must wait for things that are busy.
    Later,
    Nothing,
}

impl Apart {
    /// The next job of a worker whose things are not busy; they are then.
    fn take<'j, 't, J>(
        &mut self,
        worker: usize,
        jobs: &'j [J],
        things_of: &impl Fn(&J) -> &'t [usize],
    ) -> Next<'j, J> {
        // Those of its own, and then, backwards, all before them and all behind.
        let [first, end] = [worker, worker + 1].map(|at| at * jobs.len() / self.passed.len());
        let own = end - first;
        let job_at = |passed: usize| {
            if passed < own {
                first + passed
            } else {
                (first + jobs.len() - 1 - (passed - own)) % jobs.len()
            }
        };
        let passed = &mut self.passed[worker];
        while *passed < jobs.len() && self.is_taken[job_at(*passed)] {
            *passed += 1;
        }
        if *passed == jobs.len() {
            return Next::Nothing;
        }
        let next = *passed..jobs.len().min(*passed + LOOKED_AT);
        let is_free = |&job: &usize| {
            !self.is_taken[job]
                && things_of(&jobs[job])
                    .iter()
                    .all(|&thing| !self.is_busy[thing])
        };
        let Some(job) = next.map(job_at).find(is_free) else {
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::num::NonZeroUsize;

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
            let jobs: Vec<_> = pairs.iter().collect();
            threads.run_apart(
                &jobs,
                |pair| &pair[..],
                things.len(),
                &mut workers,
                |done, pair| {
                    let mut both = pair.map(|thing| things[thing].try_lock().unwrap());
                    both.iter_mut().for_each(|thing| **thing += 1);
                    std::thread::yield_now();
                    done.push(**pair);
                },
            );
            let mut done = workers.concat();
            done.sort_unstable();
            assert!(done.iter().eq(&sorted), "{count} threads");
        }
    }
}
