//! Brute force: every box against every later one, n (n - 1) / 2 comparisons.

use super::overlap::Overlap;
use crate::geometry::Aabb;
use crate::ids::Rank;

/// Appends the pairs of a body and later bodies whose boxes overlap its own, in order. O(n).
pub(super) fn row(boxes: &[Aabb], body: Rank, pairs: &mut Vec<Overlap>) {
    let its_box = &boxes[body.index()];
    let others = (0..).map(Rank).zip(boxes).skip(body.index() + 1);
    let overlapping = others.filter(|(_, other)| its_box.overlaps(other));
    pairs.extend(overlapping.map(|(other, _)| [body, other]));
}
