//! Every two elements whose boxes are within a margin of each other.

use crate::all_pairs::{ElementPairs, Moving, Part};
use crate::error::Error;
use crate::geometry::Real;
use crate::world::scalar::Scalar;

/// The candidates (vertex of a, triangle of b), sorted, as
/// [`World::vertex_triangle_candidates`](crate::World::vertex_triangle_candidates) means them.
///
/// # Errors
///
/// Those of [`intersection_pairs`](crate::reference::intersection_pairs).
pub fn vertex_triangle_pairs<S: Scalar>(
    a: &Moving<S>,
    b: &Moving<S>,
    radius: f64,
) -> Result<Vec<[u32; 2]>, Error> {
    ElementPairs::VerticesAndTriangles.that(a, Some(b), near(radius))
}

/// The candidates (vertex, triangle) of one body with itself, sorted.
///
/// # Errors
///
/// Those of [`intersection_pairs`](crate::reference::intersection_pairs).
pub fn self_vertex_triangle_pairs<S: Scalar>(
    body: &Moving<S>,
    radius: f64,
) -> Result<Vec<[u32; 2]>, Error> {
    ElementPairs::VerticesAndTriangles.that(body, None, near(radius))
}

/// The candidates (edge of a, edge of b), sorted, as [`World::edge_edge_candidates`](crate::World::edge_edge_candidates) means them.
///
/// # Errors
///
/// Those of [`intersection_pairs`](crate::reference::intersection_pairs).
pub fn edge_edge_pairs<S: Scalar>(
    a: &Moving<S>,
    b: &Moving<S>,
    radius: f64,
) -> Result<Vec<[u32; 2]>, Error> {
    ElementPairs::EdgesAndEdges.that(a, Some(b), near(radius))
}

/// The candidates (smaller edge, larger edge) of one body with itself, sorted.
///
/// # Errors
///
/// Those of [`intersection_pairs`](crate::reference::intersection_pairs).
pub fn self_edge_edge_pairs<S: Scalar>(
    body: &Moving<S>,
    radius: f64,
) -> Result<Vec<[u32; 2]>, Error> {
    ElementPairs::EdgesAndEdges.that(body, None, near(radius))
}

/// Whether the boxes of two elements are near each other, at both ends of their motions.
fn near<S: Real>(radius: f64) -> impl Fn(Part<S>, Part<S>) -> bool {
    move |(a, of_a), (b, of_b)| a.box_of(of_a).are_within(&b.box_of(of_b), 2.0 * radius)
}
