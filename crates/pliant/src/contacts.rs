//! How two triangles that intersect do so.

use crate::hits::{Numbered, Pair};

/// How two triangles, as closed sets, have points in common. Each pair that intersects is of one kind, decided exactly.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ContactKind {
    /// Neither of the others: a corner or an edge on the other triangle, or two edges at a point. A move of their corners, however
    /// small, could part them.
    #[default]
    Touching,
    /// They lie in one plane, and have an area in common. A small move could part them too.
    Overlapping,
    /// They go through each other: after every small enough move of their corners they still intersect. So there is no plane with one
    /// triangle on either closed side of it. A triangle without area, a segment, crosses another if it goes through its inside.
    Crossing,
}

/// Two triangles that intersect, and how.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Contact {
    /// Which they are.
    pub pair: Pair,
    /// How they intersect.
    pub kind: ContactKind,
}

impl Numbered for Contact {
    #[inline]
    fn numbers(&self) -> [u32; 4] {
        self.pair.numbers()
    }
}
