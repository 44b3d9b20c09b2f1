//! On which side of a plane a point lies: the sign of a 3 x 3 determinant, exactly.
//!
//! A filter in double precision decides most signs; its bound is proven at `RELATIVE_ERROR`. Where
//! it is not certain, `robust::orient3d` (adaptive expansions, Shewchuk 1997) has the last word.
//! That is exact unless it underflows (`SMALLEST`); for smaller coordinates integers of any size
//! decide. In the plane the same holds with four roundings, and with products of two: expansions
//! are exact from 2^-459. So every sign is exact for every f32 and f64 in range.

use super::Precision;
use super::float::{U, power, sign_beyond};
use super::integer::powers_of_all;
use super::point::{Point, Sign, Triangle};
use super::vector::{cross_on, determinant, in_units, minus};

/// A source of orientation signs.
pub(super) trait Orientation {
    /// The side of the plane through a, b, c on which d lies.
    fn sign(&mut self, a: &Point, b: &Point, c: &Point, d: &Point) -> Sign;

    /// The sides of the plane of a triangle on which three points lie.
    #[inline]
    fn plane_signs(&mut self, [a, b, c]: &Triangle, points: &Triangle) -> [Sign; 3] {
        [0, 1, 2].map(|i| self.sign(a, b, c, &points[i]))
    }

    /// Whether signs so far may be wrong, so that no more need be asked for.
    #[inline]
    fn has_given_up(&self) -> bool {
        false
    }

    /// The side of the line through a, b on which c lies, in the plane of two coordinates; exact
    /// whatever the source is.
    #[inline]
    fn sign_in_plane(&mut self, a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> Sign {
        orientation_2d(a, b, c)
    }
}

/// Exact arithmetic at once: slow, and the reference.
pub(super) struct Exact;

impl Orientation for Exact {
    fn sign(&mut self, a: &Point, b: &Point, c: &Point, d: &Point) -> Sign {
        if [a, b, c, d].iter().all(|point| are_from(SMALLEST, point)) {
            adaptive(a, b, c, d)
        } else {
            in_integers(a, b, c, d)
        }
    }
}

/// The smallest coordinate but zero for which `robust` is exact: 2^-288.
///
/// With input up to `f32::MAX` it cannot overflow. Its limit is underflow. If no coordinate but
/// zero is below 2^-288, all are multiples of 2^-340. Then whatever it forms from them is a
/// multiple of 2^-1020, and nothing but its error bounds is ever subnormal. An error smaller than
/// that in a multiple of 2^-1020 is none. For smaller coordinates, which no f32 is, integers of any
/// size have the last word.
const SMALLEST: f64 = power(-288);

/// The smallest coordinate but zero for which `robust` is exact in the plane: 2^-459.
const SMALLEST_2D: f64 = power(-459);

/// Whether each coordinate is zero or at least `smallest` in magnitude. As integers: a thread that
/// flushes subnormal numbers takes them for zero.
#[inline]
pub(super) fn are_from<const N: usize>(smallest: f64, point: &[f64; N]) -> bool {
    // Zero, less one, is the largest of all. No early exit: comparisons without a branch.
    point.iter().fold(true, |all, x| {
        all & (x.abs().to_bits().wrapping_sub(1) >= smallest.to_bits() - 1)
    })
}

/// The sign by expansions, as exact as `SMALLEST` says.
fn adaptive(a: &Point, b: &Point, c: &Point, d: &Point) -> Sign {
    let coord = |&[x, y, z]: &Point| robust::Coord3D { x, y, z };
    // robust's determinant is that of (a - d, b - d, c - d), which is minus n . t.
    sign_of(-robust::orient3d(coord(a), coord(b), coord(c), coord(d)))
}

/// The filter, and exact arithmetic where it is not certain.
pub(super) struct Filtered {
    underflow: f64,
    uncertain: bool,
}

impl Filtered {
    /// For input of this type.
    pub(super) fn new(precision: Precision) -> Self {
        Self {
            underflow: precision.underflow(),
            uncertain: false,
        }
    }

    /// Whether any sign needed exact arithmetic.
    pub(super) fn was_uncertain(&self) -> bool {
        self.uncertain
    }
}

/// The relative error of the filter: 9 u, with u = 2^-53.
///
/// For points a, b, c, d let n = (b - a) x (c - a) and t = d - a. The orientation is the sign of n
/// . t. In floating point each difference carries one rounding; each component of n two
/// differences, a product and a subtraction. The product n . t has another difference, a product
/// and two sums: eight roundings on every path. Let N_i = |e1_j e2_k| + |e1_k e2_j|. The computed
/// value is off by at most 8 u (N . |t|), to first order. A ninth u covers the rest and the
/// rounding of the bound itself. So the sign is certain if
///
/// ```text
/// |n . t| > 9 u (N . |t|) + underflow (|t_x| + |t_y| + |t_z| + 1)
/// ```
///
/// The last term is for results below the normal range. It is zero for f32 input, whose products of
/// three differences stay far inside f64. For f64 input each such result is off by at most 2^-1022,
/// whether it is rounded to a subnormal number or flushed to zero. There are three in a component
/// of n, multiplied by |t_i|, and six in n . t and the bound itself; 2^-1018 covers all.
/// Differences below the normal range are exact. Where a thread flushes them to zero, none arises
/// from coordinates that are zero or at least 2^-969.
///
/// The strict comparison leaves NaN uncertain. The formula is n . (d - a), never n . d - n . a,
/// whose error grows with the distance from the origin.
const RELATIVE_ERROR: f64 = 9.0 * U;

/// A plane through three points: its normal, and the sizes that rounding errors are parts of.
pub(super) struct Plane<'p> {
    origin: &'p Point,
    normal: [f64; 3],
    size: [f64; 3],
}

impl<'p> Plane<'p> {
    #[inline]
    pub(super) fn of(origin: &'p Point, b: &Point, c: &Point) -> Self {
        let [e1, e2] = [b, c].map(|p| minus(p, origin));
        let (mut normal, mut size) = ([0.0; 3], [0.0; 3]);
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let (left, right) = (e1[j] * e2[k], e1[k] * e2[j]);
            normal[i] = left - right;
            size[i] = left.abs() + right.abs();
        }
        Self {
            origin,
            normal,
            size,
        }
    }

    /// The determinant of the plane and a point, rounded, and its size: see `RELATIVE_ERROR`.
    #[inline]
    pub(super) fn height(&self, point: &Point) -> (f64, f64) {
        let t = minus(point, self.origin);
        let (mut determinant, mut size) = (0.0, 0.0);
        for i in 0..3 {
            determinant += self.normal[i] * t[i];
            size += self.size[i] * t[i].abs();
        }
        (determinant, size)
    }
}

impl Filtered {
    /// The side of the plane on which a point lies, if the filter is certain of it or two of the
    /// four points are one.
    #[inline]
    fn certain_side(&self, plane: &Plane, [a, b, c]: [&Point; 3], point: &Point) -> Option<Sign> {
        let (determinant, magnitude) = plane.height(point);
        let t = minus(point, plane.origin);
        let reach = t[0].abs() + t[1].abs() + t[2].abs() + 1.0;
        if determinant.abs() > RELATIVE_ERROR * magnitude + self.underflow * reach {
            return Some(sign_of(determinant));
        }
        are_two_one([a, b, c, point]).then_some(0)
    }
}

/// Whether two of four points have the same bits: a thread that flushes subnormal numbers compares
/// no others.
#[cold]
fn are_two_one([a, b, c, d]: [&Point; 4]) -> bool {
    let are_one = |p: &Point, q: &Point| p.map(f64::to_bits) == q.map(f64::to_bits);
    let within = are_one(a, b) || are_one(b, c) || are_one(c, a);
    within || [a, b, c].into_iter().any(|it| are_one(it, d))
}

impl Orientation for Filtered {
    #[inline]
    fn sign(&mut self, a: &Point, b: &Point, c: &Point, d: &Point) -> Sign {
        let certain = self.certain_side(&Plane::of(a, b, c), [a, b, c], d);
        certain.unwrap_or_else(|| {
            self.uncertain = true;
            Exact.sign(a, b, c, d)
        })
    }

    #[inline]
    fn plane_signs(&mut self, [a, b, c]: &Triangle, points: &Triangle) -> [Sign; 3] {
        let plane = Plane::of(a, b, c);
        [0, 1, 2].map(|i| {
            let certain = self.certain_side(&plane, [a, b, c], &points[i]);
            certain.unwrap_or_else(|| {
                self.uncertain = true;
                Exact.sign(a, b, c, &points[i])
            })
        })
    }
}

/// The filter alone, which gives any sign where it is not certain, and remembers that.
pub(super) struct Certain(Filtered);

impl Certain {
    /// For input of this type.
    pub(super) fn new(precision: Precision) -> Self {
        Self(Filtered::new(precision))
    }

    /// Whether all signs so far were certain.
    pub(super) fn are_all(&self) -> bool {
        !self.0.uncertain
    }

    #[inline]
    fn side(&mut self, plane: &Plane, corners: [&Point; 3], point: &Point) -> Sign {
        let certain = self.0.certain_side(plane, corners, point);
        certain.unwrap_or_else(|| {
            self.0.uncertain = true;
            0
        })
    }
}

impl Orientation for Certain {
    #[inline]
    fn sign(&mut self, a: &Point, b: &Point, c: &Point, d: &Point) -> Sign {
        self.side(&Plane::of(a, b, c), [a, b, c], d)
    }

    #[inline]
    fn plane_signs(&mut self, [a, b, c]: &Triangle, points: &Triangle) -> [Sign; 3] {
        let plane = Plane::of(a, b, c);
        let mut signs = [0; 3];
        for (sign, point) in signs.iter_mut().zip(points) {
            *sign = self.side(&plane, [a, b, c], point);
            if self.has_given_up() {
                break;
            }
        }
        signs
    }

    #[inline]
    fn has_given_up(&self) -> bool {
        !self.are_all()
    }
}

/// The side of the line through a, b on which c lies, in the plane of the first two coordinates
/// given; exact.
#[inline]
pub(super) fn orientation_2d(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> Sign {
    // Whatever the input, the underflow of f64: it is far below what two differences of f32 can
    // make.
    let left = (b[0] - a[0]) * (c[1] - a[1]);
    let right = (b[1] - a[1]) * (c[0] - a[0]);
    let determinant = left - right;
    if determinant.abs()
        > RELATIVE_ERROR_2D * (left.abs() + right.abs()) + Precision::Double.underflow()
    {
        return sign_of(determinant);
    }
    if are_from(SMALLEST_2D, &[a[0], a[1], b[0], b[1], c[0], c[1]]) {
        adaptive_2d(a, b, c)
    } else {
        in_integers_2d(a, b, c)
    }
}

/// The relative error of the filter in the plane: 5 u.
const RELATIVE_ERROR_2D: f64 = 5.0 * U;

/// The sign by expansions, as exact as `SMALLEST_2D` says.
fn adaptive_2d(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> Sign {
    let coord = |[x, y]: [f64; 2]| robust::Coord { x, y };
    sign_of(robust::orient2d(coord(a), coord(b), coord(c)))
}

/// In integers: of any coordinates, whether or not the thread keeps subnormal numbers, because only
/// bits are read.
#[cold]
fn in_integers(a: &Point, b: &Point, c: &Point, d: &Point) -> Sign {
    let [unit, _] = powers_of_all([a, b, c, d].into_iter().flatten());
    let [a, b, c, d] = [a, b, c, d].map(|point| in_units(point, unit));
    let [e1, e2, t] = [b, c, d].map(|p| minus(&p, &a));
    determinant(&e1, &e2, &t).sign()
}

/// The side in the plane, in integers.
#[cold]
fn in_integers_2d(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> Sign {
    let [unit, _] = powers_of_all([a, b, c].as_flattened());
    let [a, b, c] = [a, b, c].map(|[x, y]| in_units(&[x, y, 0.0], unit));
    cross_on(2, &minus(&b, &a), &minus(&c, &a)).sign()
}

/// The sign of a determinant; of points out of range perhaps of no number, whose sign is 0.
fn sign_of(value: f64) -> Sign {
    sign_beyond(value, 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The determinant of lattice points in integers.
    fn integer(points: [[i64; 3]; 4]) -> Sign {
        let [a, b, c, d] = points.map(|point| point.map(i128::from));
        let difference =
            |p: [i128; 3]| -> [i128; 3] { std::array::from_fn(|axis| p[axis] - a[axis]) };
        let (e1, e2, t) = (difference(b), difference(c), difference(d));
        let normal =
            |i: usize| e1[(i + 1) % 3] * e2[(i + 2) % 3] - e1[(i + 2) % 3] * e2[(i + 1) % 3];
        (normal(0) * t[0] + normal(1) * t[1] + normal(2) * t[2]).signum() as Sign
    }

    #[test]
    fn signs_are_those_of_integers() {
        let mut state = 1_u64;
        let mut next = |range: i64| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            ((state >> 33) as i64).rem_euclid(2 * range + 1) - range
        };
        let (mut zeros, mut uncertain) = (0, 0);
        for round in 0..200_000 {
            // Small lattices are full of zeros; on large ones rounding begins to matter.
            let range = [1, 2, 5, 1 << 20, 1 << 26][round % 5];
            let mut points: [[i64; 3]; 4] =
                std::array::from_fn(|_| std::array::from_fn(|_| next(range)));
            if round % 3 == 0 {
                // d on the plane or one step beside it: a + (b - a) + (c - a), nudged.
                points[3] =
                    std::array::from_fn(|axis| points[1][axis] + points[2][axis] - points[0][axis]);
                points[3][0] += next(1);
            }
            let [a, b, c, d] = points.map(|point| point.map(|x| x as f64));
            let expected = integer(points);
            let mut filtered = Filtered::new(Precision::Single);
            assert_eq!(filtered.sign(&a, &b, &c, &d), expected, "{points:?}");
            assert_eq!(Exact.sign(&a, &b, &c, &d), expected, "{points:?}");
            zeros += u32::from(expected == 0);
            uncertain += u32::from(filtered.was_uncertain());
        }
        // The test is about hard cases, and the filter is for the easy ones.
        assert!(
            zeros > 20_000 && uncertain < 150_000,
            "{zeros} zeros, {uncertain} uncertain"
        );
    }

    #[test]
    fn tiny_differences_are_not_lost() {
        // Products of three such differences are below the smallest f64.
        for scale in [-60, -149, -300] {
            let s = 2f64.powi(scale);
            let (a, b, c, d) = ([0.0; 3], [s, 0.0, 0.0], [0.0, s, 0.0], [0.0, 0.0, s]);
            let underflow = if scale == -300 {
                Precision::Double
            } else {
                Precision::Single
            };
            assert_eq!(
                Filtered::new(underflow).sign(&a, &b, &c, &d),
                1,
                "2^{scale}"
            );
            assert_eq!(
                Filtered::new(underflow).sign(&a, &c, &b, &d),
                -1,
                "2^{scale}"
            );
        }
    }

    #[test]
    fn products_that_underflow_in_part_are_not_trusted() {
        // Lattice points scaled to where products of two differences keep a few bits, or none. A
        // factor of ordinary size then lifts what is left above the relative bound. Above 2^-305
        // the answer is still the answer on the lattice.
        let mut state = 5_u64;
        let mut next = |range: i64| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            ((state >> 33) as i64).rem_euclid(2 * range + 1) - range
        };
        let (mut wrong_without_the_term, mut lattices) = (0, 0);
        for exponent in [-540, -537, -535, -530] {
            for _ in 0..20_000 {
                let points: [[i64; 3]; 4] =
                    std::array::from_fn(|_| std::array::from_fn(|_| next(9)));
                // x and y tiny, z of ordinary size: n_z is a product of two tiny differences.
                let scaled = points.map(|[x, y, z]| {
                    [
                        x as f64 * 2f64.powi(exponent),
                        y as f64 * 2f64.powi(exponent),
                        z as f64,
                    ]
                });
                let [a, b, c, d] = scaled;
                let expected = integer(points);
                lattices += 1;
                // The filter alone, with the term: certain signs are right. (`robust` is past its
                // limit here and is not asked.)
                let filter = |underflow| {
                    let mut filtered = Filtered::new(underflow);
                    let sign = filtered.sign(&a, &b, &c, &d);
                    (!filtered.was_uncertain()).then_some(sign)
                };
                assert!(
                    filter(Precision::Double).is_none_or(|sign| sign == expected),
                    "{points:?} at 2^{exponent}"
                );
                wrong_without_the_term +=
                    u32::from(filter(Precision::Single).is_some_and(|sign| sign != expected));
            }
        }
        assert!(
            wrong_without_the_term > 100,
            "{wrong_without_the_term} of {lattices}: the term is needed"
        );
    }

    /// Multiplies with 2^exponent; exact for integers.
    fn scaled(points: [Point; 4], exponents: [i32; 3]) -> [Point; 4] {
        // In two steps, as powi does not reach the smallest powers; the first is exact for the
        // numbers of these tests.
        let by = |x: f64, exponent: i32| {
            x * 2f64.powi(exponent / 2) * 2f64.powi(exponent - exponent / 2)
        };
        points.map(|p| std::array::from_fn(|axis| by(p[axis], exponents[axis])))
    }

    /// The oracle's sign, after every source of signs gave the same. Counts signs of which the
    /// filter was certain.
    fn check([a, b, c, d]: [Point; 4], certain: &mut u32) -> Sign {
        let expected = pliant_oracle::orientation(&a, &b, &c, &d);
        assert_eq!(
            Exact.sign(&a, &b, &c, &d),
            expected,
            "{a:?} {b:?} {c:?} {d:?}"
        );
        let mut check = |underflow| {
            let mut filtered = Filtered::new(underflow);
            assert_eq!(
                filtered.sign(&a, &b, &c, &d),
                expected,
                "{a:?} {b:?} {c:?} {d:?}"
            );
            *certain += u32::from(!filtered.was_uncertain());
        };
        check(Precision::Double);
        if pliant_oracle::fits_f32(&[[a, b, c], [d; 3]]) {
            check(Precision::Single);
        }
        for (x, y) in [(0, 1), (1, 2), (2, 0)] {
            let [p, q, r] = [a, b, d].map(|point| [point[x], point[y]]);
            let expected = pliant_oracle::orientation_2d(p, q, r);
            assert_eq!(orientation_2d(p, q, r), expected, "{p:?} {q:?} {r:?}");
        }
        expected
    }

    #[test]
    fn no_filter_gives_a_wrong_sign_at_any_scale() {
        let mut random = pliant_oracle::Random::new(4);
        for exponent in [
            0, -60, -126, -149, -288, -289, -306, -307, -340, -459, -485, -535, -1022, -1074,
        ] {
            let (mut certain, mut zeros) = (0, 0);
            for round in 0..2_000 {
                let point = |random: &mut pliant_oracle::Random| {
                    std::array::from_fn(|_| f64::from(random.below(13)) - 6.0)
                };
                let mut points: [Point; 4] = std::array::from_fn(|_| point(&mut random));
                if round % 3 == 0 {
                    points[3] = std::array::from_fn(|i| points[1][i] + points[2][i] - points[0][i]);
                }
                // All axes at this scale, or one or two of ordinary size, which lift what the
                // others lost.
                let exponents = match round % 4 {
                    0 | 1 => [exponent; 3],
                    2 => [exponent, exponent, 0],
                    _ => [0, exponent, 100],
                };
                zeros += u32::from(check(scaled(points, exponents), &mut certain) == 0);
            }
            assert!(
                (100..1_900).contains(&zeros),
                "{zeros} zeros at 2^{exponent}"
            );
            // From 2^-340 there is nothing left that a filter could be certain of, but with an axis
            // of ordinary size.
            let least = if exponent >= -126 { 1_500 } else { 0 };
            assert!(certain >= least, "{certain} certain at 2^{exponent}");
        }
    }

    #[test]
    fn no_filter_gives_a_wrong_sign_on_hard_pairs() {
        let mut random = pliant_oracle::Random::new(5);
        let mut certain = 0;
        for class in pliant_oracle::Class::ALL {
            for _ in 0..1_500 {
                let [a, b] = class.pair(&mut random);
                check([a[0], a[1], a[2], b[0]], &mut certain);
                check([a[0], a[1], b[0], b[1]], &mut certain);
            }
        }
        assert!(certain > 20_000, "{certain} certain");
    }

    /// Two differences that round to opposite sides, times numbers so small that the products round
    /// to a whole one of them.
    #[test]
    fn products_that_underflow_are_not_trusted_in_the_plane() {
        let (unit, tiny) = (2f64.powi(-52), f64::from_bits(1));
        let a = [0.88 * unit, 0.0];
        let b = [0.25 + unit, tiny];
        let c = [2.5 + 2.0 * unit, 10.0 * tiny];
        assert_eq!(pliant_oracle::orientation_2d(a, b, c), 1);
        assert!(
            (b[0] - a[0]) * c[1] < b[1] * (c[0] - a[0]),
            "which is wrong"
        );
        assert_eq!(orientation_2d(a, b, c), 1);
    }

    /// Four points with all their 53 bits, the last nearly on the plane of the others, and three
    /// nearly on a line. The smallest coordinates, if not zero, are from 2^exponent to four times
    /// that.
    fn at_the_limit(
        random: &mut pliant_oracle::Random,
        exponent: i32,
    ) -> ([Point; 4], [[f64; 2]; 3]) {
        let mut coordinate = || -> f64 {
            let mantissa = (random.bits() >> 11 | 1 << 52) as f64 * 2f64.powi(-52);
            let sign = if random.below(2) == 0 { 1.0 } else { -1.0 };
            sign * mantissa * 2f64.powi(random.below(2) as i32)
        };
        let not_below = |x: f64| if x.abs() < 1.0 { 0.0 } else { x };
        let [a, b, c]: [Point; 3] = std::array::from_fn(|_| std::array::from_fn(|_| coordinate()));
        let d = std::array::from_fn(|i| not_below(b[i] + c[i] - a[i]));
        let [p, q] = [a, b].map(|point| [point[0], point[1]]);
        let r = std::array::from_fn(|i| not_below(2.0 * q[i] - p[i]));
        let by = 2f64.powi(exponent);
        (
            [a, b, c, d].map(|p| p.map(|x| x * by)),
            [p, q, r].map(|p| p.map(|x| x * by)),
        )
    }

    #[test]
    fn expansions_are_exact_down_to_the_limit_and_not_below() {
        let mut random = pliant_oracle::Random::new(6);
        let mut wrong = |exponent: i32, in_plane: bool| {
            let wrong = |([a, b, c, d], [p, q, r]): ([Point; 4], [[f64; 2]; 3])| {
                if in_plane {
                    let expected = pliant_oracle::orientation_2d(p, q, r);
                    assert_eq!(orientation_2d(p, q, r), expected, "{p:?} {q:?} {r:?}");
                    adaptive_2d(p, q, r) != expected
                } else {
                    let expected = pliant_oracle::orientation(&a, &b, &c, &d);
                    assert_eq!(
                        Exact.sign(&a, &b, &c, &d),
                        expected,
                        "{a:?} {b:?} {c:?} {d:?}"
                    );
                    adaptive(&a, &b, &c, &d) != expected
                }
            };
            (0..4_000)
                .filter(|_| wrong(at_the_limit(&mut random, exponent)))
                .count()
        };
        for exponent in [-288, -287, -280] {
            assert_eq!(wrong(exponent, false), 0, "2^{exponent}");
        }
        for exponent in [-459, -458, -450] {
            assert_eq!(wrong(exponent, true), 0, "2^{exponent}");
        }
        // Well below they are wrong; what has the last word there is not.
        for (exponent, in_plane) in [(-345, false), (-360, false), (-537, true), (-550, true)] {
            assert!(wrong(exponent, in_plane) > 0, "2^{exponent}");
        }
    }

    #[test]
    fn exact_signs_do_not_depend_on_the_thread() {
        let mut random = pliant_oracle::Random::new(7);
        let mut points = Vec::new();
        for exponent in [-288, -289, -340, -459, -460, -470, -485, -511, -520] {
            points.extend((0..2_000).map(|_| at_the_limit(&mut random, exponent)));
        }
        for class in pliant_oracle::Class::ALL {
            points.extend((0..500).map(|_| {
                let [a, b] = class.pair(&mut random);
                let in_plane = [a[0], a[1], b[0]].map(|point| [point[0], point[1]]);
                ([a[0], a[1], a[2], b[0]], in_plane)
            }));
        }
        let signs = |&([a, b, c, d], [p, q, r]): &([Point; 4], [[f64; 2]; 3])| {
            [Exact.sign(&a, &b, &c, &d), orientation_2d(p, q, r)]
        };
        let all = || -> Vec<_> { points.iter().map(signs).collect() };
        let ordinary = all();
        if let Some(flushed) = pliant_oracle::subnormals_flushed(all) {
            for ((ordinary, flushed), points) in ordinary.iter().zip(flushed).zip(&points) {
                assert_eq!(*ordinary, flushed, "{points:?}");
            }
        }
    }

    #[test]
    fn the_limits_are_where_they_are_said_to_be() {
        assert_eq!((SMALLEST, SMALLEST_2D), (2f64.powi(-288), 2f64.powi(-459)));
        for smallest in [SMALLEST, SMALLEST_2D] {
            assert!(are_from(
                smallest,
                &[0.0, -0.0, smallest, -smallest, 1e38, -1e38]
            ));
            for below in [smallest.next_down(), f64::MIN_POSITIVE, 5e-324] {
                assert!(!are_from(smallest, &[1.0, below, 0.0]));
                assert!(!are_from(smallest, &[0.0, 1.0, -below]));
            }
        }
        // No f32 is below either, so that Filtered need not ask.
        assert!(are_from(SMALLEST, &[f64::from(f32::from_bits(1))]));
    }

    #[test]
    fn the_smallest_numbers_decide_beside_the_largest() {
        for (tiny, huge) in [
            (5e-324, 1e38),
            (1e-320, 1e38),
            (1e-310, f64::from(f32::MAX)),
            (1e-300, 1.0),
        ] {
            let (a, b, c) = ([0.0; 3], [huge, 0.0, 0.0], [0.0, huge, 0.0]);
            let at = |z: f64| [huge, huge, z];
            for (z, expected) in [(tiny, 1), (-tiny, -1), (0.0, 0)] {
                assert_eq!(check([a, b, c, at(z)], &mut 0), expected, "{tiny} {huge}");
            }
            assert_eq!(orientation_2d([0.0, 0.0], [huge, 0.0], [-huge, tiny]), 1);
            assert_eq!(orientation_2d([0.0, 0.0], [huge, 0.0], [-huge, -tiny]), -1);
        }
    }
}
