//! One axis-aligned box. Many of them side by side are `kernels::BoxLanes`.

use super::real::{OUTWARD, larger, smaller};

/// A closed box `lo <= x <= hi` in `f32`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Aabb {
    pub(crate) lo: [f32; 3],
    pub(crate) hi: [f32; 3],
}

impl Aabb {
    /// Touching counts: the boxes are closed.
    #[inline]
    pub(crate) fn overlaps(&self, other: &Self) -> bool {
        (0..3).all(|axis| self.lo[axis] <= other.hi[axis] && other.lo[axis] <= self.hi[axis])
    }

    /// Whether `other` lies in this box.
    #[cfg(test)]
    pub(crate) fn holds(&self, other: &Self) -> bool {
        (0..3).all(|axis| self.lo[axis] <= other.lo[axis] && other.hi[axis] <= self.hi[axis])
    }

    /// The smallest box that holds both.
    pub(crate) fn union(&self, other: &Self) -> Self {
        Self {
            lo: std::array::from_fn(|axis| smaller(self.lo[axis], other.lo[axis])),
            hi: std::array::from_fn(|axis| larger(self.hi[axis], other.hi[axis])),
        }
    }

    /// This box grown by a distance on every side, rounded outward.
    pub(crate) fn grown(&self, distance: f32) -> Self {
        // A difference is off by at most a quarter of what is taken away here, as in `Real::round_down` of f64.
        let outward = |x: f32| x.abs() * OUTWARD + f32::MIN_POSITIVE;
        Self {
            lo: self.lo.map(|x| (x - distance) - outward(x - distance)),
            hi: self.hi.map(|x| (x + distance) + outward(x + distance)),
        }
    }
}
