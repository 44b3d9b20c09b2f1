//! Index types: each kind of number is a type of its own, so that mixing two does not compile.
//!
//! Triangles and vertices have two numbers: the caller's, and one in the order of the tree.
//! `mesh::Order` translates. The caller's numbers come in and go out as plain `u32`; between,
//! everything is in tree order.

use std::fmt;

macro_rules! numbers {
    ($($(#[$doc:meta])* $name:ident;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub(crate) struct $name(pub(crate) u32);

        impl $name {
            /// The number as an array index.
            #[inline(always)]
            pub(crate) fn index(self) -> usize {
                self.0 as usize
            }
        }
    )*};
}

numbers! {
    /// Triangle, as the caller numbers it.
    CallerTriangle;
    /// Triangle, in tree order.
    TreeTriangle;
    /// Vertex, as the caller numbers it.
    CallerVertex;
    /// Vertex, in tree order.
    TreeVertex;
    /// Place of a body in its world's list. The last body takes the place of a removed one.
    Place;
    /// Rank of a body: its index among the bodies of its world, in the order of their ids.
    Rank;
    /// Wide node of a tree: the children of one node, up to N of them, side by side.
    WideNodeId;
    /// Leaf of a tree.
    LeafId;
    /// Block: up to eight triangles of a leaf, side by side.
    BlockId;
}

impl TreeTriangle {
    /// The triangle `count` places later in tree order.
    #[inline(always)]
    pub(crate) fn plus(self, count: u32) -> Self {
        Self(self.0 + count)
    }
}

impl LeafId {
    /// The leaf `count` places later.
    #[inline(always)]
    pub(crate) fn plus(self, count: u32) -> Self {
        Self(self.0 + count)
    }
}

/// Id of a body: a number in order of adding, never used again in its world.
///
/// An id means nothing in another world: there it is refused, or names another body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct BodyId(pub u32);

impl fmt::Display for BodyId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "body {}", self.0)
    }
}

/// Node of a tree: one lane of a wide node, with one box over all triangles below it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct NodeId(u32);

impl NodeId {
    pub(crate) const ROOT: Self = Self(0);

    /// Packs a wide node and a lane. Every wide node takes eight numbers, whatever the degree of
    /// the tree is.
    #[inline(always)]
    pub(crate) fn new(wide_node: WideNodeId, lane: usize) -> Self {
        Self(wide_node.0 * 8 + lane as u32)
    }

    #[inline(always)]
    pub(crate) fn wide_node_and_lane(self) -> (WideNodeId, usize) {
        (WideNodeId(self.0 / 8), self.0 as usize % 8)
    }
}
