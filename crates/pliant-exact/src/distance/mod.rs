//! How far apart a vertex and a triangle are, or two edges: whether at most so far, and how far.
//!
//! The least distance of two elements is that of a pair of *features*: ends, insides of edges, the
//! inside of a face. Each pair of features is some distance apart, and one is the nearest; its
//! squared distance is a quotient of integers. So "at most d" is a comparison of integers. A
//! distance has an error of a few units in the last place, however small it is. The features are
//! known from minimum-distance tests (Ericson 2005, chapter 5); here they are compared exactly.

mod features;
mod nearest;
mod triangles;

use super::Feature::{self, Corner, Edge, Inside};
use super::float::{power, scaled};
use super::integer::{Integer, in_proportion, powers_of_all, quotient};
use super::ring::Ring;
use super::vector::{Vector, cross, dot, in_units, minus};
use super::{Length, Point, denormals_are_kept};
pub use features::closest_features;
pub use nearest::nearest_triangle;
pub use triangles::point_in_common;
pub use triangles::{SomePoints, TrianglesClosest, are_triangles_within, closest_triangles};

/// Two elements, by their corners.
#[derive(Clone, Copy, Debug)]
pub enum Primitives {
    /// A point, and the corners of a triangle.
    VertexTriangle([Point; 4]),
    /// The ends of one edge, and the ends of another.
    EdgeEdge([Point; 4]),
}

/// Where two elements are closest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Closest {
    /// How far apart they are, in the unit of the coordinates.
    pub distance: f64,
    /// Where the points are: in a triangle a, b, c the point a + p (b - a) + q (c - a). On two
    /// edges the part p of the way along the first, and the part q along the second.
    pub along: [f64; 2],
    /// From the second to the first, of length 1 within rounding; zero if the distance is.
    pub direction: Point,
}

/// A pair of features: the square of their distance is `over / under`.
struct Feet {
    over: Integer,
    under: Integer,
    along: [f64; 2],
    /// The way from the second to the first, of any length; where they touch, any.
    way: Vector,
    features: [Feature; 2],
}

/// Distances that are larger are all the same: no two points are further apart.
const FARTHEST: f64 = 2.0 * 2.0 * (f32::MAX as f64);

/// Whether two elements are at most a distance apart. Exact.
///
/// The distance is at least 0, in the unit of the coordinates, which are at most `f32::MAX` in
/// magnitude. Cost: some microseconds.
#[cold]
pub fn are_within_distance(elements: &Primitives, distance: impl Into<Length>) -> bool {
    are_within_length(elements, distance.into())
}

fn are_within_length(elements: &Primitives, distance: Length) -> bool {
    let [low, _] = distance.bounds();
    if low >= FARTHEST {
        return true;
    }
    let distance = distance.exactly();
    let [unit, _] = powers_of_all(elements.corners().as_flattened());
    let mut is_within = false;
    feet(elements, unit, &mut |feet| {
        is_within = is_within || is_at_most(&feet, &distance, unit);
    });
    is_within
}

/// Whether two points are at most a distance apart: as [`are_within_distance`], and mostly at once.
///
/// The distance is at least 0, in the unit of the coordinates. With u = 2^-53 the square of the
/// distance of the points is off by 5 u of itself (a difference twice, a square, two sums). That of
/// the given distance is off by u: 32 u of the latter are allowed for. What is lost below the
/// normal range is at most 2^-1020. That is less than the rest of what is allowed where the latter
/// is above 2^-900.
pub fn are_points_within(p: &Point, q: &Point, distance: f64) -> bool {
    let way = minus(p, q);
    let square = dot(&way, &way);
    let limit = distance * distance;
    if limit >= power(-900) && (square - limit).abs() > limit * (16.0 * f64::EPSILON) {
        return square < limit;
    }
    are_within_distance(&Primitives::EdgeEdge([*p, *p, *q, *q]), distance)
}

/// Whether the distance of a pair of features is at most this integer times a power of two.
fn is_at_most(feet: &Feet, (integer, exponent): &(Integer, i32), unit: i32) -> bool {
    if feet.over.is_zero() || integer.is_zero() {
        return feet.over.is_zero();
    }
    let exponent = exponent - unit;
    let (m, e) = integer.approximately();
    // Both are off by less than 2^-49 of themselves.
    let (n, f) = quotient(&feet.over, &feet.under);
    let square = scaled(m * m, (2 * (e + exponent) - f).clamp(-8, 8));
    if (square - n).abs() > n * power(-40) {
        return n < square;
    }
    // So neither of these is much larger than the other.
    let shift = 2 * exponent.unsigned_abs() as usize;
    let [of_over, of_square] = if exponent < 0 { [shift, 0] } else { [0, shift] };
    let over = feet.over.shifted(of_over);
    let square = integer.times(integer).times(&feet.under);
    over.is_at_most(&square.shifted(of_square))
}

/// Where two elements are closest: distance and direction with an error of less than 2^-48 of
/// themselves.
///
/// What is `along` is within 2^-48 of the exact one. The distance is zero where they touch alone:
/// what is below the smallest number is that, and off by as much. Coordinates are [in
/// range](crate::is_in_range). Cost: some microseconds.
#[cold]
pub fn closest(elements: &Primitives) -> Closest {
    closest_of(std::slice::from_ref(elements)).1
}

/// Where the nearest of some pairs of elements are closest, and which pair it is: exactly the
/// nearest, or the first of equally near ones.
fn closest_of(pairs: &[Primitives]) -> (usize, Closest) {
    let coordinates = pairs.iter().flat_map(|pair| pair.corners().as_flattened());
    let [unit, _] = powers_of_all(coordinates);
    let mut least: Option<(usize, Feet)> = None;
    for (which, elements) in pairs.iter().enumerate() {
        feet(elements, unit, &mut |feet| {
            let is_less = least.as_ref().is_none_or(|(_, least)| {
                let [new, old] = [feet.over.times(&least.under), least.over.times(&feet.under)];
                !old.is_at_most(&new)
            });
            if is_less {
                least = Some((which, feet));
            }
        });
    }
    let Some((which, feet)) = least else {
        // There are feet of ends, whatever the elements are.
        return (0, Closest::default());
    };
    let (square, exponent) = quotient(&feet.over, &feet.under);
    // An even exponent: its root is a power of two.
    let odd = exponent.rem_euclid(2);
    let length = scaled(square, odd).sqrt();
    let mut closest = Closest {
        along: feet.along,
        ..Closest::default()
    };
    if !feet.over.is_zero() {
        closest.distance = scaled(length, (exponent - odd) / 2 + unit).max(smallest());
        closest.direction = unit_vector(&feet.way);
    }
    (which, closest)
}

/// The smallest number that is not zero to this thread.
fn smallest() -> f64 {
    if denormals_are_kept() {
        f64::from_bits(1)
    } else {
        f64::MIN_POSITIVE
    }
}

impl Primitives {
    fn corners(&self) -> &[Point; 4] {
        match self {
            Self::VertexTriangle(corners) | Self::EdgeEdge(corners) => corners,
        }
    }
}

/// Shows `found` all feet of elements, in units of 2^unit: some distance each, the least among
/// them.
///
/// ```text
/// point p, edge a + s e, t = p - a      s = t.e / e.e within (0, 1): |t x e|^2 / e.e, else an end
/// point and face, n = e1 x e2           inside by three signs: (n.t)^2 / n.n
/// edges, n = e x f, t = a - b           s = -(t x f).n / n.n, and so the other, within [0, 1]:
///                                       (n.t)^2 / n.n
/// ```
///
/// Where n is zero, the face is an edge or a point. Two parallel edges are as near as an end of one
/// is to the other.
///
/// With b bits a coordinate, a difference has b + 1. A normal has 2 (b + 1) + 1 in each of three,
/// and its square 4 (b + 1) + 4. The square of a volume has 6 (b + 1) + 6. Two quotients of such
/// are compared by products of 10 (b + 1) + 10 bits. A quotient and the square of a distance are by
/// as few, for that is only done where they are nearly equal. So up to 60 bits a coordinate nothing
/// is allocated.
fn feet(elements: &Primitives, unit: i32, found: &mut dyn FnMut(Feet)) {
    let [p, q, r, s] = elements.corners().map(|corner| in_units(&corner, unit));
    match elements {
        Primitives::VertexTriangle(_) => {
            let [a, b, c] = [q, r, s];
            let on =
                |from, edge, to| [Corner(from), Edge(edge), Corner(to)].map(|on| [Corner(0), on]);
            of_end(&p, &a, &b, |along| [along, 0.0], on(0, 0, 1), false, found);
            of_end(&p, &a, &c, |along| [0.0, along], on(0, 2, 2), false, found);
            // Of x and 1 - x the sum is 1 exactly: the first corner counts nothing.
            let from_b = |along: f64| [1.0 - along, 1.0 - (1.0 - along)];
            of_end(&p, &b, &c, from_b, on(1, 1, 2), false, found);
            let (e1, e2, t) = (minus(&b, &a), minus(&c, &a), minus(&p, &a));
            let n = cross(&e1, &e2);
            of_insides(
                &n,
                &t,
                &[dot(&cross(&t, &e2), &n), dot(&cross(&e1, &t), &n)],
                [Corner(0), Inside],
                found,
            );
        }
        Primitives::EdgeEdge(_) => {
            let [a0, a1, b0, b1] = [p, q, r, s];
            let on_b = |end| EDGE.map(|on| [Corner(end), on]);
            let on_a = |end| EDGE.map(|on| [on, Corner(end)]);
            of_end(&a0, &b0, &b1, |along| [0.0, along], on_b(0), false, found);
            of_end(&a1, &b0, &b1, |along| [1.0, along], on_b(1), false, found);
            of_end(&b0, &a0, &a1, |along| [along, 0.0], on_a(0), true, found);
            of_end(&b1, &a0, &a1, |along| [along, 1.0], on_a(1), true, found);
            let (e, f, t) = (minus(&a1, &a0), minus(&b1, &b0), minus(&a0, &b0));
            let n = cross(&e, &f);
            let along = [dot(&cross(&t, &f), &n), dot(&cross(&t, &e), &n)].map(Integer::negated);
            of_insides(&n, &t, &along, [Edge(0); 2], found);
        }
    }
}

/// Features of an edge, from its start to its end.
const EDGE: [Feature; 3] = [Corner(0), Edge(0), Corner(1)];

/// A point and a segment from a to b, which may be a point. `features` are both at its start,
/// inside, and at its end. `is_second`: the point is of the second element.
fn of_end(
    p: &Vector,
    a: &Vector,
    b: &Vector,
    along: impl Fn(f64) -> [f64; 2],
    features: [[Feature; 2]; 3],
    is_second: bool,
    found: &mut dyn FnMut(Feet),
) {
    let (e, t) = (minus(b, a), minus(p, a));
    let (whole, part) = (dot(&e, &e), dot(&t, &e));
    let one = Integer::from(1);
    let (over, under, way, at, place) = if part.sign() <= 0 {
        (dot(&t, &t), one, t, 0.0, 0)
    } else if whole.is_at_most(&part) {
        let t = minus(p, b);
        (dot(&t, &t), one, t, 1.0, 2)
    } else {
        let area = cross(&t, &e);
        let way = std::array::from_fn(|i| t[i].times(&whole).minus(&e[i].times(&part)));
        let along = fraction(&part, &whole);
        (dot(&area, &area), whole, way, along, 1)
    };
    found(Feet {
        over,
        under,
        along: along(at),
        way: turned(way, is_second),
        features: features[place],
    });
}

/// The insides of a face and a point, or of two edges: with a common normal, and how far along
/// times its square. Shown if each is within 0 and the whole, and of a triangle their sum too.
fn of_insides(
    n: &Vector,
    t: &Vector,
    [p, q]: &[Integer; 2],
    features: [Feature; 2],
    found: &mut dyn FnMut(Feet),
) {
    let whole = dot(n, n);
    let is_inside = |x: &Integer| x.sign() >= 0 && x.is_at_most(&whole);
    if whole.is_zero()
        || !is_inside(p)
        || !is_inside(q)
        || features[1] == Inside && !p.plus(q).is_at_most(&whole)
    {
        return;
    }
    let height = dot(n, t);
    found(Feet {
        over: height.times(&height),
        way: turned(n.clone(), height.sign() < 0),
        along: [fraction(p, &whole), fraction(q, &whole)],
        under: whole,
        features,
    });
}

/// A way, or the opposite one.
fn turned(way: Vector, is_opposite: bool) -> Vector {
    if is_opposite {
        way.map(Integer::negated)
    } else {
        way
    }
}

/// A quotient from 0 to 1.
fn fraction(over: &Integer, under: &Integer) -> f64 {
    let (m, e) = quotient(over, under);
    scaled(m, e).min(1.0)
}

/// The unit vector of a way, or zero.
fn unit_vector(way: &Vector) -> Point {
    let way = in_proportion(way);
    let length = dot(&way, &way).sqrt();
    // Of a way that is not zero one component is 1 at least.
    if length == 0.0 {
        way
    } else {
        way.map(|x| x / length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pliant_oracle::{Class, Random, compare_distance};
    use std::cmp::Ordering;

    /// Eight pairs of elements of a hard pair of triangles, and the corners of either.
    fn hard_pairs(triangles: &[[Point; 3]; 2]) -> Vec<(Primitives, Vec<Point>, Vec<Point>)> {
        let pairs = pliant_oracle::element_pairs(triangles).into_iter();
        let of = |(first, corners): (usize, [Point; 4])| {
            let elements = if first == 1 {
                Primitives::VertexTriangle(corners)
            } else {
                Primitives::EdgeEdge(corners)
            };
            let (a, b) = corners.split_at(first);
            (elements, a.to_vec(), b.to_vec())
        };
        pairs.map(of).collect()
    }

    #[test]
    fn the_exact_distance_is_that_of_the_oracle() {
        let mut random = Random::new(41);
        let [mut inside, mut touching, mut tiny, mut total] = [0; 4];
        for round in 0..6_000 {
            let pair = Class::ALL[round % Class::ALL.len()].pair(&mut random);
            for (elements, a, b) in hard_pairs(&pair) {
                let found = closest(&elements);
                let d = found.distance;
                for x in [
                    d,
                    d.next_up(),
                    d.next_down().max(0.0),
                    d * (1.0 + 1e-9),
                    d * (1.0 - 1e-9),
                    0.0,
                    0.3,
                ] {
                    let expected = compare_distance(&a, &b, x);
                    assert_eq!(
                        are_within_distance(&elements, x),
                        expected != Ordering::Greater,
                        "{elements:?} {x}"
                    );
                    // As a sum of three, and as one that is a little more.
                    let is_within = |numbers| are_within_distance(&elements, Length::sum(numbers));
                    let parts = [x / 2.0, x / 4.0, x - x / 2.0 - x / 4.0];
                    assert_eq!(is_within(parts), expected != Ordering::Greater, "{parts:?}");
                    let more = is_within([x, x * 2f64.powi(-200), 0.0]);
                    let below = expected != Ordering::Greater;
                    assert!(more || !below, "{elements:?} {x}");
                    if more && !below {
                        let within = compare_distance(&a, &b, x.next_up());
                        assert_ne!(within, Ordering::Greater, "{elements:?} {x}");
                    }
                }
                // Below the normal range by no more than the smallest number besides.
                let slack = 2f64.powi(-48);
                let [below, above] = [d * (1.0 - slack), d * (1.0 + slack)];
                let [below, above] = if d > f64::MIN_POSITIVE {
                    [below, above]
                } else {
                    [below.next_down().max(0.0), above.next_up()]
                };
                assert_ne!(compare_distance(&a, &b, above), Ordering::Greater);
                assert_ne!(compare_distance(&a, &b, below), Ordering::Less);
                let touch = compare_distance(&a, &b, 0.0) == Ordering::Equal;
                assert_eq!(d == 0.0, touch, "{elements:?}");
                total += 1;
                touching += u32::from(touch);
                tiny += u32::from(!touch && compare_distance(&a, &b, f64::from_bits(1)).is_lt());
                inside += u32::from(found.along.iter().all(|&x| x > 0.0 && x < 1.0));
                assert_eq!(d == 0.0, found.direction == [0.0; 3], "{elements:?}");
            }
        }
        assert!(
            touching > total / 50 && inside > total / 20 && tiny > 20,
            "{touching} {inside} {tiny} {total}"
        );
    }
}
