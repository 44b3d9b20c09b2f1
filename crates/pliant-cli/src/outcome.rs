//! How the program ends.

/// What the caller of the program learns from its exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// 0: nothing intersects, or nothing was asked.
    Clear,
    /// 1: something intersects.
    Intersects,
}
