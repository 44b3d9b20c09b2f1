//! How two triangles that intersect do so.

use crate::hits::{Numbered, Pair};
pub use pliant_exact::ContactKind;

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
