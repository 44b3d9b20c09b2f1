//! Adjacent contacts as callers get them: two triangles of one body that meet beyond the corners
//! that they have in common, and how.

use crate::queries::{ContactKind, Pair};
use crate::sort::Numbered;

/// Two triangles of a body that have a vertex in common and meet beyond what they share, and the
/// kind of their contact.
///
/// They have one, two or three vertices of the mesh in common. They *meet beyond* if they have more
/// points in common than the corner, the edge or the triangle between these vertices. With three in
/// common the triangle is there twice, which counts. The kinds are:
///
/// - **Crossing**: one corner in common, and after every small enough move of the vertices they
///   still meet beyond it.
/// - **Overlapping**: they lie in one plane, with an area in common; or the triangle is there
///   twice.
/// - **Touching**: anything else.
///
/// A degenerate triangle is the segment or point that it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct AdjacentContact {
    /// The two triangles, the smaller number first. Both bodies are the same.
    pub pair: Pair,
    /// Kind of contact: how they meet beyond what they share.
    pub kind: ContactKind,
}

impl From<AdjacentContact> for Pair {
    fn from(contact: AdjacentContact) -> Self {
        contact.pair
    }
}

impl Numbered for AdjacentContact {
    #[inline]
    fn numbers(&self) -> [u32; 4] {
        self.pair.numbers()
    }
}
