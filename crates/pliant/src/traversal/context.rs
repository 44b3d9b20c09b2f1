//! Context of a descent: what its tasks share, and the limits after which each yields to the
//! others.

use super::tree_pair::Views;
use crate::kernels::Instructions;
use crate::queries::Needs;
use crate::threads::Interrupt;

/// Read-only context that all tasks of a descent share.
pub(super) struct Context<'q, S> {
    pub(super) needs: Needs,
    pub(super) pair: Views<'q, S>,
    pub(super) instructions: Instructions,
    pub(super) interrupt: &'q Interrupt<'q>,
    pub(super) limits: TaskLimits,
}

/// Limits after which a task yields.
#[derive(Clone, Copy, Debug)]
pub(super) struct TaskLimits {
    /// Batch size: pairs of nodes that are taken from the stack at once.
    pub(super) batch: usize,
    /// Pairs of leaves on the list of a task from which it tests them.
    pub(super) leaf_pairs: usize,
    /// Pairs of blocks after which hits are shown to a visitor, and pairs of nodes distributed
    /// anew.
    pub(super) block_pairs: usize,
    /// Pairs of nodes on the stack of a task from which it gives some to others.
    pub(super) stack: usize,
}
