//! Interrupt of a query from outside.
//!
//! A caller may bring a question, "stop now?". It is asked between jobs, and between runs of a long
//! loop. Each of these takes well below ten milliseconds, with the exceptions that
//! `Query::interrupt_if` names. After the first yes, every thread ends its present work and begins
//! nothing new. The world then drops everything that is half done: see `collide/asked.rs`.

use std::sync::atomic::{AtomicBool, Ordering};

/// Question of the caller: whether to stop now.
pub(crate) type Question<'q> = &'q (dyn Fn() -> bool + Sync);

/// Flag that ends a query early, set by the first yes to the question.
#[derive(Default)]
pub(crate) struct Interrupt<'q> {
    question: Option<Question<'q>>,
    is_set: AtomicBool,
}

impl<'q> Interrupt<'q> {
    pub(crate) fn new(question: Option<Question<'q>>) -> Self {
        Self {
            question,
            is_set: AtomicBool::new(false),
        }
    }

    /// Asks the question if it was not yet answered with yes. Returns whether the query is to end.
    #[inline]
    pub(crate) fn is_set(&self) -> bool {
        match self.question {
            None => false,
            Some(question) => self.ask(question),
        }
    }

    #[cold]
    #[inline(never)]
    fn ask(&self, question: Question) -> bool {
        // Other threads read the flag, so that none of them asks again.
        if !self.is_set.load(Ordering::Relaxed) && question() {
            self.is_set.store(true, Ordering::Relaxed);
        }
        self.is_set.load(Ordering::Relaxed)
    }
}
