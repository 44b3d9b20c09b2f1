//! A record of jobs: how long each takes when one thread does all, for a replay on more workers.
//!
//! Work is cut as it would be for some number of threads, and done by the calling thread alone. The
//! clock is the caller's, as the library reads none.

use super::lock::locked;
use std::fmt;
use std::num::NonZeroUsize;
use std::sync::{Arc, Mutex};

/// A clock of the caller's, in nanoseconds.
pub type Clock = Arc<dyn Fn() -> u64 + Send + Sync>;

/// A part of a step: what one thread does, then jobs that several may share.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RecordedPart {
    /// Nanoseconds between the jobs of the part before and these.
    pub serial: u64,
    /// Nanoseconds that each job took, in order.
    pub jobs: Vec<u64>,
    /// The most threads that would share them, however many there are.
    pub most_threads: usize,
}

/// Takes the times of all jobs.
pub(super) struct Recorder {
    /// As many threads as work is cut for.
    pub(super) count: NonZeroUsize,
    clock: Clock,
    log: Mutex<Log>,
}

#[derive(Default)]
struct Log {
    /// When the last part, or piece of work, ended.
    since: u64,
    /// Times of the pieces of the part that is going on.
    jobs: Vec<u64>,
    parts: Vec<RecordedPart>,
}

impl Recorder {
    pub(super) fn new(count: NonZeroUsize, clock: Clock) -> Self {
        let log = Mutex::new(Log {
            since: clock(),
            ..Log::default()
        });
        Self { count, clock, log }
    }

    /// Does all jobs, and takes their times.
    pub(super) fn run<J>(&self, jobs: &mut [J], most_threads: usize, work: &dyn Fn(usize, &mut J)) {
        let serial = self.lap();
        for (number, job) in jobs.iter_mut().enumerate() {
            work(number, job);
            self.mark();
        }
        let log = &mut *locked(&self.log);
        let jobs = std::mem::take(&mut log.jobs);
        log.parts.push(RecordedPart {
            serial,
            jobs,
            most_threads,
        });
    }

    /// A piece of a job ends here, the rest of which another thread could have done.
    pub(super) fn mark(&self) {
        let time = self.lap();
        locked(&self.log).jobs.push(time);
    }

    /// The time since the last lap.
    fn lap(&self) -> u64 {
        let now = (self.clock)();
        let log = &mut *locked(&self.log);
        now - std::mem::replace(&mut log.since, now)
    }

    /// What was recorded since the last call; its last part has no jobs.
    pub(super) fn take(&self) -> Vec<RecordedPart> {
        let serial = self.lap();
        let mut parts = std::mem::take(&mut locked(&self.log).parts);
        parts.push(RecordedPart {
            serial,
            ..RecordedPart::default()
        });
        parts
    }
}

impl fmt::Debug for Recorder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Recorder")
            .field("count", &self.count)
            .finish_non_exhaustive()
    }
}
