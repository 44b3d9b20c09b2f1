//! A ray along an axis against a triangle, exactly: what winding numbers are summed from.
//!
//! The number of times that a closed surface winds round a point is how often a ray from it leaves,
//! less how often it enters. Seen along the ray, triangles are a mesh in the plane, and the point
//! lies in some of them. On a border it is moved aside by less than any number (Edelsbrunner and
//! Mücke 1990, *Simulation of Simplicity*). So triangles that are seen edge on hold it nowhere, and
//! every edge keeps one side for both its triangles. In space the point stays where it is, and
//! whether a triangle has it is decided before.

use crate::orientation::{Filtered, Orientation, orientation_2d};
use crate::point::Point2;
use crate::triangles::triangles_intersect;
use crate::{Point, Precision, Triangle};

/// Ray along an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Axis {
    /// The axis: 0, 1 or 2.
    pub number: usize,
    /// Whether the ray goes towards larger coordinates.
    pub ascends: bool,
}

/// Crossing of a ray and a closed triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crossing {
    /// Passes it by.
    Misses,
    /// Leaves through it, towards where its normal (b - a) x (c - a) points to.
    Leaves,
    /// Enters through it.
    Enters,
    /// Begins on it.
    Begins,
}

/// Crossing of the ray from a point along an axis and a triangle.
///
/// Exact, for coordinates that are [in range](crate::is_in_range). A degenerate triangle is the
/// segment or point that it is: a ray begins on it or misses it. Over a closed surface, leaves less
/// enters is its winding number, whatever the axis is. Cost: nanoseconds, or about a microsecond
/// where rounding does not decide.
///
/// ```
/// use pliant_exact::{Axis, Crossing, Precision, crossing};
///
/// let roof = [[0.0, 0.0, 1.0], [2.0, 0.0, 1.0], [0.0, 2.0, 1.0]];
/// let up = Axis { number: 2, ascends: true };
/// let from = |z: f64| crossing(Precision::Double, up, &[0.5, 0.5, z], &roof);
/// assert_eq!(
///     [0.0, 1.0, 1.0 + 1e-15].map(from),
///     [Crossing::Leaves, Crossing::Begins, Crossing::Misses]
/// );
/// ```
#[inline]
pub fn crossing(precision: Precision, axis: Axis, point: &Point, triangle: &Triangle) -> Crossing {
    // From these two axes to the third as from x and y to z.
    let (x, y) = ((axis.number + 1) % 3, (axis.number + 2) % 3);
    let seen = |point: &Point| -> Point2 { [point[x], point[y]] };
    let corners = triangle.each_ref().map(seen);
    let at = seen(point);
    let signs = [0, 1, 2].map(|k| orientation_2d(corners[k], corners[(k + 1) % 3], at));
    if signs.contains(&1) && signs.contains(&-1) {
        return Crossing::Misses;
    }
    let mut filtered = Filtered::new(precision);
    let mut turn = signs[0];
    if signs.contains(&0) {
        if triangles_intersect(&[*point; 3], triangle, &mut filtered) {
            return Crossing::Begins;
        }
        let aside = [0, 1, 2].map(|k| match signs[k] {
            0 => side_when_moved(corners[k], corners[(k + 1) % 3]),
            sign => sign,
        });
        turn = aside[0];
        if turn == 0 || aside != [turn; 3] {
            return Crossing::Misses;
        }
    }
    let [a, b, c] = triangle;
    let side = filtered.sign(a, b, c, point);
    // Behind a triangle that is seen from behind, or before one that is seen from before.
    match (side == 0, side == if axis.ascends { -turn } else { turn }) {
        (true, _) => Crossing::Begins,
        (_, false) => Crossing::Misses,
        _ if side < 0 => Crossing::Leaves,
        _ => Crossing::Enters,
    }
}

/// The side of the line from a to b on which a point of it lies, once it is moved. It moves along
/// the first axis, and by much less along the second. Zero if a is b.
///
/// Both are compared as they are: a difference might be flushed to zero.
fn side_when_moved(a: Point2, b: Point2) -> i8 {
    // Of (b - a) x (point - a) the change is minus (b - a)[1], then (b - a)[0].
    let sign = |axis: usize| i8::from(b[axis] > a[axis]) - i8::from(b[axis] < a[axis]);
    match sign(1) {
        0 => sign(0),
        down => -down,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pliant_oracle::{Class, Random, fits_f32, subnormals_flushed, winding_number};

    const FACES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

    fn winding(precision: Precision, axis: Axis, point: &Point, all: &[Triangle]) -> Option<i32> {
        all.iter().try_fold(0, |sum, triangle| {
            match crossing(precision, axis, point, triangle) {
                Crossing::Misses => Some(sum),
                Crossing::Leaves => Some(sum + 1),
                Crossing::Enters => Some(sum - 1),
                Crossing::Begins => None,
            }
        })
    }

    fn axes() -> impl Iterator<Item = Axis> {
        let ways = [true, false].into_iter();
        ways.flat_map(|ascends| (0..3).map(move |number| Axis { number, ascends }))
    }

    /// Two tetrahedra with a common face in some rounds, so that vertices, edges and walls are
    /// straight above and below the points.
    #[test]
    fn windings_are_those_of_segments_in_general_position() {
        let mut random = Random::new(55);
        let [mut on, mut inside, mut outside] = [0; 3];
        for round in 0..1_600 {
            let pair = Class::ALL[round % Class::ALL.len()].pair(&mut random);
            let precision = if fits_f32(&pair) {
                Precision::Single
            } else {
                Precision::Double
            };
            let [a, b] = pair;
            let corners = [a[0], a[1], a[2], b[0]];
            let mut surface = FACES.map(|face| face.map(|k| corners[k])).to_vec();
            if round % 3 == 0 {
                let corners = [a[0], a[1], b[0], b[1]];
                surface.extend(FACES.map(|face| face.map(|k| corners[k])));
            }
            let part = |weights: [f64; 4]| -> Point {
                [0, 1, 2].map(|axis| (0..4).map(|k| weights[k] * corners[k][axis]).sum())
            };
            let mut points = vec![b[1], b[2], corners[3], a[1]];
            if precision == Precision::Double {
                points.push(part([0.25; 4]));
                points.push(part([0.5, 0.25, 0.25, 0.0]));
                points.push(part([0.5, 0.0, 0.5, 0.0]));
            }
            for point in points {
                let expected = winding_number(point, &surface);
                match expected {
                    None => on += 1,
                    Some(0) => outside += 1,
                    Some(_) => inside += 1,
                }
                for axis in axes() {
                    let found = winding(precision, axis, &point, &surface);
                    assert_eq!(found, expected, "{axis:?} {point:?} {surface:?}");
                }
            }
        }
        assert!(
            on > 2_500 && inside > 400 && outside > 2_000,
            "{on} {inside} {outside}"
        );
    }

    /// Every point of a lattice, and a cube whose sides are split: each ray runs along walls, edges
    /// and vertices.
    #[test]
    fn rays_along_walls_count_nothing_twice() {
        let corner = |k: usize| [0, 1, 2].map(|axis| f64::from(u8::from(k >> axis & 1 == 1)) * 2.0);
        let sides = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        let split = |[a, b, c, d]: [usize; 4]| [[a, b, c], [a, c, d]];
        let cube: Vec<Triangle> = sides
            .into_iter()
            .flat_map(split)
            .map(|it| it.map(corner))
            .collect();
        for k in 0..125 {
            let point = [k % 5, k / 5 % 5, k / 25].map(|x| f64::from(x) - 1.0);
            let is_in = point.iter().all(|&x| x == 1.0);
            let is_out = point.iter().any(|&x| !(0.0..=2.0).contains(&x));
            let expected = (is_in || is_out).then_some(i32::from(is_in));
            for axis in axes() {
                assert_eq!(
                    winding(Precision::Single, axis, &point, &cube),
                    expected,
                    "{point:?}"
                );
            }
        }
    }

    #[test]
    fn a_thread_that_flushes_subnormal_numbers_decides_alike() {
        let mut random = Random::new(56);
        let pairs: Vec<_> = (0..400)
            .map(|_| Class::NearUnderflow.pair(&mut random))
            .collect();
        let decide = || -> Vec<Crossing> {
            let of = |[a, b]: &[Triangle; 2]| {
                axes()
                    .map(|axis| crossing(Precision::Double, axis, &a[0], b))
                    .collect()
            };
            pairs
                .iter()
                .flat_map(|pair| -> Vec<_> { of(pair) })
                .collect()
        };
        let expected = decide();
        let flushed = subnormals_flushed(decide);
        assert!(flushed.is_none_or(|found| found == expected));
    }
}
