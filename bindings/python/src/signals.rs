//! Ctrl-C while a query computes: signals are handled in the middle of it, and what a handler raises ends it.
//!
//! Python handles signals only between instructions of its own, in its main thread; during a call of an extension module there are
//! none. So a query looks now and then whether a signal has come. That needs the interpreter lock, for which it may have to wait
//! while another thread of Python's runs: so it looks seldom, and only where it is of use, in the thread that asks and if this is
//! the main one. What no query does, building a tree for example, is not interrupted.

use crate::error::{Refused, Result};
use pyo3::prelude::*;
use std::cell::Cell;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread::{self, ThreadId};
use std::time::Instant;

/// Milliseconds between two looks: nobody notices as much after Ctrl-C, and a wait for the lock, mostly 5 milliseconds where other
/// threads of Python's are busy, is little beside it.
const BETWEEN_LOOKS: u64 = 50;

/// A query asks so many times before the clock is looked at. It asks every 10 milliseconds at least, but mostly so much more often that
/// the clock alone would cost a sixth of a small query.
const ASKED_PER_LOOK_AT_CLOCK: u32 = 16;

thread_local! {
    /// How often this thread has asked. Were the number shared, the threads of a query would wait for each other.
    static ASKED: Cell<u32> = const { Cell::new(0) };
}

/// What is known of signals during one query.
struct Signals {
    began: Instant,
    asker: ThreadId,
    /// In milliseconds since the beginning.
    next_look: AtomicU64,
    /// So many questions to a look at the clock.
    per_look: u32,
    raised: OnceLock<PyErr>,
}

/// Asks a query, for which it is called without the interpreter lock, and gives it what interrupts it. What a signal handler raised
/// meanwhile, `KeyboardInterrupt` if nobody set another, is what comes back then.
pub(crate) fn interruptible<T, E: Into<Refused>>(
    ask: impl FnOnce(&(dyn Fn() -> bool + Sync)) -> Result<T, E>,
) -> Result<T> {
    interruptible_after(ASKED_PER_LOOK_AT_CLOCK, ask)
}

/// The same of what may compute for long between any two of so many questions.
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
    // Also where the query came to its end in spite of it: no exception is lost.
    match signals.raised.into_inner() {
        Some(raised) => Err(Refused::Python(raised)),
        None => answer.map_err(Into::into),
    }
}

impl Signals {
    /// Whether a handler has raised something; looks for signals where it is time to.
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

    /// Has signals handled that have come. Returns whether to look again.
    fn look(&self) -> bool {
        let handled = Python::try_attach(|py| {
            py.check_signals()?;
            is_main_thread(py)
        });
        match handled {
            Some(Ok(is_main)) => is_main,
            Some(Err(raised)) => {
                // Nothing was there before: after the first there is no other look.
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
