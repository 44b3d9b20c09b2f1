//! Boxes of directions: from a vertex into a triangle, for sweep and prune over a large star.
//!
//! Idea: two triangles at a vertex meet beyond it only along a ray from it that is in both. So the
//! arcs of their directions on the unit sphere meet, and the boxes of these.

use std::cmp::Ordering;

/// More than all roundings of a direction.
const ROUNDED: f64 = 1e-12;

/// Box round the directions from a vertex into a triangle.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sector {
    /// Place of the triangle in the star.
    pub(super) place: usize,
    lo: [f64; 3],
    hi: [f64; 3],
}

impl Sector {
    /// From the edges at the vertex. Where an edge has no direction, the box has all.
    ///
    /// A point of the arc is off the chord c between its ends by at most `1 - sqrt(1 - c^2 / 4)`,
    /// which is at most `c^2 / 4`.
    pub(super) fn new(place: usize, edges: [[f64; 3]; 2]) -> Self {
        let [p, q] = edges.map(|edge| {
            // The largest component first, so that no square overflows or vanishes.
            let largest = edge.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            let edge = edge.map(|x| x / largest);
            let length = edge.iter().map(|x| x * x).sum::<f64>().sqrt();
            edge.map(|x| x / length)
        });
        let chord: f64 = p.iter().zip(&q).map(|(p, q)| (p - q) * (p - q)).sum();
        let by = chord / 4.0 + ROUNDED;
        let (mut lo, mut hi) = ([-2.0; 3], [2.0; 3]);
        if by.is_finite() {
            for axis in 0..3 {
                lo[axis] = p[axis].min(q[axis]) - by;
                hi[axis] = p[axis].max(q[axis]) + by;
            }
        }
        Self { place, lo, hi }
    }

    /// Order of the sweep, along the first axis.
    pub(super) fn by_beginning(&self, other: &Self) -> Ordering {
        let by_place = self.place.cmp(&other.place);
        self.lo[0].total_cmp(&other.lo[0]).then(by_place)
    }

    /// Whether a later box in the order of the sweep begins before this one ends.
    pub(super) fn reaches(&self, later: &Self) -> bool {
        later.lo[0] <= self.hi[0]
    }

    pub(super) fn overlaps(&self, other: &Self) -> bool {
        (0..3).all(|axis| self.lo[axis] <= other.hi[axis] && other.lo[axis] <= self.hi[axis])
    }
}
