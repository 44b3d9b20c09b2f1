//! Every box against every later one: n (n - 1) / 2 comparisons.

use crate::geometry::Aabb;
use crate::pairs::BodyPair;

pub(super) fn overlapping(boxes: &[Aabb], pairs: &mut Vec<BodyPair>) {
    pairs.clear();
    for (a, box_a) in boxes.iter().enumerate() {
        for (b, box_b) in boxes.iter().enumerate().skip(a + 1) {
            if box_a.overlaps(box_b) {
                pairs.push([a as u32, b as u32]);
            }
        }
    }
}
