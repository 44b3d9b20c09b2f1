//! Every box against every later one: n (n - 1) / 2 comparisons.

use super::Overlap;
use crate::geometry::Aabb;
use crate::ids::Place;
use crate::threads::Interrupt;

pub(super) fn overlapping(boxes: &[Aabb], interrupt: &Interrupt, overlaps: &mut Vec<Overlap>) {
    overlaps.clear();
    let places = || (0..).map(Place).zip(boxes);
    for (a, box_a) in places() {
        if interrupt.is_set() {
            return;
        }
        for (b, box_b) in places().skip(a.index() + 1) {
            if box_a.overlaps(box_b) {
                overlaps.push([a, b]);
            }
        }
    }
}
