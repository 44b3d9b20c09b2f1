//! The same decisions on triangles by exact arithmetic at once: slow, without a filter, to compare with.

use super::orientation::Exact;
use super::{ContactKind, Triangle};

/// Whether two closed triangles have a point in common.
pub fn intersect(a: &Triangle, b: &Triangle) -> bool {
    super::triangles::triangles_intersect(a, b, &mut Exact)
}

/// How two triangles that are known to intersect do so.
pub fn contact_kind(a: &Triangle, b: &Triangle) -> ContactKind {
    super::contact_kind::contact_kind(a, b, &mut Exact)
}
