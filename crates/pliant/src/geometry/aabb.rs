//! One axis-aligned box. Many of them side by side are `kernels::BoxLanes`.

use super::scalar::{larger, smaller};

/// A closed box `lo <= x <= hi` in `f32`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Aabb {
    pub(crate) lo: [f32; 3],
    pub(crate) hi: [f32; 3],
}

impl Aabb {
    /// Holds nothing and overlaps nothing finite; the neutral element of [`Aabb::merge`].
    pub(crate) const EMPTY: Self = Self {
        lo: [f32::INFINITY; 3],
        hi: [f32::NEG_INFINITY; 3],
    };

    /// Touching counts: the boxes are closed.
    #[inline]
    pub(crate) fn overlaps(&self, other: &Self) -> bool {
        (0..3).all(|axis| self.lo[axis] <= other.hi[axis] && other.lo[axis] <= self.hi[axis])
    }

    /// The smallest box that holds both; an empty lane's NaN, on the right, is passed over.
    #[inline]
    pub(crate) fn merge(&self, other: &Self) -> Self {
        Self {
            lo: std::array::from_fn(|axis| smaller(self.lo[axis], other.lo[axis])),
            hi: std::array::from_fn(|axis| larger(self.hi[axis], other.hi[axis])),
        }
    }

    /// Whether `other` lies in this box.
    pub(crate) fn holds(&self, other: &Self) -> bool {
        (0..3).all(|axis| self.lo[axis] <= other.lo[axis] && other.hi[axis] <= self.hi[axis])
    }
}
