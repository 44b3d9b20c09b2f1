//! Closest features of two elements: which ends, edges or faces hold the nearest points, exactly.
//!
//! A contact that is seen from several triangles has the same features in each, so they are its
//! name. Voronoi regions (Ericson 2005, chapter 5) decide in double precision with proven bounds;
//! what is not certain is decided by comparing all feet in integers. Two parallel edges may have
//! several nearest pairs of features.

use super::{Feature, Feet, Primitives, feet};
use crate::Feature::{Corner, Edge, Inside};
use crate::Point;
use crate::float::power;
use crate::integer::powers_of_all;
use crate::ring::Ring;

/// Shows `found` the pairs of features that hold the closest points of two elements. Exact.
///
/// Corners are numbered as in either element. An edge goes from a corner to the next; of two edges
/// `Edge(0)` is the inside of each. Mostly there is one pair of features. Parallel edges, and
/// points on a border between features, have several. Then all are shown, some perhaps twice.
///
/// Cost: below a microsecond, or microseconds where rounding does not decide.
pub fn closest_features(elements: &Primitives, mut found: impl FnMut([Feature; 2])) {
    if let Some(features) = certain_features(elements) {
        return found(features);
    }
    let [unit, _] = powers_of_all(elements.corners().as_flattened());
    let mut nearest: Vec<Feet> = Vec::new();
    feet(elements, unit, &mut |new| {
        if let Some(old) = nearest.first() {
            let [of_new, of_old] = [new.over.times(&old.under), old.over.times(&new.under)];
            if !of_old.is_at_most(&of_new) {
                nearest.clear();
            } else if !of_new.is_at_most(&of_old) {
                return;
            }
        }
        nearest.push(new);
    });
    nearest.iter().for_each(|feet| found(feet.features));
}

/// Bound on what a product, and the sum that it is part of, lose below the normal range.
const LOST: f64 = 4.0 * f64::MIN_POSITIVE;

/// A number, and a bound on how far it is off.
///
/// Bounds are sums of roundings of 2^-52 instead of 2^-53 each. What is computed of a bound is off
/// by less than the other half.
#[derive(Clone, Copy)]
struct Bounded {
    x: f64,
    error: f64,
}

impl Bounded {
    fn of(x: f64, error: f64) -> Self {
        Self {
            x,
            error: error + x.abs() * f64::EPSILON,
        }
    }

    fn times(self, other: Self) -> Self {
        let error = self.x.abs() * other.error + other.x.abs() * self.error;
        let error = error + self.error * other.error + LOST;
        Self::of(self.x * other.x, error)
    }

    fn plus(self, other: Self) -> Self {
        Self::of(self.x + other.x, self.error + other.error)
    }

    fn minus(self, other: Self) -> Self {
        Self::of(self.x - other.x, self.error + other.error)
    }

    /// Whether it is certainly above 0.
    fn is_positive(self) -> bool {
        self.x > self.error
    }

    /// Whether it is certainly below 0.
    fn is_negative(self) -> bool {
        self.x < -self.error
    }
}

type Way = [Bounded; 3];

/// The way from `b` to `a`.
fn way(a: &Point, b: &Point) -> Way {
    [0, 1, 2].map(|axis| Bounded::of(a[axis] - b[axis], 0.0))
}

fn dot(a: &Way, b: &Way) -> Bounded {
    let [x, y, z] = [0, 1, 2].map(|axis| a[axis].times(b[axis]));
    x.plus(y).plus(z)
}

fn cross(a: &Way, b: &Way) -> Way {
    [0, 1, 2].map(|axis| {
        let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
        a[j].times(b[k]).minus(a[k].times(b[j]))
    })
}

/// The features, if they are certain in double precision.
fn certain_features(elements: &Primitives) -> Option<[Feature; 2]> {
    // Products of six differences neither overflow nor lose anything.
    let size = |most: f64, x: &f64| most.max(x.abs());
    let most = elements.corners().as_flattened().iter().fold(0.0, size);
    if !(power(-100)..power(100)).contains(&most) {
        return None;
    }
    match elements {
        Primitives::VertexTriangle([p, a, b, c]) => {
            of_point_and_triangle(p, [a, b, c]).map(|on| [Corner(0), on])
        }
        Primitives::EdgeEdge([a0, a1, b0, b1]) => of_edges([a0, a1], [b0, b1]),
    }
}

/// The feature of a triangle in whose Voronoi region a point certainly is.
fn of_point_and_triangle(p: &Point, corners: [&Point; 3]) -> Option<Feature> {
    // From each corner to the next, and to the point.
    let edges = [0, 1, 2].map(|k| way(corners[(k + 1) % 3], corners[k]));
    let to_point = corners.map(|corner| way(p, corner));
    let ahead = [0, 1, 2].map(|k| dot(&edges[k], &to_point[k]));
    let behind = [0, 1, 2].map(|k| dot(&edges[k], &to_point[(k + 1) % 3]));
    for k in 0..3 {
        // Behind the start of its edge, and beyond the end of the edge before.
        if ahead[k].is_negative() && behind[(k + 2) % 3].is_positive() {
            return Some(Corner(k));
        }
    }
    let n = cross(&edges[0], &edges[1]);
    let sides = [0, 1, 2].map(|k| dot(&cross(&edges[k], &to_point[k]), &n));
    for k in 0..3 {
        if sides[k].is_negative() && ahead[k].is_positive() && behind[k].is_negative() {
            return Some(Edge(k));
        }
    }
    sides
        .iter()
        .all(|side| side.is_positive())
        .then_some(Inside)
}

/// The features of two edges that are certainly the nearest.
fn of_edges(a: [&Point; 2], b: [&Point; 2]) -> Option<[Feature; 2]> {
    let (e, f, t) = (way(a[1], a[0]), way(b[1], b[0]), way(a[0], b[0]));
    let n = cross(&e, &f);
    let whole = dot(&n, &n);
    // How far along each edge the common normal is, times the square of its length.
    let along = [dot(&cross(&f, &t), &n), dot(&cross(&e, &t), &n)];
    let is_inside = |x: &Bounded| x.is_positive() && whole.minus(*x).is_positive();
    if along.iter().all(is_inside) {
        return Some([Edge(0); 2]);
    }
    let is_outside = |x: &Bounded| x.is_negative() || whole.minus(*x).is_negative();
    if !whole.is_positive() || !along.iter().any(is_outside) {
        return None;
    }
    // So an end of one is nearest to the other: its square of the distance is `over / under`.
    let mut nearest: Option<(Bounded, Bounded, [Feature; 2])> = None;
    for (point, end, edge, is_second) in [
        (a[0], 0, b, false),
        (a[1], 1, b, false),
        (b[0], 0, a, true),
        (b[1], 1, a, true),
    ] {
        let (e, t, beyond) = (
            way(edge[1], edge[0]),
            way(point, edge[0]),
            way(point, edge[1]),
        );
        let (ahead, behind) = (dot(&e, &t), dot(&e, &beyond));
        let one = Bounded { x: 1.0, error: 0.0 };
        let (over, under, on) = if ahead.is_negative() {
            (dot(&t, &t), one, Corner(0))
        } else if behind.is_positive() {
            (dot(&beyond, &beyond), one, Corner(1))
        } else if ahead.is_positive() && behind.is_negative() {
            let area = cross(&t, &e);
            (dot(&area, &area), dot(&e, &e), Edge(0))
        } else {
            return None;
        };
        let features = if is_second {
            [on, Corner(end)]
        } else {
            [Corner(end), on]
        };
        let Some((least, of_least, known)) = nearest else {
            nearest = Some((over, under, features));
            continue;
        };
        if known == features {
            continue;
        }
        let difference = over.times(of_least).minus(least.times(under));
        if difference.is_negative() {
            nearest = Some((over, under, features));
        } else if !difference.is_positive() {
            return None;
        }
    }
    nearest.map(|(_, _, features)| features)
}

#[cfg(test)]
mod tests {
    use super::*;
    use pliant_oracle::{Class, Random, compare_distance, element_pairs};
    use std::cmp::Ordering;

    /// Compares a distance, by an oracle that takes a point, or two edges.
    fn compare(p: &[Point], q: &[Point], x: f64) -> Ordering {
        match [p.len(), q.len()] {
            [2, 1] => compare_distance(q, p, x),
            _ => compare_distance(p, q, x),
        }
    }

    /// Points of a feature of an element, which has one corner, two or three.
    fn corners_of(element: &[Point], on: Feature) -> Vec<Point> {
        match on {
            Corner(k) => vec![element[k]],
            Edge(k) => vec![element[k], element[(k + 1) % element.len()]],
            Inside => element.to_vec(),
        }
    }

    /// Parts of a feature that are features of their own, and of one dimension less.
    fn borders_of(element: &[Point], on: Feature) -> Vec<Vec<Point>> {
        match on {
            Corner(_) => vec![],
            Edge(_) => corners_of(element, on)
                .into_iter()
                .map(|it| vec![it])
                .collect(),
            Inside => (0..3).map(|k| corners_of(element, Edge(k))).collect(),
        }
    }

    /// All are as near as the elements, by an oracle that knows no features. What is certain in
    /// double precision is not as near anywhere on its borders.
    #[test]
    fn features_are_as_near_as_the_elements_and_their_borders_are_not() {
        let mut random = Random::new(5);
        let (mut certain, mut several, mut total) = (0, 0, 0);
        for round in 0..4_000 {
            let pair = Class::ALL[round % Class::ALL.len()].pair(&mut random);
            for (first, corners) in element_pairs(&pair) {
                let elements = if first == 1 {
                    Primitives::VertexTriangle(corners)
                } else {
                    Primitives::EdgeEdge(corners)
                };
                let (a, b) = corners.split_at(first);
                let mut all = Vec::new();
                closest_features(&elements, |features| all.push(features));
                let exactly = {
                    let mut all = Vec::new();
                    let [unit, _] = powers_of_all(corners.as_flattened());
                    feet(&elements, unit, &mut |feet| all.push(feet.features));
                    all
                };
                let distance = crate::distance::closest(&elements).distance;
                let as_near = |p: &[Point], q: &[Point]| {
                    [distance, distance.next_down().max(0.0), distance.next_up()]
                        .iter()
                        .all(|&x| compare(p, q, x) == compare(a, b, x))
                };
                for [of_a, of_b] in &all {
                    assert!(exactly.contains(&[*of_a, *of_b]), "{elements:?}");
                    let (p, q) = (corners_of(a, *of_a), corners_of(b, *of_b));
                    assert!(as_near(&p, &q), "{elements:?} {of_a:?} {of_b:?}");
                }
                total += 1;
                several += u32::from(all.len() > 1);
                if let Some([of_a, of_b]) = certain_features(&elements) {
                    certain += 1;
                    let [p, q] = [corners_of(a, of_a), corners_of(b, of_b)];
                    // Only where doubles tell distances apart.
                    let further = |p: &[Point], q: &[Point]| {
                        compare(p, q, distance * (1.0 - 1e-9)) == Ordering::Greater
                    };
                    for border in borders_of(a, of_a) {
                        assert!(further(&border, &q));
                    }
                    for border in borders_of(b, of_b) {
                        assert!(further(&p, &border));
                    }
                }
            }
        }
        assert!(
            certain > total / 4 && several > total / 20,
            "{certain} {several} {total}"
        );
    }
}
