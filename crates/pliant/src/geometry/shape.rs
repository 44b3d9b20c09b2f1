//! The shape a body has now, and the boxes of its parts.

use super::scalar::{larger, smaller};
use super::{Aabb, Points, Scalar};

/// The current shape of a body, as everything that makes boxes sees it.
#[derive(Clone, Copy)]
pub(crate) struct Shape<'a, S> {
    /// Positions in tree order.
    pub(crate) positions: &'a Points<S>,
    /// The corners of each triangle, both in tree order.
    pub(crate) triangles: &'a [[u32; 3]],
    /// Boxes are relative to this point (zero for `f32`).
    pub(crate) origin: Origin,
    /// Counts the changes of shape; a box made in another epoch is not true.
    pub(crate) epoch: u64,
}

/// The point that the boxes of a world are relative to, and one number that means nothing.
pub(crate) type Origin = [f64; 4];

/// The exact extent of some points, in the caller's coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds<S> {
    pub(crate) lo: [S; 3],
    pub(crate) hi: [S; 3],
}

impl<S: Scalar> Bounds<S> {
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

    /// The box that holds these bounds: exact for `f32`, rounded outward for `f64`.
    #[inline]
    pub(crate) fn to_box(self, origin: Origin) -> Aabb {
        Aabb {
            lo: std::array::from_fn(|axis| self.lo[axis].round_down(origin[axis])),
            hi: std::array::from_fn(|axis| self.hi[axis].round_up(origin[axis])),
        }
    }

    pub(crate) fn holds(&self, point: [S; 3]) -> bool {
        (0..3).all(|axis| self.lo[axis] <= point[axis] && point[axis] <= self.hi[axis])
    }
}

impl<S: Scalar> Shape<'_, S> {
    /// The box of one triangle: what the kernels must give.
    pub(crate) fn box_of(&self, triangle: u32) -> Aabb {
        let mut bounds = Bounds::EMPTY;
        for vertex in self.triangles[triangle as usize] {
            bounds.include(self.positions.get(vertex));
        }
        bounds.to_box(self.origin)
    }

    /// Three corners of a triangle as the exact decision wants them; exact.
    #[inline]
    pub(crate) fn corners(&self, triangle: u32) -> [[f64; 3]; 3] {
        self.triangles[triangle as usize].map(|vertex| self.positions.get(vertex).map(S::to_f64))
    }
}
