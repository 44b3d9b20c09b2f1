//! Coordinates as integers, scaled by a common power of two.
//!
//! Every finite `f64` is an integer times a power of two. Division by the smallest of these powers
//! makes all coordinates integers and changes no answer. Small coordinates, and all that is
//! computed from them, fit 128 bits; others are big integers.

use dashu_int::IBig;

/// Exact addition and multiplication. An implementation has room for all results, or grows.
pub(crate) trait Ring: Clone {
    fn minus(&self, other: &Self) -> Self;
    fn plus(&self, other: &Self) -> Self;
    fn times(&self, other: &Self) -> Self;
}

/// An exact number whose sign is known, with which the oracle decides.
pub(crate) trait Exact: Ring {
    fn sign(&self) -> i8;
}

/// A point or a direction.
pub(crate) type Vector<I> = [I; 3];

impl Ring for i128 {
    fn minus(&self, other: &Self) -> Self {
        self - other
    }
    fn plus(&self, other: &Self) -> Self {
        self + other
    }
    fn times(&self, other: &Self) -> Self {
        self * other
    }
}

impl Exact for i128 {
    fn sign(&self) -> i8 {
        self.signum() as i8
    }
}

impl Ring for IBig {
    fn minus(&self, other: &Self) -> Self {
        self - other
    }
    fn plus(&self, other: &Self) -> Self {
        self + other
    }
    fn times(&self, other: &Self) -> Self {
        self * other
    }
}

impl Exact for IBig {
    fn sign(&self) -> i8 {
        i8::from(*self > IBig::ZERO) - i8::from(*self < IBig::ZERO)
    }
}

/// Points with integer coordinates, small or big.
pub(crate) enum Scaled {
    /// Coordinates of at most [`SMALL`] bits.
    Small(Vec<Vector<i128>>),
    Big(Vec<Vector<IBig>>),
}

/// Most bits of a small coordinate.
///
/// Coordinates below 2^40 have differences below 2^41. Products of three are below 2^123, and a
/// determinant is the sum of six.
const SMALL: u32 = 40;

/// Scales points to integers, by one power of two for all coordinates.
pub(crate) fn scale(points: &[[f64; 3]]) -> Scaled {
    let parts: Vec<[(i64, i32); 3]> = points.iter().map(|point| point.map(split)).collect();
    let nonzero = || parts.as_flattened().iter().filter(|part| part.0 != 0);
    let least = nonzero().map(|part| part.1).min().unwrap_or(0);
    let bits = nonzero()
        .map(|&(mantissa, exponent)| mantissa.unsigned_abs().ilog2() + 1 + exponent.abs_diff(least))
        .max();
    let shift = |exponent: i32| exponent.abs_diff(least) as usize;
    if bits.is_none_or(|bits| bits <= SMALL) {
        let whole = |(mantissa, exponent): (i64, i32)| match mantissa {
            0 => 0,
            _ => i128::from(mantissa) << shift(exponent),
        };
        Scaled::Small(parts.iter().map(|point| point.map(whole)).collect())
    } else {
        Scaled::Big(parts.iter().map(|&point| big(point, shift)).collect())
    }
}

fn big(point: [(i64, i32); 3], shift: impl Fn(i32) -> usize) -> Vector<IBig> {
    point.map(|(mantissa, exponent)| match mantissa {
        0 => IBig::ZERO,
        _ => IBig::from(mantissa) << shift(exponent),
    })
}

/// Scales numbers to integers, by one power of two for all.
pub(crate) fn integers(numbers: &[f64]) -> Vec<IBig> {
    let parts: Vec<(i64, i32)> = numbers.iter().map(|&x| split(x)).collect();
    let nonzero = parts.iter().filter(|part| part.0 != 0);
    let least = nonzero.map(|part| part.1).min().unwrap_or(0);
    let whole = |&(mantissa, exponent): &(i64, i32)| match mantissa {
        0 => IBig::ZERO,
        _ => IBig::from(mantissa) << exponent.abs_diff(least) as usize,
    };
    parts.iter().map(whole).collect()
}

/// Splits `x` into an odd integer, or zero, and the exponent of a power of two.
fn split(x: f64) -> (i64, i32) {
    assert!(x.is_finite(), "{x} is no coordinate");
    let bits = x.to_bits();
    let (fraction, biased) = ((bits & ((1 << 52) - 1)) as i64, (bits >> 52 & 0x7ff) as i32);
    // The smallest normal numbers and the subnormals are multiples of the same power.
    let (mantissa, exponent) = match biased {
        0 => (fraction, -1074),
        _ => (fraction | 1 << 52, biased - 1075),
    };
    if mantissa == 0 {
        return (0, 0);
    }
    let zeros = mantissa.trailing_zeros();
    let odd = mantissa >> zeros;
    (if x < 0.0 { -odd } else { odd }, exponent + zeros as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_their_parts() {
        let max = f64::from(f32::MAX);
        for x in [
            0.0,
            -0.0,
            1.0,
            -1.0,
            0.1,
            -1e30,
            1e-30,
            max,
            f64::MAX,
            5e-324,
            -1e-310,
            f64::MIN_POSITIVE,
        ] {
            let (odd, exponent) = split(x);
            // In two halves, since powi rounds on the way to 2^-1074.
            let half = exponent / 2;
            assert_eq!(odd as f64 * 2f64.powi(half) * 2f64.powi(exponent - half), x);
            assert!(odd % 2 != 0 || x == 0.0);
        }
    }

    #[test]
    fn small_and_big_integers_are_chosen_by_what_they_must_hold() {
        let small = |x: f64| matches!(scale(&[[1.0, 0.0, x]]), Scaled::Small(_));
        assert!(small(2f64.powi(39)) && !small(2f64.powi(40)));
        assert!(small(2f64.powi(-39)) && !small(2f64.powi(-40)));
        assert!(matches!(scale(&[[5e-324, 0.0, 1e-322]]), Scaled::Small(_)));
        let Scaled::Big(points) = scale(&[[5e-324, 1.0, -0.0]]) else {
            panic!("1074 bits are not small")
        };
        assert_eq!(
            points[0],
            [IBig::from(1), IBig::from(1) << 1074, IBig::ZERO]
        );
    }
}
