//! Reference of close triangles: all pairs of triangles at most a distance apart, decided in
//! integers.

use crate::all_pairs::{triangles_that, without};
use crate::error::Error;
use crate::geometry::Bounds;
use crate::world::scalar::Scalar;
use pliant_exact::Triangle;
use pliant_exact::distance::{Primitives, are_within_distance};
use pliant_exact::reference::intersect;

/// Pairs (triangle of a, triangle of b) at most `distance` apart, sorted, as in
/// [`World::close_triangle_pairs`](crate::World::close_triangle_pairs). Cost: O(m_a m_b).
///
/// # Errors
///
/// The errors of [`intersection_pairs`](crate::reference::intersection_pairs).
pub fn close_triangle_pairs<S: Scalar>(
    triangles_a: &[[u32; 3]],
    positions_a: &[[S; 3]],
    triangles_b: &[[u32; 3]],
    positions_b: &[[S; 3]],
    distance: f64,
) -> Result<Vec<[u32; 2]>, Error> {
    let (a, b) = ((triangles_a, positions_a), (triangles_b, positions_b));
    triangles_that(a, Some(b), |a, b| are_close(a, b, distance).then_some(())).map(without)
}

/// Pairs (smaller triangle, larger triangle) of one body that share no vertex and are at most
/// `distance` apart, sorted. Cost: O(m^2).
///
/// # Errors
///
/// The errors of [`intersection_pairs`](crate::reference::intersection_pairs).
pub fn self_close_triangle_pairs<S: Scalar>(
    triangles: &[[u32; 3]],
    positions: &[[S; 3]],
    distance: f64,
) -> Result<Vec<[u32; 2]>, Error> {
    let body = (triangles, positions);
    triangles_that(body, None, |a, b| are_close(a, b, distance).then_some(())).map(without)
}

/// Whether two triangles intersect, or any of their elements are at most `distance` apart.
fn are_close(a: &Triangle, b: &Triangle, distance: f64) -> bool {
    // Whatever is further apart on one axis is further apart.
    let box_of = |corners: &Triangle| {
        let mut bounds = Bounds::EMPTY;
        corners.iter().for_each(|&corner| bounds.include(corner));
        bounds
    };
    box_of(a).are_within(&box_of(b), distance)
        && (intersect(a, b) || {
            let corner = |i: usize, [p, q]: [&Triangle; 2]| {
                Primitives::VertexTriangle([p[i], q[0], q[1], q[2]])
            };
            let edges = |i: usize, j: usize| {
                Primitives::EdgeEdge([a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]])
            };
            (0..3).any(|i| {
                are_within_distance(&corner(i, [a, b]), distance)
                    || are_within_distance(&corner(i, [b, a]), distance)
                    || (0..3).any(|j| are_within_distance(&edges(i, j), distance))
            })
        })
}
