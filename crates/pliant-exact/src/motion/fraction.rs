//! Times that are fractions: of two, at which roots are looked for; and of any integers, which some
//! roots are.

use super::super::float::scaled;
use super::super::integer::{Integer, parts, quotient};
use super::super::ring::Ring;
use std::cmp::Ordering;

/// An integer over what is positive.
#[derive(Clone, Debug)]
pub(super) struct Quotient<U> {
    pub(super) over: Integer,
    pub(super) under: U,
}

/// An integer over a power of two.
pub(super) type Dyadic = Quotient<Twos>;

/// An integer over a positive one.
pub(super) type Fraction = Quotient<Integer>;

/// A power of two, by its exponent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Twos(pub(super) usize);

/// A positive number that integers are divided by.
pub(super) trait Denominator {
    /// An integer times it.
    fn multiply(&self, integer: &Integer) -> Integer;
}

impl Denominator for Integer {
    fn multiply(&self, integer: &Integer) -> Integer {
        self.times(integer)
    }
}

impl Denominator for Twos {
    fn multiply(&self, integer: &Integer) -> Integer {
        integer.shifted(self.0)
    }
}

impl<U: Denominator> Quotient<U> {
    pub(super) fn compare<V: Denominator>(&self, other: &Quotient<V>) -> Ordering {
        let [a, b] = [
            other.under.multiply(&self.over),
            self.under.multiply(&other.over),
        ];
        a.compare(&b)
    }
}

impl<U: Denominator, V: Denominator> PartialEq<Quotient<V>> for Quotient<U> {
    fn eq(&self, other: &Quotient<V>) -> bool {
        self.compare(other).is_eq()
    }
}

impl<U: Denominator, V: Denominator> PartialOrd<Quotient<V>> for Quotient<U> {
    fn partial_cmp(&self, other: &Quotient<V>) -> Option<Ordering> {
        Some(self.compare(other))
    }
}

impl Dyadic {
    /// A number that is not negative.
    pub(super) fn new(x: f64) -> Self {
        let (_, integer, exponent) = parts(x);
        let up = exponent.max(0).unsigned_abs() as usize;
        let twos = exponent.min(0).unsigned_abs() as usize;
        Self::reduced(&Integer::from(integer).shifted(up), twos)
    }

    /// An integer over a power of two, without twos that both have.
    fn reduced(over: &Integer, twos: usize) -> Self {
        let zeros = over.trailing_zeros().min(twos);
        Self {
            over: over.unshifted(zeros),
            under: Twos(twos - zeros),
        }
    }

    /// The largest power of two that it is not below; none for zero.
    pub(super) fn power(&self) -> Option<i32> {
        let (_, power) = self.over.approximately();
        (!self.over.is_zero()).then(|| power - self.under.0 as i32)
    }

    /// Absolute value divided by 2^`twos`.
    pub(super) fn magnitude_over(&self, twos: usize) -> Self {
        Self {
            over: self.over.clone().magnitude(),
            under: Twos(self.under.0 + twos),
        }
    }

    /// The sum or difference of two, made of both integers over the twos of both.
    fn combined(&self, other: &Self, by: impl Fn(&Integer, &Integer) -> Integer) -> Self {
        let twos = self.under.0.max(other.under.0);
        let [a, b] = [self, other].map(|it| it.over.shifted(twos - it.under.0));
        Self::reduced(&by(&a, &b), twos)
    }

    pub(super) fn plus(&self, other: &Self) -> Self {
        self.combined(other, Integer::plus)
    }

    pub(super) fn minus(&self, other: &Self) -> Self {
        self.combined(other, Integer::minus)
    }

    /// The middle of two.
    pub(super) fn middle(&self, other: &Self) -> Self {
        let twice = self.plus(other);
        Self::reduced(&twice.over, twice.under.0 + 1)
    }

    /// Nearly the same number, which is not negative: off by 2^-52 of itself; zero if it is below
    /// 2^-1000.
    pub(super) fn approximately(&self) -> f64 {
        let (m, e) = self.over.approximately();
        times_power(m, e - self.under.0 as i32)
    }
}

impl Fraction {
    /// A fraction of two integers, the second of which is not zero.
    pub(super) fn new(over: Integer, under: Integer) -> Self {
        Self {
            over: if under.sign() < 0 {
                over.negated()
            } else {
                over
            },
            under: under.magnitude(),
        }
    }

    /// Nearly the same number, which is from 0 to 1: off by 2^-50 of itself; zero if it is below
    /// 2^-1000.
    pub(super) fn approximately(&self) -> f64 {
        let (m, e) = quotient(&self.over, &self.under);
        times_power(m, e)
    }

    /// Nearly by how much it is more than a fraction of two, both from 0 to 1: off by 2^-50 of
    /// that.
    pub(super) fn minus(&self, other: &Dyadic) -> Dyadic {
        let over = other.under.multiply(&self.over);
        let over = over.minus(&self.under.times(&other.over));
        // A number below 2 in magnitude, and no smaller than a half unless it is 0, times a power
        // of two up to 2^53.
        let (m, e) = quotient(&over, &self.under);
        Dyadic {
            over: Integer::new(m, -53),
            under: Twos((53 - e + other.under.0 as i32).unsigned_abs() as usize),
        }
    }
}

impl From<Dyadic> for Fraction {
    fn from(dyadic: Dyadic) -> Self {
        Self {
            under: dyadic.under.multiply(&Integer::from(1)),
            over: dyadic.over,
        }
    }
}

/// A number times a power of two; zero if that is below 2^-1000.
fn times_power(m: f64, e: i32) -> f64 {
    if e < -1000 { 0.0 } else { scaled(m, e) }
}
