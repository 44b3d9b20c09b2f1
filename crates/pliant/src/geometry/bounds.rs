//! Single axis-aligned boxes: exact in the caller's scalar, and in `f32` for pruning.

use super::Real;
use super::real::{OUTWARD, larger, smaller};
use pliant_exact::Length;
use std::array::from_fn;

/// Origin that the boxes of a world are relative to, and padding.
///
/// It follows the bodies of the world. Where the bodies of an `f64` world are far apart compared
/// with their size, boxes are looser: the same answers take more work.
pub(crate) type Origin = [f64; 4];

/// Axis-aligned bounds of points in the caller's coordinates, exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds<S> {
    pub(crate) lo: [S; 3],
    pub(crate) hi: [S; 3],
}

impl<S: Real> Bounds<S> {
    /// Bounds of no point: the neutral element of [`union`](Self::union).
    pub(crate) const EMPTY: Self = Self {
        lo: [S::INFINITY; 3],
        hi: [S::NEG_INFINITY; 3],
    };

    /// Returns the bounds of one point.
    #[inline]
    pub(crate) fn at(point: [S; 3]) -> Self {
        Self {
            lo: point,
            hi: point,
        }
    }

    /// Extends the bounds to a point. A NaN is passed over.
    #[inline]
    pub(crate) fn include(&mut self, point: [S; 3]) {
        for axis in 0..3 {
            self.lo[axis] = smaller(self.lo[axis], point[axis]);
            self.hi[axis] = larger(self.hi[axis], point[axis]);
        }
    }

    /// Returns the smallest bounds that hold both.
    pub(crate) fn union(&self, other: &Self) -> Self {
        Self {
            lo: from_fn(|axis| smaller(self.lo[axis], other.lo[axis])),
            hi: from_fn(|axis| larger(self.hi[axis], other.hi[axis])),
        }
    }

    /// Converts to an `f32` box relative to `origin`: exact for `f32`, rounded outward for `f64`.
    #[inline]
    pub(crate) fn to_box(self, origin: Origin) -> Aabb {
        Aabb {
            lo: from_fn(|axis| self.lo[axis].round_down(origin[axis])),
            hi: from_fn(|axis| self.hi[axis].round_up(origin[axis])),
        }
    }

    /// Whether two bounds overlap: touching counts. Empty bounds overlap nothing.
    #[inline]
    pub(crate) fn overlaps(&self, other: &Self) -> bool {
        (0..3).all(|axis| self.lo[axis] <= other.hi[axis] && other.lo[axis] <= self.hi[axis])
    }

    /// Whether a point lies within the bounds, borders included.
    pub(crate) fn holds(&self, point: [S; 3]) -> bool {
        (0..3).all(|axis| self.lo[axis] <= point[axis] && point[axis] <= self.hi[axis])
    }
}

/// Closed axis-aligned box `lo <= x <= hi` in `f32`.
pub(crate) type Aabb = Bounds<f32>;

impl Aabb {
    /// Whether `other` lies in this box.
    #[cfg(test)]
    pub(crate) fn holds_box(&self, other: &Self) -> bool {
        self.holds(other.lo) && self.holds(other.hi)
    }

    /// Returns the box grown by `distance` on every side, rounded outward.
    pub(crate) fn grown(&self, distance: f32) -> Self {
        // A difference is off by at most a quarter of `outward`, as in `Real::round_down` of `f64`.
        let outward = |x: f32| x.abs() * OUTWARD + f32::MIN_POSITIVE;
        Self {
            lo: self.lo.map(|x| (x - distance) - outward(x - distance)),
            hi: self.hi.map(|x| (x + distance) + outward(x + distance)),
        }
    }
}

impl Bounds<f64> {
    /// Whether two bounds are at most `distance` apart on every axis, decided exactly.
    pub(crate) fn are_within(&self, other: &Self, distance: impl Into<Length>) -> bool {
        pliant_exact::are_boxes_within(&[self.lo, self.hi], &[other.lo, other.hi], distance)
    }
}
