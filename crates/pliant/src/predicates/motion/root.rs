//! Roots of polynomials in (0, 1], in order, and signs of other polynomials there: all exact, with no number that is rounded in an answer.
//!
//! A root is a fraction of two, or alone in an open interval between two such at which its polynomial, which has no multiple roots, has
//! opposite signs. The sign of another polynomial at it is mostly known from floating point, with a bound; where it is not, as where it is
//! zero, from a sequence of signed remainders, however near other roots are. So the work is bounded.

use super::super::integer::Integer;
use super::polynomial::{Dyadic, Polynomial, SignedRemainders};
use std::cmp::Ordering;
use std::ops::ControlFlow;

/// A root.
#[derive(Clone, Debug)]
#[expect(
    clippy::large_enum_variant,
    reason = "there are three at most at a time, and memory for each would be allocated"
)]
pub(super) enum Root {
    At(Dyadic),
    Between(Alone),
}

/// A root alone in an open interval, at whose ends the polynomial has opposite signs.
#[derive(Clone, Debug)]
pub(super) struct Alone {
    polynomial: Polynomial,
    low: Dyadic,
    high: Dyadic,
    sign_at_low: i8,
}

/// Intervals of roots are narrowed to 2^-32 at least before floating point is asked for signs.
const NARROW: f64 = f64::from_bits((1023 - 32) << 52);

/// Shows the roots in (0, 1] of a polynomial that is not zero, each once, in order, until one is enough.
pub(super) fn visit_roots<B>(
    polynomial: &Polynomial,
    found: &mut dyn FnMut(Root) -> ControlFlow<B>,
) -> ControlFlow<B> {
    if polynomial.is_constant() {
        return ControlFlow::Continue(());
    }
    let chain = SignedRemainders::new(polynomial, polynomial.derivative());
    let [zero, one] = [Dyadic::zero(), Dyadic::one()];
    let is_one = polynomial.sign_at(&one) == 0;
    let is_zero = polynomial.sign_at_zero() == 0;
    let is_simple = chain.common_divisor().is_constant();
    if is_simple && !is_zero && !is_one {
        return visit_counted(&chain, polynomial, zero, one, found);
    }
    let mut simple = if is_simple {
        polynomial.clone()
    } else {
        polynomial.quotient(chain.common_divisor())
    };
    if is_zero {
        simple = simple.without_root(&zero);
    }
    if is_one {
        simple = simple.without_root(&one);
    }
    visit_between(&simple, zero, one.clone(), found)?;
    if is_one {
        found(Root::At(one))
    } else {
        ControlFlow::Continue(())
    }
}

/// Those between two times that are no roots; the polynomial has no multiple ones.
fn visit_between<B>(
    polynomial: &Polynomial,
    low: Dyadic,
    high: Dyadic,
    found: &mut dyn FnMut(Root) -> ControlFlow<B>,
) -> ControlFlow<B> {
    if polynomial.is_constant() {
        return ControlFlow::Continue(());
    }
    let chain = SignedRemainders::new(polynomial, polynomial.derivative());
    visit_counted(&chain, polynomial, low, high, found)
}

/// The same, of a polynomial whose chain of signed remainders with its derivative is known.
fn visit_counted<B>(
    chain: &SignedRemainders,
    polynomial: &Polynomial,
    low: Dyadic,
    high: Dyadic,
    found: &mut dyn FnMut(Root) -> ControlFlow<B>,
) -> ControlFlow<B> {
    // The later parts are below the earlier ones.
    let mut parts = vec![[low, high]];
    while let Some([low, high]) = parts.pop() {
        match chain.lost(&low, &high) {
            0 => {}
            1 => found(Root::Between(Alone {
                sign_at_low: polynomial.sign_at(&low),
                polynomial: polynomial.clone(),
                low,
                high,
            }))?,
            _ => {
                let middle = low.middle(&high);
                if polynomial.sign_at(&middle) == 0 {
                    // Of a lower degree: this goes no deeper than there are roots.
                    let others = polynomial.without_root(&middle);
                    visit_between(&others, low, middle.clone(), found)?;
                    found(Root::At(middle.clone()))?;
                    visit_between(&others, middle, high, found)?;
                } else {
                    parts.push([middle.clone(), high]);
                    parts.push([low, middle]);
                }
            }
        }
    }
    ControlFlow::Continue(())
}

impl Root {
    /// Narrows the interval until floating point has a use for it.
    pub(super) fn narrow(&mut self) {
        if let Self::Between(alone) = self
            && let Some(at) = alone.narrow()
        {
            *self = Self::At(at);
        }
    }

    /// Whether the root is at most this number, which is from 0 to 1.
    pub(super) fn is_at_most(&self, x: f64) -> bool {
        let t = Dyadic::new(x);
        match self {
            Self::At(at) => *at <= t,
            Self::Between(alone) => alone.compare(&t) != Ordering::Greater,
        }
    }

    /// Two numbers from 0 to 1 that are nearly next to the root, on either side or at it.
    pub(super) fn about(&self) -> [f64; 2] {
        let [low, high] = match self {
            Self::At(at) => [at, at],
            Self::Between(alone) => [&alone.low, &alone.high],
        };
        let [low, high] = [low, high].map(Dyadic::approximately);
        [
            low * (1.0 - 4.0 * f64::EPSILON),
            (high * (1.0 + 4.0 * f64::EPSILON)).min(1.0),
        ]
    }

    /// The sign of another polynomial at the root.
    pub(super) fn sign_of(&self, other: &Polynomial) -> i8 {
        match self {
            Self::At(at) => other.sign_at(at),
            Self::Between(_) if other.is_constant() => other.sign_at_zero(),
            Self::Between(alone) => alone
                .certain_sign_of(other)
                .unwrap_or_else(|| alone.exact_sign_of(other)),
        }
    }

    pub(super) fn compare(&self, other: &Self) -> Ordering {
        match (self, other) {
            (Self::At(a), Self::At(b)) => a.cmp(b),
            (Self::Between(a), Self::At(b)) => a.compare(b),
            (Self::At(a), Self::Between(b)) => b.compare(a).reverse(),
            (Self::Between(a), Self::Between(b)) => a.compare_with(b),
        }
    }
}

impl Alone {
    /// The root compared with a time.
    fn compare(&self, t: &Dyadic) -> Ordering {
        if *t <= self.low {
            return Ordering::Greater;
        }
        if *t >= self.high {
            return Ordering::Less;
        }
        match self.polynomial.sign_at(t) {
            0 => Ordering::Equal,
            sign if sign == self.sign_at_low => Ordering::Greater,
            _ => Ordering::Less,
        }
    }

    fn compare_with(&self, other: &Self) -> Ordering {
        // Beyond the interval of the other they are on different sides of an end of it.
        for end in [&other.low, &other.high] {
            let of_self = self.compare(end);
            let of_other = other.compare(end);
            if of_self != of_other {
                return of_self.cmp(&of_other);
            }
        }
        // In there the polynomial of the other has no other root.
        match self.exact_sign_of(&other.polynomial) {
            0 => Ordering::Equal,
            sign if sign == other.sign_at_low => Ordering::Less,
            _ => Ordering::Greater,
        }
    }

    fn width(&self) -> f64 {
        self.high.approximately() - self.low.approximately()
    }

    /// Narrows the interval; returns the root if it is a fraction that was met.
    fn narrow(&mut self) -> Option<Dyadic> {
        if self.width() <= NARROW {
            return None;
        }
        let guess = self.guess();
        for x in [guess - NARROW / 4.0, guess + NARROW / 4.0] {
            if x > 0.0 && x < 1.0 {
                let at = self.cut(Dyadic::new(x));
                if at.is_some() {
                    return at;
                }
            }
        }
        while self.width() > NARROW {
            let at = self.cut(self.low.middle(&self.high));
            if at.is_some() {
                return at;
            }
        }
        None
    }

    /// Keeps the side of a time on which the root is; or returns the time, if it is the root.
    fn cut(&mut self, at: Dyadic) -> Option<Dyadic> {
        if at <= self.low || at >= self.high {
            return None;
        }
        match self.compare(&at) {
            Ordering::Equal => return Some(at),
            Ordering::Less => self.high = at,
            Ordering::Greater => self.low = at,
        }
        None
    }

    /// About where the root is, by bisection in floating point.
    fn guess(&self) -> f64 {
        let coefficients = scaled(&self.polynomial);
        let [mut low, mut high] = [&self.low, &self.high].map(Dyadic::approximately);
        for _ in 0..48 {
            let middle = 0.5 * (low + high);
            let value = value_at(&coefficients, middle);
            if (value < 0.0) == (self.sign_at_low < 0) {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }

    /// The sign, if floating point is certain of it.
    ///
    /// Let S be the sum of the magnitudes of the coefficients, each of which has an error of 2^-51 of itself. Horner's rule with t from 0
    /// to 1 rounds twice for each power, up to the third, each time a number of at most S: both are less than 2^-49 S. The root is within w
    /// / 2 + 2^-51 of the middle, where w is the width that is computed, and there the value changes by at most 3 S times that. In all less
    /// than (2 w + 2^-48) S; twice that is allowed for, with what this line itself rounds.
    fn certain_sign_of(&self, other: &Polynomial) -> Option<i8> {
        let coefficients = scaled(other);
        let [low, high] = [&self.low, &self.high].map(Dyadic::approximately);
        let sum: f64 = coefficients.iter().map(|c| c.abs()).sum();
        let error = sum * (4.0 * (high - low) + f64::from_bits((1023 - 47) << 52));
        let value = value_at(&coefficients, 0.5 * (low + high));
        (value.abs() > error).then_some(if value < 0.0 { -1 } else { 1 })
    }

    /// The sign, by signed remainders.
    fn exact_sign_of(&self, other: &Polynomial) -> i8 {
        let of_other = if other.degree() < self.polynomial.degree() {
            other.clone()
        } else {
            other.remainder(&self.polynomial)
        };
        let product = self.polynomial.derivative().times(&of_other);
        let second = product.remainder(&self.polynomial);
        let chain = SignedRemainders::new(&self.polynomial, second);
        chain.lost(&self.low, &self.high) as i8
    }
}

/// The coefficients, divided by one power of two, so that the largest is about 1.
fn scaled(polynomial: &Polynomial) -> [f64; 5] {
    let parts = polynomial.coefficients().iter().map(Integer::approximately);
    let largest = parts
        .clone()
        .filter(|(m, _)| *m != 0.0)
        .map(|(_, e)| e)
        .max();
    let mut scaled = [0.0; 5];
    for (value, (m, e)) in scaled.iter_mut().zip(parts) {
        let e = e - largest.unwrap_or(0);
        // What is smaller is lost in the error.
        if e > -1000 {
            *value = m * f64::powi(2.0, e);
        }
    }
    scaled
}

fn value_at(coefficients: &[f64; 5], t: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, &c| sum * t + c)
}
