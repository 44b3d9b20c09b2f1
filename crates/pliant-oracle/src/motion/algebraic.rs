//! Algebraic numbers in [0, 1]: isolation of a polynomial's roots, and signs of other polynomials
//! at them.

use super::polynomial::Polynomial;
use crate::integers::Exact;
use dashu_int::IBig;
use std::cmp::Ordering;

/// A root of a polynomial, isolated in an interval of fractions over a power of two.
#[derive(Clone, Debug)]
pub(super) struct Root {
    /// Polynomial without double roots. If low < high it has no root at either, and one between.
    of: Polynomial,
    low: IBig,
    high: IBig,
    /// Exponent of the denominator 2^bits.
    bits: usize,
    /// The next refinement divides the interval into 2^steps parts.
    steps: usize,
}

impl Root {
    /// The integer `n` as a root.
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
    /// Between neighbouring roots of its derivative, 0 and 1, a polynomial is monotonic. So there
    /// is a root between if and only if the signs at both are opposite. Common roots of both were
    /// divided out.
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
            // If the sign is not zero, it holds from cut.low to cut.high.
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
                // This is 0 or 1, since a root that is also a turn would be a double root.
                roots.push(cut.clone());
            }
            before = Some((cut, sign));
        }
        roots
    }

    /// Sign of a polynomial at this number.
    pub(super) fn sign_of(&mut self, other: &Polynomial) -> i8 {
        /// Bits of the interval's denominator from which on the gcd is tried. It takes longer than
        /// to see in a short interval that the value is not zero.
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
                // A common root in the interval can only be this number. It is simple, and not at
                // an end.
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

    /// Shortens the interval: by half, or by far more once the polynomial is almost a line in it.
    ///
    /// Quadratic interval refinement (Abbott 2014): the interval is divided into 2^steps parts. The
    /// part is taken in which a straight line from end to end has its zero. If the root is there,
    /// the next division is finer, else coarser. The interval kept always has opposite signs at its
    /// ends.
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
            // Between the ends, the sign of the other's polynomial tells on which side of its root
            // this is.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Random;
    use crate::integers::Ring;

    fn polynomial(coefficients: &[i32]) -> Polynomial {
        Polynomial::new(coefficients.iter().map(|&x| x.into()).collect())
    }

    #[test]
    fn roots_that_are_known() {
        // Coefficients of 1, t, t^2, t^3; the number of roots in [0, 1]; and the roots that are n /
        // 16.
        for (coefficients, count, fractions) in [
            (&[][..], 0, &[][..]),
            (&[3], 0, &[]),
            (&[0, 5], 1, &[0]),
            (&[-1, 1], 1, &[16]),
            (&[-1, 3], 1, &[]),
            (&[1, 3], 0, &[]),
            (&[-1, 0, 2], 1, &[]),
            (&[1, -6, 7], 2, &[]),
            (&[1, -4, 4], 1, &[8]),
            (&[0, 0, 1], 1, &[0]),
            (&[1, 0, 1], 0, &[]),
            (&[0, -1, 1], 2, &[0, 16]),
            // (2t - 1) (3t - 1) (5t - 4), (2t - 1)^3, (4t - 1)^2 (4t - 3), t (t - 1) (2t - 1), t^2
            // (t - 1).
            (&[4, -25, 49, -30], 3, &[8]),
            (&[-1, 6, -12, 8], 1, &[8]),
            (&[-3, 28, -80, 64], 2, &[4, 12]),
            (&[0, 1, -3, 2], 3, &[0, 8, 16]),
            (&[0, 0, -1, 1], 2, &[0, 16]),
        ] {
            let of = polynomial(coefficients);
            let mut roots = Root::all(&of);
            assert_eq!(roots.len(), count, "{of:?} {roots:?}");
            for root in &mut roots {
                assert_eq!(root.sign_of(&of), 0);
            }
            for pair in roots.windows(2) {
                let [mut a, mut b] = [pair[0].clone(), pair[1].clone()];
                assert_eq!(a.compare(&b), Ordering::Less);
                assert_eq!(b.compare(&a), Ordering::Greater);
            }
            let found = (0..=16).filter(|&n| {
                let is = |root: &mut Root| root.compare_with_fraction(&n.into(), 4).is_eq();
                roots.iter_mut().any(is)
            });
            assert_eq!(found.collect::<Vec<_>>(), fractions, "{of:?}");
        }
    }

    /// Products of lines with known roots and a factor without roots.
    #[test]
    fn roots_of_products() {
        let mut random = Random::new(6);
        for _ in 0..2000 {
            let count = random.between(1, 3);
            // Fractions over one denominator, some outside [0, 1].
            let denominator = [3, 7, 12, 1000][random.below(4) as usize];
            let mut over: Vec<i32> = (0..count)
                .map(|_| random.between(-denominator / 2, 3 * denominator / 2))
                .collect();
            let scale = random.between(1, 5);
            let of = over.iter().fold(polynomial(&[scale]), |of, &n| {
                of.times(&polynomial(&[-n, denominator]))
            });
            over.retain(|&n| (0..=denominator).contains(&n));
            over.sort_unstable();
            over.dedup();
            let mut roots = Root::all(&of);
            assert_eq!(roots.len(), over.len(), "{of:?}");
            for (root, &n) in roots.iter_mut().zip(&over) {
                assert_eq!(root.sign_of(&polynomial(&[-n, denominator])), 0);
                // Lines with a root a little less or more, and another polynomial with the same
                // root.
                assert_eq!(
                    root.sign_of(&polynomial(&[1 - 1000 * n, 1000 * denominator])),
                    1
                );
                assert_eq!(
                    root.sign_of(&polynomial(&[-1 - 1000 * n, 1000 * denominator])),
                    -1
                );
                let other = polynomial(&[-n, denominator]).times(&polynomial(&[1, 0, 1]));
                assert_eq!(root.compare(&Root::all(&other)[0]), Ordering::Equal);
                assert_eq!(Root::all(&other)[0].compare(root), Ordering::Equal);
            }
        }
    }

    #[test]
    fn roots_that_are_close() {
        // 2^k t = 1, and (2^k t)^2 = 1 + 2^-k in integers: apart by about 2^-(2 k + 1).
        for k in [4, 20, 100, 1000] {
            let one = |bits: usize| IBig::ONE << bits;
            let line = Polynomial::new(vec![-one(0), one(k)]);
            let curve = Polynomial::new(vec![-one(k) - one(0), IBig::ZERO, one(3 * k)]);
            let [mut a, mut b] = [&line, &curve].map(|of| Root::all(of).remove(0));
            assert_eq!(a.compare(&b), Ordering::Less);
            assert_eq!(b.compare(&a), Ordering::Greater);
            assert_eq!((a.sign_of(&curve), b.sign_of(&line)), (-1, 1));
        }
    }

    #[test]
    fn a_root_refined_stays_in_its_interval() {
        // 1000 t^3 + t - 7, and t^2 - 1/2, whose roots are no fractions.
        for of in [polynomial(&[-7, 1, 0, 1000]), polynomial(&[-1, 0, 2])] {
            let mut root = Root::all(&of).remove(0);
            let mut width = 1.0;
            let mut times = 0;
            while width > 1e-30 {
                let signs = [&root.low, &root.high].map(|n| of.sign_at(n, root.bits));
                assert_eq!(signs, [-1, 1]);
                root.refine();
                let now = (&root.high - &root.low).to_f64().value() / 2f64.powi(root.bits as i32);
                assert!(now < width);
                width = now;
                times += 1;
            }
            // Halving would take a hundred.
            assert!(times < 25, "{times}");
        }
    }
}
