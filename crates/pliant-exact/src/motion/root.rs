//! Roots of polynomials in (0, 1], in order, and signs of other polynomials there: all exact.
//!
//! A root is a fraction, or alone in an open interval between two fractions of two (`sturm`). Its
//! polynomial has no multiple roots, and opposite signs at the ends. The sign of another polynomial
//! at a root is mostly known from floating point, with a bound. Where it is not, as where it is
//! zero, quotients and remainders tell it, however near other roots are. So the work is bounded.

use super::super::float::{power, sign_beyond};
use super::super::integer::{Integer, in_proportion};
use super::fraction::{Denominator, Dyadic, Fraction, Quotient, Twos};
use super::polynomial::Polynomial;
use super::sturm::Sturm;
use std::cmp::Ordering;
use std::ops::ControlFlow;

/// A root.
#[derive(Clone, Debug)]
#[expect(
    clippy::large_enum_variant,
    reason = "there are three at most at a time, and memory for each would be allocated"
)]
pub(super) enum Root {
    At(Fraction),
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

/// Bits of a fraction that are known: it is off by less than 2^-48 of itself.
const KNOWN_BITS: usize = 48;

/// Intervals of roots are narrowed to 2^-32 at least before floating point is asked for signs.
const NARROW: f64 = power(-32);

/// A receiver of roots, which says when one is enough.
pub(super) type Found<'f> = &'f mut dyn FnMut(Root) -> ControlFlow<()>;

/// Shows the roots in (0, 1] of a polynomial, each once, in order, until one is enough; of zero
/// none.
pub(super) fn visit_roots(polynomial: &Polynomial, found: Found) -> ControlFlow<()> {
    let [zero, one] = [0.0, 1.0].map(Dyadic::new);
    let mut others = polynomial.clone();
    for end in [&zero, &one] {
        while !others.is_constant() && others.sign_at(end) == 0 {
            others = others.without_root(end);
        }
    }
    visit_between(&others, zero, one.clone(), found)?;
    if !polynomial.is_zero() && polynomial.sign_at(&one) == 0 {
        found(Root::At(one.into()))?;
    }
    ControlFlow::Continue(())
}

/// The roots of a polynomial between two times, neither of which is one.
fn visit_between(
    polynomial: &Polynomial,
    low: Dyadic,
    high: Dyadic,
    found: Found,
) -> ControlFlow<()> {
    let sturm = Sturm::new(polynomial);
    if let Some(fractions) = sturm.fractions() {
        let mut roots = Vec::from(fractions);
        roots.sort_by(Quotient::compare);
        roots.dedup();
        roots.retain(|root| *root > low && *root < high);
        return roots.into_iter().map(Root::At).try_for_each(found);
    }
    let mut cuts = Cuts::new(&sturm);
    // The later parts are below the earlier ones.
    let mut parts = vec![[low, high]];
    while let Some([low, high]) = parts.pop() {
        match sturm.roots_between(&low, &high) {
            0 => {}
            1 => found(Root::Between(Alone {
                sign_at_low: polynomial.sign_at(&low),
                polynomial: polynomial.clone(),
                low,
                high,
            }))?,
            _ => {
                let cut = cuts.next(&low, &high);
                if polynomial.sign_at(&cut) == 0 {
                    // Of a lower degree: this goes no deeper than there are roots.
                    let others = polynomial.without_root(&cut);
                    visit_between(&others, low, cut.clone(), found)?;
                    found(Root::At(cut.clone().into()))?;
                    visit_between(&others, cut, high, found)?;
                } else {
                    parts.push([cut.clone(), high]);
                    parts.push([low, cut]);
                }
            }
        }
    }
    ControlFlow::Continue(())
}

/// Where parts with several roots are cut.
///
/// That is in the middle, and close before and behind the place where roots are near each other, if
/// any are. The place is known twice as well with every 50 bits more of it. Halves alone would take
/// a step a bit, and there may be a thousand. As many are between 1 and roots that are tiny. So a
/// long part is cut at a power of two, too, in the middle of the powers that it holds.
struct Cuts {
    /// Place near which roots are near each other.
    of: Option<Fraction>,
    /// Approximation of that place. `error` bounds its distance from the exact one.
    about: Dyadic,
    error: Dyadic,
    turn: usize,
}

impl Cuts {
    fn new(sturm: &Sturm) -> Self {
        let [zero, one] = [0.0, 1.0].map(Dyadic::new);
        let of = sturm.affine().map(Polynomial::affine_root);
        Self {
            of: of.filter(|of| *of > zero && *of < one),
            about: zero.clone(),
            error: zero,
            turn: 0,
        }
    }

    /// Where the next part is cut.
    fn next(&mut self, low: &Dyadic, high: &Dyadic) -> Dyadic {
        self.turn += 1;
        let close = self.of.as_ref().and_then(|of| match self.turn % 3 {
            0 => {
                let correction = of.minus(&self.about);
                self.about = self.about.plus(&correction);
                self.error = correction.magnitude_over(KNOWN_BITS);
                Some(self.about.minus(&self.error))
            }
            1 if self.turn > 1 => Some(self.about.plus(&self.error)),
            _ => None,
        });
        let power = || match self.turn % 3 {
            2 if self.turn > 8 => middle_power(low, high),
            _ => None,
        };
        close
            .or_else(power)
            .filter(|cut| cut > low && cut < high)
            .unwrap_or_else(|| low.middle(high))
    }
}

/// The power of two in the middle of those between two times, if these are far apart; behind 0
/// there are many.
fn middle_power(low: &Dyadic, high: &Dyadic) -> Option<Dyadic> {
    const FAR: i32 = 32;
    let highest = high.power();
    let lowest = low.power().unwrap_or(4 * highest? - 2 * FAR);
    let power = highest?.midpoint(lowest);
    (highest? > lowest + FAR).then(|| Dyadic {
        over: Integer::from(1),
        under: Twos(power.min(0).unsigned_abs() as usize),
    })
}

impl Root {
    /// Narrows the interval until floating point has a use for it.
    pub(super) fn narrow(&mut self) {
        if let Self::Between(alone) = self
            && let ControlFlow::Break(at) = alone.narrow()
        {
            *self = Self::At(at.into());
        }
    }

    /// Whether the root is at most this number, which is from 0 to 1.
    pub(super) fn is_at_most(&self, x: f64) -> bool {
        let t = Dyadic::new(x);
        match self {
            Self::At(at) => *at <= t,
            Self::Between(alone) => alone.compare(&t).is_le(),
        }
    }

    /// Two numbers from 0 to 1 that are nearly next to the root, on either side or at it.
    pub(super) fn about(&self) -> [f64; 2] {
        let [low, high] = self.approximately();
        [
            low * (1.0 - 4.0 * f64::EPSILON),
            (high * (1.0 + 4.0 * f64::EPSILON)).min(1.0),
        ]
    }

    /// The root, or the ends of its interval: each off by 2^-50 of itself.
    fn approximately(&self) -> [f64; 2] {
        match self {
            Self::At(at) => [at.approximately(); 2],
            Self::Between(alone) => alone.approximately(),
        }
    }

    /// The sign of another polynomial at the root.
    pub(super) fn sign_of(&self, other: &Polynomial) -> i8 {
        match self {
            Self::At(at) => {
                certain_sign(other, self.approximately()).unwrap_or_else(|| other.sign_at(at))
            }
            Self::Between(alone) => alone.sign_of(other),
        }
    }

    pub(super) fn compare(&self, other: &Self) -> Ordering {
        match (self, other) {
            (Self::At(a), Self::At(b)) => a.compare(b),
            (Self::Between(a), Self::At(b)) => a.compare(b),
            (Self::At(a), Self::Between(b)) => b.compare(a).reverse(),
            (Self::Between(a), Self::Between(b)) => a.compare_with(b),
        }
    }
}

impl Alone {
    /// The root compared with a time.
    fn compare<U: Denominator>(&self, t: &Quotient<U>) -> Ordering {
        if *t <= self.low {
            Ordering::Greater
        } else if *t >= self.high {
            Ordering::Less
        } else {
            self.side(self.polynomial.sign_at(t))
        }
    }

    /// Where the root is from a time in its interval at which its polynomial has this sign.
    fn side(&self, sign: i8) -> Ordering {
        match sign {
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
        other.side(self.exact_sign_of(&other.polynomial)).reverse()
    }

    fn approximately(&self) -> [f64; 2] {
        [&self.low, &self.high].map(Dyadic::approximately)
    }

    fn width(&self) -> f64 {
        let [low, high] = self.approximately();
        high - low
    }

    /// Narrows the interval; ends with the root if it is a fraction that was met.
    fn narrow(&mut self) -> ControlFlow<Dyadic> {
        if self.width() <= NARROW {
            return ControlFlow::Continue(());
        }
        let guess = self.guess();
        for x in [guess - NARROW / 4.0, guess + NARROW / 4.0] {
            if x > 0.0 && x < 1.0 {
                self.cut(Dyadic::new(x))?;
            }
        }
        while self.width() > NARROW {
            self.cut(self.low.middle(&self.high))?;
        }
        ControlFlow::Continue(())
    }

    /// Keeps the side of a time on which the root is; or ends with the time, if it is the root.
    fn cut(&mut self, at: Dyadic) -> ControlFlow<Dyadic> {
        match self.compare(&at) {
            Ordering::Equal => return ControlFlow::Break(at),
            Ordering::Less if at < self.high => self.high = at,
            Ordering::Greater if at > self.low => self.low = at,
            // It is no time in the interval.
            _ => {}
        }
        ControlFlow::Continue(())
    }

    /// About where the root is, by bisection in floating point.
    fn guess(&self) -> f64 {
        let coefficients = in_proportion(&self.polynomial.0);
        let [mut low, mut high] = self.approximately();
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

    fn sign_of(&self, other: &Polynomial) -> i8 {
        certain_sign(other, self.approximately()).unwrap_or_else(|| self.exact_sign_of(other))
    }

    /// The sign, by division: m p = q g + r, where m is positive, and q and r are of lower degrees
    /// than g. So g is -r / q at a root of p.
    fn exact_sign_of(&self, other: &Polynomial) -> i8 {
        if other.degree() >= self.polynomial.degree() {
            let [_, rest] = other.divided(&self.polynomial);
            return self.exact_sign_of(&rest);
        }
        match other.degree() {
            0 => other.sign_at_zero(),
            1 => self.exact_sign_of_affine(other),
            _ => {
                let [quotient, rest] = self.polynomial.divided(other);
                let [by, of] = [&quotient, &rest].map(|affine| self.sign_of(affine));
                if by == 0 {
                    other.sign_at(&quotient.affine_root())
                } else {
                    -of * by
                }
            }
        }
    }

    /// The sign of what is affine, and not constant: it has a root, and that is on a side of this
    /// one.
    fn exact_sign_of_affine(&self, affine: &Polynomial) -> i8 {
        let [_, slope, ..] = &affine.0;
        self.compare(&affine.affine_root()) as i8 * slope.sign()
    }
}

/// The sign of a polynomial at a root, or in an interval round it, if floating point is certain of
/// it.
///
/// Let S be the sum of the magnitudes of the coefficients, each of which has an error of 2^-51 of
/// itself. Horner's rule with t from 0 to 1 rounds twice for each power, up to the third. Each time
/// it rounds a number of at most S: both are less than 2^-49 S. Let w be the width that is
/// computed. The root is within w / 2 + 2^-50 of the middle, and there the value changes by at most
/// 3 S times that. In all that is less than (2 w + 2^-47) S. Twice that is allowed for, with what
/// this line itself rounds.
fn certain_sign(other: &Polynomial, [low, high]: [f64; 2]) -> Option<i8> {
    if other.is_constant() {
        return Some(other.sign_at_zero());
    }
    let coefficients = in_proportion(&other.0);
    let sum: f64 = coefficients.iter().map(|c| c.abs()).sum();
    let error = sum * (4.0 * (high - low) + power(-46));
    let value = value_at(&coefficients, 0.5 * (low + high));
    Some(sign_beyond(value, error)).filter(|&sign| sign != 0)
}

/// By Horner's rule.
fn value_at(coefficients: &[f64; 4], t: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, &c| sum * t + c)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ring::Ring;
    use pliant_oracle::Random;

    fn integer(x: i64) -> Integer {
        let magnitude = Integer::from(x.unsigned_abs());
        if x < 0 {
            magnitude.negated()
        } else {
            magnitude
        }
    }

    /// A positive multiple of t - root.
    fn factor(root: &Fraction) -> Polynomial {
        Polynomial::new([root.over.clone().negated(), root.under.clone()])
    }

    fn product(factors: &[Polynomial]) -> Polynomial {
        let one = Polynomial::new([Integer::from(1), Integer::ZERO]);
        factors
            .iter()
            .fold(one, |product, factor| product.times(factor))
    }

    fn roots_of(polynomial: &Polynomial) -> Vec<Root> {
        let mut roots = Vec::new();
        let _ = visit_roots(polynomial, &mut |root| {
            roots.push(root);
            ControlFlow::Continue(())
        });
        roots
    }

    fn sign(ordering: Ordering) -> i8 {
        ordering as i8
    }

    /// A fraction that is mostly from 0 to 1, and often an end, or near or at another.
    fn fraction(random: &mut Random, others: &[Fraction]) -> Fraction {
        let under = 1 + random.below(50);
        let over = i64::from(random.below(under + 4)) - 2;
        let Some(other) = others.last().filter(|_| random.below(2) == 0) else {
            return Fraction::new(integer(over), integer(under.into()));
        };
        // By so little as only a thousand bits tell.
        let twos = [0, 20, 60, 500, 1100][random.below(5) as usize];
        let by = integer(random.below(3) as i64 - 1);
        let over = other.over.shifted(twos).plus(&by.times(&other.under));
        Fraction::new(over, other.under.shifted(twos))
    }

    #[test]
    fn fractions_are_found_in_order_and_signs_there() {
        let mut random = Random::new(11);
        let mut found = [0; 4];
        for _ in 0..4000 {
            let degree = 1 + random.below(3) as usize;
            let mut expected: Vec<Fraction> = Vec::new();
            for _ in 0..degree {
                expected.push(fraction(&mut random, &expected));
            }
            let factors: Vec<Polynomial> = expected.iter().map(factor).collect();
            let mut polynomial = product(&factors);
            if random.below(2) == 0 {
                polynomial = polynomial.negated();
            }
            let any = fraction(&mut random, &expected);
            expected.sort_by(Quotient::compare);
            expected.dedup();
            let [zero, one] = [0.0, 1.0].map(|x| Fraction::from(Dyadic::new(x)));
            expected.retain(|root| *root > zero && *root <= one);

            let mut roots = roots_of(&polynomial);
            assert_eq!(roots.len(), expected.len(), "{polynomial:?}");
            for round in 0..2 {
                for (root, expected) in roots.iter().zip(&expected) {
                    let at = Root::At(expected.clone());
                    assert_eq!(root.compare(&at), Ordering::Equal, "{polynomial:?} {round}");
                    let side = root.compare(&Root::At(any.clone()));
                    assert_eq!(side, expected.compare(&any));
                    assert_eq!(root.sign_of(&factor(&any)), sign(side));
                    // Of degrees 2 and 3, which may have the root themselves.
                    let three = [any.clone(), expected.clone(), one.clone()];
                    let three = three.each_ref().map(factor);
                    assert_eq!(root.sign_of(&product(&three[..2])), 0);
                    assert_eq!(root.sign_of(&product(&three)), 0);
                    let square = product(&[factor(&any), factor(&any)]);
                    assert_eq!(root.sign_of(&square), sign(side).abs());
                    let cube = product(&[square, factor(&one)]);
                    let before_one = sign(expected.compare(&one));
                    assert_eq!(root.sign_of(&cube), sign(side).abs() * before_one);
                }
                roots.iter_mut().for_each(Root::narrow);
            }
            found[roots.len()] += 1;
        }
        assert!(found.iter().all(|&times| times > 200), "{found:?}");
    }

    /// Roots of m t^2 - n, and the signs of what is zero there, or nearly so.
    /// However many powers of two are between them and 1, and each other.
    #[test]
    fn tiny_roots_are_told_apart_by_few_cuts() {
        let at = |over: u64, twos: usize| {
            Fraction::new(Integer::from(over), Integer::from(1).shifted(twos))
        };
        for twos in [2, 40, 300, 1190, 2300] {
            for others in [[5, 7], [3, 1 << 20], [4, 1 << 40]] {
                let expected = [
                    at(1, twos),
                    at(others[0], twos + 1),
                    at(others[1], twos + 42),
                ];
                let mut expected = expected.to_vec();
                expected.sort_by(Quotient::compare);
                let factors: Vec<_> = expected.iter().map(factor).collect();
                let polynomial = product(&factors);
                let roots = roots_of(&polynomial);
                assert_eq!(roots.len(), 3);
                for (root, expected) in roots.iter().zip(expected) {
                    assert_eq!(root.compare(&Root::At(expected)), Ordering::Equal);
                }
                // As roots are looked for: parts with two or three of them are cut.
                let sturm = Sturm::new(&polynomial);
                let (mut cuts, mut parts) = (Cuts::new(&sturm), vec![[0.0, 1.0].map(Dyadic::new)]);
                while let Some([low, high]) = parts.pop() {
                    if sturm.roots_between(&low, &high) > 1 {
                        let cut = cuts.next(&low, &high);
                        parts.extend([[cut.clone(), high], [low, cut]]);
                    }
                }
                assert!(cuts.turn < 250, "{twos} {others:?}: {}", cuts.turn);
            }
        }
    }

    #[test]
    fn roots_that_are_no_fractions() {
        let mut random = Random::new(12);
        for _ in 0..2000 {
            let mut below = |end: i64| (random.bits() >> 1) as i64 % end;
            let m = 2 + below(1 << 20);
            let n = 1 + below(m - 1);
            let [u, many] = [1 + below(1 << 40), below(1 << 60)];
            let [zero, one] = [Integer::ZERO, Integer::from(1)];
            let t = Polynomial::new([zero.clone(), one]);
            let constant = |x: i64| Polynomial::new([integer(x), Integer::ZERO]);
            let square = product(&[constant(m), t.clone(), t.clone()]).plus(&constant(-n));
            let other = factor(&fraction(&mut random, &[]));
            let find = |polynomial: &Polynomial| {
                let mut roots = roots_of(polynomial).into_iter();
                roots.find(|root| root.sign_of(&square) == 0).unwrap()
            };
            let roots = [find(&square), find(&product(&[square.clone(), other]))];
            assert_eq!(roots[0].compare(&roots[1]), Ordering::Equal);
            // The sign of u t - v, as near to zero as there is one with this u.
            let v = ((n as f64 / m as f64).sqrt() * u as f64).round() as i64;
            let of = |[a, b]: [i64; 2]| i128::from(a) * i128::from(b).pow(2);
            let expected = sign(of([n, u]).cmp(&of([m, v])));
            let affine = product(&[constant(u), t]).plus(&constant(-v));
            let near = product(&[constant(many), square.clone()]).plus(&affine);
            for root in &roots {
                assert_eq!(root.sign_of(&affine), expected, "{m} {n} {u} {v}");
                assert_eq!(root.sign_of(&near), expected, "{m} {n} {u} {v}");
            }
        }
    }
}
