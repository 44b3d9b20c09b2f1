//! What is refitted, and with what.

use crate::kernels::Instructions;
use crate::options::Update;
use crate::threads::Executor;
use crate::tree::{BoxSet, Source, Tree};

/// What a body meets in a query: of how much of its tree boxes are made ahead depends on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Partner {
    Another,
    /// Then every leaf meets at least itself.
    Itself,
}

/// How boxes are made.
#[derive(Clone, Copy)]
pub(crate) struct Refit<'q> {
    pub(crate) executor: Executor<'q>,
    pub(crate) instructions: Instructions,
    pub(crate) update: Update,
}

/// A tree, a set of its boxes, and what these are made of.
pub(crate) struct Refitted<'t, S> {
    pub(crate) tree: &'t Tree,
    pub(crate) boxes: &'t mut BoxSet,
    pub(crate) source: &'t Source<'t, S>,
}
