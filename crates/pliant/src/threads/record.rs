//! Record of jobs: how long each takes when one thread does all, for a replay on more workers.
//!
//! Work is cut as for some number of threads, and done by the calling thread alone. The clock is
//! the caller's, as the library reads none.

use super::lock::locked;
use std::fmt;
use std::num::NonZeroUsize;
use std::sync::{Arc, Mutex};

/// Clock of the caller, which returns nanoseconds.
pub type Clock = Arc<dyn Fn() -> u64 + Send + Sync>;

/// Part of a step: serial work of one thread, then jobs that several may share.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RecordedPart {
    /// Nanoseconds of serial work, from the end of the previous part's jobs to the start of these.
    pub serial: u64,
    /// Nanoseconds that each job took, in order.
    pub jobs: Vec<u64>,
    /// Most threads that would share the jobs, however many there are.
    pub most_threads: usize,
}

/// Recorder of the times of all jobs.
pub(super) struct Recorder {
    /// Number of threads for which work is cut.
    pub(super) count: NonZeroUsize,
    clock: Clock,
    log: Mutex<Log>,
}

/// Parts recorded so far, and the present one.
#[derive(Default)]
struct Log {
    /// Time at which the last part, or piece of work, ended.
    since: u64,
    /// Times of the pieces of the present part.
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

    /// Runs jobs by their numbers, and records their times as a part.
    pub(super) fn run(&self, jobs: usize, most_threads: usize, work: &dyn Fn(usize)) {
        let serial = self.lap();
        for number in 0..jobs {
            work(number);
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

    /// Marks the end of a piece of a job, after which another thread could have done the rest.
    pub(super) fn mark(&self) {
        let time = self.lap();
        locked(&self.log).jobs.push(time);
    }

    /// Nanoseconds since the last lap.
    fn lap(&self) -> u64 {
        let now = (self.clock)();
        let log = &mut *locked(&self.log);
        now - std::mem::replace(&mut log.since, now)
    }

    /// Returns the record since the last call; its last part has no jobs.
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
