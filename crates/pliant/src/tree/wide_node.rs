//! The children of one node, side by side: a wide node.

use crate::ids::{LeafId, WideNodeId};

/// What is below a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Child {
    /// A wide node, which holds the node's children.
    Inner(WideNodeId),
    Leaf(LeafId),
}

/// A [`Child`], or nothing in a lane that is not used, in one word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct PackedChild(u32);

impl PackedChild {
    const LEAF: u32 = 1 << 31;
    const NONE: Self = Self(u32::MAX);

    fn new(child: Child) -> Self {
        match child {
            Child::Inner(wide_node) => Self(wide_node.0),
            Child::Leaf(leaf) => Self(leaf.0 | Self::LEAF),
        }
    }

    /// Of a lane that is used.
    #[inline(always)]
    fn get(self) -> Child {
        if self.0 & Self::LEAF == 0 {
            Child::Inner(WideNodeId(self.0))
        } else {
            Child::Leaf(LeafId(self.0 & !Self::LEAF))
        }
    }
}

/// The most nodes that have one parent: the largest degree.
const MOST_LANES: usize = 8;

/// Up to eight nodes with one parent, as many as the degree of the tree at most. Lanes are used from the first on.
#[derive(Clone, Debug)]
pub(crate) struct WideNode {
    children: [PackedChild; MOST_LANES],
    /// The number of the node in lane 0 when nodes are counted level by level: its place in `VertexSets`.
    pub(crate) first_node: u32,
    /// The leaf in lane 0 if all lanes that are used are leaves, which then have consecutive numbers.
    pub(crate) first_leaf: Option<LeafId>,
}

impl WideNode {
    pub(super) fn new(first_node: u32) -> Self {
        Self {
            children: [PackedChild::NONE; MOST_LANES],
            first_node,
            first_leaf: None,
        }
    }

    pub(super) fn set_child(&mut self, lane: usize, child: Child) {
        self.children[lane] = PackedChild::new(child);
    }

    /// What is below the node in a lane that is used.
    #[inline(always)]
    pub(crate) fn child(&self, lane: usize) -> Child {
        self.children[lane].get()
    }

    /// What is below the nodes in all lanes that are used.
    #[inline]
    pub(crate) fn children(&self) -> impl Iterator<Item = Child> {
        let used = self.children.into_iter();
        used.take_while(|&child| child != PackedChild::NONE)
            .map(PackedChild::get)
    }

    /// How many lanes are used.
    #[inline]
    pub(crate) fn len(&self) -> usize {
        self.children().count()
    }
}
