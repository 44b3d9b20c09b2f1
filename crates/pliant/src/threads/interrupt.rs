//! How a query is interrupted from outside.
//!
//! Whoever asks may bring a question, "stop now?", which is looked at between jobs and between runs of a long loop: each of these
//! takes well below ten milliseconds, but for the exceptions that `Query::interrupt_if` names. Once it was answered with yes, every
//! thread ends what it is at and begins nothing new. What was left half done is then forgotten by the world: see `collide/asked.rs`.

use std::sync::atomic::{AtomicBool, Ordering};

/// The caller's question.
pub(crate) type Question<'q> = &'q (dyn Fn() -> bool + Sync);

/// Whether a query is to end early.
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

    /// Looks, and remembers a yes.
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
        // The others are told by the flag, so that none of them asks again.
        if !self.is_set.load(Ordering::Relaxed) && question() {
            self.is_set.store(true, Ordering::Relaxed);
        }
        self.is_set.load(Ordering::Relaxed)
    }
}
