//! Times that are fractions: of two, at which roots are looked for; and of any integers, which some roots are.

use super::super::integer::{Integer, parts, quotient};
use std::cmp::Ordering;

/// An integer over a power of two.
#[derive(Clone, Debug)]
pub(super) struct Dyadic {
    pub(super) over: Integer,
    pub(super) twos: usize,
}

/// An integer over a positive one.
#[derive(Clone, Debug)]
pub(super) struct Fraction {
    pub(super) over: Integer,
    pub(super) under: Integer,
}

impl Dyadic {
    pub(super) fn zero() -> Self {
        Self {
            over: Integer::ZERO,
            twos: 0,
        }
    }

    pub(super) fn one() -> Self {
        Self {
            over: Integer::from(1),
            twos: 0,
        }
    }

    /// A power of two that is at most 1.
    pub(super) fn power_of_two(power: i32) -> Self {
        Self {
            over: Integer::from(1),
            twos: power.min(0).unsigned_abs() as usize,
        }
    }

    /// The largest power of two that it is not below; none for zero.
    pub(super) fn power(&self) -> Option<i32> {
        let (_, power) = self.over.approximately();
        (self.over.sign() != 0).then(|| power - self.twos as i32)
    }

    /// A number from 0 to 1.
    pub(super) fn new(x: f64) -> Self {
        let (_, integer, exponent) = parts(x);
        if integer == 0 {
            return Self::zero();
        }
        let zeros = integer.trailing_zeros();
        let (odd, exponent) = (integer >> zeros, exponent + zeros as i32);
        Self {
            // Of numbers up to 1 only 1 itself has an exponent above none.
            over: Integer::from(odd).shifted(exponent.max(0).unsigned_abs() as usize),
            twos: exponent.min(0).unsigned_abs() as usize,
        }
    }

    /// A number that is below 2 in magnitude, and no smaller than a half unless it is 0, times a power of two up to 2^53.
    fn scaled(m: f64, e: i32) -> Self {
        Self {
            over: Integer::new(m, -53),
            twos: (53 - e).unsigned_abs() as usize,
        }
    }

    /// This many powers of two less, and not negative.
    pub(super) fn magnitude_over(&self, twos: usize) -> Self {
        let over = self.over.clone();
        Self {
            over: if over.sign() < 0 {
                over.negated()
            } else {
                over
            },
            twos: self.twos + twos,
        }
    }

    pub(super) fn plus(&self, other: &Self) -> Self {
        let twos = self.twos.max(other.twos);
        let [a, b] = [self, other].map(|it| it.over.shifted(twos - it.twos));
        let over = a.plus(&b);
        let zeros = over.trailing_zeros().min(twos);
        Self {
            over: over.unshifted(zeros),
            twos: twos - zeros,
        }
    }

    pub(super) fn minus(&self, other: &Self) -> Self {
        self.plus(&Self {
            over: other.over.clone().negated(),
            twos: other.twos,
        })
    }

    /// The middle of two.
    pub(super) fn middle(&self, other: &Self) -> Self {
        let [a, b] = [self, other].map(|it| Self {
            over: it.over.clone(),
            twos: it.twos + 1,
        });
        a.plus(&b)
    }

    /// Nearly the same number, which is not negative: off by 2^-52 of itself; zero if it is below 2^-1000.
    pub(super) fn approximately(&self) -> f64 {
        let (m, e) = self.over.approximately();
        times_power(m, e - self.twos as i32)
    }
}

impl PartialEq for Dyadic {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Dyadic {}

impl PartialOrd for Dyadic {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Dyadic {
    fn cmp(&self, other: &Self) -> Ordering {
        let twos = self.twos.max(other.twos);
        let [a, b] = [self, other].map(|it| it.over.shifted(twos - it.twos));
        a.minus(&b).sign().cmp(&0)
    }
}

impl Fraction {
    /// Of two integers, the second of which is not zero.
    pub(super) fn new(over: Integer, under: Integer) -> Self {
        let [over, under] = if under.sign() < 0 {
            [over.negated(), under.negated()]
        } else {
            [over, under]
        };
        Self { over, under }
    }

    /// Nearly the same number, which is from 0 to 1: off by 2^-50 of itself; zero if it is below 2^-1000.
    pub(super) fn approximately(&self) -> f64 {
        let (m, e) = quotient(&self.over, &self.under);
        times_power(m, e)
    }

    /// Nearly by how much it is more than a fraction of two, both from 0 to 1: off by 2^-50 of that.
    pub(super) fn minus(&self, other: &Dyadic) -> Dyadic {
        let over = self.over.shifted(other.twos);
        let over = over.minus(&self.under.times(&other.over));
        let (m, e) = quotient(&over, &self.under);
        Dyadic::scaled(m, e - other.twos as i32)
    }
}

impl From<Dyadic> for Fraction {
    fn from(dyadic: Dyadic) -> Self {
        Self {
            over: dyadic.over,
            under: Integer::from(1).shifted(dyadic.twos),
        }
    }
}

impl PartialEq for Fraction {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Fraction {}

impl PartialOrd for Fraction {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Fraction {
    fn cmp(&self, other: &Self) -> Ordering {
        let [a, b] = [self.over.times(&other.under), other.over.times(&self.under)];
        a.minus(&b).sign().cmp(&0)
    }
}

/// A number times a power of two; zero if that is below 2^-1000.
fn times_power(m: f64, e: i32) -> f64 {
    if e < -1000 {
        0.0
    } else {
        m * f64::powi(2.0, e)
    }
}
