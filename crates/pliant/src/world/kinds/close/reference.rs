//! Reference of close pairs: all pairs of elements at most a distance apart, decided in integers.

use crate::all_pairs::{Element, ElementPairs, Moving};
use crate::error::Error;
use crate::geometry::{Bounds, Real};
use crate::world::scalar::Scalar;
use pliant_exact::Length;
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

/// Pairs (vertex, triangle) of one body at most `distance` apart, but not in the rest shape,
/// without pairs that labels leave out, sorted.
///
/// Cost: O(n m).
///
/// # Errors
///
/// The errors of [`intersection_pairs`](crate::reference::intersection_pairs).
pub fn self_close_vertex_triangle_pairs<S: Scalar>(
    body: &Moving<S>,
    distance: f64,
) -> Result<Vec<[u32; 2]>, Error> {
    let elements = ElementPairs::VerticesAndTriangles;
    let close = elements.that(body, None, close_in_one(distance))?;
    Ok(elements.that_stay(body, close))
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

/// Pairs (smaller edge, larger edge) of one body at most `distance` apart, but not in the rest
/// shape, without pairs that labels leave out, sorted. Cost: O(m^2).
///
/// # Errors
///
/// The errors of [`intersection_pairs`](crate::reference::intersection_pairs).
pub fn self_close_edge_edge_pairs<S: Scalar>(
    body: &Moving<S>,
    distance: f64,
) -> Result<Vec<[u32; 2]>, Error> {
    let elements = ElementPairs::EdgesAndEdges;
    let close = elements.that(body, None, close_in_one(distance))?;
    Ok(elements.that_stay(body, close))
}

/// Whether two elements of two bodies are at most `distance` and their thickness apart in the
/// present shapes.
fn close<S: Real>(distance: f64) -> impl Fn(Element<S>, Element<S>) -> bool {
    move |a, b| are_close([a.0.positions, b.0.positions], a, b, distance)
}

/// Whether two elements of one body are at most `distance` and their thickness apart in the present
/// shape, and not in the rest shape.
fn close_in_one<S: Real>(distance: f64) -> impl Fn(Element<S>, Element<S>) -> bool {
    move |a, b| {
        let at = |shape| are_close([shape; 2], a, b, distance);
        at(a.0.positions) && !a.0.rest.is_some_and(at)
    }
}

/// Whether two elements are at most `distance` and their thickness apart at these positions.
fn are_close<S: Real>(
    [of_a, of_b]: [&[[S; 3]]; 2],
    (body_a, a): Element<S>,
    (body_b, b): Element<S>,
    distance: f64,
) -> bool {
    let [s, t] = [body_a.thickness_of(a), body_b.thickness_of(b)];
    let distance = Length::sum([distance, s, t]);
    let corner = |at: &[[S; 3]], vertex: u32| at[vertex as usize].map(Real::to_f64);
    let [box_a, box_b] = [(of_a, a), (of_b, b)].map(|(at, vertices)| {
        let mut bounds = Bounds::EMPTY;
        vertices
            .iter()
            .for_each(|&it| bounds.include(corner(at, it)));
        bounds
    });
    // Whatever is further apart on one axis is further apart.
    if !box_a.are_within(&box_b, distance) {
        return false;
    }
    let elements = match (a, b) {
        (&[vertex], &[i, j, k]) => {
            let [i, j, k] = [i, j, k].map(|vertex| corner(of_b, vertex));
            Primitives::VertexTriangle([corner(of_a, vertex), i, j, k])
        }
        (&[i, j], &[k, l]) => {
            let [i, j] = [i, j].map(|vertex| corner(of_a, vertex));
            let [k, l] = [k, l].map(|vertex| corner(of_b, vertex));
            Primitives::EdgeEdge([i, j, k, l])
        }
        _ => return false,
    };
    are_within_distance(&elements, distance)
}
