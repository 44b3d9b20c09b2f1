//! How much of a long piece of work is done before something else has its turn: all of it, unless it is interrupted, or a share.
//!
//! What can be left and gone on with keeps where it is, and has a method `advance(.., budget) -> bool`, which returns whether all is done.
//! Work is counted in *looks* at a triangle, some nanoseconds each, never in time: it is cut in the same places on every machine.

use super::Interrupt;

/// What is left of a share of work.
pub(crate) struct Budget<'q> {
    looks: usize,
    interrupt: Option<&'q Interrupt<'q>>,
}

impl<'q> Budget<'q> {
    /// So much, and what was begun when it is spent.
    pub(crate) fn of(looks: usize) -> Self {
        Self {
            looks,
            interrupt: None,
        }
    }

    /// All there is.
    pub(crate) fn whole() -> Self {
        Self::of(usize::MAX)
    }

    /// All there is, until it is interrupted.
    pub(crate) fn until(interrupt: &'q Interrupt<'q>) -> Self {
        Self {
            looks: usize::MAX,
            interrupt: Some(interrupt),
        }
    }

    /// So much was done.
    pub(crate) fn spend(&mut self, looks: usize) {
        self.looks = self.looks.saturating_sub(looks);
    }

    /// Whether it is somebody else's turn.
    pub(crate) fn is_spent(&self) -> bool {
        self.looks == 0 || self.interrupt.is_some_and(Interrupt::is_set)
    }
}
