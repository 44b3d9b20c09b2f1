//! Polynomials of one variable with integer coefficients.

use crate::integers::{Exact, Ring};
use dashu_int::IBig;
use dashu_int::ops::{Gcd, UnsignedAbs};

/// A polynomial by its coefficients of 1, t, t^2, ... The last one is not zero; zero has none.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Polynomial(Vec<IBig>);

impl Polynomial {
    pub(super) fn new(mut coefficients: Vec<IBig>) -> Self {
        while coefficients.last().is_some_and(|last| *last == IBig::ZERO) {
            coefficients.pop();
        }
        Self(coefficients)
    }

    pub(super) fn is_zero(&self) -> bool {
        self.0.is_empty()
    }

    /// Degree; 0 for the zero polynomial too.
    pub(super) fn degree(&self) -> usize {
        self.0.len().saturating_sub(1)
    }

    /// Sign of the coefficient of 1, which is the whole polynomial at degree 0.
    pub(super) fn sign_of_constant(&self) -> i8 {
        self.0.first().map_or(0, Exact::sign)
    }

    pub(super) fn derivative(&self) -> Self {
        let terms = self.0.iter().enumerate().skip(1);
        Self::new(terms.map(|(i, x)| x * IBig::from(i)).collect())
    }

    /// Value at n / 2^bits, times 2^(bits * degree), which does not change its sign.
    pub(super) fn at(&self, n: &IBig, bits: usize) -> IBig {
        let mut terms = self.0.iter().rev().enumerate();
        let lead = terms.next().map_or(IBig::ZERO, |(_, lead)| lead.clone());
        terms.fold(lead, |sum, (i, x)| sum * n + (x << (bits * i)))
    }

    /// Sign of the value at n / 2^bits.
    pub(super) fn sign_at(&self, n: &IBig, bits: usize) -> i8 {
        Exact::sign(&self.at(n, bits))
    }

    /// Sign on all of [low, high] / 2^bits, ends included, if the Bernstein coefficients show it.
    ///
    /// With t = low + (high - low) x, the variable x runs from 0 to 1. There a polynomial lies
    /// between the least and the largest of its Bernstein coefficients. As the interval shrinks to
    /// a point, they all tend to the value there. So the sign shows sooner or later, unless that
    /// value is zero.
    pub(super) fn sign_on(&self, low: &IBig, high: &IBig, bits: usize) -> Option<i8> {
        let Some(lead) = self.0.last() else {
            return Some(0);
        };
        let degree = self.degree();
        let width = high - low;
        // Coefficients of powers of x by Horner's rule: times (low + width x), plus the next.
        let mut powers = vec![lead.clone()];
        for (i, next) in self.0.iter().rev().enumerate().skip(1) {
            powers.push(IBig::ZERO);
            for j in (0..powers.len()).rev() {
                let below = if j > 0 {
                    &powers[j - 1] * &width
                } else {
                    next << (bits * i)
                };
                powers[j] = &powers[j] * low + below;
            }
        }
        // Bernstein coefficient j times degree!: the sum over i <= j of powers[i] (j choose i) /
        // (degree choose i).
        let falling = |n: usize, count: usize| (0..count).map(|i| n - i).product::<usize>();
        let mut signs = (0..=degree).map(|j| {
            let terms = (0..=j).map(|i| {
                let factor = falling(j, i) * falling(degree - i, degree - i);
                &powers[i] * IBig::from(factor)
            });
            Exact::sign(&terms.fold(IBig::ZERO, |sum, term| sum + term))
        });
        let first = signs.next().expect("not zero");
        (first != 0 && signs.all(|sign| sign == first)).then_some(first)
    }

    /// Divides by the common divisor of the coefficients.
    fn primitive(self) -> Self {
        // The last one first, since it is not zero.
        let magnitudes = self.0.iter().rev().map(UnsignedAbs::unsigned_abs);
        match magnitudes.reduce(Gcd::gcd) {
            None => self,
            Some(content) => {
                let content = IBig::from(content);
                Self(self.0.into_iter().map(|x| x / &content).collect())
            }
        }
    }

    /// Pseudo-division: quotient and remainder of this polynomial times a non-zero integer.
    fn divided(&self, divisor: &Self) -> [Self; 2] {
        let lead = divisor.0.last().expect("the divisor is not zero");
        let mut rest = self.clone();
        let mut quotient = vec![IBig::ZERO; (self.0.len() + 1).saturating_sub(divisor.0.len())];
        while rest.0.len() >= divisor.0.len() {
            let shift = rest.0.len() - divisor.0.len();
            let first = rest.0[rest.degree()].clone();
            for x in rest.0.iter_mut().chain(&mut quotient) {
                *x *= lead;
            }
            for (x, y) in rest.0[shift..].iter_mut().zip(&divisor.0) {
                *x -= &first * y;
            }
            quotient[shift] += first;
            rest = Self::new(rest.0);
        }
        [Self::new(quotient), rest]
    }

    /// Greatest common divisor up to a factor, by Euclid's algorithm. Its roots are the common
    /// roots.
    pub(super) fn gcd(&self, other: &Self) -> Self {
        let (mut a, mut b) = (self.clone().primitive(), other.clone().primitive());
        while !b.is_zero() {
            let [_, rest] = a.divided(&b);
            (a, b) = (b, rest.primitive());
        }
        a
    }

    /// Squarefree part up to a factor: the same roots, each once.
    ///
    /// Divides by what the polynomial and its derivative have in common.
    pub(super) fn squarefree(&self) -> Self {
        if self.degree() == 0 {
            return self.clone();
        }
        let [quotient, rest] = self.divided(&self.gcd(&self.derivative()));
        debug_assert!(rest.is_zero());
        quotient.primitive()
    }
}

impl Ring for Polynomial {
    fn minus(&self, other: &Self) -> Self {
        let length = self.0.len().max(other.0.len());
        let of = |it: &Self, i| it.0.get(i).cloned().unwrap_or(IBig::ZERO);
        Self::new((0..length).map(|i| of(self, i) - of(other, i)).collect())
    }
    fn plus(&self, other: &Self) -> Self {
        let length = self.0.len().max(other.0.len());
        let of = |it: &Self, i| it.0.get(i).cloned().unwrap_or(IBig::ZERO);
        Self::new((0..length).map(|i| of(self, i) + of(other, i)).collect())
    }
    fn times(&self, other: &Self) -> Self {
        let mut product = vec![IBig::ZERO; self.0.len() + other.0.len()];
        for (i, x) in self.0.iter().enumerate() {
            for (j, y) in other.0.iter().enumerate() {
                product[i + j] += x * y;
            }
        }
        Self::new(product)
    }
}
