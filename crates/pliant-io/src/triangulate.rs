//! Triangulation of polygons: a fan where it is right, otherwise other triangles.
//!
//! A fan round the first corner is right for every convex polygon; on a concave one it may leave
//! the polygon and fold over itself. The polygon is projected along the axis nearest to its normal,
//! which keeps two coordinates exact. If all triangles of the fan have the same orientation there,
//! it stays. Any other polygon is cut so that no corner is lost, even on straight edges: neighbours
//! have it too.
//!
//! - Four corners: the polygon has one other diagonal.
//! - More corners: a constrained Delaunay triangulation of its corners, with the exact predicates
//!   of the crate `spade`. A triangle is inside if an odd number of edges separates it from the
//!   outside. So holes that are tied to the rim by an edge there and back stay open.
//! - A polygon that crosses itself, or has two vertices in one place, has no triangulation; it
//!   stays a fan.

use spade::{ConstrainedDelaunayTriangulation as Triangulation, Point2, Triangulation as _};

/// Result of triangulating a polygon.
#[derive(Debug, PartialEq)]
pub(crate) enum Cut {
    /// The fan round the first corner.
    Fan,
    /// Other triangles, as many as a fan has, by numbers of corners.
    Other(Vec<[usize; 3]>),
    /// No triangulation exists: the polygon crosses itself, and a fan is wrong too.
    Crossed,
}

type Point = [f64; 3];
type Flat = [f64; 2];

/// Triangulates a polygon of at least four corners.
///
/// `same(i, j)`: whether two corners are the same vertex.
pub(crate) fn cut(corners: &[Point], same: impl Fn(usize, usize) -> bool) -> Cut {
    let flat = flattened(&near_one(corners));
    let turns = |i: usize, j: usize, k: usize| area(flat[i], flat[j], flat[k]);
    let last = corners.len() - 1;
    if (1..last).all(|i| turns(0, i, i + 1) >= 0.0) {
        return Cut::Fan;
    }
    if corners.len() == 4 {
        return if turns(1, 2, 3) >= 0.0 && turns(1, 3, 0) >= 0.0 {
            Cut::Other(vec![[0, 1, 3], [1, 2, 3]])
        } else {
            Cut::Crossed
        };
    }
    delaunay(&flat, same).map_or(Cut::Crossed, Cut::Other)
}

/// Whether any corner is further from the mean plane than a tenth of the bounding box's diagonal.
pub(crate) fn is_bent(corners: &[Point]) -> bool {
    let corners = &near_one(corners)[..];
    let normal = normal(corners);
    let length = normal.iter().fold(0.0, |sum: f64, x| sum.hypot(*x));
    let count = corners.len() as f64;
    let mean: Point =
        std::array::from_fn(|axis| corners.iter().map(|point| point[axis] / count).sum());
    let diagonal = (0..3).fold(0.0, |sum: f64, axis| {
        let along = corners.iter().map(|point| point[axis]);
        let low = along.clone().fold(f64::INFINITY, f64::min);
        sum.hypot(along.fold(f64::NEG_INFINITY, f64::max) - low)
    });
    let height = |point: &Point| -> f64 {
        let parts = (0..3).map(|axis| (normal[axis] / length) * (point[axis] - mean[axis]));
        parts.sum::<f64>().abs()
    };
    // Without a normal the height is NaN, and the comparison false.
    corners.iter().any(|point| height(point) > 0.1 * diagonal)
}

/// Corners scaled by a power of two so that the largest coordinate is about 1.
///
/// Products of small coordinates then do not underflow.
fn near_one(corners: &[Point]) -> Vec<Point> {
    let largest = corners
        .as_flattened()
        .iter()
        .fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let exponent = (largest.to_bits() >> 52) as i32 - 1023;
    // A subnormal number has the smallest exponent, and is scaled as far as one power goes.
    let power = 2.0_f64.powi((-exponent).clamp(-1000, 1000));
    corners
        .iter()
        .map(|point| point.map(|x| x * power))
        .collect()
}

/// Newell's normal: the sum of the areas of the fan's triangles, as a vector.
///
/// Computed relative to the first corner, so that a distant origin causes no cancellation.
fn normal(corners: &[Point]) -> Point {
    let from_first =
        |point: &Point| -> Point { std::array::from_fn(|axis| point[axis] - corners[0][axis]) };
    let mut sum = [0.0; 3];
    for edge in corners[1..].windows(2) {
        let (a, b) = (from_first(&edge[0]), from_first(&edge[1]));
        for axis in 0..3 {
            let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
            sum[axis] += a[i] * b[j] - a[j] * b[i];
        }
    }
    sum
}

/// Corners projected along the axis nearest to the normal, in counterclockwise order.
fn flattened(corners: &[Point]) -> Vec<Flat> {
    let normal = normal(corners);
    let larger = |a: usize, b: usize| {
        if normal[b].abs() > normal[a].abs() {
            b
        } else {
            a
        }
    };
    let axis = larger(larger(0, 1), 2);
    let (mut i, mut j) = ((axis + 1) % 3, (axis + 2) % 3);
    if normal[axis] < 0.0 {
        (i, j) = (j, i);
    }
    corners.iter().map(|point| [point[i], point[j]]).collect()
}

/// Twice the signed area of a triangle, positive if counterclockwise.
fn area(a: Flat, b: Flat, c: Flat) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Triangles of a constrained Delaunay triangulation inside the polygon, sorted.
///
/// They are triples of corner numbers. None unless there are as many as in a fan. Takes O(n log n).
fn delaunay(flat: &[Flat], same: impl Fn(usize, usize) -> bool) -> Option<Vec<[usize; 3]>> {
    // Corners by place. The first of several at one place represents them; they must be one vertex.
    let mut order: Vec<usize> = (0..flat.len()).collect();
    let by_place = |&i: &usize, &j: &usize| {
        let [a, b] = [flat[i], flat[j]];
        a[0].total_cmp(&b[0])
            .then(a[1].total_cmp(&b[1]))
            .then(i.cmp(&j))
    };
    order.sort_by(by_place);
    let mut number = vec![0; flat.len()];
    let mut firsts: Vec<usize> = Vec::new();
    for corner in order {
        match firsts.last() {
            Some(&first) if flat[first] == flat[corner] => {
                if !same(first, corner) {
                    return None;
                }
            }
            _ => firsts.push(corner),
        }
        number[corner] = firsts.len() - 1;
    }

    // Edges there and back are no boundary.
    let next = |corner: usize| (corner + 1) % flat.len();
    let mut edges: Vec<[usize; 2]> = (0..flat.len())
        .map(|corner| [number[corner], number[next(corner)]])
        .map(|[a, b]| [a.min(b), a.max(b)])
        .filter(|[a, b]| a != b)
        .collect();
    edges.sort_unstable();
    let odd = edges
        .chunk_by(|a, b| a == b)
        .filter(|same| same.len() % 2 == 1);
    let edges: Vec<[usize; 2]> = odd.map(|same| same[0]).collect();

    let points = firsts.iter().map(|&corner| {
        let [x, y] = flat[corner];
        spade::mitigate_underflow(Point2::new(x, y))
    });
    let points: Vec<_> = points.collect();
    let count = points.len();
    let mut is_crossed = false;
    let made =
        Triangulation::<Point2<f64>>::try_bulk_load_cdt(points, edges, |_| is_crossed = true);
    let made = made.ok()?;
    if is_crossed || made.num_vertices() != count {
        return None;
    }
    let mut triangles: Vec<[usize; 3]> = inner_faces(&made)
        .map(|corners| corners.map(|vertex| firsts[vertex]))
        .collect();
    if triangles.len() != flat.len() - 2 {
        return None;
    }
    for corners in &mut triangles {
        let least = (0..3).min_by_key(|&at| corners[at]).unwrap_or(0);
        corners.rotate_left(least);
    }
    triangles.sort_unstable();
    Some(triangles)
}

/// The faces inside, counterclockwise: an odd number of constraint edges separates them from
/// outside.
fn inner_faces(made: &Triangulation<Point2<f64>>) -> impl Iterator<Item = [usize; 3]> + '_ {
    let mut is_inside: Vec<Option<bool>> = vec![None; made.num_all_faces()];
    let outside = made.outer_face().fix().index();
    is_inside[outside] = Some(false);
    let mut open = Vec::new();
    for hull in made.convex_hull() {
        open.extend([hull.fix(), hull.rev().fix()]);
    }
    // Each directed edge on the stack has a known face on one of its sides.
    while let Some(edge) = open.pop() {
        let edge = made.directed_edge(edge);
        let [here, there] = [edge.face(), edge.rev().face()].map(|face| face.fix().index());
        if let (Some(inside), None) = (is_inside[here], is_inside[there]) {
            is_inside[there] = Some(inside != edge.is_constraint_edge());
            let face = edge.rev().face();
            if let Some(face) = face.as_inner() {
                open.extend(face.adjacent_edges().map(|edge| edge.fix()));
            }
        }
    }
    made.inner_faces()
        .filter(move |face| is_inside[face.fix().index()] == Some(true))
        .map(|face| face.vertices().map(|vertex| vertex.fix().index()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Triangulates a polygon in the plane, and the same one turned and moved in space.
    fn cuts(flat: &[Flat]) -> Cut {
        let never = |_, _| false;
        let upright: Vec<Point> = flat.iter().map(|&[x, y]| [x, y, 0.0]).collect();
        let made = cut(&upright, never);
        let leaning = flat
            .iter()
            .map(|&[x, y]| [5.0 + x - y, 2.0 * y - 3.0, x + 3.0 * y]);
        let below = flat.iter().map(|&[x, y]| [y, x, 7.0]);
        for elsewhere in [leaning.collect::<Vec<Point>>(), below.collect()] {
            let other = cut(&elsewhere, never);
            assert_eq!(
                std::mem::discriminant(&other),
                std::mem::discriminant(&made)
            );
            check(flat, &other);
        }
        check(flat, &made);
        made
    }

    /// Triangles have the polygon's orientation and its total area.
    fn check(flat: &[Flat], made: &Cut) {
        let Cut::Other(triangles) = made else {
            return;
        };
        let twice = |[i, j, k]: [usize; 3]| area(flat[i], flat[j], flat[k]);
        let whole: f64 = (1..flat.len() - 1).map(|i| twice([0, i, i + 1])).sum();
        let parts = triangles.iter().map(|&triangle| twice(triangle));
        assert!(
            parts
                .clone()
                .all(|part| part.signum() == whole.signum() || part == 0.0)
        );
        assert!((parts.sum::<f64>() - whole).abs() <= 1e-9 * whole.abs());
        let mut used: Vec<usize> = triangles.concat();
        used.sort_unstable();
        used.dedup();
        assert_eq!(used.len(), flat.len(), "no corner is lost");
        assert_eq!(triangles.len(), flat.len() - 2);
    }

    const L: [Flat; 6] = [
        [0.0, 0.0],
        [2.0, 0.0],
        [2.0, 1.0],
        [1.0, 1.0],
        [1.0, 2.0],
        [0.0, 2.0],
    ];

    #[test]
    fn convex_polygons_stay_fans() {
        assert_eq!(
            cuts(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]),
            Cut::Fan
        );
        let round = |i: u32| {
            (f64::from(i) / 9.0 * std::f64::consts::TAU)
                .sin_cos()
                .into()
        };
        assert_eq!(cuts(&(0..9).map(round).collect::<Vec<Flat>>()), Cut::Fan);
        // Corners on a line, and an L whose fan is right.
        assert_eq!(
            cuts(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]),
            Cut::Fan
        );
        assert_eq!(cuts(&L), Cut::Fan);
    }

    #[test]
    fn others_are_cut_inside_whatever_corner_is_the_first() {
        let mut arrow = vec![[0.0, 0.0], [2.0, 1.0], [0.0, 2.0], [1.0, 1.0]];
        let (mut fans, mut others) = (0, 0);
        for _ in 0..4 {
            match cuts(&arrow) {
                Cut::Fan => fans += 1,
                Cut::Other(_) => others += 1,
                Cut::Crossed => panic!("{arrow:?}"),
            }
            arrow.rotate_left(1);
        }
        assert_eq!((fans, others), (2, 2));
        let mut l = L.to_vec();
        for first in 0..6 {
            assert_eq!(
                matches!(cuts(&l), Cut::Fan),
                [0, 3].contains(&first),
                "{first}"
            );
            l.rotate_left(1);
        }
        // A comb, with corners on straight edges.
        let mut comb: Vec<Flat> = vec![[0.0, -1.0], [20.0, -1.0], [40.0, -1.0]];
        for tooth in (0..20).rev() {
            let x = 2.0 * f64::from(tooth);
            comb.extend([[x + 1.0, 0.0], [x + 0.5, 5.0], [x, 0.0]]);
        }
        assert!(matches!(cuts(&comb), Cut::Other(_)));
    }

    #[test]
    fn a_hole_that_is_tied_to_the_rim_stays_open() {
        let rim = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
        let hole = [[1.0, 1.0], [1.0, 3.0], [3.0, 3.0], [3.0, 1.0]];
        let flat: Vec<Flat> = rim
            .into_iter()
            .chain([rim[0]])
            .chain(hole)
            .chain([hole[0]])
            .collect();
        let points: Vec<Point> = flat.iter().map(|&[x, y]| [x, y, 0.0]).collect();
        let made = cut(&points, |i, j| [i, j].contains(&4) || [i, j].contains(&9));
        let Cut::Other(triangles) = made else {
            panic!("{made:?}");
        };
        let sum: f64 = triangles
            .iter()
            .map(|&[i, j, k]| area(flat[i], flat[j], flat[k]))
            .sum();
        assert_eq!((triangles.len(), sum), (8, 2.0 * 12.0));
        // Two vertices at one place could be mistaken for each other.
        assert_eq!(cut(&points, |_, _| false), Cut::Crossed);
    }

    #[test]
    fn what_crosses_itself_is_said_so() {
        assert_eq!(
            cuts(&[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 3.0]]),
            Cut::Crossed
        );
        let star = |i: u32| {
            (f64::from(i) * 0.4 * std::f64::consts::TAU)
                .sin_cos()
                .into()
        };
        let star: Vec<Flat> = (0..5).map(star).collect();
        assert_ne!(cuts(&star), Cut::Fan);
    }

    /// Random star-shaped polygons are triangulated at any magnitude that a file can have.
    #[test]
    fn random_polygons_are_covered() {
        let mut state = 1_u64;
        let mut next = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 40) as f64 / f64::from(1_u32 << 24)
        };
        let mut others = 0;
        for round in 0..600 {
            let scale = [1.0, 1e-30, 3e37, 1e-300][round % 4];
            let count = 4 + round % 40;
            let corner = |i: usize| {
                let (sin, cos) = (i as f64 / count as f64 * std::f64::consts::TAU).sin_cos();
                let far = (0.1 + next()) * scale;
                [far * cos, far * sin]
            };
            let flat: Vec<Flat> = (0..count).map(corner).collect();
            let points: Vec<Point> = flat.iter().map(|&[x, y]| [x, y, 0.0]).collect();
            let made = cut(&points, |_, _| false);
            assert_ne!(made, Cut::Crossed, "{round}");
            let scaled: Vec<Flat> = flat.iter().map(|point| point.map(|x| x / scale)).collect();
            check(&scaled, &made);
            others += usize::from(matches!(made, Cut::Other(_)));
        }
        assert!(others > 300, "{others}");
    }

    #[test]
    fn only_strongly_bent_polygons_are_bent() {
        let square = |z: f64| {
            [
                [0.0, 0.0, z],
                [1.0, 0.0, 0.0],
                [1.0, 1.0, z],
                [0.0, 1.0, 0.0],
            ]
        };
        assert!(!is_bent(&square(0.0)) && !is_bent(&square(0.2)) && is_bent(&square(0.5)));
        assert!(!is_bent(&[[0.0; 3]; 4]), "no plane");
    }
}
