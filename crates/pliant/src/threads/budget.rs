//! Budget of a long piece of work: a share of it, or all of it unless it is interrupted.
//!
//! Resumable work keeps its position and has a method `advance(.., budget) -> bool`, which returns
//! whether all is done. Work is counted in *looks* at a triangle, some nanoseconds each. It is
//! never measured in time, so it is cut in the same places on every machine.

use super::Interrupt;

/// Rest of a share of work.
pub(crate) struct Budget<'q> {
    looks: usize,
    interrupt: Option<&'q Interrupt<'q>>,
}

impl<'q> Budget<'q> {
    /// Budget of `looks` looks. A unit of work that has begun is finished even if it is spent.
    pub(crate) fn of(looks: usize) -> Self {
        Self {
            looks,
            interrupt: None,
        }
    }

    /// Unlimited budget.
    pub(crate) fn whole() -> Self {
        Self::of(usize::MAX)
    }

    /// Unlimited budget that ends with an interrupt.
    pub(crate) fn until(interrupt: &'q Interrupt<'q>) -> Self {
        Self {
            looks: usize::MAX,
            interrupt: Some(interrupt),
        }
    }

    /// Takes `looks` looks off the budget; it stops at 0.
    pub(crate) fn spend(&mut self, looks: usize) {
        self.looks = self.looks.saturating_sub(looks);
    }

    /// Whether the budget is used up, or the interrupt set.
    pub(crate) fn is_spent(&self) -> bool {
        self.looks == 0 || self.interrupt.is_some_and(Interrupt::is_set)
    }
}
