//! Jobs that need resources, scheduled such that no two under way need the same: no thread ever waits for a lock.
//!
//! Which thread does a job, and when, is left open; so jobs are for work whose result does not depend on its order. Each thread begins
//! with jobs side by side, whose resources it is likely to need again, and then takes what is left of others' from the back.

use super::{Backoff, Executor, locked};
use std::sync::Mutex;

/// How many jobs are looked at for one whose resources are free.
const LOOKED_AT: usize = 64;

impl Executor<'_> {
    /// Does so many jobs, each of which needs some resources, such that no two under way need the same. Every worker does one after
    /// the other; which it does is left open. Interrupted, it does some of them.
    pub(crate) fn run_conflict_free<'t, W: Send>(
        &self,
        jobs: usize,
        resources_of: &(dyn Fn(usize) -> &'t [usize] + Sync),
        resources: usize,
        workers: &mut [W],
        work: &(dyn Fn(&mut W, usize) + Sync),
    ) {
        let schedule = &Mutex::new(Schedule {
            is_taken: vec![false; jobs],
            passed: vec![0; workers.len()],
            is_busy: vec![false; resources],
        });
        self.run(workers, u64::MAX, |number, worker| {
            let work = &mut |job| work(worker, job);
            self.run_some(schedule, number, resources_of, work);
        });
    }

    /// Does jobs as a worker of this number until none is left.
    fn run_some<'t>(
        &self,
        schedule: &Mutex<Schedule>,
        number: usize,
        resources_of: &dyn Fn(usize) -> &'t [usize],
        work: &mut dyn FnMut(usize),
    ) {
        let mut busy = Busy {
            schedule,
            resources: &[],
        };
        let mut backoff = Backoff::default();
        while !self.is_interrupted() {
            let next = {
                let mut schedule = locked(schedule);
                schedule.set_busy(std::mem::take(&mut busy.resources), false);
                schedule.take(number, resources_of)
            };
            match next {
                Next::Job(job) => {
                    busy.resources = resources_of(job);
                    work(job);
                    backoff = Backoff::default();
                }
                Next::Later => {
                    backoff.waits();
                }
                Next::Nothing => break,
            }
        }
    }
}

/// Which jobs are taken, and which resources those under way need.
struct Schedule {
    is_taken: Vec<bool>,
    /// How many jobs, in an order of its own, every worker has passed because they are taken.
    passed: Vec<usize>,
    is_busy: Vec<bool>,
}

enum Next {
    /// This one.
    Job(usize),
    /// What is left must wait for resources that are busy.
    Later,
    Nothing,
}

impl Schedule {
    /// The next job of a worker whose resources are free; they are busy then.
    fn take<'t>(&mut self, worker: usize, resources_of: &dyn Fn(usize) -> &'t [usize]) -> Next {
        let jobs = self.is_taken.len();
        // Those of its own, and then, backwards, all before them and all behind.
        let [first, end] = [worker, worker + 1].map(|at| at * jobs / self.passed.len());
        let own = end - first;
        let job_at = |passed: usize| {
            if passed < own {
                first + passed
            } else {
                (first + jobs - 1 - (passed - own)) % jobs
            }
        };
        let passed = &mut self.passed[worker];
        while *passed < jobs && self.is_taken[job_at(*passed)] {
            *passed += 1;
        }
        if *passed == jobs {
            return Next::Nothing;
        }
        let next = *passed..jobs.min(*passed + LOOKED_AT);
        let is_free = |&job: &usize| {
            !self.is_taken[job]
                && resources_of(job)
                    .iter()
                    .all(|&resource| !self.is_busy[resource])
        };
        let Some(job) = next.map(job_at).find(is_free) else {
            return Next::Later;
        };
        self.is_taken[job] = true;
        self.set_busy(resources_of(job), true);
        Next::Job(job)
    }

    fn set_busy(&mut self, resources: &[usize], are: bool) {
        for &resource in resources {
            self.is_busy[resource] = are;
        }
    }
}

/// The resources of a job under way. If it panics they become free, because others wait for them.
struct Busy<'a, 't> {
    schedule: &'a Mutex<Schedule>,
    resources: &'t [usize],
}

impl Drop for Busy<'_, '_> {
    fn drop(&mut self) {
        locked(self.schedule).set_busy(self.resources, false);
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Interrupt, Threads};
    use super::*;
    use std::num::NonZeroUsize;

    #[test]
    fn no_two_jobs_under_way_need_the_same() {
        // One resource in a third of all pairs, and pairs in rows.
        let pairs: Vec<[usize; 2]> = (1..600)
            .map(|at| if at % 3 == 0 { [0, at] } else { [at, at + 1] })
            .collect();
        let mut sorted = pairs.clone();
        sorted.sort_unstable();
        for count in [1, 2, 7] {
            let threads = &Threads::private(NonZeroUsize::new(count).unwrap());
            let interrupt = &Interrupt::default();
            let executor = Executor { threads, interrupt };
            assert_eq!(executor.count(), count);
            let counts: Vec<Mutex<u32>> = (0..601).map(|_| Mutex::new(0)).collect();
            let mut workers = vec![Vec::new(); count];
            executor.run_conflict_free(
                pairs.len(),
                &|job| &pairs[job],
                counts.len(),
                &mut workers,
                &|done, job| {
                    let pair = pairs[job];
                    let mut both = pair.map(|which| counts[which].try_lock().unwrap());
                    both.iter_mut().for_each(|count| **count += 1);
                    std::thread::yield_now();
                    done.push(pair);
                },
            );
            let mut done = workers.concat();
            done.sort_unstable();
            assert!(done.iter().eq(&sorted), "{count} threads");
        }
    }
}
