//! Reference of crossing edges: every edge against every triangle, by exact signs.

use crate::all_pairs::{Mesh, edges_and_triangles};
use crate::error::Error;
use crate::queries::ContactKind;
use crate::world::scalar::Scalar;
use pliant_exact::reference::{contact_kind, intersect};

/// Pairs (edge of a, triangle of b) of which the edge crosses the triangle, sorted. Edges are
/// numbered as [`edges`](crate::reference::edges) does. For a body with itself, give it twice.
///
/// Cost: O(e_a m_b) for e_a edges.
///
/// # Errors
///
/// The errors of [`intersection_pairs`](crate::reference::intersection_pairs).
pub fn crossing_edges<S: Scalar>(
    triangles_a: &[[u32; 3]],
    positions_a: &[[S; 3]],
    triangles_b: &[[u32; 3]],
    positions_b: &[[S; 3]],
) -> Result<Vec<[u32; 2]>, Error> {
    let (a, b): (Mesh<S>, Mesh<S>) = ((triangles_a, positions_a), (triangles_b, positions_b));
    // An edge is a triangle without area.
    edges_and_triangles(a, b, |&[p, q], triangle| {
        let edge = [p, q, q];
        intersect(&edge, triangle) && contact_kind(&edge, triangle) == ContactKind::Crossing
    })
}
