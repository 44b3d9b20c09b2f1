//! Jobs that need things, no thing in two jobs at once.
//!
//! Which thread does a job, and when, is left open; so jobs are for work whose result does not depend on its order.

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
