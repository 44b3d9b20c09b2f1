//! Reference of intersections: all pairs of triangles, by exact signs.

use crate::all_pairs::{triangles_that, without};
use crate::error::Error;
use crate::world::scalar::Scalar;
use pliant_exact::reference::intersect;

/// Pairs (triangle of a, triangle of b) that intersect, sorted. Cost: O(m_a m_b).
///
/// # Errors
///
/// [`VertexOutOfRange`](crate::ErrorKind::VertexOutOfRange),
/// [`BadPosition`](crate::ErrorKind::BadPosition) and the other errors of
/// [`World::add`](crate::World::add).
pub fn intersection_pairs<S: Scalar>(
    triangles_a: &[[u32; 3]],
    positions_a: &[[S; 3]],
    triangles_b: &[[u32; 3]],
    positions_b: &[[S; 3]],
) -> Result<Vec<[u32; 2]>, Error> {
    let (a, b) = ((triangles_a, positions_a), (triangles_b, positions_b));
    triangles_that(a, Some(b), |a, b| intersect(a, b).then_some(())).map(without)
}

/// Pairs (smaller triangle, larger triangle) of one body that intersect and share no vertex,
/// sorted. Cost: O(m^2).
///
/// # Errors
///
/// The errors of [`intersection_pairs`].
pub fn self_intersection_pairs<S: Scalar>(
    triangles: &[[u32; 3]],
    positions: &[[S; 3]],
) -> Result<Vec<[u32; 2]>, Error> {
    let body = (triangles, positions);
    triangles_that(body, None, |a, b| intersect(a, b).then_some(())).map(without)
}
