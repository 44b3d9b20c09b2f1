//! Polynomials in the time t whose coefficients are integers, and their signs at fractions.
//!
//! A polynomial is only ever asked for signs, so it may be multiplied by what is positive: remainders are, and so stay integers.

use super::super::integer::Integer;
use super::fraction::{Dyadic, Fraction};

/// Coefficients of a polynomial, at most.
pub(super) const MOST: usize = 4;

/// A polynomial of degree 3 at most.
#[derive(Clone, Debug)]
pub(super) struct Polynomial {
    /// So many coefficients are used; the last of them is not zero.
    len: usize,
    /// That of the lowest power first; those that are not used are zero.
    coefficients: [Integer; MOST],
}

impl Polynomial {
    pub(super) const ZERO: Self = Self {
        len: 0,
        coefficients: [Integer::ZERO; MOST],
    };

    /// Of two coefficients, that of 1 and that of t.
    pub(super) fn new([of_one, of_t]: [Integer; 2]) -> Self {
        let mut new = Self::ZERO;
        new.coefficients[0] = of_one;
        new.coefficients[1] = of_t;
        new.trimmed()
    }

    /// What is `start` at 0 and `end` at 1, and affine.
    pub(super) fn affine(start: Integer, end: &Integer) -> Self {
        let by = end.minus(&start);
        Self::new([start, by])
    }

    fn trimmed(mut self) -> Self {
        let used = self.coefficients.iter().rposition(|c| !c.is_zero());
        self.len = used.map_or(0, |last| last + 1);
        self
    }

    pub(super) fn is_zero(&self) -> bool {
        self.len == 0
    }

    /// Whether it is a number, which may be zero.
    pub(super) fn is_constant(&self) -> bool {
        self.len <= 1
    }

    /// The degree; 0 of zero.
    pub(super) fn degree(&self) -> usize {
        self.len.saturating_sub(1)
    }

    /// The coefficients that are used.
    pub(super) fn coefficients(&self) -> &[Integer] {
        &self.coefficients[..self.len]
    }

    fn leading(&self) -> &Integer {
        &self.coefficients[self.degree()]
    }

    pub(super) fn negated(mut self) -> Self {
        for coefficient in &mut self.coefficients[..self.len] {
            *coefficient = std::mem::replace(coefficient, Integer::ZERO).negated();
        }
        self
    }

    /// The root of a polynomial of degree 1.
    pub(super) fn affine_root(&self) -> Fraction {
        let [over, under] = [0, 1].map(|power| self.coefficients[power].clone());
        Fraction::new(over.negated(), under)
    }

    pub(super) fn plus(&self, other: &Self) -> Self {
        let mut sum = Self::ZERO;
        for power in 0..self.len.max(other.len) {
            sum.coefficients[power] = self.coefficients[power].plus(&other.coefficients[power]);
        }
        sum.trimmed()
    }

    pub(super) fn minus(&self, other: &Self) -> Self {
        let mut difference = Self::ZERO;
        for power in 0..self.len.max(other.len) {
            difference.coefficients[power] =
                self.coefficients[power].minus(&other.coefficients[power]);
        }
        difference.trimmed()
    }

    /// The degrees add up to 3 at most.
    pub(super) fn times(&self, other: &Self) -> Self {
        let mut product = Self::ZERO;
        for (i, a) in self.coefficients().iter().enumerate() {
            for (j, b) in other.coefficients().iter().enumerate() {
                let sum = &mut product.coefficients[i + j];
                *sum = sum.plus(&a.times(b));
            }
        }
        product.trimmed()
    }

    pub(super) fn derivative(&self) -> Self {
        let mut derivative = Self::ZERO;
        for power in 1..self.len {
            derivative.coefficients[power - 1] =
                self.coefficients[power].times(&Integer::from(power as u64));
        }
        derivative.trimmed()
    }

    /// Without a power of two that all coefficients are multiples of.
    fn without_twos(mut self) -> Self {
        let used = self.coefficients[..self.len].iter();
        let zeros = used.filter(|c| !c.is_zero()).map(Integer::trailing_zeros);
        if let Some(zeros) = zeros.min().filter(|&zeros| zeros > 0) {
            for coefficient in &mut self.coefficients[..self.len] {
                *coefficient = coefficient.unshifted(zeros);
            }
        }
        self
    }

    /// A positive multiple of the quotient, and one of the remainder; the other is not zero.
    pub(super) fn divided(&self, by: &Self) -> [Self; 2] {
        let [mut quotient, mut rest] = [Self::ZERO, self.clone()];
        let leading = by.leading();
        let is_negative = leading.sign() < 0;
        while rest.len >= by.len {
            // |leading| rest - sign(leading) lead x^shift by: the highest power is gone.
            let shift = rest.len - by.len;
            let lead = rest.leading().clone();
            let mut next = Self::ZERO;
            for power in 0..rest.len - 1 {
                let mut coefficient = rest.coefficients[power].times(leading);
                if power >= shift {
                    let taken = by.coefficients[power - shift].times(&lead);
                    coefficient = coefficient.minus(&taken);
                }
                next.coefficients[power] = if is_negative {
                    coefficient.negated()
                } else {
                    coefficient
                };
            }
            for coefficient in &mut quotient.coefficients {
                *coefficient = coefficient.times(leading);
            }
            quotient.coefficients[shift] = quotient.coefficients[shift].plus(&lead);
            if is_negative {
                quotient = quotient.negated_all();
            }
            rest = next.trimmed();
        }
        [quotient.trimmed().without_twos(), rest.without_twos()]
    }

    /// The same of one whose length is not known.
    fn negated_all(mut self) -> Self {
        self.len = MOST;
        self.negated()
    }

    /// A positive multiple of the remainder of a division by another, which is not zero.
    pub(super) fn remainder(&self, by: &Self) -> Self {
        let [_, rest] = self.divided(by);
        rest
    }

    /// Divided by 2^twos t - over: that is a root.
    pub(super) fn without_root(&self, root: &Dyadic) -> Self {
        let under = Integer::from(1).shifted(root.twos);
        let [quotient, _] = self.divided(&Self::new([root.over.clone().negated(), under]));
        quotient
    }

    pub(super) fn sign_at(&self, t: &Dyadic) -> i8 {
        let Some(last) = self.len.checked_sub(1) else {
            return 0;
        };
        // Times 2^(twos degree), which is positive.
        let mut sum = self.coefficients[last].clone();
        for power in (0..last).rev() {
            let term = self.coefficients[power].shifted(t.twos * (last - power));
            sum = sum.times(&t.over).plus(&term);
        }
        sum.sign()
    }

    pub(super) fn sign_at_fraction(&self, t: &Fraction) -> i8 {
        let Some(last) = self.len.checked_sub(1) else {
            return 0;
        };
        // Times under^degree, which is positive.
        let mut sum = self.coefficients[last].clone();
        let mut by = Integer::from(1);
        for power in (0..last).rev() {
            by = by.times(&t.under);
            let term = self.coefficients[power].times(&by);
            sum = sum.times(&t.over).plus(&term);
        }
        sum.sign()
    }

    /// The sign at 0.
    pub(super) fn sign_at_zero(&self) -> i8 {
        self.coefficients[0].sign()
    }
}
