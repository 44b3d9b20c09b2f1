//! Numbers of things, each kind with a type of its own, so that mixing two of them does not compile.
//!
//! Triangles and vertices have two numbers: that of the caller, and that in the order of the tree (`mesh::Order` knows both). The
//! caller's come in and go out as plain `u32`; between, everything is in tree order.

use std::fmt;

macro_rules! numbers {
    ($($(#[$doc:meta])* $name:ident;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub(crate) struct $name(pub(crate) u32);

        impl $name {
            /// As the index of an array.
            #[inline(always)]
            pub(crate) fn index(self) -> usize {
                self.0 as usize
            }
        }
    )*};
}

numbers! {
    /// A triangle, as the caller numbers them.
    CallerTriangle;
    /// A triangle, in the order of the tree.
    TreeTriangle;
    /// A vertex, as the caller numbers them.
    CallerVertex;
    /// A vertex, in the order of the tree.
    TreeVertex;
    /// Where a body stands in the list of its world.
    Place;
    /// Where a body stands among those of its world in the order of their ids.
    Rank;
    /// A wide node of a tree: up to N nodes side by side, the children of one node.
    WideNodeId;
    /// A leaf of a tree.
    LeafId;
    /// Up to eight triangles of a leaf, side by side.
    BlockId;
}

impl TreeTriangle {
    /// The triangle that comes so many later.
    #[inline(always)]
    pub(crate) fn plus(self, count: u32) -> Self {
        Self(self.0 + count)
    }
}

impl LeafId {
    /// The leaf that comes so many later.
    #[inline(always)]
    pub(crate) fn plus(self, count: u32) -> Self {
        Self(self.0 + count)
    }
}

/// A body of a world: a number in order of adding, never used again in that world.
///
/// An id means nothing in another world; there it is refused, or is another body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct BodyId(pub u32);

impl fmt::Display for BodyId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "body {}", self.0)
    }
}

/// A node of a tree: one lane of a wide node. The node has one box, over all triangles below it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct NodeId(u32);

impl NodeId {
    pub(crate) const ROOT: Self = Self(0);

    /// Eight lanes to a wide node, whatever the degree of the tree is.
    #[inline(always)]
    pub(crate) fn new(wide_node: WideNodeId, lane: usize) -> Self {
        Self(wide_node.0 * 8 + lane as u32)
    }

    #[inline(always)]
    pub(crate) fn wide_node_and_lane(self) -> (WideNodeId, usize) {
        (WideNodeId(self.0 / 8), self.0 as usize % 8)
    }
}
