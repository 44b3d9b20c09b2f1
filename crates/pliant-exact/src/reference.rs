//! Decisions on triangles by exact arithmetic alone: slow, without a filter, to compare with.
//!
//! They are the ones of the crate's root with another source of signs (`orientation::Exact`).

use super::orientation::Exact;
use super::{ContactKind, Triangle};

/// Whether two closed triangles have a point in common, in exact arithmetic. Some microseconds.
pub fn intersect(a: &Triangle, b: &Triangle) -> bool {
    super::triangles::triangles_intersect(a, b, &mut Exact)
}

/// How two triangles that are known to intersect do so, in exact arithmetic. Some microseconds.
pub fn contact_kind(a: &Triangle, b: &Triangle) -> ContactKind {
    super::contact_kind::contact_kind(a, b, &mut Exact)
}

/// How two triangles of one mesh meet beyond the corners that they have in common, if they do, in
/// exact arithmetic. Some microseconds.
pub fn adjacent_contact(numbers: [[u32; 3]; 2], a: &Triangle, b: &Triangle) -> Option<ContactKind> {
    super::adjacent::beyond_common(numbers, [a, b], &mut Exact)
}
