//! Reference of adjacent contacts: all pairs of triangles with a vertex in common, by exact signs.

use crate::all_pairs::adjacent_triangles;
use crate::error::Error;
use crate::queries::ContactKind;
use crate::world::scalar::Scalar;
use pliant_exact::reference::adjacent_contact;

/// Pairs (smaller triangle, larger triangle) of one body that share a vertex and meet beyond what
/// they share, with their kinds, sorted by pair. Cost: O(m^2).
///
/// # Errors
///
/// The errors of [`intersection_pairs`](crate::reference::intersection_pairs).
pub fn adjacent_contacts<S: Scalar>(
    triangles: &[[u32; 3]],
    positions: &[[S; 3]],
) -> Result<Vec<([u32; 2], ContactKind)>, Error> {
    adjacent_triangles((triangles, positions), adjacent_contact)
}
