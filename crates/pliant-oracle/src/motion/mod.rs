//! Exact continuous collision of a vertex and a triangle, or of two edges, on straight paths.
//!
//! Two elements meet at a time if and only if the origin is in the hull of the differences of their
//! corners. `zero_in_hull` decides that by signs of polynomials in time, of degree at most 3.
//! Between neighbouring roots no sign changes, and the times of contact are a closed set. So the
//! first contact is at 0 or at a root, and `zero_in_hull` runs there with polynomials as numbers
//! (`algebraic.rs`). Nothing is rounded, and a degenerate element is the segment or point that it
//! is.

mod algebraic;
mod classes;
mod polynomial;
#[cfg(test)]
mod proofs;

pub use classes::{MotionClass, motion_fits_f32};

use crate::hull::{cross, determinant, dot, minus, pairs, triples, zero_in_hull};
use crate::integers::{Exact, Ring, Vector, integers};
use algebraic::Root;
use polynomial::Polynomial;
use std::cell::RefCell;
use std::cmp::Ordering;

/// Kind of the two elements that four corners form.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Elements {
    /// A vertex, then a triangle.
    VertexTriangle,
    /// An edge, then an edge.
    EdgeEdge,
}

/// Four corners at the start, time 0, and at the end, time 1.
pub type Moving = [[[f64; 3]; 4]; 2];

/// Whether two elements meet, as closed sets, at some time of [0, until].
///
/// # Panics
///
/// If a coordinate is not finite, or `until` is not in [0, 1].
pub fn meet_until(elements: Elements, motion: &Moving, until: f64) -> bool {
    assert!((0.0..=1.0).contains(&until), "{until} is not in [0, 1]");
    first_contact(elements, motion).is_some_and(|first| first.compare(until).is_le())
}

/// Compares the times at which two motions first meet. `None` if either never does in [0, 1].
///
/// # Panics
///
/// If a coordinate is not finite.
pub fn compare_first(a: (Elements, &Moving), b: (Elements, &Moving)) -> Option<Ordering> {
    Some(first_contact(a.0, a.1)?.compare_with(&first_contact(b.0, b.1)?))
}

/// Time of a first contact, exactly: a root of a polynomial.
///
/// Comparing one with several numbers takes less time than calling [`meet_until`] for each.
#[derive(Clone, Debug)]
pub struct FirstContact(RefCell<Root>);

impl FirstContact {
    /// Compares the time of this contact with t.
    ///
    /// # Panics
    ///
    /// If t is not finite.
    pub fn compare(&self, t: f64) -> Ordering {
        let [n, one] = &integers(&[t, 1.0])[..] else {
            unreachable!("two numbers were given")
        };
        // In units in which one is a power of two.
        let bits = one.trailing_zeros().expect("one is not zero");
        self.0.borrow_mut().compare_with_fraction(n, bits)
    }

    /// Compares the time of this contact with another's.
    pub fn compare_with(&self, other: &Self) -> Ordering {
        let other = other.0.borrow().clone();
        self.0.borrow_mut().compare(&other)
    }
}

/// First time of [0, 1] at which two elements meet, as closed sets; `None` if they never do.
///
/// At contact the origin and the first three differences are in one plane. For three differences,
/// because the origin is in their triangle; for four, because they are the corners of a
/// parallelogram. So if the determinant of the three is not zero always, its roots are the only
/// times to test.
///
/// The tests of this folder also test all roots, with the same results (`Times::Every`). They prove
/// most answers by means that know no roots (`proofs.rs`).
///
/// # Panics
///
/// If a coordinate is not finite.
pub fn first_contact(elements: Elements, motion: &Moving) -> Option<FirstContact> {
    let coordinates = motion.as_flattened().as_flattened();
    assert!(coordinates.iter().all(|x| x.is_finite()));
    if apart_along_an_axis(elements, motion) {
        return None;
    }
    first_of_all(elements, motion, Times::OfOnePlane)
}

/// Times that are tested.
#[derive(Clone, Copy)]
enum Times {
    /// Roots of one determinant; all roots if it is zero always.
    OfOnePlane,
    /// Always all roots: slower, with the same answer.
    #[cfg(test)]
    Every,
}

fn first_of_all(elements: Elements, motion: &Moving, times: Times) -> Option<FirstContact> {
    let corners: [Vector<Polynomial>; 4] = paths(motion);
    let difference = |[i, j]: [usize; 2]| minus(&corners[i], &corners[j]);
    let root = match elements {
        Elements::VertexTriangle => first(&[[0, 1], [0, 2], [0, 3]].map(difference), times),
        Elements::EdgeEdge => first(&[[0, 2], [0, 3], [1, 2], [1, 3]].map(difference), times),
    };
    root.map(|root| FirstContact(RefCell::new(root)))
}

/// Whether all differences are on one side of zero on some axis, at both ends and so always.
fn apart_along_an_axis(elements: Elements, motion: &Moving) -> bool {
    let of_first = match elements {
        Elements::VertexTriangle => 1,
        Elements::EdgeEdge => 2,
    };
    (0..3).any(|axis| {
        [Ordering::Less, Ordering::Greater].iter().any(|&side| {
            motion.iter().all(|corners| {
                let (one, other) = corners.split_at(of_first);
                one.iter().all(|p| {
                    other
                        .iter()
                        .all(|q| p[axis].partial_cmp(&q[axis]) == Some(side))
                })
            })
        })
    })
}

/// Coordinates of corners as functions of time, scaled by one power of two.
fn paths(motion: &Moving) -> [Vector<Polynomial>; 4] {
    let whole = integers(motion.as_flattened().as_flattened());
    std::array::from_fn(|corner| {
        std::array::from_fn(|axis| {
            let [start, end] = [0, 12].map(|first| whole[first + 3 * corner + axis].clone());
            let speed = end - &start;
            Polynomial::new(vec![start, speed])
        })
    })
}

/// First time at which the origin is in the hull of points.
fn first<const N: usize>(points: &[Vector<Polynomial>; N], times: Times) -> Option<Root> {
    let plane = determinant(&points[0], &points[1], &points[2]);
    let of_one_plane = matches!(times, Times::OfOnePlane) && !plane.is_zero();
    if of_one_plane {
        // Roots are in order, so the first contact found is the first.
        return Root::all(&plane)
            .into_iter()
            .find_map(|time| contact(points, time));
    }
    let mut first = contact(points, Root::whole(0));
    for polynomial in signs_asked_for(points) {
        for mut time in Root::all(&polynomial) {
            if first.as_ref().is_none_or(|it| time.compare(it).is_lt()) {
                first = contact(points, time).or(first);
            }
        }
    }
    first
}

/// Polynomials whose signs `zero_in_hull` uses.
fn signs_asked_for<const N: usize>(points: &[Vector<Polynomial>; N]) -> Vec<Polynomial> {
    let mut all: Vec<Polynomial> = points.iter().flatten().cloned().collect();
    for [i, j] in pairs(N) {
        all.extend(cross(&points[i], &points[j]));
        all.push(dot(&points[i], &points[j]));
    }
    all.extend(triples(N).map(|[i, j, k]| determinant(&points[i], &points[j], &points[k])));
    all
}

/// Returns the time if the origin is in the hull of points then.
fn contact<const N: usize>(points: &[Vector<Polynomial>; N], time: Root) -> Option<Root> {
    let time = RefCell::new(time);
    let then = points.each_ref().map(|point| {
        point.each_ref().map(|value| AtTime {
            value: value.clone(),
            time: &time,
        })
    });
    let meet = zero_in_hull(&then);
    drop(then);
    meet.then(|| time.into_inner())
}

/// Value of a polynomial at a root of another.
#[derive(Clone)]
struct AtTime<'a> {
    value: Polynomial,
    time: &'a RefCell<Root>,
}

impl AtTime<'_> {
    fn at_same(&self, value: Polynomial) -> Self {
        Self {
            value,
            time: self.time,
        }
    }
}

impl Ring for AtTime<'_> {
    fn minus(&self, other: &Self) -> Self {
        self.at_same(self.value.minus(&other.value))
    }
    fn plus(&self, other: &Self) -> Self {
        self.at_same(self.value.plus(&other.value))
    }
    fn times(&self, other: &Self) -> Self {
        self.at_same(self.value.times(&other.value))
    }
}

impl Exact for AtTime<'_> {
    fn sign(&self) -> i8 {
        self.time.borrow_mut().sign_of(&self.value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Random;

    #[test]
    fn every_root_or_those_of_one_plane() {
        for class in MotionClass::ALL {
            let mut random = Random::new(2);
            for _ in 0..300 {
                let (elements, motion) = class.motion(&mut random);
                let expected = first_of_all(elements, &motion, Times::Every);
                let first = first_contact(elements, &motion);
                let agree = match (&first, &expected) {
                    (Some(a), Some(b)) => a.compare_with(b).is_eq(),
                    (a, b) => a.is_none() && b.is_none(),
                };
                assert!(
                    agree,
                    "{class:?} {elements:?} {motion:?}: {first:?}, {expected:?}"
                );
            }
        }
    }

    /// The determinant whose roots are tested.
    fn volume(elements: Elements, motion: &Moving) -> Polynomial {
        let [a, b, c, d] = paths(motion);
        match elements {
            Elements::VertexTriangle => determinant(&minus(&a, &b), &minus(&a, &c), &minus(&a, &d)),
            Elements::EdgeEdge => determinant(&minus(&a, &c), &minus(&a, &d), &minus(&b, &c)),
        }
    }

    #[test]
    fn classes_have_the_roots_that_they_are_named_for() {
        // Numbers among 1,000: always in one plane; with a double root; with three roots; and of
        // these, with the first contact at a later root.
        let count = |class: MotionClass| {
            let mut counts = [0; 4];
            let mut random = Random::new(4);
            for _ in 0..1000 {
                let (elements, motion) = class.motion(&mut random);
                let volume = volume(elements, &motion);
                if volume.is_zero() {
                    counts[0] += 1;
                    continue;
                }
                counts[1] += u32::from(volume.gcd(&volume.derivative()).degree() > 0);
                let mut roots = Root::all(&volume);
                if roots.len() == 3 {
                    counts[2] += 1;
                    let later = first_contact(elements, &motion)
                        .is_some_and(|first| roots[0].compare(&first.0.borrow()).is_lt());
                    counts[3] += u32::from(later);
                }
            }
            println!("{class:?} {counts:?}");
            counts
        };
        assert!(count(MotionClass::Coplanar)[0] > 700);
        assert!(count(MotionClass::Parallel)[0] > 200);
        assert!(count(MotionClass::DoubleRoot)[1] > 150);
        let three = count(MotionClass::ThreeRoots);
        assert!(three[2] > 300 && three[3] > 100);
        assert!(count(MotionClass::Random)[..2] == [0, 0]);
    }
}
