//! Crossing edges as callers get them: an edge and a triangle.

use crate::ids::BodyId;
use crate::sort::Numbered;

/// An edge that crosses a triangle: the open edge meets the open triangle, and not in its plane.
///
/// Ordered by its fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CrossingEdge {
    /// Body of the edge.
    pub edge_body: BodyId,
    /// Edge, with the number that [`World::edges`](crate::World::edges) gives it.
    pub edge: u32,
    /// Body of the triangle. It equals `edge_body` in a body that meets itself.
    pub triangle_body: BodyId,
    /// Triangle, with the caller's number.
    pub triangle: u32,
}

/// As a row of numbers: body, edge, body, triangle.
impl From<CrossingEdge> for [u32; 4] {
    fn from(crossing: CrossingEdge) -> Self {
        crossing.numbers()
    }
}

impl Numbered for CrossingEdge {
    #[inline]
    fn numbers(&self) -> [u32; 4] {
        [
            self.edge_body.0,
            self.edge,
            self.triangle_body.0,
            self.triangle,
        ]
    }
}
