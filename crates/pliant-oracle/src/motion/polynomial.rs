//! Polynomials of one variable with integer coefficients.

use crate::integers::{Exact, Ring};
use dashu_int::IBig;
use dashu_int::ops::{Gcd, UnsignedAbs};

/// The coefficients of 1, t, t^2, ...; the last one is not zero, and zero has none.
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

    /// That of zero is 0 too.
    pub(super) fn degree(&self) -> usize {
        self.0.len().saturating_sub(1)
    }

    /// The sign of the coefficient of 1, which is all of a polynomial of degree 0.
    pub(super) fn sign_of_constant(&self) -> i8 {
        self.0.first().map_or(0, Exact::sign)
    }

    pub(super) fn derivative(&self) -> Self {
        let terms = self.0.iter().enumerate().skip(1);
        Self::new(terms.map(|(i, x)| x * IBig::from(i)).collect())
    }

    /// The value at n / 2^bits, times 2^(bits * degree), which does not change its sign.
    pub(super) fn at(&self, n: &IBig, bits: usize) -> IBig {
        let mut terms = self.0.iter().rev().enumerate();
        let lead = terms.next().map_or(IBig::ZERO, |(_, lead)| lead.clone());
        terms.fold(lead, |sum, (i, x)| sum * n + (x << (bits * i)))
    }

    /// The sign of the value at n / 2^bits.
    pub(super) fn sign_at(&self, n: &IBig, bits: usize) -> i8 {
        Exact::sign(&self.at(n, bits))
    }

    /// The sign that it has everywhere in [low, high] / 2^bits, ends included, if that can be seen.
    ///
    /// With t = low + (high - low) x the interval is that of x from 0 to 1, where a polynomial lies between the least and the largest of
    /// its coefficients in the basis of Bernstein. As the interval shrinks to a point, all of them tend to the value there; so the
    /// sign is seen sooner or later unless that value is zero.
    pub(super) fn sign_on(&self, low: &IBig, high: &IBig, bits: usize) -> Option<i8> {
        let Some(lead) = self.0.last() else {
            return Some(0);
        };
        let degree = self.degree();
        let width = high - low;
        // Coefficients of powers of x, by Horner's rule: times (low + width x), plus the next.
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
        // Bernstein's coefficient j, times degree!: the sum over i <= j of powers[i] (j choose i) / (degree choose i).
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

    /// Without the common divisor of its coefficients.
    fn primitive(self) -> Self {
        // The last one first, as it is not zero.
        let magnitudes = self.0.iter().rev().map(UnsignedAbs::unsigned_abs);
        match magnitudes.reduce(Gcd::gcd) {
            None => self,
            Some(content) => {
                let content = IBig::from(content);
                Self(self.0.into_iter().map(|x| x / &content).collect())
            }
        }
    }

    /// Quotient and remainder of its product with some integer other than zero.
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

    /// The greatest common divisor, up to a factor: its roots are those that both have, by Euclid.
    pub(super) fn gcd(&self, other: &Self) -> Self {
        let (mut a, mut b) = (self.clone().primitive(), other.clone().primitive());
        while !b.is_zero() {
            let [_, rest] = a.divided(&b);
            (a, b) = (b, rest.primitive());
        }
        a
    }

    /// The polynomial that has the same roots, each once, up to a factor: what is divided out is what it has in common with its derivative.
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
