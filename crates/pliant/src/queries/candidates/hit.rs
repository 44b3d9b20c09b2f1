//! Candidates as callers get them: a vertex and a triangle, or two edges.

use crate::ids::BodyId;
use crate::sort::{Hit, Numbered};

/// A vertex near a triangle that it is no corner of, of two bodies or of one.
///
/// Ordered by its fields: the vertex first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct VertexTriangle {
    /// Body of the vertex.
    pub vertex_body: BodyId,
    /// Vertex, with the caller's number.
    pub vertex: u32,
    /// Body of the triangle. It equals `vertex_body` in a body that meets itself.
    pub triangle_body: BodyId,
    /// Triangle, with the caller's number.
    pub triangle: u32,
}

/// As a row of numbers: body, vertex, body, triangle.
impl From<VertexTriangle> for [u32; 4] {
    fn from(hit: VertexTriangle) -> Self {
        hit.numbers()
    }
}

impl Numbered for VertexTriangle {
    #[inline]
    fn numbers(&self) -> [u32; 4] {
        let Self {
            vertex_body,
            vertex,
            triangle_body,
            triangle,
        } = *self;
        [vertex_body.0, vertex, triangle_body.0, triangle]
    }
}

impl Hit for VertexTriangle {
    #[inline]
    fn of_numbers([vertex_body, vertex, triangle_body, triangle]: [u32; 4]) -> Self {
        Self {
            vertex_body: BodyId(vertex_body),
            vertex,
            triangle_body: BodyId(triangle_body),
            triangle,
        }
    }
}

/// Two edges near each other that have no end in common, of two bodies or of one.
///
/// Ordered by its fields. The smaller (body, edge) is first. But if the query names two bodies, the
/// one named first is first.
/// [`World::edges`](crate::World::edges) numbers edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct EdgeEdge {
    /// Body of the first edge.
    pub body_a: BodyId,
    /// First edge, as [`World::edges`](crate::World::edges) numbers edges.
    pub edge_a: u32,
    /// Body of the second edge. It equals `body_a` in a body that meets itself.
    pub body_b: BodyId,
    /// Second edge, as [`World::edges`](crate::World::edges) numbers edges.
    pub edge_b: u32,
}

/// As a row of numbers: body, edge, body, edge.
impl From<EdgeEdge> for [u32; 4] {
    fn from(hit: EdgeEdge) -> Self {
        hit.numbers()
    }
}

impl Numbered for EdgeEdge {
    #[inline]
    fn numbers(&self) -> [u32; 4] {
        [self.body_a.0, self.edge_a, self.body_b.0, self.edge_b]
    }
}

impl Hit for EdgeEdge {
    #[inline]
    fn of_numbers([body_a, edge_a, body_b, edge_b]: [u32; 4]) -> Self {
        Self {
            body_a: BodyId(body_a),
            edge_a,
            body_b: BodyId(body_b),
            edge_b,
        }
    }
}
