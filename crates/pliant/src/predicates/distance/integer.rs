//! Integers with room for everything that squared distances of two elements are compared by.
//!
//! Every coordinate is an integer of units of 2^-1074 and below 2^128, so it has 1202 bits; but coordinates of one question are all counted
//! in the largest power of two that they are multiples of, and mostly have less than 99. With b bits a difference has b + 1, a normal
//! 2 (b + 1) + 1 in each of three and its square 4 (b + 1) + 4, the square of a volume 6 (b + 1) + 6. Two quotients of such are compared by
//! products of 10 (b + 1) + 10 bits, and of the square of a distance by as few, for that is only done where they are nearly equal. So 16
//! limbs of 64 bits are enough up to 99 bits, and 190 for all. Nothing is rounded and nothing allocated.

use std::cmp::Ordering;

/// Limbs for coordinates of up to [`FEW_BITS`].
pub(super) const FEW: usize = 16;
pub(super) const FEW_BITS: i32 = 99;
/// Limbs for all coordinates.
pub(super) const ENOUGH: usize = 190;

/// An integer of so many limbs.
#[derive(Clone, Copy)]
pub(super) struct Integer<const LIMBS: usize> {
    is_negative: bool,
    /// So many limbs are used; the last of them is not zero.
    len: usize,
    /// The least first; those that are not used are zero.
    limbs: [u64; LIMBS],
}

/// The largest power of two that a finite number is a multiple of, and the smallest that it is below; none for zero.
pub(super) fn powers(x: f64) -> Option<[i32; 2]> {
    let (_, integer, exponent) = parts(x);
    let [low, high] = [integer.trailing_zeros(), 64 - integer.leading_zeros()];
    (integer != 0).then(|| [low, high].map(|power| exponent + power as i32))
}

/// The sign, and the integer and the exponent of two whose product a number is; of bits, so that a thread that flushes subnormal
/// numbers sees them.
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

impl<const LIMBS: usize> Integer<LIMBS> {
    pub(super) const ZERO: Self = Self {
        is_negative: false,
        len: 0,
        limbs: [0; LIMBS],
    };

    /// A finite number as an integer of units of 2^unit, which it is a multiple of.
    pub(super) fn new(x: f64, unit: i32) -> Self {
        let (is_negative, integer, exponent) = parts(x);
        let mut new = Self::ZERO;
        if integer == 0 {
            return new;
        }
        let (integer, shift) = if exponent < unit {
            (integer >> (unit - exponent), 0)
        } else {
            (integer, exponent.abs_diff(unit) as usize)
        };
        new.limbs[0] = integer;
        new.len = 1;
        new.is_negative = is_negative;
        new.shifted(shift)
    }

    /// Times a power of two.
    pub(super) fn shifted(&self, by: usize) -> Self {
        let (limbs, bits) = (by / 64, by % 64);
        if self.len == 0 || by == 0 {
            return *self;
        }
        let mut new = Self::ZERO;
        new.is_negative = self.is_negative;
        let mut carry = 0;
        for (place, &limb) in self.limbs[..self.len].iter().enumerate() {
            let wide = u128::from(limb) << bits | carry;
            new.limbs[place + limbs] = wide as u64;
            carry = wide >> 64;
        }
        let mut len = self.len + limbs;
        if carry != 0 {
            new.limbs[len] = carry as u64;
            len += 1;
        }
        new.len = len;
        new
    }

    /// Of so many limbs perhaps some at the end are not used.
    fn trim(&mut self, len: usize) {
        let used = self.limbs[..len].iter().rposition(|&limb| limb != 0);
        self.len = used.map_or(0, |last| last + 1);
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

    fn compare_magnitudes(&self, other: &Self) -> Ordering {
        let [a, b] = [self, other].map(|it| it.limbs[..it.len].iter().rev());
        self.len.cmp(&other.len).then_with(|| a.cmp(b))
    }

    pub(super) fn plus(&self, other: &Self) -> Self {
        if self.is_negative == other.is_negative {
            let mut sum = *self;
            let len = self.len.max(other.len);
            let mut carry = false;
            for place in 0..len {
                let (limb, over) = self.limbs[place].overflowing_add(other.limbs[place]);
                let (limb, again) = limb.overflowing_add(carry.into());
                (sum.limbs[place], carry) = (limb, over | again);
            }
            if carry {
                sum.limbs[len] = 1;
            }
            sum.trim(len + usize::from(carry));
            return sum;
        }
        let (large, small) = match self.compare_magnitudes(other) {
            Ordering::Equal => return Self::ZERO,
            Ordering::Greater => (self, other),
            Ordering::Less => (other, self),
        };
        let mut difference = *large;
        let mut borrow = false;
        for place in 0..large.len {
            let (limb, under) = large.limbs[place].overflowing_sub(small.limbs[place]);
            let (limb, again) = limb.overflowing_sub(borrow.into());
            (difference.limbs[place], borrow) = (limb, under | again);
        }
        difference.trim(large.len);
        difference
    }

    pub(super) fn minus(&self, other: &Self) -> Self {
        self.plus(&other.negated())
    }

    pub(super) fn times(&self, other: &Self) -> Self {
        let mut product = Self::ZERO;
        product.is_negative = self.is_negative != other.is_negative;
        for (place, &limb) in self.limbs[..self.len].iter().enumerate() {
            let mut carry = 0;
            for (offset, &by) in other.limbs[..other.len].iter().enumerate() {
                let slot = &mut product.limbs[place + offset];
                let total = u128::from(limb) * u128::from(by) + u128::from(*slot) + carry;
                *slot = total as u64;
                carry = total >> 64;
            }
            if carry != 0 {
                product.limbs[place + other.len] = carry as u64;
            }
        }
        product.trim((self.len + other.len).min(LIMBS));
        product
    }

    pub(super) fn is_at_most(&self, other: &Self) -> bool {
        self.minus(other).sign() <= 0
    }

    /// A number m and an exponent e so that it is m 2^e but for an error of 2^-52 of itself: |m| from 1 to 2, or zero.
    pub(super) fn approximately(&self) -> (f64, i32) {
        let Some(last) = self.len.checked_sub(1) else {
            return (0.0, 0);
        };
        let high = self.limbs[last];
        let below = if last > 0 { self.limbs[last - 1] } else { 0 };
        let zeros = high.leading_zeros();
        let top = ((u128::from(high) << 64 | u128::from(below)) << zeros >> 64) as u64;
        let magnitude = top as f64 * f64::powi(0.5, 63);
        let m = if self.is_negative {
            -magnitude
        } else {
            magnitude
        };
        (m, (64 * last) as i32 + 63 - zeros as i32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pliant_oracle::Random;

    #[test]
    fn small_ones_are_those_of_the_machine() {
        let mut random = Random::new(3);
        for _ in 0..20_000 {
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
            let [p, q] = [a, b].map(|x| Integer::<FEW>::new(x as f64, 0));
            let check = |found: Integer<FEW>, expected: i128| {
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
        }
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
                let odd = Integer::<FEW>::new(x, low);
                assert_eq!(odd.limbs[0] % 2, 1);
                assert_eq!(odd.approximately().1, high - low - 1);
            }
        }
    }

    /// The largest number that is ever made of coordinates of so many bits.
    fn largest<const LIMBS: usize>(bits: usize) -> usize {
        let one = Integer::<LIMBS>::new(1.0, 0);
        let coordinate = one.shifted(bits).minus(&one);
        let difference = coordinate.plus(&coordinate);
        let product = difference.times(&difference);
        let normal = product.plus(&product);
        let square = normal.times(&normal);
        let square = square.plus(&square).plus(&square);
        let volume = normal.times(&difference);
        let volume = volume.plus(&volume).plus(&volume);
        let compared = volume.times(&volume).times(&square);
        assert!(compared.minus(&compared).is_zero());
        compared.len
    }

    #[test]
    fn the_largest_there_can_be_has_room() {
        assert_eq!(largest::<FEW>(FEW_BITS.unsigned_abs() as usize), FEW);
        let len = largest::<ENOUGH>(128 + 1074);
        assert!(len == ENOUGH || len == ENOUGH - 1, "{len}");
    }
}
