//! Doubles: powers of two, and signs that are certain.

/// The largest part of itself by which a rounding to nearest changes a normal number: 2^-53.
pub(super) const U: f64 = power(-53);

/// 2 to a power from -1022 to 1023.
pub(super) const fn power(exponent: i32) -> f64 {
    f64::from_bits((1023 + exponent).unsigned_abs() as u64 * (1 << 52))
}

/// m 2^e, rounded once; zero where it is too small for a normal number and the thread flushes
/// others.
pub(super) fn scaled(m: f64, e: i32) -> f64 {
    match e {
        -1000..=1000 => m * power(e),
        // Two steps: the first is exact.
        ..-1000 => m * power(-1000) * power((e + 1000).max(-1000)),
        _ => m * power(1000) * power((e - 1000).min(1000)),
    }
}

/// The sign of a number that is off by less than an error; 0 where it is not certain.
#[inline]
pub(super) fn sign_beyond(x: f64, error: f64) -> i8 {
    i8::from(x > error) - i8::from(x < -error)
}

/// The sign that all of some numbers have, which are off by less than an error; 0 where it is not
/// certain, or not one.
#[inline]
pub(super) fn common_sign<const N: usize>(all: [f64; N], error: f64) -> i8 {
    i8::from(all.iter().all(|&x| x > error)) - i8::from(all.iter().all(|&x| x < -error))
}
