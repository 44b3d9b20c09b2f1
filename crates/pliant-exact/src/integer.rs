//! Integers of any size, for what floating point leaves undecided: nothing is rounded.
//!
//! Every coordinate is an integer of units of 2^-1074 and below 2^128, so it has 1202 bits. But the
//! coordinates of one question are all counted in the largest power of two that they are multiples
//! of. Mostly they have less than 60 bits then. So most numbers that come up have room in place,
//! and only the longest are allocated.

use super::float::{power, scaled};
use super::ring::Ring;
use std::cmp::Ordering;

/// The number of limbs that have room in place.
const IN_PLACE: usize = 10;

/// An integer.
#[derive(Clone, Debug)]
pub(super) struct Integer {
    is_negative: bool,
    /// How many limbs are used; the last of them is not zero.
    len: usize,
    /// The least first; those that are not used are zero.
    few: [u64; IN_PLACE],
    /// In place of those, if they are more.
    many: Vec<u64>,
}

/// The largest power of two that a finite number is a multiple of, and the smallest that it is
/// below; none for zero.
pub(super) fn powers(x: f64) -> Option<[i32; 2]> {
    let (_, integer, exponent) = parts(x);
    let [low, high] = [integer.trailing_zeros(), 64 - integer.leading_zeros()];
    (integer != 0).then(|| [low, high].map(|power| exponent + power as i32))
}

/// The largest power of two that all of these are multiples of, and the smallest that all are
/// below.
pub(super) fn powers_of_all<'x>(numbers: impl IntoIterator<Item = &'x f64>) -> [i32; 2] {
    let powers = numbers.into_iter().filter_map(|&x| powers(x));
    let both = powers.reduce(|[low, high], [l, h]| [low.min(l), high.max(h)]);
    both.unwrap_or([0; 2])
}

/// The sign, the integer and the exponent of a number, which is that integer times a power of two.
/// Read from its bits, so that a thread that flushes subnormal numbers sees them.
pub(super) fn parts(x: f64) -> (bool, u64, i32) {
    let bits = x.to_bits();
    let (fraction, biased) = (bits & ((1 << 52) - 1), (bits >> 52 & 0x7ff) as i32);
    let is_negative = bits >> 63 == 1;
    if biased == 0 {
        (is_negative, fraction, -1074)
    } else {
        (is_negative, fraction | 1 << 52, biased - 1075)
    }
}

impl Integer {
    pub(super) const ZERO: Self = Self {
        is_negative: false,
        len: 0,
        few: [0; IN_PLACE],
        many: Vec::new(),
    };

    /// Zero, with room for some limbs.
    fn with_room(len: usize) -> Self {
        let mut zero = Self::ZERO;
        if len > IN_PLACE {
            zero.many = vec![0; len];
        }
        zero
    }

    /// A finite number as an integer of units of 2^unit, which it is a multiple of.
    pub(super) fn new(x: f64, unit: i32) -> Self {
        let (is_negative, integer, exponent) = parts(x);
        let (integer, shift) = if exponent < unit {
            (integer >> (unit - exponent).min(63), 0)
        } else {
            (integer, exponent.abs_diff(unit) as usize)
        };
        let mut new = Self::from(integer).shifted(shift);
        new.is_negative = is_negative;
        new
    }

    /// The limbs that are used.
    fn limbs(&self) -> &[u64] {
        let all = if self.many.is_empty() {
            &self.few[..]
        } else {
            &self.many
        };
        &all[..self.len]
    }

    /// All that there is room for.
    fn room(&mut self) -> &mut [u64] {
        if self.many.is_empty() {
            &mut self.few
        } else {
            &mut self.many
        }
    }

    /// Counts the limbs that are used, after some were written, the last of which may be zero.
    fn trim(&mut self, len: usize) {
        let used = self.room()[..len].iter().rposition(|&limb| limb != 0);
        self.len = used.map_or(0, |last| last + 1);
    }

    /// Times a power of two.
    pub(super) fn shifted(&self, by: usize) -> Self {
        if self.len == 0 || by == 0 {
            return self.clone();
        }
        let (limbs, bits) = (by / 64, by % 64);
        let len = self.len + limbs + 1;
        let mut new = Self::with_room(len);
        new.is_negative = self.is_negative;
        let room = new.room();
        let mut carry = 0;
        for (place, &limb) in self.limbs().iter().enumerate() {
            let wide = u128::from(limb) << bits | carry;
            room[place + limbs] = wide as u64;
            carry = wide >> 64;
        }
        room[len - 1] = carry as u64;
        new.trim(len);
        new
    }

    /// Divided by a power of two that it is a multiple of.
    pub(super) fn unshifted(&self, by: usize) -> Self {
        let (limbs, bits) = (by / 64, by % 64);
        if self.len <= limbs {
            return Self::ZERO;
        }
        let len = self.len - limbs;
        let mut new = Self::with_room(len);
        new.is_negative = self.is_negative;
        let old = self.limbs();
        for (place, limb) in new.room()[..len].iter_mut().enumerate() {
            let above = old.get(place + limbs + 1).copied().unwrap_or(0);
            let wide = u128::from(above) << 64 | u128::from(old[place + limbs]);
            *limb = (wide >> bits) as u64;
        }
        new.trim(len);
        new
    }

    /// The largest power of two that it is a multiple of; of zero the largest number there is.
    pub(super) fn trailing_zeros(&self) -> usize {
        let mut limbs = self.limbs().iter().enumerate();
        let lowest = limbs.find(|&(_, &limb)| limb != 0);
        lowest.map_or(usize::MAX, |(place, limb)| {
            64 * place + limb.trailing_zeros() as usize
        })
    }

    pub(super) fn is_zero(&self) -> bool {
        self.len == 0
    }

    /// 1, 0 or -1.
    pub(super) fn sign(&self) -> i8 {
        match (self.len, self.is_negative) {
            (0, _) => 0,
            (_, true) => -1,
            (_, false) => 1,
        }
    }

    pub(super) fn negated(mut self) -> Self {
        self.is_negative = !self.is_negative;
        self
    }

    pub(super) fn magnitude(mut self) -> Self {
        self.is_negative = false;
        self
    }

    fn compare_magnitudes(&self, other: &Self) -> Ordering {
        let [a, b] = [self, other].map(|it| it.limbs().iter().rev());
        self.len.cmp(&other.len).then_with(|| a.cmp(b))
    }

    /// The sum of this and another, as if the other had this sign.
    fn plus_signed(&self, other: &Self, is_negative: bool) -> Self {
        let (large, small, sign) = match self.compare_magnitudes(other) {
            Ordering::Less => (other, self, is_negative),
            _ => (self, other, self.is_negative),
        };
        let len = large.len + 1;
        let mut sum = Self::with_room(len);
        sum.is_negative = sign;
        let is_difference = self.is_negative != is_negative;
        let room = &mut sum.room()[..len];
        room[..large.len].copy_from_slice(large.limbs());
        let mut carry = 0;
        for (place, limb) in room.iter_mut().enumerate() {
            let by = small.limbs().get(place).copied();
            if by.is_none() && carry == 0 {
                break;
            }
            let (all, by) = (u128::from(*limb), u128::from(by.unwrap_or(0)) + carry);
            let wide = if is_difference {
                all.wrapping_sub(by)
            } else {
                all + by
            };
            // The bit above a limb is carried, or borrowed.
            (*limb, carry) = (wide as u64, wide >> 64 & 1);
        }
        sum.trim(len);
        sum
    }

    pub(super) fn compare(&self, other: &Self) -> Ordering {
        self.minus(other).sign().cmp(&0)
    }

    pub(super) fn is_at_most(&self, other: &Self) -> bool {
        self.compare(other).is_le()
    }

    /// A number m and an exponent e: the integer is m 2^e within 2^-52 of itself. |m| is from 1 to
    /// 2, or zero.
    pub(super) fn approximately(&self) -> (f64, i32) {
        let Some(last) = self.len.checked_sub(1) else {
            return (0.0, 0);
        };
        let limbs = self.limbs();
        let high = limbs[last];
        let below = if last > 0 { limbs[last - 1] } else { 0 };
        let zeros = high.leading_zeros();
        let top = ((u128::from(high) << 64 | u128::from(below)) << zeros >> 64) as u64;
        let magnitude = top as f64 * power(-63);
        let m = magnitude * f64::from(self.sign());
        (m, (64 * last) as i32 + 63 - zeros as i32)
    }
}

impl Ring for Integer {
    fn plus(&self, other: &Self) -> Self {
        self.plus_signed(other, other.is_negative)
    }

    fn minus(&self, other: &Self) -> Self {
        self.plus_signed(other, !other.is_negative)
    }

    fn times(&self, other: &Self) -> Self {
        let len = self.len + other.len;
        let mut product = Self::with_room(len);
        product.is_negative = self.is_negative != other.is_negative;
        let room = product.room();
        // Many are multiples of high powers of two, where one coordinate of all is tiny.
        let zeros = other.limbs().iter().take_while(|&&limb| limb == 0).count();
        for (place, &limb) in self.limbs().iter().enumerate() {
            if limb == 0 {
                continue;
            }
            let mut carry = 0;
            let slots = &mut room[place..=place + other.len];
            for (slot, &by) in slots.iter_mut().zip(other.limbs()).skip(zeros) {
                let total = u128::from(limb) * u128::from(by) + u128::from(*slot) + carry;
                *slot = total as u64;
                carry = total >> 64;
            }
            slots[other.len] = carry as u64;
        }
        product.trim(len);
        product
    }
}

/// Nearly the quotient of two integers, the second of which is not zero: a number times a power of
/// two. The number is from a half to 2, or zero; it is off by 2^-50 of itself.
pub(super) fn quotient(over: &Integer, under: &Integer) -> (f64, i32) {
    let [(m, e), (by, of_by)] = [over, under].map(Integer::approximately);
    (m / by, e - of_by)
}

/// Nearly some integers, divided by one power of two so that the largest is from 1 to 2 in
/// magnitude. Each is off by 2^-52 of itself, or, below the normal range, by what is lost there.
pub(super) fn in_proportion<const N: usize>(integers: &[Integer; N]) -> [f64; N] {
    let all = integers.each_ref().map(Integer::approximately);
    let exponents = all.iter().filter(|(m, _)| *m != 0.0).map(|&(_, e)| e);
    let largest = exponents.max().unwrap_or(0);
    all.map(|(m, e)| {
        if m == 0.0 {
            0.0
        } else {
            scaled(m, e - largest)
        }
    })
}

impl From<u64> for Integer {
    fn from(x: u64) -> Self {
        let mut new = Self::ZERO;
        new.few[0] = x;
        new.len = usize::from(x != 0);
        new
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pliant_oracle::Random;

    #[test]
    fn small_ones_are_those_of_the_machine() {
        let mut random = Random::new(3);
        for round in 0..20_000 {
            let mut number = || {
                let bits = 1 + random.below(40);
                let magnitude = (random.bits() >> (64 - bits)) as i64;
                if random.below(2) == 0 {
                    -magnitude
                } else {
                    magnitude
                }
            };
            let [a, b] = [number(), number()];
            let [p, q] = [a, b].map(|x| Integer::new(x as f64, 0));
            let check = |found: Integer, expected: i128| {
                let (m, e) = found.approximately();
                assert_eq!(i128::from(found.sign()), expected.signum());
                let value = m * f64::powi(2.0, e);
                assert!((value - expected as f64).abs() <= (expected as f64).abs() * 1e-15);
            };
            let [a, b] = [a, b].map(i128::from);
            check(p.plus(&q), a + b);
            check(p.minus(&q), a - b);
            check(p.times(&q), a * b);
            check(p.times(&p).minus(&q.times(&q)), a * a - b * b);
            check(p.times(&p).minus(&p.times(&p)), 0);
            check(p.shifted(70).times(&q).minus(&p.times(&q).shifted(70)), 0);
            check(p.shifted(61), a << 61);
            assert_eq!(p.is_at_most(&q), a <= b);
            // Longer than what has room in place, and back.
            let by = 64 * (round % 60) + round % 63;
            let long = p.shifted(by).minus(&q);
            let square = long.times(&long);
            let terms = p
                .times(&p)
                .shifted(2 * by)
                .minus(&p.times(&q).shifted(by + 1));
            assert!(square.minus(&terms).minus(&q.times(&q)).is_zero());
            check(long.plus(&q).unshifted(by), a);
            check(square.shifted(by).unshifted(by).minus(&square), 0);
            if a != 0 {
                assert_eq!(
                    p.shifted(by).trailing_zeros(),
                    by + a.trailing_zeros() as usize
                );
            }
        }
        assert_eq!(Integer::ZERO.trailing_zeros(), usize::MAX);
    }

    #[test]
    fn powers_are_the_largest_and_the_smallest() {
        for (x, expected) in [
            (0.0, None),
            (1.0, Some([0, 1])),
            (-96.0, Some([5, 7])),
            (0.75, Some([-2, 0])),
            (5e-324, Some([-1074, -1073])),
            (f64::MIN_POSITIVE, Some([-1022, -1021])),
        ] {
            assert_eq!(powers(x), expected);
            if let Some([low, high]) = expected {
                let odd = Integer::new(x, low);
                assert_eq!(odd.trailing_zeros(), 0);
                assert_eq!(odd.approximately().1, high - low - 1);
            }
        }
    }
}
