//! Segment in which two triangles of different planes meet: where it ends, and on what.
//!
//! Idea: both triangles meet the line of the two planes in a segment each, and have the overlap of
//! these in common. Ends are compared along the line by orientations of edges alone. So it is exact
//! on which corner, edge or inside an end lies; only coordinates are rounded. Source: the interval
//! test of Guigue and Devillers (2003), with all that is degenerate.

use super::environment::Precision;
use super::float::scaled;
use super::integer::{powers_of_all, quotient};
use super::orientation::{Filtered, Orientation};
use super::point::{Point, Sign, Triangle};
use super::ring::Ring;
use super::triangles::plane_signs;
use super::vector::{determinant, in_units, minus};
use std::cmp::Ordering::{self, Equal, Greater, Less};

/// The part of a triangle on which a point lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Feature {
    /// A corner, by its number.
    Corner(usize),
    /// Inside an edge, from the corner with its number to the next.
    Edge(usize),
    /// Inside the triangle.
    Inside,
}

/// An end of the segment in which two triangles meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct End {
    /// Where it lies on either triangle, exactly.
    pub on: [Feature; 2],
    /// Its position, rounded.
    pub point: Point,
}

/// The segment in which two triangles meet; both ends are equal where they meet in a point.
///
/// `None` if they do not meet, or lie in one plane, as two without area always do. If one has no
/// area, and the other's plane is not its own, they meet in a point.
///
/// On which corner, edge or inside an end lies is exact, and so is the position of a corner.
/// Another position is off by at most 2^-38 of the edge that it lies on, and by four roundings of
/// its coordinates. The order of the ends depends on which triangle is first.
///
/// ```
/// use pliant_exact::{Feature, Precision, segment};
///
/// let floor = [[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
/// let leaf = [[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [9.0, 1.0, 1.0]];
/// let ends = segment(Precision::Double, &floor, &leaf).unwrap();
/// // Edge 0 of the leaf goes through the floor; edge 1 of the floor goes through the leaf.
/// let on = ends.map(|end| end.on);
/// assert!(on.contains(&[Feature::Inside, Feature::Edge(0)]));
/// assert!(on.contains(&[Feature::Edge(1), Feature::Inside]));
/// ```
pub fn segment(precision: Precision, a: &Triangle, b: &Triangle) -> Option<[End; 2]> {
    let orientation = &mut Filtered::new(precision);
    let ends = features([a, b], orientation)?;
    Some(ends.map(|on| End {
        on,
        point: position([a, b], on),
    }))
}

/// A point of a triangle's outline on the plane of another.
#[derive(Clone, Copy)]
struct Crossing {
    on: Feature,
    /// Corners of an edge through it. The first is in front of the plane or on it, the second
    /// behind or on it; not both are on it.
    line: [usize; 2],
}

/// Where the ends lie on both triangles; the ends in the order of the line of both planes.
fn features(
    [a, b]: [&Triangle; 2],
    orientation: &mut impl Orientation,
) -> Option<[[Feature; 2]; 2]> {
    let of_b = plane_signs(a, b, orientation);
    let of_a = plane_signs(b, a, orientation);
    // Corners in the plane of a triangle that is not in theirs: it has no area.
    match (of_a == [0; 3], of_b == [0; 3]) {
        (true, true) => return None,
        (true, false) => {
            let [of_b, of_a] = pierced(b, of_b, a, orientation)?;
            return Some([[of_a, of_b]; 2]);
        }
        (false, true) => return Some([pierced(a, of_a, b, orientation)?; 2]),
        (false, false) => {}
    }
    // Along the line the first triangle begins where its outline goes behind the other's plane. The
    // second begins where its outline comes in front.
    let ([start_a, end_a], [end_b, start_b]) = (outline(of_a)?, outline(of_b)?);
    let mut order = |one: Crossing, other: Crossing| {
        let ([p, q], [r, s]) = (one.line.map(|i| &a[i]), other.line.map(|j| &b[j]));
        orientation.sign(p, q, r, s).cmp(&0)
    };
    let inner = [inner(of_a), inner(of_b)];
    let ends = [order(start_a, end_b), order(end_a, start_b)];
    match ends {
        [Greater, _] | [_, Less] => return None,
        [Equal, _] => return Some([[start_a.on, end_b.on]; 2]),
        [_, Equal] => return Some([[end_a.on, start_b.on]; 2]),
        [Less, Greater] => {}
    }
    // A corner alone, inside the other's segment.
    if start_a.on == end_a.on {
        return Some([[start_a.on, inner[1]]; 2]);
    }
    if start_b.on == end_b.on {
        return Some([[inner[0], start_b.on]; 2]);
    }
    let end = |one: Crossing, other: Crossing, order: Ordering, of_a: Ordering| match order {
        Equal => [one.on, other.on],
        order if order == of_a => [one.on, inner[1]],
        _ => [inner[0], other.on],
    };
    let (starts, stops) = (order(start_a, start_b), order(end_a, end_b));
    Some([
        end(start_a, start_b, starts, Greater),
        end(end_a, end_b, stops, Less),
    ])
}

/// Where the outline of a triangle, with its corners on these sides of a plane, goes behind the
/// plane, and where it comes in front. None if it stays on one side.
fn outline(sides: [Sign; 3]) -> Option<[Crossing; 2]> {
    let (mut down, mut up) = (None, None);
    for i in 0..3 {
        let [before, next] = [(i + 2) % 3, (i + 1) % 3];
        if sides[i] == 0 {
            let other = if sides[next] != 0 { next } else { before };
            let line = if sides[other] < 0 {
                [i, other]
            } else {
                [other, i]
            };
            let on = Feature::Corner(i);
            let crossing = Some(Crossing { on, line });
            // Sides before and behind, where zero goes on as the other does not.
            match (sides[before], sides[next]) {
                (1, 1) | (-1, -1) => (down, up) = (crossing, crossing),
                (1, _) | (0, -1) => down = crossing,
                _ => up = crossing,
            }
        } else if sides[i] * sides[next] < 0 {
            let on = Feature::Edge(i);
            if sides[i] > 0 {
                let line = [i, next];
                down = Some(Crossing { on, line });
            } else {
                let line = [next, i];
                up = Some(Crossing { on, line });
            }
        }
    }
    Some([down?, up?])
}

/// The part of a triangle on which its points between two crossings lie.
fn inner(sides: [Sign; 3]) -> Feature {
    let edge = (0..3).find(|&i| sides[i] == 0 && sides[(i + 1) % 3] == 0);
    edge.map_or(Feature::Inside, Feature::Edge)
}

/// Where a triangle without area, with its corners on these sides of the plane, meets another: the
/// place on either.
fn pierced(
    segment: &Triangle,
    sides: [Sign; 3],
    other: &Triangle,
    orientation: &mut impl Orientation,
) -> Option<[Feature; 2]> {
    let [down, up] = outline(sides)?;
    let [p, q] = down.line.map(|i| &segment[i]);
    let past = [0, 1, 2].map(|j| orientation.sign(p, q, &other[j], &other[(j + 1) % 3]));
    let are_inside = past.iter().all(|&side| side >= 0) || past.iter().all(|&side| side <= 0);
    let on = match past.map(|side| side == 0) {
        [false, false, false] => Feature::Inside,
        [true, false, false] => Feature::Edge(0),
        [false, true, false] => Feature::Edge(1),
        [false, false, true] => Feature::Edge(2),
        [true, _, true] => Feature::Corner(0),
        [true, true, _] => Feature::Corner(1),
        [_, true, true] => Feature::Corner(2),
    };
    are_inside.then_some([down.on.min(up.on), on])
}

/// Position of an end.
fn position([a, b]: [&Triangle; 2], on: [Feature; 2]) -> Point {
    let corner = |triangle: &Triangle, on| match on {
        Feature::Corner(i) => Some(triangle[i]),
        _ => None,
    };
    let edge = |triangle: &Triangle, on, other| match on {
        Feature::Edge(i) => on_plane([triangle[i], triangle[(i + 1) % 3]], other),
        _ => None,
    };
    // On two edges, the other triangle of one may have no plane.
    let known = corner(a, on[0]).or_else(|| corner(b, on[1]));
    let known = known.or_else(|| edge(a, on[0], b));
    known.or_else(|| edge(b, on[1], a)).unwrap_or(a[0])
}

/// Where an edge meets a plane, with its ends on the two sides. None if the plane is none.
fn on_plane([p, q]: [Point; 2], plane: &Triangle) -> Option<Point> {
    let t = parameter([&p, &q], plane)?;
    Some([0, 1, 2].map(|axis| {
        let (from, to) = (p[axis], q[axis]);
        // From the nearer end, so that rounding does not leave the edge.
        let there = if t < 0.5 {
            from + t * (to - from)
        } else {
            to - (1.0 - t) * (to - from)
        };
        there.max(from.min(to)).min(from.max(to))
    }))
}

/// Part of the way from the first end to the second at which an edge meets a plane; off by less
/// than 2^-38. None if the plane is none.
fn parameter([p, q]: [&Point; 2], [a, b, c]: &Triangle) -> Option<f64> {
    // As in the filter of orientations: each is off by at most 9 u of its size.
    let [e, f] = [b, c].map(|corner| minus(corner, a));
    let height = |point: &Point| {
        let t = minus(point, a);
        let (mut value, mut size) = (0.0, 0.0);
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let (left, right) = (e[j] * f[k], e[k] * f[j]);
            value += (left - right) * t[i];
            size += (left.abs() + right.abs()) * t[i].abs();
        }
        (value, size)
    };
    let ((of_p, size_p), (of_q, size_q)) = (height(p), height(q));
    let length = of_p.abs() + of_q.abs();
    let is_certain = size_p + size_q < MOST_TERMS * length && length > LEAST;
    if is_certain && of_p * of_q <= 0.0 {
        return Some(of_p.abs() / length);
    }
    let [unit, _] = powers_of_all([p, q, a, b, c].into_iter().flatten());
    let [p, q, a, b, c] = [p, q, a, b, c].map(|point| in_units(point, unit));
    let [e, f] = [b, c].map(|corner| minus(&corner, &a));
    let [of_p, of_q] = [p, q].map(|point| determinant(&e, &f, &minus(&point, &a)));
    let all = Ring::minus(&of_p, &of_q);
    (all.sign() != 0).then(|| {
        let (m, exponent) = quotient(&of_p, &all);
        scaled(m, exponent).clamp(0.0, 1.0)
    })
}

/// Most that sizes of terms may be of the length: of these 18 u is 2^-39.
const MOST_TERMS: f64 = (1 << 13) as f64 / 9.0;
/// Far above what products of three differences lose below the normal range.
const LEAST: f64 = 1e-200;

#[cfg(test)]
mod tests {
    use super::super::orientation::Exact;
    use super::*;
    use pliant_oracle::Random;

    /// A feature as the oracle numbers it.
    fn number(on: Feature) -> usize {
        match on {
            Feature::Corner(i) => i,
            Feature::Edge(i) => 3 + i,
            Feature::Inside => 6,
        }
    }

    /// Small lattices have ends on corners and edges; on large ones they are inside.
    #[test]
    fn ends_are_the_oracles() {
        let mut random = Random::new(52);
        let mut seen = [[0; 7]; 7];
        let mut points = 0;
        for round in 0..60_000 {
            let size = [2, 3, 5, 9, 40][round % 5];
            let lattice =
                [(); 2].map(|()| [(); 3].map(|()| [(); 3].map(|()| i64::from(random.below(size)))));
            let [a, b] = lattice.map(|triangle| triangle.map(|point| point.map(|x| x as f64)));
            let found = segment(Precision::Double, &a, &b);
            let expected = pliant_oracle::segment(lattice);
            let is_expected = |end: &End| {
                let on = end.on.map(number);
                let other = expected.iter().flatten();
                let mut same = other.filter(|(features, _)| *features == on);
                same.any(|(_, point)| {
                    let off = (0..3).map(|axis| (end.point[axis] - point[axis]).abs());
                    off.fold(0.0, f64::max) <= 40.0 * 2f64.powi(-37)
                })
            };
            assert_eq!(found.is_some(), expected.is_some(), "{lattice:?} {found:?}");
            let (Some(found), Some(expected)) = (found, expected) else {
                continue;
            };
            assert!(
                found.iter().all(is_expected),
                "{lattice:?} {found:?} {expected:?}"
            );
            let is_point = expected[0].1 == expected[1].1;
            assert_eq!(
                is_point,
                found[0] == found[1],
                "{lattice:?} {found:?} {expected:?}"
            );
            points += u32::from(is_point);
            // Both ends, each once.
            let [first, second] = found.map(|end| end.on.map(number));
            assert!(is_point || first != second);
            for on in [first, second] {
                seen[on[0]][on[1]] += 1;
            }
            // With roles exchanged: the same ends.
            let turned = segment(Precision::Double, &b, &a).unwrap();
            let mut turned = turned.map(|end| [end.on[1], end.on[0]]);
            let mut same = found.map(|end| end.on);
            turned.sort_unstable();
            same.sort_unstable();
            assert_eq!(turned, same);
            // The same, far below the range of expansions, and by exact signs alone.
            assert_eq!(
                features([&a, &b], &mut Exact),
                Some(found.map(|end| end.on))
            );
            let tiny = 0.5_f64.powi(600);
            let [a, b] = [&a, &b].map(|triangle| triangle.map(|point| point.map(|x| tiny * x)));
            let small = segment(Precision::Double, &a, &b).unwrap();
            assert_eq!(small.map(|end| end.on), found.map(|end| end.on));
        }
        for (of_a, row) in seen.iter().enumerate() {
            for (of_b, &count) in row.iter().enumerate() {
                let are_both_inside = of_a == 6 && of_b == 6;
                assert_eq!(count > 20, !are_both_inside, "{seen:?}");
            }
        }
        assert!(points > 2_000, "{points}");
    }

    /// Edges that run nearly along the plane: double precision does not know where they meet it.
    #[test]
    fn positions_are_as_near_as_promised() {
        let mut random = Random::new(53);
        for _ in 0..4_000 {
            // Every coordinate is exact: a multiple of 2^-40 below 2^12.
            let unit = 2f64.powi(-40);
            let slope = f64::from(random.below(5)) / 4.0;
            let at = |x: f64, y: f64, height: f64| [x, y, slope * x + unit * height];
            let floor = [
                at(-4000.0, -4000.0, 0.0),
                at(4000.0, -4000.0, 0.0),
                at(0.0, 4000.0, 0.0),
            ];
            let [x, y] = [(); 2].map(|()| f64::from(random.below(1 << 8)));
            let [above, below] = [(); 2].map(|()| f64::from(1 + random.below(9)));
            let from = at(x, y, above);
            let to = at(x + 1000.0, y, -below);
            let leaf = [from, to, [x, y, 3000.0]];
            let ends = segment(Precision::Double, &floor, &leaf).unwrap();
            let on = [Feature::Inside, Feature::Edge(0)];
            let end = ends.iter().find(|end| end.on == on).unwrap();
            let part = above / (above + below);
            let expected = [x + 1000.0 * part, y, slope * (x + 1000.0 * part)];
            for axis in 0..3 {
                let off = (end.point[axis] - expected[axis]).abs();
                let promised = (to[axis] - from[axis]).abs() * 2f64.powi(-38);
                // The formula here is rounded too.
                assert!(
                    off <= promised + 2f64.powi(-39),
                    "{leaf:?} {off} {promised}"
                );
            }
        }
    }
}
