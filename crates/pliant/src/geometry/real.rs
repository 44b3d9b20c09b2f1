//! The two coordinate types, `f32` and `f64`, and all that differs between them.
//!
//! Positions stay in the caller's type, and decisions are exact on them. In between lie boxes,
//! which are always `f32`. A box only *skips* work, so it must hold its triangles; how tightly is a
//! matter of speed. For `f32` a box is exact. For `f64` it is rounded outward, relative to one
//! origin of the world: far from zero an `f32` has no digits left.

use pliant_exact::Precision;
use std::ops::{Add, Mul, Sub};

/// Coordinate scalar, `f32` or `f64`: operations on one number. For registers see
/// `kernels::Coordinate`.
pub(crate) trait Real:
    Copy
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + std::fmt::Debug
    + Default
    + Send
    + Sync
    + 'static
{
    /// Sentinel that no position may be; a buffer is filled with it before the caller writes.
    const NAN: Self;
    const INFINITY: Self;
    const NEG_INFINITY: Self;
    /// Precision of the type, as exact decisions are told it.
    const PRECISION: Precision;
    /// Whether boxes are exact, so that an origin has no use.
    const BOXES_ARE_EXACT: bool;

    /// Relative margin of [`past`](Self::past): this part of the larger end's magnitude.
    const FURTHER: f64;
    /// Absolute margin of [`past`](Self::past), added to the relative one.
    const LEAST: f64;
    /// Smallest positive coordinate with which arithmetic needs no subnormal numbers.
    const NEEDS_NONE: Self;
    const ONE: Self;
    /// Five roundings: half of the spacing of numbers at 1, five times.
    const FIVE_ROUNDINGS: Self;
    /// The smallest positive normal number, times 64.
    const TINY: Self;

    /// Absolute value.
    fn magnitude(self) -> Self;
    /// Converts to `f64`; exact.
    fn to_f64(self) -> f64;
    /// Rounds to the nearest value of this type.
    fn from_f64(x: f64) -> Self;
    /// Whether the value is finite and at most `f32::MAX` in magnitude.
    fn is_in_range(self) -> bool;
    /// Whether a thread that flushes subnormal numbers may lose this coordinate, or its difference
    /// from another.
    fn needs_subnormals(self) -> bool;
    /// Linear interpolation to `to` at `t` from 0 to 1, rounded, never beyond either end.
    ///
    /// It is `self + t (to - self)` in `f64`, each operation rounded, and the result rounded to
    /// this type.
    #[inline]
    fn toward(self, to: Self, t: f64) -> Self {
        Self::from_f64(part_of_way(self.to_f64(), to.to_f64(), t))
    }
    /// Linear interpolation to `to` at `t` from 0 to 1, rounded towards `to` and never beyond.
    ///
    /// At least as far as the interpolation in exact arithmetic. This also holds where subnormal
    /// numbers are flushed, and where they are read as zero.
    #[inline]
    fn past(self, to: Self, t: f64) -> Self {
        let [from, to] = [self, to].map(Self::to_f64);
        let there = part_of_way(from, to, t);
        let further = larger(from.abs(), to.abs()) * Self::FURTHER + Self::LEAST;
        // Rounding is monotonic, so this is not beyond the other end.
        Self::from_f64(if from < to {
            smaller(there + further, to)
        } else if from > to {
            larger(there - further, to)
        } else {
            from
        })
    }
    /// Rounds `self - origin` to an `f32` that is not above it. For `f32` the origin is zero, and
    /// the value is kept.
    fn round_down(self, origin: f64) -> f32;
    /// Rounds `self - origin` to an `f32` that is not below it. For `f32` the origin is zero, and
    /// the value is kept.
    fn round_up(self, origin: f64) -> f32;
}

/// Implements the part of [`Real`] that reads alike for both types.
macro_rules! in_both {
    ($type:ty) => {
        const NAN: Self = <$type>::NAN;
        const INFINITY: Self = <$type>::INFINITY;
        const NEG_INFINITY: Self = <$type>::NEG_INFINITY;
        const ONE: Self = 1.0;
        const FIVE_ROUNDINGS: Self = 5.0 * <$type>::EPSILON / 2.0;
        const TINY: Self = 64.0 * <$type>::MIN_POSITIVE;

        #[inline]
        fn magnitude(self) -> Self {
            self.abs()
        }

        #[inline]
        fn to_f64(self) -> f64 {
            self.into()
        }
        #[inline]
        fn from_f64(x: f64) -> Self {
            x as Self
        }
        #[inline]
        fn is_in_range(self) -> bool {
            self.abs() <= f32::MAX.into()
        }
        fn needs_subnormals(self) -> bool {
            // Bits, because a thread that flushes reads a subnormal number as zero. Zero needs
            // none: its bits less one wrap to the largest number.
            self.abs().to_bits().wrapping_sub(1) < Self::NEEDS_NONE.to_bits() - 1
        }
    };
}

impl Real for f32 {
    in_both!(f32);

    const PRECISION: Precision = Precision::Single;
    const BOXES_ARE_EXACT: bool = true;
    // `past` rounds once to f32, after roundings that are 2^29 times smaller: together less than
    // 2^-23. A result below 2^-126 may be taken for zero.
    const FURTHER: f64 = f64::from_bits((1023 - 22) << 52);
    const LEAST: f64 = f64::from_bits((1023 - 124) << 52);
    const NEEDS_NONE: Self = f32::MIN_POSITIVE;

    #[inline]
    fn round_down(self, _origin: f64) -> f32 {
        self
    }
    #[inline]
    fn round_up(self, _origin: f64) -> f32 {
        self
    }
}

impl Real for f64 {
    in_both!(f64);
    const PRECISION: Precision = Precision::Double;
    const BOXES_ARE_EXACT: bool = false;
    // Let L be the magnitude of the larger end. Four values are rounded: a difference of at most
    // 2 L, a product with it, a sum of at most 3 L, and the result. Each is off by 2^-53 of itself:
    // together less than 2^-49 L. A result below 2^-1022 may be taken for zero.
    const FURTHER: f64 = f64::from_bits((1023 - 49) << 52);
    const LEAST: f64 = f64::from_bits((1023 - 1018) << 52);
    // 2^-969: from there on coordinates, and so their differences, are multiples of 2^-1021.
    const NEEDS_NONE: Self = f64::from_bits((1023 - 969) << 52);

    #[inline]
    fn round_down(self, origin: f64) -> f32 {
        // Two roundings to nearest, to f64 and to f32, are off by less than a quarter of the amount
        // subtracted here. So is the rounding of this subtraction itself. The absolute term makes
        // up for losses below the normal range. A difference beyond f32 becomes the largest f32,
        // which is below it.
        let nearest = smaller((self - origin) as f32, f32::MAX);
        nearest - (nearest.abs() * OUTWARD + f32::MIN_POSITIVE)
    }
    #[inline]
    fn round_up(self, origin: f64) -> f32 {
        let nearest = larger((self - origin) as f32, -f32::MAX);
        nearest + (nearest.abs() * OUTWARD + f32::MIN_POSITIVE)
    }
}

/// Linear interpolation at `t`, clamped to the two ends.
#[inline]
fn part_of_way(from: f64, to: f64, t: f64) -> f64 {
    let there = from + t * (to - from);
    larger(smaller(there, larger(from, to)), smaller(from, to))
}

/// Factor of outward rounding: 2^-22, four times the relative error of rounding to `f32`.
pub(crate) const OUTWARD: f32 = 2.0 * f32::EPSILON;

/// Returns the smaller of two values; `a` if either is NaN.
///
/// One instruction, which `f32::min`, careful on both sides, is not.
#[inline]
pub(crate) fn smaller<T: PartialOrd>(a: T, b: T) -> T {
    if b < a { b } else { a }
}

/// Returns the larger of two values; `a` if either is NaN.
#[inline]
pub(crate) fn larger<T: PartialOrd>(a: T, b: T) -> T {
    if b > a { b } else { a }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::hint::black_box;

    /// Converts to a multiple of 2^-40: all values here are such multiples, below 2^60.
    fn exact(x: f64) -> i128 {
        (x * 2f64.powi(40)) as i128
    }

    #[test]
    fn outward_rounding_holds_the_exact_difference_and_little_more() {
        let values = [
            0.0,
            1.0,
            -1.0,
            0.1f32 as f64,
            1e7 + 2f64.powi(-20),
            -1e7 - 2f64.powi(-21),
            2f64.powi(50) + 1.0,
            3.0 + 2f64.powi(-40),
            16_777_217.0,
        ];
        for x in values {
            for origin in values {
                let true_value = exact(x) - exact(origin);
                let (below, above) = (x.round_down(origin), x.round_up(origin));
                assert!(exact(below as f64) <= true_value, "{x} - {origin}");
                assert!(exact(above as f64) >= true_value, "{x} - {origin}");
                let gap = f64::from(above) - f64::from(below);
                let size = f64::from(below.abs().max(above.abs()));
                assert!(
                    gap <= size * 2f64.powi(-20) + 2f64.powi(-120),
                    "{x} - {origin}: {gap}"
                );
            }
        }
    }

    #[test]
    fn rounding_survives_the_ends_of_the_range() {
        let max = f64::from(f32::MAX);
        assert_eq!(max.round_up(-max), f32::INFINITY);
        assert!((1e38..f32::MAX).contains(&max.round_down(-max)));
        assert_eq!((-max).round_down(max), f32::NEG_INFINITY);
        assert!((1e38..f32::MAX).contains(&-(-max).round_up(max)));
        assert!(1e-300.round_down(0.0) <= 0.0);
        assert!(1e-300.round_up(0.0) > 0.0);
        assert!((-1e-300).round_down(0.0) < 0.0);
    }

    #[test]
    fn past_is_at_least_as_far_as_in_exact_arithmetic_and_never_beyond_the_end() {
        let coordinates = [
            0.0,
            1.0,
            -1.0,
            3.5,
            1023.0,
            -1_000_001.0,
            f64::from(2f32.powi(24) - 1.0),
            -2f64.powi(30),
        ];
        for from in coordinates {
            for to in coordinates {
                for parts in [0_i128, 1, 3, 64, 511, 512, 1023, 1024] {
                    let t = parts as f64 / 1024.0;
                    // Multiples of 2^-50 are multiples of 2^-40 divided by 1024.
                    let place = exact(from) * 1024 + parts * (exact(to) - exact(from));
                    let single = f64::from((from as f32).past(to as f32, t));
                    for (found, further) in [
                        (single, f32::FURTHER),
                        (from.past(to, t), <f64 as Real>::FURTHER),
                    ] {
                        let [low, high] = [from.min(to), from.max(to)];
                        assert!((low..=high).contains(&found), "{from} {to} {t}: {found}");
                        // Rounded down to a multiple of 2^-40, which is allowed for.
                        let more = (exact(found) * 1024 - place) * if from < to { 1 } else { -1 };
                        let most = from.abs().max(to.abs()) * 2.0 * further + 2f64.powi(-39);
                        assert!(more >= -1024, "{from} {to} {t}: {found}");
                        assert!(more <= exact(most) * 1024, "{from} {to} {t}: {found}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_thread_that_flushes_goes_past_too() {
        let smallest = 2f64.powi(-969);
        let ways = [
            (0.0, 1e-37, 0.1),
            (-1e-37, 1.2e-38, 0.9),
            (1e-37, -1e-37, 0.5 + 2f64.powi(-30)),
            (-3e-38, 0.0, 0.7),
        ];
        let doubles = ways.map(|(from, to, t)| (from * smallest * 1e45, to * smallest * 1e45, t));
        let single = |(from, to, t): (f64, f64, f64)| (from as f32).past(to as f32, t);
        let double = |(from, to, t): (f64, f64, f64)| from.past(to, t);
        let places = || {
            let (ways, doubles) = (black_box(ways), black_box(doubles));
            (ways.map(single), doubles.map(double))
        };
        // Compared here, where no operand is taken for zero. A result that is read as zero must be
        // as good.
        let check = |(singles, found): ([f32; 4], [f64; 4])| {
            let read = |place: f64, least: f64| if place.abs() < least { 0.0 } else { place };
            for ((from, to, t), found) in ways.into_iter().zip(singles) {
                let [from, to] = [from, to].map(|it| f64::from(it as f32));
                let place = (1.0 - t) * from + t * to;
                let found = read(found.into(), f32::MIN_POSITIVE.into());
                assert!((found - place) * (to - from) >= 0.0, "{from} {to} {t}");
            }
            for ((from, to, t), found) in doubles.into_iter().zip(found) {
                let place = (1.0 - t) * from + t * to;
                let found = read(found, f64::MIN_POSITIVE);
                // The sign of a product that could be lost.
                let is_past = if from < to {
                    found >= place
                } else {
                    found <= place
                };
                assert!(is_past, "{from:e} {to:e} {t}: {found:e}");
            }
        };
        check(places());
        if let Some(flushed) = pliant_oracle::subnormals_flushed(places) {
            check(flushed);
        }
    }

    #[test]
    fn coordinates_that_need_subnormals_are_known_in_any_thread() {
        let smallest = 2f64.powi(-969);
        let singles = [0.0, -0.0, f32::MIN_POSITIVE, -1.0, 1e-38, -1e-45];
        let doubles = [0.0, -0.0, smallest, -1.0, smallest.next_down(), -5e-324];
        let ask = || {
            let (singles, doubles) = (black_box(singles), black_box(doubles));
            (
                singles.map(f32::needs_subnormals),
                doubles.map(f64::needs_subnormals),
            )
        };
        let expected = [false, false, false, false, true, true];
        assert_eq!(ask(), (expected, expected));
        let flushed = pliant_oracle::subnormals_flushed(ask);
        assert!(flushed.is_none_or(|flushed| flushed == (expected, expected)));
    }

    #[test]
    fn a_thread_that_flushes_rounds_outward() {
        let values = [
            -1e-38,
            -1e-40,
            -1e-45,
            -1e-290,
            0.0,
            1e-290,
            1e-45,
            1e-40,
            1.175_494_3e-38,
            1e-38,
            3e-38,
        ];
        let bounds = || black_box(values).map(|x: f64| [x.round_down(0.0), x.round_up(0.0)]);
        // Compared here, where no operand is taken for zero.
        let check = |bounds: [[f32; 2]; 11]| {
            for (x, [below, above]) in values.into_iter().zip(bounds) {
                assert!(
                    f64::from(below) <= x && x <= f64::from(above),
                    "{below:e} {x:e} {above:e}"
                );
            }
        };
        check(bounds());
        if let Some(flushed) = pliant_oracle::subnormals_flushed(bounds) {
            check(flushed);
        }
    }
}
