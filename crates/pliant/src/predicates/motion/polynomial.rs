//! Polynomials in the time t whose coefficients are integers, and their signs at fractions of two.
//!
//! A polynomial is only ever asked for signs, so it may be multiplied by what is positive: remainders are, and so stay integers.

use super::super::integer::{Integer, parts};
use std::cmp::Ordering;

/// The largest degree is 4: of a square times the derivative of a cube.
const MOST: usize = 5;

/// A polynomial of degree 4 at most.
#[derive(Clone, Debug)]
pub(super) struct Polynomial {
    /// So many coefficients are used; the last of them is not zero.
    len: usize,
    /// That of the lowest power first; those that are not used are zero.
    coefficients: [Integer; MOST],
}

/// A fraction: an integer over a power of two.
#[derive(Clone, Debug)]
pub(super) struct Dyadic {
    pub(super) over: Integer,
    pub(super) twos: usize,
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

    /// The middle of two.
    pub(super) fn middle(&self, other: &Self) -> Self {
        let twos = self.twos.max(other.twos);
        let [a, b] = [self, other].map(|it| it.over.shifted(twos - it.twos));
        let over = a.plus(&b);
        let zeros = over.trailing_zeros().min(twos + 1);
        Self {
            over: over.unshifted(zeros),
            twos: twos + 1 - zeros,
        }
    }

    /// Nearly the same number: off by 2^-52 of itself; zero if it is below 2^-1000.
    pub(super) fn approximately(&self) -> f64 {
        let (m, e) = self.over.approximately();
        let e = e - self.twos as i32;
        if e < -1000 {
            0.0
        } else {
            m * f64::powi(2.0, e)
        }
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

impl Polynomial {
    pub(super) const ZERO: Self = Self {
        len: 0,
        coefficients: [Integer::ZERO; MOST],
    };

    /// What is `start` at 0 and `end` at 1, and affine.
    pub(super) fn affine(start: Integer, end: &Integer) -> Self {
        let mut affine = Self::ZERO;
        affine.coefficients[1] = end.minus(&start);
        affine.coefficients[0] = start;
        affine.trimmed()
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

    /// The degrees add up to 4 at most.
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

    /// A positive multiple of quotient and remainder; the other is not zero.
    fn divided(&self, by: &Self) -> [Self; 2] {
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

    /// A positive multiple of the quotient.
    pub(super) fn quotient(&self, by: &Self) -> Self {
        let [quotient, _] = self.divided(by);
        quotient
    }

    /// Divided by 2^twos t - over: that is a root.
    pub(super) fn without_root(&self, root: &Dyadic) -> Self {
        let mut by = Self::ZERO;
        by.coefficients[0] = root.over.clone().negated();
        by.coefficients[1] = Integer::from(1).shifted(root.twos);
        self.quotient(&by.trimmed())
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

    /// The sign at 0.
    pub(super) fn sign_at_zero(&self) -> i8 {
        self.coefficients[0].sign()
    }
}

/// Signed remainders: of two polynomials, each further one the negative remainder of the two before it, to the last that is not zero.
///
/// Between two fractions that are no roots of the first, its sequence with its derivative loses as many changes of sign as there are roots,
/// each counted once (Sturm); that with its derivative times another loses as many more where the other is positive than where it is
/// negative (Tarski; Basu, Pollack, Roy, Algorithms in Real Algebraic Geometry, theorems 2.61 and 2.73; the product may be replaced by its
/// remainder).
#[derive(Clone, Debug)]
pub(super) struct SignedRemainders {
    len: usize,
    sequence: [Polynomial; MOST],
}

impl SignedRemainders {
    /// The second is of a lower degree than the first, which is of degree 3 at most.
    pub(super) fn new(first: &Polynomial, second: Polynomial) -> Self {
        let mut sequence = [Polynomial::ZERO; MOST];
        sequence[0] = first.clone();
        sequence[1] = second;
        let mut len = 1;
        while !sequence[len].is_zero() {
            len += 1;
            if len == MOST {
                break;
            }
            sequence[len] = sequence[len - 2].remainder(&sequence[len - 1]).negated();
        }
        Self { len, sequence }
    }

    /// A greatest common divisor of the two.
    pub(super) fn common_divisor(&self) -> &Polynomial {
        &self.sequence[self.len - 1]
    }

    /// How often the sign changes along the sequence at a time.
    pub(super) fn changes_at(&self, t: &Dyadic) -> i32 {
        let mut changes = 0;
        let mut last = 0;
        for polynomial in &self.sequence[..self.len] {
            let sign = polynomial.sign_at(t);
            if sign != 0 {
                changes += i32::from(sign == -last);
                last = sign;
            }
        }
        changes
    }

    /// How many changes are lost from one time to another.
    pub(super) fn lost(&self, low: &Dyadic, high: &Dyadic) -> i32 {
        self.changes_at(low) - self.changes_at(high)
    }
}
