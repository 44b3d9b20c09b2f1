//! The exact extent of points, and the box that holds it. Many boxes side by side are
//! `kernels::BoxLanes`.

use super::Real;
use super::real::{OUTWARD, larger, smaller};
use std::array::from_fn;

/// The point that the boxes of a world are relative to, and padding.
pub(crate) type Origin = [f64; 4];

/// The exact extent of some points, in the caller's coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds<S> {
    pub(crate) lo: [S; 3],
    pub(crate) hi: [S; 3],
}

impl<S: Real> Bounds<S> {
    pub(crate) const EMPTY: Self = Self {
        lo: [S::INFINITY; 3],
        hi: [S::NEG_INFINITY; 3],
    };

    /// A NaN is passed over.
    #[inline]
    pub(crate) fn include(&mut self, point: [S; 3]) {
        for axis in 0..3 {
            self.lo[axis] = smaller(self.lo[axis], point[axis]);
            self.hi[axis] = larger(self.hi[axis], point[axis]);
        }
    }

    /// The bounds of both.
    pub(crate) fn union(&self, other: &Self) -> Self {
        Self {
            lo: from_fn(|axis| smaller(self.lo[axis], other.lo[axis])),
            hi: from_fn(|axis| larger(self.hi[axis], other.hi[axis])),
        }
    }

    /// The box that holds these bounds: exact for `f32`, rounded outward for `f64`.
    #[inline]
    pub(crate) fn to_box(self, origin: Origin) -> Aabb {
        Aabb {
            lo: from_fn(|axis| self.lo[axis].round_down(origin[axis])),
            hi: from_fn(|axis| self.hi[axis].round_up(origin[axis])),
        }
    }

    /// Touching counts; nothing overlaps the bounds of nothing.
    #[inline]
    pub(crate) fn overlaps(&self, other: &Self) -> bool {
        (0..3).all(|axis| self.lo[axis] <= other.hi[axis] && other.lo[axis] <= self.hi[axis])
    }

    pub(crate) fn holds(&self, point: [S; 3]) -> bool {
        (0..3).all(|axis| self.lo[axis] <= point[axis] && point[axis] <= self.hi[axis])
    }
}

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
        // A difference is off by at most a quarter of what is taken away here, as in
        // `Real::round_down` of f64.
        let outward = |x: f32| x.abs() * OUTWARD + f32::MIN_POSITIVE;
        Self {
            lo: self.lo.map(|x| (x - distance) - outward(x - distance)),
            hi: self.hi.map(|x| (x + distance) + outward(x + distance)),
        }
    }
}

impl Bounds<f64> {
    /// Whether both are at most so far apart on every axis: exactly.
    pub(crate) fn are_within(&self, other: &Self, distance: f64) -> bool {
        pliant_exact::are_boxes_within(&[self.lo, self.hi], &[other.lo, other.hi], distance)
    }
}
