//! Ctrl-C while a query computes: signals are handled during it, and an exception ends it.
//!
//! Python handles signals in its main thread, between instructions of its own. A call of an
//! extension module has none, so a query checks for signals now and then. A check needs the
//! interpreter lock, and may wait for it while another thread of Python runs. So checks are rare,
//! and only in the thread that asks, if it is the main one. Work outside queries, such as building
//! a tree, is not interrupted.

use crate::error::{Refused, Result};
use pyo3::prelude::*;
use std::cell::Cell;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread::{self, ThreadId};
use std::time::Instant;

/// Milliseconds between two checks for signals.
///
/// Nobody notices such a delay after Ctrl-C. A wait for the lock, mostly 5 milliseconds where other
/// threads of Python are busy, is small beside it.
const BETWEEN_LOOKS: u64 = 50;

/// Questions of a query for each look at the clock.
///
/// A query asks at least every 10 milliseconds, and mostly far more often: the clock alone would
/// cost a sixth of a small query.
const ASKED_PER_LOOK_AT_CLOCK: u32 = 16;

thread_local! {
    /// Questions of this thread so far. A shared counter would make the threads of a query wait for
    /// each other.
    static ASKED: Cell<u32> = const { Cell::new(0) };
}

/// State of the checks for signals during one query.
struct Signals {
    began: Instant,
    asker: ThreadId,
    /// Time of the next check, in milliseconds since the beginning.
    next_look: AtomicU64,
    /// Questions for each look at the clock.
    per_look: u32,
    raised: OnceLock<PyErr>,
}

/// Runs `ask` with a question that interrupts it; called without the interpreter lock.
///
/// Returns the exception that a signal handler raised meanwhile: `KeyboardInterrupt`, if nobody set
/// another handler.
pub(crate) fn interruptible<T, E: Into<Refused>>(
    ask: impl FnOnce(&(dyn Fn() -> bool + Sync)) -> Result<T, E>,
) -> Result<T> {
    interruptible_after(ASKED_PER_LOOK_AT_CLOCK, ask)
}

/// Runs `ask` as [`interruptible`] does, with `per_look` questions for each look at the clock.
pub(crate) fn interruptible_after<T, E: Into<Refused>>(
    per_look: u32,
    ask: impl FnOnce(&(dyn Fn() -> bool + Sync)) -> Result<T, E>,
) -> Result<T> {
    let signals = Signals {
        began: Instant::now(),
        asker: thread::current().id(),
        next_look: AtomicU64::new(BETWEEN_LOOKS),
        per_look,
        raised: OnceLock::new(),
    };
    let answer = ask(&|| signals.have_raised());
    // Also where the query ended in spite of it: no exception is lost.
    match signals.raised.into_inner() {
        Some(raised) => Err(Refused::Python(raised)),
        None => answer.map_err(Into::into),
    }
}

impl Signals {
    /// Whether a handler has raised an exception; checks for signals when it is time.
    fn have_raised(&self) -> bool {
        let asked = ASKED.get().wrapping_add(1);
        ASKED.set(asked);
        if asked.is_multiple_of(self.per_look) && self.is_due() {
            let next = if self.look() {
                self.elapsed() + BETWEEN_LOOKS
            } else {
                u64::MAX
            };
            self.next_look.store(next, Ordering::Relaxed);
        }
        self.raised.get().is_some()
    }

    fn is_due(&self) -> bool {
        self.elapsed() >= self.next_look.load(Ordering::Relaxed)
            && thread::current().id() == self.asker
    }

    fn elapsed(&self) -> u64 {
        self.began.elapsed().as_millis() as u64
    }

    /// Has pending signals handled. Returns whether to check again.
    fn look(&self) -> bool {
        let handled = Python::try_attach(|py| {
            py.check_signals()?;
            is_main_thread(py)
        });
        match handled {
            Some(Ok(is_main)) => is_main,
            Some(Err(raised)) => {
                // The first exception: there is no check after it.
                let _ = self.raised.set(raised);
                false
            }
            // The interpreter is at its end.
            None => false,
        }
    }
}

fn is_main_thread(py: Python<'_>) -> PyResult<bool> {
    let threading = py.import("threading")?;
    let main = threading.call_method0("main_thread")?.getattr("ident")?;
    threading.call_method0("get_ident")?.eq(main)
}
