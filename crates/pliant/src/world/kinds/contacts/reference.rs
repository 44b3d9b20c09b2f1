//! Reference of contacts: all pairs of triangles and their kinds, by exact signs.

use crate::all_pairs::triangles_that;
use crate::error::Error;
use crate::queries::ContactKind;
use crate::world::scalar::Scalar;
use pliant_exact::Triangle;
use pliant_exact::reference::{contact_kind, intersect};

/// Pairs (triangle of a, triangle of b) that intersect, with their kinds, sorted by pair. Cost:
/// O(m_a m_b).
///
/// # Errors
///
/// The errors of [`intersection_pairs`](crate::reference::intersection_pairs).
pub fn contacts<S: Scalar>(
    triangles_a: &[[u32; 3]],
    positions_a: &[[S; 3]],
    triangles_b: &[[u32; 3]],
    positions_b: &[[S; 3]],
) -> Result<Vec<([u32; 2], ContactKind)>, Error> {
    let (a, b) = ((triangles_a, positions_a), (triangles_b, positions_b));
    triangles_that(a, Some(b), kind_of_contact)
}

/// Pairs (smaller triangle, larger triangle) of one body that intersect and share no vertex, with
/// their kinds, sorted by pair. Cost: O(m^2).
///
/// # Errors
///
/// The errors of [`intersection_pairs`](crate::reference::intersection_pairs).
pub fn self_contacts<S: Scalar>(
    triangles: &[[u32; 3]],
    positions: &[[S; 3]],
) -> Result<Vec<([u32; 2], ContactKind)>, Error> {
    triangles_that((triangles, positions), None, kind_of_contact)
}

fn kind_of_contact(a: &Triangle, b: &Triangle) -> Option<ContactKind> {
    intersect(a, b).then(|| contact_kind(a, b))
}
