//! Points that two triangles have in common: where, and on which corner, edge or inside of either.
//!
//! Two triangles of different planes meet in a segment, or in a point; in one plane they meet in a
//! polygon. Its corners are features of both, decided by signs alone, and so exactly. Coordinates
//! alone are rounded.

mod feature;
mod polygon;
mod position;
mod segment;

use super::environment::Precision;
use super::orientation::{Filtered, Orientation};
use super::point::{Point, Triangle};
pub use feature::Feature;
use polygon::Corners;
use position::position;

/// A corner of what two triangles have in common: an end of a segment, or a corner of a polygon.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct End {
    /// Where it lies on either triangle, exactly.
    pub on: [Feature; 2],
    /// Its position, rounded.
    pub point: Point,
    /// Where it lies on an edge: the part of the way from the edge's corner to the next, rounded.
    pub parameter: [Option<f64>; 2],
}

/// Points that two triangles have in common: the corners of their hull.
///
/// None, if they do not meet; one point; two ends of a segment; or three to six corners of a
/// polygon, in order around it. A polygon lies in the plane of both.
#[derive(Clone, Copy, Debug)]
pub struct Intersection<'t> {
    of: [&'t Triangle; 2],
    corners: Corners,
    is_flat: bool,
}

impl Intersection<'_> {
    /// Number of ends.
    pub fn len(&self) -> usize {
        self.corners.all().len()
    }

    /// Whether they do not meet.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The ends, whose positions are computed here.
    pub fn ends(&self) -> impl ExactSizeIterator<Item = End> {
        self.corners.all().iter().map(|&on| {
            let (point, parameter) = position(self.of, on);
            End {
                on,
                point,
                parameter,
            }
        })
    }

    /// Whether all corners of each triangle are in the plane of the other.
    ///
    /// Two triangles without area always are, whether or not in one plane.
    pub fn is_flat(&self) -> bool {
        self.is_flat
    }
}

/// The points that two triangles have in common, as closed sets.
///
/// On which corner, edge or inside an end lies is exact, and so is the position of a corner.
/// Another position is off by at most 2^-38 of the edge that it lies on, and by four roundings of
/// its coordinates. A parameter is off by at most 2^-38. Where an edge goes through the inside of a
/// triangle, both depend only on these two. So every triangle that has the edge gives the same.
///
/// A segment runs along n_a x n_b, where n_a and n_b are the normals (b - a) x (c - a) of both. A
/// triangle without area is the segment or point that it is. Of the edges and corners of it that
/// hold an end, one is named. Exact for coordinates that are [in range](crate::is_in_range). Cost:
/// some hundred nanoseconds.
///
/// ```
/// use pliant_exact::{Feature, Precision, intersection};
///
/// let floor = [[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
/// let leaf = [[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [9.0, 1.0, 1.0]];
/// let both: Vec<_> = intersection(Precision::Double, &floor, &leaf).ends().collect();
/// // Edge 1 of the floor goes through the leaf, and edge 0 of the leaf through the floor.
/// assert_eq!(both[0].on, [Feature::Edge(1), Feature::Inside]);
/// assert_eq!(both[1].on, [Feature::Inside, Feature::Edge(0)]);
/// assert_eq!([both[0].point, both[1].point], [[3.0, 1.0, 0.0], [1.0, 1.0, 0.0]]);
/// assert_eq!(both[1].parameter, [None, Some(0.5)]);
///
/// let beside = floor.map(|[x, y, z]| [x + 1.0, y + 1.0, z]);
/// assert_eq!(intersection(Precision::Double, &floor, &beside).len(), 3);
/// ```
pub fn intersection<'t>(
    precision: Precision,
    a: &'t Triangle,
    b: &'t Triangle,
) -> Intersection<'t> {
    let (corners, is_flat) = features([a, b], &mut Filtered::new(precision));
    Intersection {
        of: [a, b],
        corners,
        is_flat,
    }
}

/// Features of both triangles on which the corners of their intersection lie. And whether all
/// corners of each triangle are in the plane of the other.
fn features(both: [&Triangle; 2], orientation: &mut impl Orientation) -> (Corners, bool) {
    let [a, b] = both;
    let sides = [orientation.plane_signs(b, a), orientation.plane_signs(a, b)];
    if sides == [[0; 3]; 2] {
        return (polygon::corners(both, orientation), true);
    }
    let ends = segment::ends(both, sides, orientation);
    (
        ends.map_or_else(Corners::default, Corners::of_segment),
        false,
    )
}

#[cfg(test)]
mod tests {
    use super::super::orientation::Exact;
    use super::super::vector::{cross, dot, minus};
    use super::*;
    use pliant_oracle::Random;

    /// A feature as the oracle numbers it.
    fn number(on: Feature) -> usize {
        u8::from(on).into()
    }

    fn off(p: Point, q: Point) -> f64 {
        (0..3)
            .map(|axis| (p[axis] - q[axis]).abs())
            .fold(0.0, f64::max)
    }

    /// The point of an edge at this part of the way.
    fn along(triangle: &Triangle, edge: usize, t: f64) -> Point {
        let [p, q] = [triangle[edge], triangle[(edge + 1) % 3]];
        [0, 1, 2].map(|axis| p[axis] + t * (q[axis] - p[axis]))
    }

    /// Whether these are corners of a convex polygon in order, none of them flat.
    fn is_convex(corners: &[End]) -> bool {
        let at = |i: usize| corners[i % corners.len()].point;
        let turn = |i: usize| {
            let (e, f) = (minus(&at(i + 1), &at(i)), minus(&at(i + 2), &at(i + 1)));
            cross(&e, &f)
        };
        let first = turn(0);
        (0..corners.len()).all(|i| dot(&turn(i), &first) > 1e-9)
    }

    /// Small lattices have ends on corners and edges; on large ones they are inside.
    #[test]
    fn ends_are_the_oracles() {
        let mut random = Random::new(52);
        let mut seen = [[0; 7]; 7];
        let mut sizes = [[0; 7]; 2];
        for round in 0..60_000 {
            let size = [2, 3, 5, 9, 40][round % 5];
            // In one plane, which is no plane of axes.
            let flat = i64::from(round % 3 == 0);
            let slope = round as i64 % 4 - 1;
            let mut point = || {
                let [x, y, z] = [(); 3].map(|()| i64::from(random.below(size)));
                [x, y, z * (1 - flat) + flat * slope * (x + y)]
            };
            let lattice: [[[i64; 3]; 3]; 2] = [(); 2].map(|()| [(); 3].map(|()| point()));
            let [a, b] = lattice.map(|triangle| triangle.map(|point| point.map(|x| x as f64)));
            let found: Vec<End> = intersection(Precision::Double, &a, &b).ends().collect();
            let expected = pliant_oracle::intersection(lattice);
            let what = format!("{lattice:?} {found:?} {expected:?}");
            assert_eq!(found.len(), expected.len(), "{what}");
            for end in &found {
                let on = end.on.map(number);
                let other = expected.iter().find(|(features, _)| *features == on);
                let (_, point) = other.unwrap_or_else(|| panic!("{what}"));
                let promised = 200.0 * 2f64.powi(-37);
                assert!(off(end.point, *point) <= promised, "{what}");
                for (of, triangle) in [&a, &b].into_iter().enumerate() {
                    let t = end.parameter[of];
                    assert_eq!(t.is_some(), matches!(end.on[of], Feature::Edge(_)));
                    if let (Feature::Edge(edge), Some(t)) = (end.on[of], t) {
                        assert!(off(along(triangle, edge, t), *point) <= promised, "{what}");
                    }
                }
                seen[on[0]][on[1]] += 1;
            }
            sizes[usize::from(round % 3 == 0)][found.len()] += 1;
            if let [first, second] = found[..]
                && round % 3 != 0
            {
                let normals = [&a, &b].map(|[p, q, r]| {
                    let [e, f] = [q, r].map(|corner| minus(corner, p));
                    cross(&e, &f)
                });
                let line = cross(&normals[0], &normals[1]);
                let way = minus(&second.point, &first.point);
                let is_flat = line == [0.0; 3];
                assert!(is_flat || dot(&line, &way) > 0.0, "{what}");
            }
            assert!(found.len() < 3 || is_convex(&found), "{what}");
            let sorted = |found: &[[Feature; 2]]| {
                let mut all = found.to_vec();
                all.sort_unstable();
                all
            };
            let on: Vec<_> = found.iter().map(|end| end.on).collect();
            // With roles exchanged: the same ends.
            let turned = intersection(Precision::Double, &b, &a);
            let turned = turned.ends().map(|end| [end.on[1], end.on[0]]);
            let turned: Vec<_> = turned.collect();
            assert_eq!(sorted(&turned), sorted(&on), "{what}");
            // The same, far below the range of expansions, and by exact signs alone.
            assert_eq!(*features([&a, &b], &mut Exact).0.all(), *on);
            let tiny = 0.5_f64.powi(600);
            let [a, b] = [&a, &b].map(|triangle| triangle.map(|point| point.map(|x| tiny * x)));
            let small = intersection(Precision::Double, &a, &b);
            assert!(small.ends().map(|end| end.on).eq(on));
        }
        for (of_a, row) in seen.iter().enumerate() {
            for (of_b, &count) in row.iter().enumerate() {
                let are_both_inside = of_a == 6 && of_b == 6;
                assert_eq!(count > 20, !are_both_inside, "{seen:?}");
            }
        }
        assert!(
            sizes[0][..3].iter().all(|&count| count > 1_000),
            "{sizes:?}"
        );
        assert!(sizes[1].iter().all(|&count| count > 20), "{sizes:?}");
    }

    /// Whichever triangle has an edge, and whichever way, it meets the other in the same point.
    #[test]
    fn positions_are_the_same_from_both_triangles_at_an_edge() {
        let mut random = Random::new(54);
        let mut number = || f64::from(random.below(1 << 20)) / 1e6;
        let mut found = 0;
        for _ in 0..4_000 {
            let mut point = || [number(), number(), number()];
            let [p, q, r, s] = [(); 4].map(|()| point());
            let floor = [(); 3].map(|()| point());
            let on_edge = |triangle: &Triangle, edge| {
                let both = intersection(Precision::Double, triangle, &floor);
                let end = both
                    .ends()
                    .find(|end| end.on == [Feature::Edge(edge), Feature::Inside]);
                end.map(|end| (end.point, end.parameter[0]))
            };
            let one = on_edge(&[p, q, r], 0);
            let other = on_edge(&[s, q, p], 1);
            assert_eq!(one.map(|(point, _)| point), other.map(|(point, _)| point));
            if let (Some((_, Some(t))), Some((_, Some(u)))) = (one, other) {
                assert!((t + u - 1.0).abs() <= f64::EPSILON);
                found += 1;
            }
        }
        assert!(found > 300, "{found}");
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
            let ends = intersection(Precision::Double, &floor, &leaf);
            let on = [Feature::Inside, Feature::Edge(0)];
            let end = ends.ends().find(|end| end.on == on).unwrap();
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
