//! Outcome of a command, which becomes the exit code of the program.

/// Outcome of a command that did not fail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// Exit code 0: nothing intersects, or nothing was asked.
    Clear,
    /// Exit code 1: something intersects.
    Intersects,
}
