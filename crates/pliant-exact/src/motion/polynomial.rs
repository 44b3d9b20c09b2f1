//! Polynomials in the time t whose coefficients are integers, and their signs at fractions.
//!
//! Only signs are asked for, so a polynomial may be scaled by any positive factor. Remainders are
//! scaled that way, so that their coefficients stay integers.

use super::super::integer::Integer;
use super::super::ring::Ring;
use super::fraction::{Denominator, Dyadic, Fraction, Quotient};
use std::array::from_fn;

/// Coefficients of a polynomial, at most.
const MOST: usize = 4;

/// A polynomial of degree 3 at most: its coefficients, that of the lowest power first.
#[derive(Clone, Debug)]
pub(super) struct Polynomial(pub(super) [Integer; MOST]);

impl Ring for Polynomial {
    fn plus(&self, other: &Self) -> Self {
        Self(from_fn(|power| self.0[power].plus(&other.0[power])))
    }

    fn minus(&self, other: &Self) -> Self {
        Self(from_fn(|power| self.0[power].minus(&other.0[power])))
    }

    /// The degrees add up to 3 at most.
    fn times(&self, other: &Self) -> Self {
        let mut product = Self::ZERO;
        for (i, a) in self.coefficients().iter().enumerate() {
            for (j, b) in other.coefficients().iter().enumerate() {
                let sum = &mut product.0[i + j];
                *sum = sum.plus(&a.times(b));
            }
        }
        product
    }
}

impl Polynomial {
    pub(super) const ZERO: Self = Self([Integer::ZERO; MOST]);

    /// A polynomial of two coefficients: that of 1 and that of t.
    pub(super) fn new([of_one, of_t]: [Integer; 2]) -> Self {
        Self([of_one, of_t, Integer::ZERO, Integer::ZERO])
    }

    /// The affine polynomial that is `start` at 0 and `end` at 1.
    pub(super) fn affine(start: Integer, end: &Integer) -> Self {
        let by = end.minus(&start);
        Self::new([start, by])
    }

    /// A number times t to some power.
    fn term(coefficient: Integer, power: usize) -> Self {
        let mut term = Self::ZERO;
        term.0[power] = coefficient;
        term
    }

    pub(super) fn is_zero(&self) -> bool {
        self.coefficients().is_empty()
    }

    /// Whether it is a number, which may be zero.
    pub(super) fn is_constant(&self) -> bool {
        self.degree() == 0
    }

    /// The degree; 0 of zero.
    pub(super) fn degree(&self) -> usize {
        self.coefficients().len().saturating_sub(1)
    }

    /// The coefficients up to the last that is not zero.
    pub(super) fn coefficients(&self) -> &[Integer] {
        let last = self.0.iter().rposition(|c| !c.is_zero());
        &self.0[..last.map_or(0, |last| last + 1)]
    }

    pub(super) fn negated(self) -> Self {
        Self(self.0.map(Integer::negated))
    }

    /// The root of a polynomial of degree 1.
    pub(super) fn affine_root(&self) -> Fraction {
        let [over, under, ..] = self.0.clone();
        Fraction::new(over.negated(), under)
    }

    pub(super) fn derivative(&self) -> Self {
        let mut derivative = Self::ZERO;
        for power in 1..MOST {
            derivative.0[power - 1] = self.0[power].times(&Integer::from(power as u64));
        }
        derivative
    }

    /// Without a power of two that all coefficients are multiples of.
    fn without_twos(&self) -> Self {
        let zeros = self.0.each_ref().map(Integer::trailing_zeros);
        let zeros = zeros.into_iter().fold(usize::MAX, usize::min);
        Self(self.0.each_ref().map(|c| c.unshifted(zeros)))
    }

    /// A positive multiple of the quotient, and one of the remainder; the other is not zero.
    pub(super) fn divided(&self, by: &Self) -> [Self; 2] {
        let [mut quotient, mut rest] = [Self::ZERO, self.clone()];
        let leading = &by.0[by.degree()];
        let size = Self::term(leading.clone().magnitude(), 0);
        while !rest.is_zero() && rest.degree() >= by.degree() {
            // |leading| rest - sign(leading) lead t^shift by: the highest power is gone.
            let (degree, shift) = (rest.degree(), rest.degree() - by.degree());
            let lead = rest.0[degree].clone();
            let lead = if leading.sign() < 0 {
                lead.negated()
            } else {
                lead
            };
            let lead = Self::term(lead, shift);
            quotient = quotient.times(&size).plus(&lead);
            rest = rest.times(&size).minus(&by.times(&lead));
        }
        [quotient.without_twos(), rest.without_twos()]
    }

    /// Divided by 2^twos t - over: that is a root.
    pub(super) fn without_root(&self, root: &Dyadic) -> Self {
        let under = root.under.multiply(&Integer::from(1));
        let [quotient, _] = self.divided(&Self::new([root.over.clone().negated(), under]));
        quotient
    }

    /// The sign at a time.
    pub(super) fn sign_at<U: Denominator>(&self, t: &Quotient<U>) -> i8 {
        let Some((leading, lower)) = self.coefficients().split_last() else {
            return 0;
        };
        // Times under^degree, which is positive.
        let mut sum = leading.clone();
        for (power, coefficient) in lower.iter().enumerate().rev() {
            let missing = power..lower.len();
            let term = missing.fold(coefficient.clone(), |term, _| t.under.multiply(&term));
            sum = sum.times(&t.over).plus(&term);
        }
        sum.sign()
    }

    /// The sign at 0.
    pub(super) fn sign_at_zero(&self) -> i8 {
        self.0[0].sign()
    }
}
