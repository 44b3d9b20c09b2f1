//! One axis-aligned box. Many of them side by side are `kernels::BoxLanes`.

use super::Bounds;
use super::real::OUTWARD;

/// A closed box `lo <= x <= hi` in `f32`.
pub(crate) type Aabb = Bounds<f32>;

impl Aabb {
    /// Whether `other` lies in this box.
    #[cfg(test)]
    pub(crate) fn holds_box(&self, other: &Self) -> bool {
        self.holds(other.lo) && self.holds(other.hi)
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
