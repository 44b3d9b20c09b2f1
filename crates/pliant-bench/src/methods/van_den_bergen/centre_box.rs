//! Box as centre and half extent in single precision, as the method keeps it.
//!
//! Making a box from a triangle or from boxes rounds to nearest, so it can miss a corner by a
//! rounding error. `relation` bounds that error and makes up for it.

/// Points whose distance from `centre` is at most `half` on every axis.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub(super) struct CentreBox {
    pub(super) centre: [f32; 3],
    pub(super) half: [f32; 3],
}

impl CentreBox {
    pub(super) const ORIGIN: Self = Self {
        centre: [0.0; 3],
        half: [0.0; 3],
    };

    #[inline]
    fn between(lo: [f32; 3], hi: [f32; 3]) -> Self {
        // Halved first: the sum of the largest numbers would overflow.
        let centre = std::array::from_fn(|axis| 0.5 * lo[axis] + 0.5 * hi[axis]);
        Self {
            centre,
            half: std::array::from_fn(|axis| {
                larger(hi[axis] - centre[axis], centre[axis] - lo[axis])
            }),
        }
    }

    #[inline]
    pub(super) fn of_triangle([a, b, c]: [[f32; 3]; 3]) -> Self {
        Self::between(
            std::array::from_fn(|axis| smaller(smaller(a[axis], b[axis]), c[axis])),
            std::array::from_fn(|axis| larger(larger(a[axis], b[axis]), c[axis])),
        )
    }

    /// Box around at least one box.
    #[inline]
    pub(super) fn hull<'a>(boxes: impl Iterator<Item = &'a Self>) -> Self {
        let (mut lo, mut hi) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for next in boxes {
            for axis in 0..3 {
                lo[axis] = smaller(lo[axis], next.centre[axis] - next.half[axis]);
                hi[axis] = larger(hi[axis], next.centre[axis] + next.half[axis]);
            }
        }
        Self::between(lo, hi)
    }

    /// Largest half extent, which decides which of two nodes is opened.
    #[inline]
    pub(super) fn size(&self) -> f32 {
        larger(larger(self.half[0], self.half[1]), self.half[2])
    }

    /// Largest distance from the origin, over all axes.
    pub(super) fn reach(&self) -> f32 {
        (0..3).fold(0.0, |reach, axis| {
            larger(reach, self.centre[axis].abs() + self.half[axis])
        })
    }

    /// The box, larger by `by` on every side.
    #[inline]
    pub(super) fn enlarged(&self, by: f32) -> Self {
        Self {
            centre: self.centre,
            half: self.half.map(|half| half + by),
        }
    }
}

// One instruction each; `f32::min` and `max` spend two more on NaN.

#[inline]
fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline]
fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}
