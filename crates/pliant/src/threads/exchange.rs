//! Work sharing: busy threads give work to idle ones, so that none waits while another has much
//! left.
//!
//! Idea: a thread checks now and then whether others are idle, and if so gives them half of its
//! remaining work. Invariant: no work is lost, and all end only when no worker has any. Use it only
//! where the order of work changes no answer.

use super::Executor;
use super::lock::locked;
use super::pool::Backoff;
use super::record::Recorder;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Looks at what others do before a worker without work gives up on workers that have not begun:
/// some tens of microseconds.
const PATIENCE: u32 = 130;

/// Pool of work that was given and not yet taken, shared by a fixed number of workers.
pub(crate) struct Exchange<'q, T> {
    given: Mutex<Vec<T>>,
    /// Number of workers that have not begun yet.
    unbegun: AtomicUsize,
    /// Number of workers that have begun, and have work.
    busy: AtomicUsize,
    /// Number of workers that wait for work.
    idle: AtomicUsize,
    /// Recorder of the times of pieces of work; one thread then does all, and none waits.
    recorder: Option<&'q Recorder>,
}

impl<'q, T> Exchange<'q, T> {
    /// Exchange for `workers` workers, each of which [begins](Self::begin) with work of its own.
    pub(crate) fn new(executor: Executor<'q>, workers: usize) -> Self {
        Self {
            recorder: executor.threads.recorder.as_ref().filter(|_| workers > 1),
            given: Mutex::default(),
            unbegun: AtomicUsize::new(workers),
            busy: AtomicUsize::new(0),
            idle: AtomicUsize::new(0),
        }
    }

    /// A worker begins.
    pub(crate) fn begin(&self) {
        self.busy.fetch_add(1, Ordering::AcqRel);
        self.unbegun.fetch_sub(1, Ordering::AcqRel);
    }

    /// Whether another worker waits for work.
    #[inline]
    pub(crate) fn is_anyone_idle(&self) -> bool {
        self.idle.load(Ordering::Relaxed) > 0
    }

    /// Whether to end a piece of work soon: another worker waits, or pieces are recorded.
    #[inline]
    pub(crate) fn wants_short_pieces(&self) -> bool {
        self.is_anyone_idle() || self.recorder.is_some()
    }

    /// Marks the end of a piece of work, after which the rest could be given to others.
    #[inline]
    pub(crate) fn mark(&self) {
        if let Some(recorder) = self.recorder {
            recorder.mark();
        }
    }

    /// Gives work to others.
    pub(crate) fn give(&self, work: impl IntoIterator<Item = T>) {
        locked(&self.given).extend(work);
    }

    /// Work that was given and that nobody took, after all workers have ended.
    ///
    /// Who waited may have just given up when it was given, and the giver may have stopped before
    /// it looked for more.
    pub(crate) fn rest(&self) -> Vec<T> {
        std::mem::take(&mut *locked(&self.given))
    }

    /// Takes some of the given work for a worker that has none left. Waits for it while others are
    /// busy, but not long. It waits less for those that have not begun: a lent pool may have other
    /// work. Returns whether there is any; if not, the worker has to end.
    pub(crate) fn take(&self, into: &mut Vec<T>) -> bool {
        let (mut backoff, mut looks) = (Backoff::default(), 0);
        self.idle.fetch_add(1, Ordering::Relaxed);
        // A giver is busy until it has given. So no work comes after the last has stopped being
        // busy.
        self.busy.fetch_sub(1, Ordering::AcqRel);
        let is_any = loop {
            looks += 1;
            let are_others = {
                let mut given = locked(&self.given);
                if !given.is_empty() {
                    let idle = self.idle.load(Ordering::Relaxed);
                    let rest = given.len() - given.len().div_ceil(idle.max(1));
                    into.extend(given.drain(rest..));
                    self.busy.fetch_add(1, Ordering::AcqRel);
                    break true;
                }
                // Under the lock: whoever takes is busy before it lets go.
                self.busy.load(Ordering::Acquire) > 0
                    || looks < PATIENCE && self.unbegun.load(Ordering::Acquire) > 0
            };
            if !are_others || self.recorder.is_some() || !backoff.waits() {
                break false;
            }
        };
        self.idle.fetch_sub(1, Ordering::Relaxed);
        is_any
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Executor, Interrupt, Threads};
    use super::*;
    use std::num::NonZeroUsize;

    /// Each number stands for all below it; one worker begins with the largest.
    #[test]
    fn all_work_is_done_once_whoever_has_it() {
        for count in [1, 2, 7] {
            let threads = &Threads::private(NonZeroUsize::new(count).unwrap());
            let interrupt = &Interrupt::default();
            let executor = Executor { threads, interrupt };
            let exchange = &Exchange::new(executor, count);
            let mut workers = vec![(Vec::new(), 0_u64); count];
            workers[0].0.push(14_u32);
            executor.run(&mut workers, u64::MAX, |_, (stack, done)| {
                exchange.begin();
                while !stack.is_empty() || exchange.take(stack) {
                    while let Some(number) = stack.pop() {
                        *done += 1;
                        stack.extend(0..number);
                        if exchange.is_anyone_idle() && stack.len() > 1 {
                            exchange.give(stack.drain(..stack.len() / 2));
                        }
                    }
                }
            });
            let done: u64 = workers.iter().map(|(_, done)| done).sum();
            assert_eq!(done, 1 << 14, "{count} threads");
        }
    }
}
