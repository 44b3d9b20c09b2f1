//! Wide node: the children of one node, side by side.

use crate::ids::{LeafId, WideNodeId};

/// Link from a node down: to the wide node of its children, or to its leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Child {
    /// A wide node, which holds the node's children.
    Inner(WideNodeId),
    Leaf(LeafId),
}

/// [`Child`] packed into one word; an unused lane has a sentinel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct PackedChild(u32);

impl PackedChild {
    /// Bit that marks a leaf.
    const LEAF: u32 = 1 << 31;
    /// Sentinel of an unused lane.
    const NONE: Self = Self(u32::MAX);

    fn new(child: Child) -> Self {
        match child {
            Child::Inner(wide_node) => Self(wide_node.0),
            Child::Leaf(leaf) => Self(leaf.0 | Self::LEAF),
        }
    }

    /// Unpacks a used lane.
    #[inline(always)]
    fn get(self) -> Child {
        if self.0 & Self::LEAF == 0 {
            Child::Inner(WideNodeId(self.0))
        } else {
            Child::Leaf(LeafId(self.0 & !Self::LEAF))
        }
    }
}

/// Most nodes that have one parent: the largest degree.
const MOST_LANES: usize = 8;

/// Up to eight nodes with one parent, at most as many as the tree's degree. Lanes are used from the
/// first on.
#[derive(Clone, Debug)]
pub(crate) struct WideNode {
    children: [PackedChild; MOST_LANES],
    /// Number of the node in lane 0, counted level by level: its place in `VertexSets`.
    pub(crate) first_node: u32,
    /// Leaf in lane 0, if all used lanes are leaves; their numbers are consecutive.
    pub(crate) first_leaf: Option<LeafId>,
}

impl WideNode {
    /// Begins a wide node without children.
    pub(super) fn new(first_node: u32) -> Self {
        Self {
            children: [PackedChild::NONE; MOST_LANES],
            first_node,
            first_leaf: None,
        }
    }

    /// Sets the link down from the node in a lane.
    pub(super) fn set_child(&mut self, lane: usize, child: Child) {
        self.children[lane] = PackedChild::new(child);
    }

    /// Returns the link down from the node in a used lane.
    #[inline(always)]
    pub(crate) fn child(&self, lane: usize) -> Child {
        self.children[lane].get()
    }

    /// Iterates over the links down of all used lanes.
    #[inline]
    pub(crate) fn children(&self) -> impl Iterator<Item = Child> {
        let used = self.children.into_iter();
        used.take_while(|&child| child != PackedChild::NONE)
            .map(PackedChild::get)
    }

    /// Returns how many lanes are used.
    #[inline]
    pub(crate) fn len(&self) -> usize {
        self.children().count()
    }
}
