//! Axis-aligned bounding boxes of the older methods.

/// A closed axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Aabb {
    pub(crate) lo: [f32; 3],
    pub(crate) hi: [f32; 3],
}

impl Aabb {
    /// The empty box: merging with it changes nothing.
    pub(crate) const EMPTY: Self = Self {
        lo: [f32::INFINITY; 3],
        hi: [f32::NEG_INFINITY; 3],
    };

    /// Smallest box around points.
    pub(crate) fn of(points: &[[f32; 3]]) -> Self {
        points.iter().fold(Self::EMPTY, |hull, &point| {
            hull.merge(&Self {
                lo: point,
                hi: point,
            })
        })
    }

    /// Smallest box that holds both.
    #[inline]
    pub(crate) fn merge(&self, other: &Self) -> Self {
        Self {
            lo: std::array::from_fn(|axis| self.lo[axis].min(other.lo[axis])),
            hi: std::array::from_fn(|axis| self.hi[axis].max(other.hi[axis])),
        }
    }

    /// Intersection of two boxes. If it is empty, `lo` is above `hi` on some axis.
    #[inline]
    pub(crate) fn overlap(&self, other: &Self) -> Self {
        Self {
            lo: std::array::from_fn(|axis| self.lo[axis].max(other.lo[axis])),
            hi: std::array::from_fn(|axis| self.hi[axis].min(other.hi[axis])),
        }
    }

    /// Whether two boxes overlap; touching counts.
    #[inline]
    pub(crate) fn overlaps(&self, other: &Self) -> bool {
        (0..3).all(|axis| self.lo[axis] <= other.hi[axis] && other.lo[axis] <= self.hi[axis])
    }
}
