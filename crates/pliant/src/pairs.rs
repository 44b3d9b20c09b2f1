//! What goes from phase to phase, and the result.

use crate::BodyId;
use crate::tree::NodeId;

/// Two triangles of two bodies that intersect. Pairs are ordered by their fields, and the smaller (body, triangle) is first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Pair {
    /// The body with the smaller id.
    pub body_a: BodyId,
    /// Its triangle, as the caller numbers it.
    pub triangle_a: u32,
    /// The body with the larger id.
    pub body_b: BodyId,
    /// Its triangle, as the caller numbers it.
    pub triangle_b: u32,
}

/// From the broad phase to the update: two bodies, by their places in the world, whose boxes overlap; the smaller first.
pub(crate) type BodyPair = [u32; 2];

/// Within the traversal: two nodes whose boxes are true and overlap.
pub(crate) type NodePair = [NodeId; 2];

/// Within the traversal: two leaves whose boxes overlap.
pub(crate) type LeafPair = [u32; 2];

/// Within the traversal: leaves side by side that are in pairs, a bit for each of eight.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct WantedLeaves {
    pub(crate) first: u32,
    pub(crate) lanes: u8,
}

/// Within the traversal: two blocks of up to eight triangles, in leaves whose boxes overlap.
pub(crate) type BlockPair = [u32; 2];

/// From the traversal to the narrow phase: two triangles, in tree order, whose boxes overlap.
pub(crate) type Candidate = [u32; 2];
