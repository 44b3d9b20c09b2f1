//! Numbers in [0, 1] that are roots of polynomials: all roots of one, and the sign of another at any of them.

use super::polynomial::Polynomial;
use crate::integers::Exact;
use dashu_int::IBig;
use std::cmp::Ordering;

/// A root of a polynomial, by itself in an interval of fractions whose denominator is a power of two.
#[derive(Clone, Debug)]
pub(super) struct Root {
    /// Has no root twice, and where low < high none at low and high, and one between.
    of: Polynomial,
    low: IBig,
    high: IBig,
    /// Of the denominator 2^bits.
    bits: usize,
    /// The interval is divided into 2^steps the next time.
    steps: usize,
}

impl Root {
    /// An integer.
    pub(super) fn whole(n: u8) -> Self {
        Self {
            of: Polynomial::new(vec![-IBig::from(n), IBig::ONE]),
            low: n.into(),
            high: n.into(),
            bits: 0,
            steps: 1,
        }
    }

    fn is_known(&self) -> bool {
        self.low == self.high
    }

    /// All roots in [0, 1], in order, each once.
    ///
    /// Between two neighbouring roots of its derivative, and 0 and 1, a polynomial rises or falls all the way. So there is one root between
    /// if and only if the signs at both are opposite; and a root of both was divided out.
    pub(super) fn all(of: &Polynomial) -> Vec<Self> {
        if of.degree() == 0 || of.sign_on(&IBig::ZERO, &IBig::ONE, 0).is_some() {
            return Vec::new();
        }
        let of = of.squarefree();
        let mut roots = Vec::new();
        let mut before: Option<(Self, i8)> = None;
        let turns = Self::all(&of.derivative());
        let ends = [Self::whole(0), Self::whole(1)];
        let [zero, one] = ends;
        for mut cut in [zero].into_iter().chain(turns).chain([one]) {
            // If it is not zero, then it is the sign of all from cut.low to cut.high.
            let sign = cut.sign_of(&of);
            if let Some((before, sign_before)) = before
                && sign * sign_before < 0
            {
                let bits = before.bits.max(cut.bits);
                roots.push(Self {
                    low: before.high << (bits - before.bits),
                    high: &cut.low << (bits - cut.bits),
                    of: of.clone(),
                    bits,
                    steps: 1,
                });
            }
            if sign == 0 {
                // This is 0 or 1: at a turn it would be a root twice.
                roots.push(cut.clone());
            }
            before = Some((cut, sign));
        }
        roots
    }

    /// The sign of a polynomial at this number.
    pub(super) fn sign_of(&mut self, other: &Polynomial) -> i8 {
        /// In how short an interval, as a fraction of one of the same form, to ask whether it is zero: that takes longer than to see in a short
        /// interval that it is not.
        const SHORT: usize = 24;
        if other.degree() == 0 {
            return other.sign_of_constant();
        }
        let mut is_other = false;
        loop {
            if self.is_known() {
                return other.sign_at(&self.low, self.bits);
            }
            if let Some(sign) = other.sign_on(&self.low, &self.high, self.bits) {
                return sign;
            }
            if !is_other && self.bits >= SHORT {
                // A common root in the interval can only be this number. It is a root once, and the ends are none.
                let common = self.of.gcd(other);
                let sign_at = |n| common.sign_at(n, self.bits);
                if common.degree() > 0 && sign_at(&self.low) != sign_at(&self.high) {
                    return 0;
                }
                is_other = true;
            }
            self.refine();
        }
    }

    /// Makes the interval shorter: by half, or by much more once it is short enough that the polynomial is almost a line in it.
    ///
    /// The interval is divided into 2^steps, and of these the one taken where a straight line from end to end has its zero (Abbott
    /// 2014, quadratic interval refinement). If the root is there, the next division is finer, else coarser; what is kept is what
    /// has opposite signs at its ends, in any case.
    fn refine(&mut self) {
        let steps = self.steps;
        let (below, above) = (
            self.of.at(&self.low, self.bits),
            self.of.at(&self.high, self.bits),
        );
        let sign_below = Exact::sign(&below);
        let part = &self.high - &self.low;
        self.bits += steps;
        self.low <<= steps;
        self.high <<= steps;
        let index = (&below << steps) / (&below - above);
        let last = (IBig::ONE << steps) - IBig::ONE;
        let from = &self.low + &part * index.min(last);
        let to = &from + &part;
        self.steps = 2 * steps;
        match self.of.sign_at(&from, self.bits) * sign_below {
            0 => (self.low, self.high) = (from.clone(), from),
            -1 => {
                self.high = from;
                self.steps = (steps / 2).max(1);
            }
            _ => match self.of.sign_at(&to, self.bits) * sign_below {
                0 => (self.low, self.high) = (to.clone(), to),
                -1 => (self.low, self.high) = (from, to),
                _ => {
                    self.low = to;
                    self.steps = (steps / 2).max(1);
                }
            },
        }
    }

    /// Compares with n / 2^bits.
    pub(super) fn compare_with_fraction(&mut self, n: &IBig, bits: usize) -> Ordering {
        let less = Polynomial::new(vec![-n, IBig::ONE << bits]);
        self.sign_of(&less).cmp(&0)
    }

    /// Compares with another root.
    pub(super) fn compare(&mut self, other: &Self) -> Ordering {
        match (
            self.compare_with_fraction(&other.low, other.bits),
            self.compare_with_fraction(&other.high, other.bits),
        ) {
            // Between the ends the sign of the other's polynomial says on which side of its root this is.
            (Ordering::Greater, Ordering::Less) => {
                let here = self.sign_of(&other.of);
                let before = other.of.sign_at(&other.low, other.bits);
                (-here * before).cmp(&0)
            }
            (Ordering::Greater, _) => Ordering::Greater,
            (Ordering::Equal, Ordering::Equal) => Ordering::Equal,
            _ => Ordering::Less,
        }
    }
}
