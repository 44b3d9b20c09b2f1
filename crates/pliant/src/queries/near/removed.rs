//! What an edit has taken out of a mesh, and its trees still hold.

use crate::ids::{TreeTriangle, TreeVertex};
use crate::mesh::Bits;

/// What was taken out of a mesh and is still in its trees.
#[derive(Clone, Copy)]
pub(crate) struct Removed<'q> {
    /// In tree order.
    pub(crate) triangles: &'q Bits,
    /// Vertices that no triangle has any more, in tree order.
    pub(crate) vertices: &'q Bits,
}

impl Removed<'_> {
    #[inline]
    pub(crate) fn has(&self, triangle: TreeTriangle) -> bool {
        self.triangles.has(triangle.0)
    }

    #[inline]
    pub(crate) fn has_vertex(&self, vertex: TreeVertex) -> bool {
        self.vertices.has(vertex.0)
    }
}
