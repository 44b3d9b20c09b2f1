//! The children of one node, side by side.

use crate::kernels::BoxLanes;

/// What is below a node: a group of siblings, a leaf, or, in a lane that is not used, nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Child(u32);

/// A [`Child`], taken apart.
pub(crate) enum Below {
    Group(u32),
    Leaf(u32),
}

impl Child {
    const LEAF: u32 = 1 << 31;
    pub(crate) const NONE: Self = Self(u32::MAX);

    pub(crate) fn group(group: u32) -> Self {
        Self(group)
    }

    pub(crate) fn leaf(leaf: u32) -> Self {
        Self(leaf | Self::LEAF)
    }

    pub(crate) fn is_none(self) -> bool {
        self == Self::NONE
    }

    /// What is below; of a lane that is used.
    #[inline]
    pub(crate) fn below(self) -> Below {
        if self.0 & Self::LEAF == 0 {
            Below::Group(self.0)
        } else {
            Below::Leaf(self.0 & !Self::LEAF)
        }
    }
}

/// Up to N nodes with one parent. Lanes are used from the first on; the box of an unused lane is empty.
#[derive(Clone, Debug)]
pub(crate) struct Siblings<const N: usize> {
    pub(crate) boxes: BoxLanes<N>,
    pub(crate) children: [Child; N],
    /// The number of the node in lane 0 when nodes are counted level by level: its place in `VertexSets`.
    pub(crate) first_node: u32,
    /// The leaf in lane 0 if all lanes that are used are leaves, which then have consecutive numbers.
    pub(crate) first_leaf: Option<u32>,
    /// The epoch of the body in which the boxes were made; 0 is before every epoch.
    pub(crate) epoch: u64,
}

impl<const N: usize> Siblings<N> {
    pub(crate) fn new(first_node: u32) -> Self {
        Self {
            boxes: BoxLanes::EMPTY,
            children: [Child::NONE; N],
            first_node,
            first_leaf: None,
            epoch: 0,
        }
    }

    /// What is below the lanes that are used.
    #[inline]
    pub(crate) fn used_children(&self) -> impl Iterator<Item = Child> {
        self.children
            .into_iter()
            .take_while(|child| !child.is_none())
    }

    /// How many lanes are used.
    #[inline]
    pub(crate) fn len(&self) -> usize {
        self.used_children().count()
    }
}
