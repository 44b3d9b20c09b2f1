//! Sine and cosine that give the same bits on every machine.
//!
//! The platform's `sin` differs in its last bits between C libraries, and with it every position of
//! a scene. Here a value is made by `+`, `-` and `*` on `f64` alone. IEEE 754 rounds these in
//! exactly one way, and Rust never fuses a product and a sum unasked. With `x = n π + r` and `|r| ≤
//! π/2`, `sin x = (-1)ⁿ sin r`, and `sin r` is its Taylor polynomial up to `r²¹` (the rest is below
//! 2e-18). There is no branch, so a loop over several angles runs in SIMD lanes.
//!
//! - The error is below 1e-15 for angles up to a million; the scenes stay below a hundred.

/// π in three parts: the highest. It and the next have 31 bits: products with `n < 2²²` are exact.
const PI_HIGH: f64 = f64::from_bits(0x4009_21fb_5440_0000);
/// π in three parts: the middle.
const PI_MIDDLE: f64 = f64::from_bits(0x3de0_b461_1a40_0000);
/// π in three parts: the lowest.
const PI_LOW: f64 = f64::from_bits(0x3bf1_3198_a2e0_3707);

/// 1.5 · 2⁵²: adding it rounds to the nearest integer, whose parity is then the lowest bit.
///
/// The sum has no bits for a fraction. (`f64::round` is a function call without SSE 4.1.)
const TO_INTEGER: f64 = 6_755_399_441_055_744.0;

/// Sine of `x` radians.
#[inline]
pub(crate) fn sin(x: f64) -> f64 {
    let shifted = x * std::f64::consts::FRAC_1_PI + TO_INTEGER;
    reduced(x, shifted - TO_INTEGER, shifted)
}

/// Cosine of `x` radians: `sin(x + π/2)` with the quarter turn subtracted exactly.
#[inline]
pub(crate) fn cos(x: f64) -> f64 {
    let shifted = (x * std::f64::consts::FRAC_1_PI + 0.5) + TO_INTEGER;
    reduced(x, (shifted - TO_INTEGER) - 0.5, shifted)
}

/// `sin(x - half_turns · π)`, negated if the integer in `shifted` is odd.
#[inline]
fn reduced(x: f64, half_turns: f64, shifted: f64) -> f64 {
    let r = ((x - half_turns * PI_HIGH) - half_turns * PI_MIDDLE) - half_turns * PI_LOW;
    let sine = r + r * (r * r) * taylor(r * r);
    f64::from_bits(sine.to_bits() ^ (shifted.to_bits() << 63))
}

/// `(sin r - r) / r³` as a polynomial in `z = r²`: the terms ∓zⁱ / (2i + 3)!.
#[inline]
fn taylor(z: f64) -> f64 {
    const INVERSE_FACTORIALS: [f64; 10] = [
        1.0 / 51_090_942_171_709_440_000.0, // 21!
        -1.0 / 121_645_100_408_832_000.0,
        1.0 / 355_687_428_096_000.0,
        -1.0 / 1_307_674_368_000.0,
        1.0 / 6_227_020_800.0,
        -1.0 / 39_916_800.0,
        1.0 / 362_880.0,
        -1.0 / 5_040.0,
        1.0 / 120.0,
        -1.0 / 6.0, // 3!
    ];
    INVERSE_FACTORIALS.iter().fold(0.0, |sum, c| sum * z + c)
}

#[cfg(test)]
mod tests {
    use super::{cos, sin};

    /// Angles over `±range`, dense and never aligned with multiples of π.
    fn angles(range: f64) -> impl Iterator<Item = f64> {
        (-200_000..=200_000).map(move |i| f64::from(i) / 200_000.0 * range)
    }

    #[test]
    fn agrees_with_the_platform() {
        for range in [1e-9, 1.0, 8.0, 100.0, 1e6] {
            for x in angles(range) {
                assert!((sin(x) - x.sin()).abs() < 1e-15, "sin {x}");
                assert!((cos(x) - x.cos()).abs() < 1e-15, "cos {x}");
            }
        }
    }

    #[test]
    fn is_exact_where_it_must_be() {
        let quarter = std::f64::consts::FRAC_PI_2;
        let exact = [(sin(0.0), 0.0), (cos(0.0), 1.0), (sin(quarter), 1.0)];
        for (value, expected) in exact {
            assert_eq!(value.to_bits(), f64::to_bits(expected));
        }
        for x in angles(50.0).filter(|x| *x != 0.0) {
            assert_eq!(sin(-x).to_bits(), (-sin(x)).to_bits(), "odd at {x}");
        }
    }

    #[test]
    fn small_angles_keep_their_relative_precision() {
        for x in angles(1e-3).filter(|x| *x != 0.0) {
            assert!((sin(x) / x.sin() - 1.0).abs() < 1e-15, "sin {x}");
        }
    }
}
