//! How many roots a polynomial has in an interval: its sequence of Sturm.
//!
//! Each further polynomial is a positive multiple of the negative remainder of the two before it,
//! from the polynomial and its derivative on. Between two times that are no roots the sequence
//! loses as many changes of sign as there are roots, each counted once. Here the degree is 3 at
//! most, and the last number is known by its sign alone. Where that is zero, there are multiple
//! roots; then all roots are fractions.

use super::super::integer::Integer;
use super::super::ring::Ring;
use super::fraction::{Dyadic, Fraction};
use super::polynomial::Polynomial;

/// Sturm sequence of a polynomial.
///
/// Let s be the sign of a in a t^3 + b t^2 + c t + d. The third is s (2 (b^2 - 3 a c) t + b c - 9 a
/// d): the remainder times -9 |a|. What comes after one of degree 1 is a number, of which the sign
/// is enough. Its sign is opposite to the quadratic's at the root of the linear one, and zero if
/// the polynomial has multiple roots.
///
/// Then all its roots are fractions. A double root is the root of the one of degree 1, and all
/// roots add up to -b / a. A triple root is -b / (3 a). A polynomial of degree 1 is itself the one
/// of degree 1: its root is a fraction too.
#[derive(Clone, Debug)]
pub(super) struct Sturm {
    /// The polynomial, its derivative, and of a cube the third, which may be zero.
    polynomials: [Polynomial; 3],
    /// The sign of the number after the one of degree 1; 0 if there is none.
    last: i8,
}

impl Sturm {
    pub(super) fn new(polynomial: &Polynomial) -> Self {
        let third = match polynomial.coefficients() {
            [d, c, b, a] => {
                let [three, nine] = [3, 9].map(Integer::from);
                let of_t = b.times(b).minus(&a.times(c).times(&three)).shifted(1);
                let of_one = b.times(c).minus(&a.times(d).times(&nine));
                let third = Polynomial::new([of_one, of_t]);
                if a.sign() < 0 { third.negated() } else { third }
            }
            _ => Polynomial::ZERO,
        };
        let polynomials = [polynomial.clone(), polynomial.derivative(), third];
        let affine = polynomials.iter().position(|it| it.degree() == 1);
        let last = match affine {
            Some(place @ 1..) => -polynomials[place - 1].sign_at(&polynomials[place].affine_root()),
            _ => 0,
        };
        Self { polynomials, last }
    }

    /// The one of degree 1, if there is one. Between two roots that are near each other, and far
    /// from a third, it has its own.
    pub(super) fn affine(&self) -> Option<&Polynomial> {
        self.polynomials.iter().find(|it| it.degree() == 1)
    }

    /// All roots, in any order, if one of them is a multiple one, or the degree is 1.
    pub(super) fn fractions(&self) -> Option<[Fraction; 2]> {
        let [polynomial, derivative, third] = &self.polynomials;
        let is_cube = polynomial.degree() == 3;
        if self.last != 0 || is_cube && third.is_constant() && !third.is_zero() {
            return None;
        }
        if is_cube && third.is_zero() {
            let of_all = derivative.derivative().affine_root();
            return Some([of_all.clone(), of_all]);
        }
        let twice = self.affine().map(Polynomial::affine_root)?;
        let [_, _, b, a] = polynomial.coefficients() else {
            return Some([twice.clone(), twice]);
        };
        let over = b.times(&twice.under).plus(&a.times(&twice.over).shifted(1));
        let once = Fraction::new(over.negated(), a.times(&twice.under));
        Some([twice, once])
    }

    /// How often the sign changes along the sequence at a time.
    fn changes_at(&self, t: &Dyadic) -> i32 {
        let signs = self.polynomials.iter().map(|it| it.sign_at(t));
        let mut signs = signs.chain([self.last]).filter(|&sign| sign != 0);
        let mut before = signs.next();
        let is_change = |sign| before.replace(sign) != Some(sign);
        signs.map(is_change).map(i32::from).sum()
    }

    /// How many roots are between two times that are none. There are no multiple ones.
    pub(super) fn roots_between(&self, low: &Dyadic, high: &Dyadic) -> i32 {
        self.changes_at(low) - self.changes_at(high)
    }
}
