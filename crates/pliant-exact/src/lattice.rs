//! Signs in integers, for two triangles on one lattice: the middle stage, for exact contact.
//!
//! Floating point is never certain of a zero, and adaptive expansions take long to find one. Two
//! flat faces that touch have fifteen for every pair of triangles. But coordinates that give zeros
//! are seldom far apart in size. If all are multiples of 2^-38 times the largest, then scaled they
//! are integers below 2^39, and differences are below 2^40. A determinant of them is a sum of six
//! products below 2^120, which fits 128 bits, and of multiples of 2^-60 it fits 192.

use super::orientation::{Orientation, are_from};
use super::point::{Point, Sign, Triangle};

/// The largest coordinate, scaled, is below twice 2 to one of these powers.
pub(super) const NARROW: u64 = 38;
pub(super) const WIDE: u64 = 60;

/// Decides by the signs of a lattice that two triangles are on, if there is one. The wide lattice
/// pays in double precision only. A macro, because the two sources of signs are two types.
macro_rules! on_lattice {
    ($precision:expr, $a:expr, $b:expr, |$p:ident, $q:ident, $signs:ident| $decision:expr) => {
        if let Some([$p, $q]) = $crate::lattice::scaled::<{ $crate::lattice::NARROW }>($a, $b) {
            let $signs = &mut $crate::lattice::Narrow;
            Some($decision)
        } else if $precision == $crate::Precision::Double
            && let Some([$p, $q]) = $crate::lattice::scaled::<{ $crate::lattice::WIDE }>($a, $b)
        {
            let $signs = &mut $crate::lattice::Wide;
            Some($decision)
        } else {
            None
        }
    };
}
pub(super) use on_lattice;

/// Two triangles scaled to integers, the largest with one bit more, if that is exact.
///
/// ```text
/// largest of 18 coordinates in [2^k, 2^(k+1))    scale 2^(BITS - k): a power of two, so exact
/// each coordinate, scaled, an integer?           else there is no such lattice
/// ```
#[inline]
pub(super) fn scaled<const BITS: u64>(a: &Triangle, b: &Triangle) -> Option<[Triangle; 2]> {
    let coordinates = a.as_flattened().iter().chain(b.as_flattened());
    let largest = coordinates.fold(0, |largest, x| largest.max(x.to_bits() & !SIGN));
    // Of the scale: the exponent as it is stored, 1023 for one. Where there is none, coordinates
    // are too small, or all are zero.
    let exponent = 2 * 1023 + BITS - (largest >> 52);
    if exponent >= 2 * 1023 {
        return None;
    }
    let scale = f64::from_bits(exponent << 52);
    let step = f64::from_bits((2 * 1023 - exponent) << 52);
    let mut are_integers = true;
    let mut scaled = [*a, *b];
    for point in scaled.as_flattened_mut() {
        // What is smaller is no integer, and might be taken for zero.
        are_integers &= are_from(step, point);
        for x in point {
            *x *= scale;
            are_integers &= *x as i64 as f64 == *x;
        }
    }
    are_integers.then_some(scaled)
}

const SIGN: u64 = 1 << 63;

/// Signs of points whose coordinates are integers below 2^39.
pub(super) struct Narrow;

impl Orientation for Narrow {
    #[inline]
    fn sign(&mut self, a: &Point, b: &Point, c: &Point, d: &Point) -> Sign {
        let along = |p: &Point, axis: usize| whole(p[axis] - a[axis]);
        let difference = |p: &Point| [along(p, 0), along(p, 1), along(p, 2)];
        let (e1, e2, t) = (difference(b), difference(c), difference(d));
        let normal = |i: usize, j: usize| e1[i] * e2[j] - e1[j] * e2[i];
        (normal(1, 2) * t[0] + normal(2, 0) * t[1] + normal(0, 1) * t[2]).signum() as Sign
    }

    #[inline]
    fn sign_in_plane(&mut self, a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> Sign {
        let difference = |p: [f64; 2]| [whole(p[0] - a[0]), whole(p[1] - a[1])];
        let (e, t) = (difference(b), difference(c));
        (e[0] * t[1] - e[1] * t[0]).signum() as Sign
    }
}

/// An integer below 2^40, which a difference of two below 2^39 is, exactly.
#[inline]
fn whole(x: f64) -> i128 {
    i128::from(x as i64)
}

/// Signs of points whose coordinates are integers below 2^61.
pub(super) struct Wide;

impl Orientation for Wide {
    fn sign(&mut self, a: &Point, b: &Point, c: &Point, d: &Point) -> Sign {
        let [e1, e2, t] = [b, c, d].map(|p| difference(p, a));
        let normal = |i: usize, j: usize| product(e1[i], e2[j]) - product(e1[j], e2[i]);
        sign_of_sum([normal(1, 2), normal(2, 0), normal(0, 1)], t)
    }

    fn sign_in_plane(&mut self, a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> Sign {
        let [e, t] = [b, c].map(|p| difference(&p, &a));
        (product(e[0], t[1]) - product(e[1], t[0])).signum() as Sign
    }
}

/// Differences of integers below 2^61: as doubles they might be rounded.
fn difference<const N: usize>(p: &[f64; N], a: &[f64; N]) -> [i64; N] {
    std::array::from_fn(|axis| p[axis] as i64 - a[axis] as i64)
}

#[inline]
fn product(a: i64, b: i64) -> i128 {
    i128::from(a) * i128::from(b)
}

/// Sign of a sum of three products of numbers below 2^125 and 2^62, in limbs of 64 bits.
#[inline]
fn sign_of_sum(normal: [i128; 3], t: [i64; 3]) -> Sign {
    const LOW: i128 = u64::MAX as i128;
    let (mut high, mut low) = (0, 0);
    for (n, t) in normal.into_iter().zip(t) {
        // n is its high limb times 2^64, and its low limb, which is not negative.
        let of_low = (n & LOW) * i128::from(t);
        high += product((n >> 64) as i64, t) + (of_low >> 64);
        low += of_low & LOW;
    }
    high += low >> 64;
    if high == 0 {
        Sign::from(low & LOW != 0)
    } else {
        high.signum() as Sign
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Precision;
    use pliant_oracle::{Class, Random, subnormals_flushed};

    /// Checks both signs of some corners of a pair, if it is on a lattice.
    fn check(a: &Triangle, b: &Triangle) -> bool {
        on_lattice!(Precision::Double, a, b, |p, q, lattice| signs(
            [a, b],
            [&p, &q],
            lattice
        ))
        .is_some()
    }

    fn signs([a, b]: [&Triangle; 2], [p, q]: [&Triangle; 2], lattice: &mut impl Orientation) {
        let corners = |a: &Triangle, b: &Triangle| [a[0], a[1], a[2], b[0], b[1], b[2]];
        let (exact, scaled) = (corners(a, b), corners(p, q));
        for i in [[0, 1, 2, 3], [3, 4, 5, 1], [0, 1, 3, 4], [2, 0, 5, 3]] {
            let [a, b, c, d] = i.map(|i| exact[i]);
            let expected = pliant_oracle::orientation(&a, &b, &c, &d);
            let [p, q, r, s] = i.map(|i| scaled[i]);
            assert_eq!(
                lattice.sign(&p, &q, &r, &s),
                expected,
                "{a:?} {b:?} {c:?} {d:?}"
            );
            for (x, y) in [(0, 1), (1, 2), (2, 0)] {
                let [a, b, c] = [a, b, d].map(|point| [point[x], point[y]]);
                let [p, q, r] = [p, q, s].map(|point| [point[x], point[y]]);
                let expected = pliant_oracle::orientation_2d(a, b, c);
                assert_eq!(
                    lattice.sign_in_plane(p, q, r),
                    expected,
                    "{a:?} {b:?} {c:?}"
                );
            }
        }
    }

    #[test]
    fn signs_of_hard_pairs_are_those_of_big_integers() {
        let mut random = Random::new(31);
        let mut on_it = 0;
        for class in Class::ALL {
            for _ in 0..1_500 {
                let [a, b] = class.pair(&mut random);
                on_it += u32::from(check(&a, &b));
            }
        }
        assert!(on_it > 5_000, "{on_it} of 24,000");
    }

    #[test]
    fn the_largest_integers_there_can_be_fit() {
        let mut random = Random::new(32);
        // 2^61 less what doubles leave out.
        let most = (1_i64 << 61) - (1 << 8);
        for round in 0..8_000 {
            // In half of them below 2^39, where the narrow one ends.
            let (most, narrower) = [(most, 0), ((1 << 39) - 1, 24)][round % 2];
            let mut coordinate = || match random.below(4) {
                0 => most as f64,
                1 => -most as f64,
                2 => (((random.bits() as i64 >> 11) << random.below(9)) >> narrower) as f64,
                _ => random.below(7) as f64 - 3.0,
            };
            let mut triangle = || -> Triangle { [0; 3].map(|_| [0; 3].map(|_: i32| coordinate())) };
            let (mut a, b) = (triangle(), triangle());
            a[0][0] = most as f64;
            // At any scale the same integers.
            let by = 2f64.powi([0, -60, 40, -900][round / 2 % 4]);
            let [a, b] = [a, b].map(|triangle| triangle.map(|point| point.map(|x| x * by)));
            assert!(check(&a, &b), "{a:?} {b:?}");
        }
    }

    fn is_on(precision: Precision, a: &Triangle, b: &Triangle) -> bool {
        on_lattice!(precision, a, b, |_p, _q, _signs| ()).is_some()
    }

    #[test]
    fn what_is_on_no_lattice_is_said_so() {
        let flat = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]];
        for (precision, bits, near_one, not) in [
            (
                Precision::Single,
                38,
                1.0 - 2f64.powi(-38),
                [1.0 - 2f64.powi(-39), 0.1],
            ),
            (
                Precision::Double,
                60,
                1.0 - 2f64.powi(-53),
                [0.0001, 0.00001],
            ),
        ] {
            let step = 2f64.powi(-bits);
            let on = |a: &Triangle, b: &Triangle| is_on(precision, a, b);
            let with = move |x: f64| is_on(precision, &flat, &[[x, 0.0, 0.0], [0.0; 3], [1.0; 3]]);
            assert!(with(step) && with(-step) && with(0.0) && with(-0.0) && with(near_one));
            let smallest = [step / 2.0, 1.5 * step, -5e-324, 5e-324, 1e-310];
            for x in smallest.into_iter().chain(not).chain([f64::MIN_POSITIVE]) {
                assert!(!with(x), "{x}");
            }
            // The largest may be negative; zero alone, and the smallest numbers, have none.
            assert!(on(&flat, &[[-1024.0, step * 1024.0, 0.0]; 3]));
            assert!(!on(&flat, &[[-1024.0, step * 512.0, 0.0]; 3]));
            assert!(!on(&[[0.0; 3]; 3], &[[0.0; 3]; 3]));
            assert!(!on(&[[5e-324; 3]; 3], &[[0.0; 3]; 3]));
            // Nor does a thread that flushes subnormal numbers take them for zero.
            let tiny = [5e-324, -1e-310, 2f64.powi(-1030)];
            let in_flushed = subnormals_flushed(move || tiny.map(with));
            assert!(in_flushed.is_none_or(|found| found == [false; 3]));
        }
    }
}
