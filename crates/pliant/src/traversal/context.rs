//! What all tasks of a descent work with, and how far each goes before it gives way to the others.

use super::tree_pair::TreePair;
use crate::kernels::Instructions;
use crate::queries::Needs;
use crate::threads::Interrupt;
use crate::tree::BoxSet;

/// What all tasks work with.
pub(super) struct Context<'q, S> {
    pub(super) needs: Needs,
    pub(super) pair: &'q TreePair<'q, S, &'q BoxSet>,
    pub(super) instructions: Instructions,
    pub(super) interrupt: &'q Interrupt<'q>,
    pub(super) limits: TaskLimits,
}

/// How far a task goes.
#[derive(Clone, Copy, Debug)]
pub(super) struct TaskLimits {
    /// Pairs of nodes that are taken from the stack at once.
    pub(super) batch: usize,
    /// With so many pairs of leaves on its list, a task tests them.
    pub(super) leaf_pairs: usize,
    /// After so many pairs of blocks, hits are shown to a visitor, and pairs of nodes distributed anew.
    pub(super) block_pairs: usize,
    /// With so many pairs of nodes on its stack, a task gives some to others.
    pub(super) stack: usize,
}
