//! Limits of coordinates, and what decisions may assume of the thread that they run in.

use super::Point;
use super::float::power;
use std::hint::black_box;

/// The type that coordinates had before they were widened to `f64`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// `f32`: products of three differences stay far inside `f64`, so that filters are simpler.
    Single,
    /// `f64`; right for `f32` too.
    Double,
}

impl Precision {
    /// The allowance of a sign's filter for results below the normal range: see `RELATIVE_ERROR`.
    /// Zero if there are none; then no coordinate is too small for adaptive expansions either.
    #[inline]
    pub(super) const fn underflow(self) -> f64 {
        match self {
            // The smallest difference of two f32 is 2^-149; the product of three of them is far
            // inside f64.
            Self::Single => 0.0,
            // 2^-1018, sixteen times the smallest normal number.
            Self::Double => power(-1018),
        }
    }
}

/// Whether decisions are exact on a point: its coordinates are finite and at most `f32::MAX` in
/// magnitude. In no unit; three comparisons.
#[inline]
pub fn is_in_range(point: &Point) -> bool {
    point.iter().all(|x| x.abs() <= f64::from(f32::MAX))
}

/// Whether this thread keeps subnormal numbers: neither flushes results to zero nor takes operands
/// for zero. Two operations, which the compiler does not foresee.
pub fn denormals_are_kept() -> bool {
    // Made, and read: the first is lost by flush-to-zero, the second by denormals-are-zero.
    // Computed now, not by the compiler.
    let half = black_box(black_box(f64::MIN_POSITIVE) * 0.5);
    half * 2.0 == f64::MIN_POSITIVE
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thread_that_flushes_is_found_out() {
        assert!(denormals_are_kept());
        assert_ne!(
            pliant_oracle::subnormals_flushed(denormals_are_kept),
            Some(true)
        );
        assert!(denormals_are_kept());
    }
}
