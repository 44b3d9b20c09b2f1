//! Lengths: a distance, and how thick two things are, added without rounding.
//!
//! Two things of thickness s and t are near each other if they are at most d + s + t apart. The
//! rounded sum is another number, so the three are kept. Bounds of the sum decide nearly always.

use super::float::power;
use super::integer::{Integer, powers_of_all};
use super::ring::Ring;

/// Length: the sum of up to three numbers of at least 0, in real arithmetic.
///
/// ```
/// use pliant_exact::Length;
///
/// let [low, high] = Length::sum([0.1, 0.2, 0.0]).bounds();
/// assert!(low < 0.1 + 0.2 && 0.1 + 0.2 < high);
/// assert_eq!(Length::sum([0.5, 0.25, 0.0]).bounds(), [0.75; 2]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Length([f64; 3]);

/// Below this a sum is not bounded tightly: a thread that flushes subnormal numbers may lose as
/// much.
const TINY: f64 = power(-900);

impl From<f64> for Length {
    #[inline]
    fn from(length: f64) -> Self {
        Self([length, 0.0, 0.0])
    }
}

impl Length {
    /// The sum of three numbers, each at least 0 and perhaps infinite.
    #[inline]
    pub fn sum(numbers: [f64; 3]) -> Self {
        Self(numbers)
    }

    /// Lower and upper bound. Both are the length if that is a floating-point number of at least
    /// 2^-900, or one of the three alone.
    #[inline]
    pub fn bounds(&self) -> [f64; 2] {
        let [a, b, c] = self.0;
        if b == 0.0 && c == 0.0 {
            return [a; 2];
        }
        // Two sums, each off by half a unit in the last place at most. The error of a sum (Knuth
        // 1969) tells whether it is off at all.
        let error = |a: f64, b: f64| {
            let sum = a + b;
            let of_a = sum - b;
            (a - of_a) + (b - (sum - of_a))
        };
        let sum = a + b + c;
        if sum < TINY {
            return [0.0, TINY];
        }
        if error(a, b) == 0.0 && error(a + b, c) == 0.0 {
            return [sum; 2];
        }
        [sum.next_down().next_down(), sum.next_up()]
    }

    /// The length as an integer times a power of two. It must be finite.
    pub(super) fn exactly(&self) -> (Integer, i32) {
        let [unit, _] = powers_of_all(&self.0);
        let all = self.0.iter().map(|&x| Integer::new(x, unit));
        let sum = all.reduce(|sum, x| sum.plus(&x));
        (sum.unwrap_or(Integer::ZERO), unit)
    }

    /// Whether real lo - hi is at most the length. Both are at most `f32::MAX` in magnitude.
    #[inline]
    pub(super) fn holds_difference(&self, lo: f64, hi: f64) -> bool {
        let [low, high] = self.bounds();
        let difference = lo - hi;
        // Rounding is monotonic: what is rounded to one side of a number is on that side.
        if difference < low {
            return true;
        }
        if difference > high {
            return false;
        }
        if low < high {
            return self.exactly_holds_difference(lo, hi);
        }
        // The error of a subtraction (Knuth 1969): exact, as nothing overflows.
        let of_lo = difference + hi;
        let error = (lo - of_lo) - (hi - (of_lo - difference));
        error <= 0.0
    }

    #[cold]
    fn exactly_holds_difference(&self, lo: f64, hi: f64) -> bool {
        let [unit, _] = powers_of_all(self.0.iter().chain(&[lo, hi]));
        let of = |x: f64| Integer::new(x, unit);
        let [a, b, c] = self.0.map(of);
        of(lo).is_at_most(&of(hi).plus(&a).plus(&b).plus(&c))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pliant_oracle::{Class, Random, sign_of_sum};

    /// Sums of three that are nearly a difference of coordinates, and on either side of it.
    #[test]
    fn sums_are_compared_to_the_last_bit() {
        let mut random = Random::new(22);
        let [mut ties, mut over, mut loose] = [0; 3];
        for round in 0..40_000 {
            let class = Class::ALL[round % Class::ALL.len()];
            let [[a, b, _], [c, ..]] = class.pair(&mut random);
            for axis in 0..3 {
                let (lo, hi) = (a[axis].max(c[axis]), a[axis].min(c[axis]));
                let third = (b[axis].abs() / 3.0).min((lo - hi) / 3.0);
                let rest = (lo - hi) - third - third;
                for rest in [rest, rest.next_up(), rest.next_down(), rest / 2.0] {
                    let numbers = [rest.max(0.0), third, third];
                    let length = Length::sum(numbers);
                    let [p, q, r] = numbers;
                    let sign = sign_of_sum(&[lo, -hi, -p, -q, -r]);
                    assert_eq!(
                        length.holds_difference(lo, hi),
                        sign <= 0,
                        "{lo} {hi} {numbers:?}"
                    );
                    let [low, high] = length.bounds();
                    assert!(sign_of_sum(&[p, q, r, -low]) >= 0, "{numbers:?}");
                    assert!(sign_of_sum(&[p, q, r, -high]) <= 0, "{numbers:?}");
                    ties += u32::from(sign == 0);
                    over += u32::from(sign > 0);
                    loose += u32::from(lo - hi >= low && lo - hi <= high && low < high);
                }
            }
        }
        let all = [ties, over, loose];
        assert!(ties > 10_000 && over > 10_000 && loose > 10_000, "{all:?}");
    }

    #[test]
    fn no_numbers_are_too_large_or_too_small() {
        let least = f64::from_bits(1);
        let two = [least, least, 0.0];
        let all = [
            [least; 3],
            two,
            [1.0, least, 0.0],
            [f64::MAX; 3],
            [f64::INFINITY, 0.0, 1.0],
        ];
        for numbers in all {
            let held = [2.0, 3.0].map(|x| Length::sum(numbers).holds_difference(x * least, 0.0));
            assert_eq!(held, [true, numbers != two], "{numbers:?}");
        }
    }
}
