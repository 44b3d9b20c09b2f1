//! Grids of times: the numbers that are told of a time that has no number of its own.
//!
//! A cell is two neighbours of a grid. Spacings are powers of two, so that quotients and products
//! by them are exact.

/// The numbers that are told of times: multiples of a power of two up to 1, or all.
///
/// Times are parts of the motion, so the spacing is one too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// The power of two; 0 for all numbers.
    pub(super) spacing: f64,
}

impl Grid {
    /// The coarsest grid with cells no wider than `width`, which is at least 0; for 0 all numbers.
    pub fn new(width: f64) -> Self {
        Self {
            spacing: if width < 1.0 {
                // The power of two alone; of subnormal numbers none.
                f64::from_bits(width.max(0.0).to_bits() & 0x7ff << 52)
            } else {
                1.0
            },
        }
    }

    /// The cell or cells that a part of the step is in.
    pub(super) fn cell_of(self, low: f64, high: f64) -> [f64; 2] {
        [self.down(low), self.up(high)]
    }

    /// Whether there is no other number of the grid between these two of it.
    pub(super) fn is_cell(self, [low, high]: [f64; 2]) -> bool {
        if self.spacing == 0.0 {
            high <= low.next_up()
        } else {
            high - low <= self.spacing
        }
    }

    /// The largest of them that is at most `t`, from 0 to 1.
    pub(super) fn down(self, t: f64) -> f64 {
        self.next_to(t, f64::floor)
    }

    /// The least of them that is at least `t`.
    pub(super) fn up(self, t: f64) -> f64 {
        self.next_to(t, f64::ceil)
    }

    #[inline]
    fn next_to(self, t: f64, whole: impl Fn(f64) -> f64) -> f64 {
        if self.spacing == 0.0 {
            return t;
        }
        // A quotient by a power of two is exact, and so is its product.
        whole(t / self.spacing) * self.spacing
    }
}
