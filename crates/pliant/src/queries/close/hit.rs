//! Close pairs, as callers get them: how far apart two elements are, and their closest points.

use crate::queries::{EdgeEdge, Pair, VertexTriangle};

/// The smallest parts of two elements that hold the points in which they are closest.
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
/// The distance is off by at most 2^-30 of itself and 2^-1074, the smallest number; it is 0 exactly if they touch. Let s be the largest
/// coordinate of any difference of the four vertices; then the vertex and the point that `barycentric` names are no further apart than the
/// distance and 2^-30 of it and 2^-48 s and 2^-1074, and along `direction` the elements are apart by the distance but for as much. (In a
/// thread that flushes subnormal numbers 2^-1022 takes the place of 2^-1074.)
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CloseVertexTriangle {
    /// Which they are.
    pub pair: VertexTriangle,
    /// How far apart they are.
    pub distance: f64,
    /// From the triangle to the vertex, of length 1; none if they touch.
    pub direction: Option<[f64; 3]>,
    /// The point of the triangle: what each corner counts, in their order; at least 0, together 1 but for rounding.
    pub barycentric: [f64; 3],
}

/// Two edges close to each other that have no end in common.
///
/// Figures are as good as those of a [`CloseVertexTriangle`]. Of parallel edges there are many closest points; those here hold an end of
/// one edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CloseEdgeEdge {
    /// Which they are.
    pub pair: EdgeEdge,
    /// How far apart they are.
    pub distance: f64,
    /// From the second edge to the first, of length 1; none if they touch.
    pub direction: Option<[f64; 3]>,
    /// The point of the first edge: what each end counts, as [`World::edges`](crate::World::edges) orders them.
    pub barycentric_a: [f64; 2],
    /// The point of the second.
    pub barycentric_b: [f64; 2],
}

/// Two triangles close to each other, of two bodies or of one.
///
/// The distance is off by at most 2^-30 of itself and 2^-1074, the smallest number; it is 0 exactly if they intersect. Let s be the largest
/// coordinate of any difference of their corners; then the points that `barycentric_a` and `barycentric_b` name are no further apart than
/// the distance and 2^-30 of it and 2^-40 s and 2^-1074: where triangles intersect, they are a point in common. Along `direction` the
/// triangles are apart by the distance but for 2^-30 of it and 2^-48 s and 2^-1074. Of several closest points, those here are some. Where
/// corners a, b, c count x, y, z the point is a + y (b - a) + z (c - a); `point_a` and `point_b` are the same points, each coordinate off by
/// at most 2^-50 of the largest coordinate of the triangle's corners, and 2^-1073. (In a thread that flushes subnormal numbers 2^-1022 and
/// 2^-1020 take the places of 2^-1074 and 2^-1073.)
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CloseTriangles {
    /// Which they are.
    pub pair: Pair,
    /// How far apart they are.
    pub distance: f64,
    /// From the second triangle to the first, of length 1; none at distance 0.
    pub direction: Option<[f64; 3]>,
    /// The point of the first triangle: what each corner counts, in their order; at least 0, together 1 but for rounding.
    pub barycentric_a: [f64; 3],
    /// The point of the second.
    pub barycentric_b: [f64; 3],
    /// The point of the first triangle, as coordinates.
    pub point_a: [f64; 3],
    /// The point of the second.
    pub point_b: [f64; 3],
}

impl CloseVertexTriangle {
    /// Between which parts they are as close as that.
    pub fn features(&self) -> ClosestFeatures {
        match count(&self.barycentric) {
            1 => ClosestFeatures::VertexVertex,
            2 => ClosestFeatures::VertexEdge,
            _ => ClosestFeatures::VertexFace,
        }
    }
}

impl CloseEdgeEdge {
    /// Between which parts they are as close as that.
    pub fn features(&self) -> ClosestFeatures {
        match count(&self.barycentric_a) + count(&self.barycentric_b) {
            2 => ClosestFeatures::VertexVertex,
            3 => ClosestFeatures::VertexEdge,
            _ => ClosestFeatures::EdgeEdge,
        }
    }
}

/// How many corners count.
fn count(barycentric: &[f64]) -> usize {
    barycentric.iter().filter(|&&x| x > 0.0).count()
}
