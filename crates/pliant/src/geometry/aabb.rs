//! One axis-aligned box. Many of them side by side are `kernels::BoxLanes`.

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
    pub(crate) fn holds(&self, other: &Self) -> bool {
        (0..3).all(|axis| self.lo[axis] <= other.lo[axis] && other.hi[axis] <= self.hi[axis])
    }
}
