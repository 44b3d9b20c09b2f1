//! Close pairs as callers get them: two elements, their distance, and their closest points.

use crate::queries::{EdgeEdge, Pair, VertexTriangle};

/// Features of two elements that hold their closest points: the smallest parts that do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ClosestFeatures {
    /// Two vertices.
    VertexVertex,
    /// A vertex and the inside of an edge.
    VertexEdge,
    /// A vertex and the inside of a triangle.
    VertexFace,
    /// The insides of two edges.
    EdgeEdge,
}

/// A vertex close to a triangle that it is no corner of.
///
/// The distance is off by at most 2^-30 of itself and 2^-1074, the smallest number. It is 0 exactly
/// if they touch.
///
/// Let s be the largest coordinate of any difference of the four vertices. Then, each with an error
/// of at most `2^-30 distance + 2^-48 s + 2^-1074`:
///
/// - The vertex and the point that `barycentric` names are no further apart than the distance.
/// - Along `direction` the elements are apart by the distance.
///
/// In a thread that flushes subnormal numbers 2^-1022 takes the place of 2^-1074.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CloseVertexTriangle {
    /// The vertex and the triangle.
    pub pair: VertexTriangle,
    /// Distance between the two, in the unit of the positions.
    pub distance: f64,
    /// Unit vector from the triangle to the vertex. None if they touch.
    pub direction: Option<[f64; 3]>,
    /// Barycentric coordinates of the triangle's closest point: the weight of each corner, in
    /// order.
    ///
    /// Each is at least 0. Their sum is 1, up to rounding.
    pub barycentric: [f64; 3],
}

/// Two edges close to each other that have no end in common.
///
/// Errors are bounded as for [`CloseVertexTriangle`]. Parallel edges have many closest points; the
/// ones here hold an end of one edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CloseEdgeEdge {
    /// The two edges.
    pub pair: EdgeEdge,
    /// Distance between the two, in the unit of the positions.
    pub distance: f64,
    /// Unit vector from the second edge to the first. None if they touch.
    pub direction: Option<[f64; 3]>,
    /// Barycentric coordinates of the first edge's closest point: the weight of each end, as
    /// [`World::edges`](crate::World::edges) orders them.
    pub barycentric_a: [f64; 2],
    /// Barycentric coordinates of the second edge's closest point.
    pub barycentric_b: [f64; 2],
}

/// Two triangles close to each other, of two bodies or of one.
///
/// The distance is off by at most 2^-30 of itself and 2^-1074, the smallest number. It is 0 exactly
/// if they intersect.
///
/// Let s be the largest coordinate of any difference of their corners.
///
/// - The points that `barycentric_a` and `barycentric_b` name are no further apart than the
///   distance, with an error of at most `2^-30 distance + 2^-40 s + 2^-1074`.
/// - Along `direction` the triangles are apart by the distance, with an error of at most `2^-30
///   distance + 2^-48 s + 2^-1074`.
/// - `point_a` and `point_b` are the same points. Each coordinate is off by at most 2^-50 of the
///   largest coordinate of the triangle's corners, and 2^-1073.
///
/// Where corners a, b, c have weights x, y, z the point is a + y (b - a) + z (c - a). If there are
/// several pairs of closest points, these are one of them. Where triangles intersect, the points
/// are a point in common.
///
/// In a thread that flushes subnormal numbers 2^-1022 and 2^-1020 take the places of 2^-1074 and
/// 2^-1073.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CloseTriangles {
    /// The two triangles.
    pub pair: Pair,
    /// Distance between the two, in the unit of the positions.
    pub distance: f64,
    /// Unit vector from the second triangle to the first. None at distance 0.
    pub direction: Option<[f64; 3]>,
    /// Barycentric coordinates of the first triangle's closest point: the weight of each corner, in
    /// order.
    ///
    /// Each is at least 0. Their sum is 1, up to rounding.
    pub barycentric_a: [f64; 3],
    /// Barycentric coordinates of the second triangle's closest point.
    pub barycentric_b: [f64; 3],
    /// Coordinates of the first triangle's closest point.
    pub point_a: [f64; 3],
    /// Coordinates of the second triangle's closest point.
    pub point_b: [f64; 3],
}

impl CloseVertexTriangle {
    /// Features of vertex and triangle that hold the closest points, from the weights that are
    /// above 0.
    pub fn features(&self) -> ClosestFeatures {
        ClosestFeatures::of(false, 1 + count(&self.barycentric))
    }
}

impl CloseEdgeEdge {
    /// Features of both edges that hold the closest points, from the weights that are above 0.
    pub fn features(&self) -> ClosestFeatures {
        let vertices = count(&self.barycentric_a) + count(&self.barycentric_b);
        ClosestFeatures::of(true, vertices)
    }
}

impl ClosestFeatures {
    /// Features of two edges, or of a vertex and a triangle, with this many vertices together.
    pub(crate) fn of(are_edges: bool, vertices: usize) -> Self {
        match vertices {
            2 => Self::VertexVertex,
            3 => Self::VertexEdge,
            _ if are_edges => Self::EdgeEdge,
            _ => Self::VertexFace,
        }
    }
}

/// Number of corners whose weight is above 0.
pub(crate) fn count(barycentric: &[f64]) -> usize {
    barycentric.iter().filter(|&&x| x > 0.0).count()
}
