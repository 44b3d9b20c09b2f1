//! Proofs of answers about motion, by means that use no roots of polynomials.
//!
//! Elements are proven apart by a list of separating directions, and in contact by a change of
//! orientation. Both are searched in `f64` and checked in integers. At a dyadic time everything is
//! decided as for elements at rest. Motions that touch in a single point, or return to the side
//! they came from, have no such proof at other times. They are counted: few are left.

use super::*;
use crate::Random;
use dashu_int::IBig;
use dashu_int::ops::BitTest;

/// A direction or a point.
type Place = Vector<IBig>;

/// Differences of corners at the start and the end, in the order of the polygon that they form.
struct Differences([Vec<Place>; 2]);

/// A dyadic time n / 2^bits.
#[derive(Clone, Copy)]
struct Time {
    n: u64,
    bits: u32,
}

impl Time {
    fn to_f64(self) -> f64 {
        self.n as f64 / 2f64.powi(self.bits as i32)
    }

    /// Changes the unit to 2^-bits; the time stays.
    fn with_bits(self, bits: u32) -> Self {
        let n = self.n << (bits - self.bits);
        Self { n, bits }
    }
}

impl Differences {
    fn new(elements: Elements, motion: &Moving) -> Self {
        let whole = integers(motion.as_flattened().as_flattened());
        let pairs: &[[usize; 2]] = match elements {
            Elements::VertexTriangle => &[[0, 1], [0, 2], [0, 3]],
            Elements::EdgeEdge => &[[0, 2], [0, 3], [1, 3], [1, 2]],
        };
        let mut at = [0, 12].map(|first| {
            let corner =
                |i: usize| -> Place { [0, 1, 2].map(|axis| whole[first + 3 * i + axis].clone()) };
            let all = pairs.iter().map(|&[i, j]| minus(&corner(i), &corner(j)));
            all.collect::<Vec<_>>()
        });
        // Makes all axes about equally large, which changes no answer.
        let most = [0, 1, 2].map(|axis| {
            at.iter()
                .flatten()
                .map(|p| p[axis].bit_len())
                .max()
                .unwrap()
        });
        for p in at.iter_mut().flatten() {
            for axis in 0..3 {
                p[axis] <<= most[0].max(most[1]).max(most[2]) - most[axis];
            }
        }
        Self(at)
    }

    /// The differences at a time, multiplied by 2^bits.
    fn then(&self, time: Time) -> Vec<Place> {
        let [from, to] = [IBig::from((1 << time.bits) - time.n), IBig::from(time.n)];
        let both = self.0[0].iter().zip(&self.0[1]);
        let mixed =
            both.map(|(p, q)| std::array::from_fn(|axis| &p[axis] * &from + &q[axis] * &to));
        mixed.collect()
    }

    /// The differences in the middle of an interval, up to a factor and rounding.
    fn roughly_between(&self, from: Time, to: Time) -> Vec<[f64; 3]> {
        let bits = from.bits.max(to.bits) + 1;
        let n = u64::midpoint(from.with_bits(bits).n, to.with_bits(bits).n);
        let points = self.then(Time { n, bits });
        let most = points.iter().flatten().map(BitTest::bit_len).max().unwrap();
        let shift = most.saturating_sub(62);
        let small = |x: &IBig| i64::try_from(x >> shift).expect("62 bits") as f64;
        points.iter().map(|p| p.each_ref().map(small)).collect()
    }

    /// Whether a proof was found that the elements are apart on all of [from, to].
    ///
    /// A separating direction has a positive product with all differences at two times. Then it has
    /// at all times between, as products change linearly, and the origin is not in the hull. A list
    /// of intervals with directions that covers [from, to] is a proof. Bisection looks for it.
    fn are_apart(&self, from: Time, to: Time, budget: &mut u32) -> bool {
        if *budget == 0 {
            return false;
        }
        *budget -= 1;
        let ends = [from, to].map(|time| self.then(time));
        let proof = directions(&self.roughly_between(from, to))
            .into_iter()
            .any(|n| {
                let n = whole(n);
                let mut all = ends.iter().flatten();
                all.all(|p| dot(&n, p) > IBig::ZERO)
            });
        let bits = from.bits.max(to.bits);
        proof
            || bits < 60 && {
                let [from, to] = [from, to].map(|time| time.with_bits(bits + 1));
                let middle = Time {
                    n: u64::midpoint(from.n, to.n),
                    bits: bits + 1,
                };
                self.are_apart(from, middle, budget) && self.are_apart(middle, to, budget)
            }
    }

    /// Whether a proof was found that there is contact in the interval.
    ///
    /// The four corners change their orientation, so at some time they are in one plane. The origin
    /// then is in the plane of the differences, which form a triangle or a parallelogram. Some
    /// direction has positive products with q x r for all neighbouring differences q and r, all the
    /// time. So the differences go around the origin, which is inside. The products are quadratic:
    /// three positive Bernstein coefficients are enough.
    fn meet_between(&self, from: Time, to: Time) -> bool {
        let ends = [from, to].map(|time| self.then(time));
        let volume = |p: &[Place]| Exact::sign(&determinant(&p[0], &p[1], &p[2]));
        if volume(&ends[0]) * volume(&ends[1]) >= 0 {
            return false;
        }
        let count = ends[0].len();
        let p = self.roughly_between(from, to);
        let n = (0..count).fold([0.0; 3], |n, i| {
            let m = rough_cross(p[i], p[(i + 1) % count]);
            [0, 1, 2].map(|axis| n[axis] + m[axis])
        });
        let n = whole(n);
        let positive = |x: IBig| x > IBig::ZERO;
        (0..count).all(|i| {
            let next = (i + 1) % count;
            let of = |a: usize, b: usize| dot(&n, &cross(&ends[a][i], &ends[b][next]));
            positive(of(0, 0)) && positive(of(1, 1)) && positive(of(0, 1) + of(1, 0))
        })
    }

    /// Whether there is contact at a time.
    fn meet_at(&self, time: Time) -> bool {
        let points = self.then(time);
        match <[Place; 3]>::try_from(points) {
            Ok(three) => zero_in_hull(&three),
            Err(points) => zero_in_hull::<4, IBig>(&points.try_into().expect("three or four")),
        }
    }
}

fn rough_cross(p: [f64; 3], q: [f64; 3]) -> [f64; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(j, k)| p[j] * q[k] - p[k] * q[j])
}

fn rough_dot(p: [f64; 3], q: [f64; 3]) -> f64 {
    (0..3).map(|axis| p[axis] * q[axis]).sum()
}

/// Converts a direction to integers, up to rounding.
fn whole(n: [f64; 3]) -> Place {
    let most = n.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    if most == 0.0 || !most.is_finite() {
        return [IBig::ZERO, IBig::ZERO, IBig::ZERO];
    }
    n.map(|x| IBig::from((x / most * 2f64.powi(60)) as i64))
}

/// Directions that may have positive products with all points, each in one of its two senses.
///
/// - axes and the points
/// - from the line of two points, and normals of their plane with the origin
/// - normals of the plane of three points
fn directions(p: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let minus = |p: [f64; 3], q: [f64; 3]| [0, 1, 2].map(|axis| p[axis] - q[axis]);
    let mut all: Vec<[f64; 3]> = p.to_vec();
    for [i, j] in pairs(p.len()) {
        let along = minus(p[j], p[i]);
        let across = rough_cross(p[i], p[j]);
        // From the origin to the line.
        all.extend([rough_cross(along, across), across]);
    }
    for [i, j, k] in triples(p.len()) {
        all.push(rough_cross(minus(p[j], p[i]), minus(p[k], p[i])));
    }
    for axis in 0..3 {
        let mut n = [0.0; 3];
        n[axis] = 1.0;
        all.push(n);
    }
    // The sense on whose side most of the points are.
    for n in &mut all {
        if p.iter().map(|&q| rough_dot(*n, q)).sum::<f64>() < 0.0 {
            *n = n.map(|x| -x);
        }
    }
    all
}

/// Number of answers of a kind, and number of proven ones.
#[derive(Clone, Copy, Debug, Default)]
struct Share {
    all: u32,
    proven: u32,
}

impl Share {
    fn count(&mut self, proven: bool) {
        self.all += 1;
        self.proven += u32::from(proven);
    }

    fn is_at_least(self, percent: u32) -> bool {
        self.proven * 100 >= self.all * percent
    }
}

const START: Time = Time { n: 0, bits: 0 };
const END: Time = Time { n: 1, bits: 0 };

/// Last multiple of 2^-bits that is not after the contact.
fn before(first: &FirstContact, bits: u32) -> Time {
    let (mut low, mut high) = (0, 1_u64 << bits);
    while low < high {
        let n = (low + high).div_ceil(2);
        if first.compare(Time { n, bits }.to_f64()).is_lt() {
            high = n - 1;
        } else {
            low = n;
        }
    }
    Time { n: low, bits }
}

#[test]
fn answers_have_proofs() {
    let mut total = [Share::default(); 3];
    for class in MotionClass::ALL {
        let mut random = Random::new(3);
        // Answers of three kinds: never in contact, not before a time, and at a time.
        let mut shares = [Share::default(); 3];
        for _ in 0..400 {
            let (elements, motion) = class.motion(&mut random);
            let differences = Differences::new(elements, &motion);
            match first_contact(elements, &motion) {
                None => shares[0].count(differences.are_apart(START, END, &mut 3000)),
                Some(first) => {
                    let early = before(&first, 8);
                    let is_early = first.compare(early.to_f64()).is_gt();
                    let until = if is_early || early.n == 0 {
                        early
                    } else {
                        Time {
                            n: early.n - 1,
                            bits: early.bits,
                        }
                    };
                    if until.n > 0 {
                        shares[1].count(differences.are_apart(START, until, &mut 3000));
                    }
                    let proven = [4, 8, 16, 24, 32, 40, 50].iter().any(|&bits| {
                        let from = before(&first, bits);
                        if first.compare(from.to_f64()).is_eq() {
                            assert!(differences.meet_at(from), "{class:?} {motion:?}");
                            return true;
                        }
                        let to = Time {
                            n: from.n + 1,
                            bits,
                        };
                        differences.meet_between(from, to)
                    });
                    shares[2].count(proven);
                }
            }
        }
        for (total, share) in total.iter_mut().zip(shares) {
            total.all += share.all;
            total.proven += share.proven;
        }
        println!("{class:?} {shares:?}");
        if matches!(class, MotionClass::Random | MotionClass::Translation) {
            assert!(
                shares.iter().all(|share| share.is_at_least(99)),
                "{class:?} {shares:?}"
            );
        }
    }
    println!("{total:?}");
    assert!(total.iter().all(|share| share.is_at_least(90)), "{total:?}");
}

/// Contact found at rest, at one of many times, is never before the first contact.
#[test]
fn no_contact_is_seen_before_the_first() {
    let mut seen = 0;
    for class in MotionClass::ALL {
        let mut random = Random::new(5);
        for _ in 0..200 {
            let (elements, motion) = class.motion(&mut random);
            let differences = Differences::new(elements, &motion);
            let first = first_contact(elements, &motion);
            for n in 0..=48 {
                // Every 32nd of the step, and a few tiny parts from its start and its end.
                let time = match n {
                    0..=32 => Time { n, bits: 5 },
                    33..=40 => Time {
                        n: n - 32,
                        bits: 20,
                    },
                    _ => Time {
                        n: (1 << 20) - (n - 40),
                        bits: 20,
                    },
                };
                if differences.meet_at(time) {
                    let first = first.as_ref().expect("there is contact");
                    assert!(
                        first.compare(time.to_f64()).is_le(),
                        "{class:?} {elements:?} {motion:?}"
                    );
                    seen += 1;
                }
            }
        }
    }
    assert!(seen > 5_000, "{seen}");
}
