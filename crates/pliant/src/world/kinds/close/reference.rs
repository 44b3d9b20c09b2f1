//! Reference of close pairs: all pairs of elements at most a distance apart, decided in integers.

use crate::all_pairs::{Element, ElementPairs, Moving};
use crate::error::Error;
use crate::geometry::Real;
use crate::world::scalar::Scalar;
use pliant_exact::distance::{Primitives, are_within_distance};

/// Pairs (vertex of a, triangle of b) at most `distance` apart, sorted, as in
/// [`World::close_vertex_triangle_pairs`](crate::World::close_vertex_triangle_pairs).
///
/// Motions do not count. Cost: O(n_a m_b).
///
/// # Errors
///
/// The errors of [`intersection_pairs`](crate::reference::intersection_pairs).
pub fn close_vertex_triangle_pairs<S: Scalar>(
    a: &Moving<S>,
    b: &Moving<S>,
    distance: f64,
) -> Result<Vec<[u32; 2]>, Error> {
    ElementPairs::VerticesAndTriangles.that(a, Some(b), close(distance))
}

/// Pairs (vertex, triangle) of one body at most `distance` apart, sorted. Cost: O(n m).
///
/// # Errors
///
/// The errors of [`intersection_pairs`](crate::reference::intersection_pairs).
pub fn self_close_vertex_triangle_pairs<S: Scalar>(
    body: &Moving<S>,
    distance: f64,
) -> Result<Vec<[u32; 2]>, Error> {
    ElementPairs::VerticesAndTriangles.that(body, None, close(distance))
}

/// Pairs (edge of a, edge of b) at most `distance` apart, sorted, as in
/// [`World::close_edge_edge_pairs`](crate::World::close_edge_edge_pairs). Cost: O(m_a m_b).
///
/// # Errors
///
/// The errors of [`intersection_pairs`](crate::reference::intersection_pairs).
pub fn close_edge_edge_pairs<S: Scalar>(
    a: &Moving<S>,
    b: &Moving<S>,
    distance: f64,
) -> Result<Vec<[u32; 2]>, Error> {
    ElementPairs::EdgesAndEdges.that(a, Some(b), close(distance))
}

/// Pairs (smaller edge, larger edge) of one body at most `distance` apart, sorted. Cost: O(m^2).
///
/// # Errors
///
/// The errors of [`intersection_pairs`](crate::reference::intersection_pairs).
pub fn self_close_edge_edge_pairs<S: Scalar>(
    body: &Moving<S>,
    distance: f64,
) -> Result<Vec<[u32; 2]>, Error> {
    ElementPairs::EdgesAndEdges.that(body, None, close(distance))
}

/// Whether two elements are at most `distance` apart in the present shape.
fn close<S: Real>(distance: f64) -> impl Fn(Element<S>, Element<S>) -> bool {
    move |(a, of_a), (b, of_b)| {
        // Whatever is further apart on one axis is further apart.
        if !a.box_now(of_a).are_within(&b.box_now(of_b), distance) {
            return false;
        }
        let corner =
            |body: &Moving<S>, vertex: u32| body.positions[vertex as usize].map(Real::to_f64);
        let elements = match (of_a, of_b) {
            (&[vertex], &[i, j, k]) => {
                let [i, j, k] = [i, j, k].map(|vertex| corner(b, vertex));
                Primitives::VertexTriangle([corner(a, vertex), i, j, k])
            }
            (&[i, j], &[k, l]) => {
                Primitives::EdgeEdge([corner(a, i), corner(a, j), corner(b, k), corner(b, l)])
            }
            _ => return false,
        };
        are_within_distance(&elements, distance)
    }
}
