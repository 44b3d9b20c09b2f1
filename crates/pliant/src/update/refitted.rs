//! Parameters of a refit: the tree, its boxes, their source, and how boxes are made.

use crate::kernels::Instructions;
use crate::options::Update;
use crate::threads::Executor;
use crate::tree::{BoxSet, Source, Tree};

/// Partner of a body in a query: it decides how much of the tree is made ahead.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Partner {
    Another,
    /// Then every leaf meets at least itself.
    Itself,
}

/// Settings with which boxes are made.
#[derive(Clone, Copy)]
pub(crate) struct Refit<'q> {
    pub(crate) executor: Executor<'q>,
    pub(crate) instructions: Instructions,
    pub(crate) update: Update,
}

/// Tree to be refitted, a set of its boxes, and the source that they are made from.
pub(crate) struct Refitted<'t, S> {
    pub(crate) tree: &'t Tree,
    pub(crate) boxes: &'t mut BoxSet,
    pub(crate) source: &'t Source<'t, S>,
}
