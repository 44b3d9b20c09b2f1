//! Triangles and vertices that edits have removed from a mesh, and its trees still hold.

use crate::ids::{TreeTriangle, TreeVertex};
use crate::mesh::Bits;

/// Removed triangles and vertices that are still in the trees.
#[derive(Clone, Copy)]
pub(crate) struct Removed<'q> {
    /// Removed triangles, in tree order.
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
