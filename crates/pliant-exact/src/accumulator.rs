//! The sign of a determinant of any finite coordinates, in integers.
//!
//! Every finite `f64` is an integer of 53 bits times a power of two that is at least 2^-1074. Multiplied out, the determinant of
//! (b - a, c - a, d - a) is a sum of twenty-four products of three coordinates, each an integer of 159 bits times a power of two
//! that is at least 2^-3222. The positive and the negative products are added up in two integers with a place for every bit that
//! such a product can have (Kulisch's accumulator, 1971), and these are compared. Nothing is rounded and nothing allocated.
//!
//! Only bits are read, never a floating-point number: the sign does not depend on the rounding mode, or on whether the thread
//! keeps subnormal numbers.

use super::point::{Point, Sign};
use std::cmp::Ordering;

/// The side of the plane through a, b, c on which d lies, as `Orientation` has it.
#[cold]
pub(super) fn orientation(a: &Point, b: &Point, c: &Point, d: &Point) -> Sign {
    let [a, b, c, d] = [a, b, c, d].map(|point| point.map(Number::new));
    let mut sums = Sums::ZERO;
    for (negative, [p, q, r]) in [
        (false, [b, c, d]),
        (true, [a, c, d]),
        (false, [a, b, d]),
        (true, [a, b, c]),
    ] {
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            sums.add(negative, [p[i], q[j], r[k]]);
            sums.add(!negative, [p[i], q[k], r[j]]);
        }
    }
    sums.sign()
}

/// The side of the line through a, b on which c lies.
#[cold]
pub(super) fn orientation_2d(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> Sign {
    let [a, b, c] = [a, b, c].map(|point| point.map(Number::new));
    let one = Number::new(1.0);
    let mut sums = Sums::ZERO;
    for [p, q] in [[a, b], [b, c], [c, a]] {
        sums.add(false, [p[0], q[1], one]);
        sums.add(true, [p[1], q[0], one]);
    }
    sums.sign()
}

/// An integer times a power of two, which is counted from 2^-1074.
#[derive(Clone, Copy)]
struct Number {
    negative: bool,
    integer: u64,
    exponent: usize,
}

impl Number {
    fn new(x: f64) -> Self {
        let bits = x.to_bits();
        let (fraction, exponent) = (bits & ((1 << 52) - 1), (bits >> 52 & 0x7ff) as usize);
        // Subnormal numbers are multiples of the same power of two as the smallest normal ones.
        Self {
            negative: x.is_sign_negative(),
            integer: if exponent == 0 {
                fraction
            } else {
                fraction | 1 << 52
            },
            exponent: exponent.saturating_sub(1),
        }
    }
}

/// Bits of the sums: products of three numbers below 2^1024 in units of 2^-3222, and five for twenty-four of them.
const BITS: usize = 3 * 1024 + 3 * 1074 + 5;
const LIMBS: usize = BITS.div_ceil(64);

/// Two sums of products in units of 2^-3222, least limb first.
struct Sums {
    positive: [u64; LIMBS],
    negative: [u64; LIMBS],
}

impl Sums {
    const ZERO: Self = Self {
        positive: [0; LIMBS],
        negative: [0; LIMBS],
    };

    /// Adds a product, or takes it away.
    fn add(&mut self, away: bool, [p, q, r]: [Number; 3]) {
        let sum = if away ^ p.negative ^ q.negative ^ r.negative {
            &mut self.negative
        } else {
            &mut self.positive
        };
        // 53 bits, 106, 159: three limbs.
        let two = u128::from(p.integer) * u128::from(q.integer);
        let [low, high] =
            [two as u64, (two >> 64) as u64].map(|limb| u128::from(limb) * u128::from(r.integer));
        let high = high + (low >> 64);
        let product = [low as u64, high as u64, (high >> 64) as u64];

        let shift = p.exponent + q.exponent + r.exponent;
        let mut carry = 0;
        let places = &mut sum[shift / 64..];
        for (index, place) in places.iter_mut().enumerate() {
            // Shifted, a limb goes to two places.
            let limb = product
                .get(index)
                .map_or(0, |&limb| u128::from(limb) << (shift % 64));
            if limb == 0 && carry == 0 && index >= product.len() {
                break;
            }
            let total = limb + u128::from(*place) + carry;
            *place = total as u64;
            carry = total >> 64;
        }
    }

    fn sign(&self) -> Sign {
        match self.positive.iter().rev().cmp(self.negative.iter().rev()) {
            Ordering::Greater => 1,
            Ordering::Equal => 0,
            Ordering::Less => -1,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pliant_oracle::{Class, Random};

    fn check([a, b, c, d]: [Point; 4]) -> Sign {
        let expected = pliant_oracle::orientation(&a, &b, &c, &d);
        assert_eq!(
            orientation(&a, &b, &c, &d),
            expected,
            "{a:?} {b:?} {c:?} {d:?}"
        );
        for (x, y) in [(0, 1), (1, 2), (2, 0)] {
            let [p, q, r] = [a, b, c].map(|point| [point[x], point[y]]);
            let expected = pliant_oracle::orientation_2d(p, q, r);
            assert_eq!(orientation_2d(p, q, r), expected, "{p:?} {q:?} {r:?}");
        }
        expected
    }

    #[test]
    fn signs_are_those_of_the_oracle() {
        let mut random = Random::new(2);
        let mut found = [0; 3];
        for round in 0..32_000 {
            let [a, b] = Class::ALL[round % Class::ALL.len()].pair(&mut random);
            found[usize::from((check([a[0], a[1], a[2], b[0]]) + 1).unsigned_abs())] += 1;
        }
        assert!(found.iter().all(|&count| count > 5_000), "{found:?}");
    }

    #[test]
    fn the_ends_of_the_range_have_their_places() {
        let (max, min) = (f64::MAX, f64::from_bits(1));
        let corner = |x: f64| [[0.0; 3], [x, 0.0, 0.0], [0.0, x, 0.0], [0.0, 0.0, x]];
        assert_eq!(check(corner(max)), 1);
        assert_eq!(check(corner(-max)), -1);
        assert_eq!(check(corner(min)), 1);
        assert_eq!(check(corner(-min)), -1);
        // The largest determinant there is: the differences are twice the largest number.
        let p = [max, max, max];
        let far = [p, [-max, -max, max], [-max, max, -max], [max, -max, -max]];
        assert_ne!(check(far), 0);
        assert_eq!(check([p, p.map(|x| -x), p, p]), 0);
        // The smallest beside the largest: a difference that no float has.
        let mut nearly = [
            [max, 0.0, 0.0],
            [max, max, 0.0],
            [max, 0.0, max],
            [max, max, max],
        ];
        assert_eq!(check(nearly), 0);
        nearly[3][0] = max.next_down();
        assert_ne!(check(nearly), 0);
        let mut flat = [[0.0; 3], [max, 0.0, 0.0], [0.0, max, 0.0], [max, max, 0.0]];
        assert_eq!(check(flat), 0);
        flat[3][2] = min;
        assert_eq!(check(flat), 1);
    }
}
