//! Input and output of a broad phase: boxes of all bodies, and pairs that overlap.

use crate::geometry::Aabb;
use crate::ids::Rank;

/// Two bodies whose boxes overlap, the smaller rank first.
pub(crate) type Overlap = [Rank; 2];

/// Boxes of all bodies, and their environments, both by rank.
#[derive(Clone, Copy)]
pub(crate) struct Boxes<'b> {
    pub(crate) of_bodies: &'b [Aabb],
    /// Bodies of different environments do not meet. Empty if all bodies are in one.
    pub(crate) environments: &'b [u32],
}
