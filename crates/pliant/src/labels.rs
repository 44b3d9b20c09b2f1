//! Labels of triangles: parts of a body, and which of them are neighbours.

/// Labels of a body's triangles, and which of them are neighbours.
///
/// See [`World::set_labels`](crate::World::set_labels).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Labels<'l> {
    /// Label of each triangle, shape (m,). A triangle labelled [`NONE`](Self::NONE) is left out of
    /// nothing.
    pub of_triangles: &'l [u32],
    /// Pairs of labels that are neighbours, shape (k, 2), in any order. `None`: labels that have a
    /// vertex in common.
    pub neighbours: Option<&'l [[u32; 2]]>,
}

impl Labels<'_> {
    /// Label of a triangle that is left out of nothing.
    pub const NONE: u32 = u32::MAX;
}
