//! Reference of candidates: all pairs of elements whose boxes are within a margin.

use crate::all_pairs::{Element, ElementPairs, Moving};
use crate::error::Error;
use crate::geometry::Real;
use crate::world::scalar::Scalar;
use pliant_exact::Length;

/// Candidates (vertex of a, triangle of b), sorted, as in
/// [`World::vertex_triangle_candidates`](crate::World::vertex_triangle_candidates). Cost: O(n_a
/// m_b).
///
/// # Errors
///
/// The errors of [`intersection_pairs`](crate::reference::intersection_pairs).
pub fn vertex_triangle_pairs<S: Scalar>(
    a: &Moving<S>,
    b: &Moving<S>,
    radius: f64,
) -> Result<Vec<[u32; 2]>, Error> {
    ElementPairs::VerticesAndTriangles.that(a, Some(b), near(radius))
}

/// Candidates (vertex, triangle) of one body with itself, sorted. Cost: O(n m).
///
/// # Errors
///
/// The errors of [`intersection_pairs`](crate::reference::intersection_pairs).
pub fn self_vertex_triangle_pairs<S: Scalar>(
    body: &Moving<S>,
    radius: f64,
) -> Result<Vec<[u32; 2]>, Error> {
    ElementPairs::VerticesAndTriangles.that(body, None, near(radius))
}

/// Candidates (edge of a, edge of b), sorted, as in
/// [`World::edge_edge_candidates`](crate::World::edge_edge_candidates). Cost: O(m_a m_b).
///
/// # Errors
///
/// The errors of [`intersection_pairs`](crate::reference::intersection_pairs).
pub fn edge_edge_pairs<S: Scalar>(
    a: &Moving<S>,
    b: &Moving<S>,
    radius: f64,
) -> Result<Vec<[u32; 2]>, Error> {
    ElementPairs::EdgesAndEdges.that(a, Some(b), near(radius))
}

/// Candidates (smaller edge, larger edge) of one body with itself, sorted. Cost: O(m^2).
///
/// # Errors
///
/// The errors of [`intersection_pairs`](crate::reference::intersection_pairs).
pub fn self_edge_edge_pairs<S: Scalar>(
    body: &Moving<S>,
    radius: f64,
) -> Result<Vec<[u32; 2]>, Error> {
    ElementPairs::EdgesAndEdges.that(body, None, near(radius))
}

/// Whether the boxes of two elements, over both ends of their motions, are within twice `radius`
/// and their thickness.
fn near<S: Real>(radius: f64) -> impl Fn(Element<S>, Element<S>) -> bool {
    move |(a, of_a), (b, of_b)| {
        let [s, t] = [a.thickness_of(of_a), b.thickness_of(of_b)];
        let gap = Length::sum([2.0 * radius, s, t]);
        a.box_of(of_a).are_within(&b.box_of(of_b), gap)
    }
}
