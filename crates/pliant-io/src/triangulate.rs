//! Which triangles a polygon is: a fan where that is right, as it is of every convex polygon, otherwise others.
//!
//! A fan round the first corner goes outside a polygon that bends inward elsewhere, and folds over itself; its triangles then meet
//! what the polygon does not. So the polygon is seen along the axis to which it is most nearly square, where its corners keep two of
//! their coordinates as they are. If all triangles of the fan go round the same way there, the fan stays. A polygon of four corners
//! has one other way to be cut. Of any other a constrained Delaunay triangulation between its own corners is made (the crate `spade`,
//! whose predicates are exact); inside is what an odd number of edges parts from the outside, so holes that are tied to the rim by an
//! edge there and back stay open. No corner is lost, also where several lie on a line, for neighbours have them too.
//!
//! A polygon that crosses itself, or has two corners in one place, has no such triangles; it stays a fan.

use spade::{ConstrainedDelaunayTriangulation as Triangulation, Point2, Triangulation as _};

/// How a polygon is cut.
#[derive(Debug, PartialEq)]
pub(crate) enum Cut {
    /// Round the first corner.
    Fan,
    /// Into these triangles, as many as a fan has, by numbers of corners.
    Other(Vec<[usize; 3]>),
    /// A fan would be wrong, and so would anything else.
    Crossed,
}

type Point = [f64; 3];
type Flat = [f64; 2];

/// Cuts a polygon of at least four corners. `same(i, j)`: whether two corners are the same vertex.
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

/// Whether any corner lies further from the mean plane than a tenth of the diagonal of the polygon's box.
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
    // Where there is no normal, nothing is said: the comparison is false of what is no number.
    corners.iter().any(|point| height(point) > 0.1 * diagonal)
}

/// The corners times a power of two, so that the largest coordinate is about one: no product of theirs is lost for being small.
fn near_one(corners: &[Point]) -> Vec<Point> {
    let largest = corners
        .as_flattened()
        .iter()
        .fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let exponent = (largest.to_bits() >> 52) as i32 - 1023;
    // A subnormal number has the smallest exponent, and is brought as far as one power goes.
    let power = 2.0_f64.powi((-exponent).clamp(-1000, 1000));
    corners
        .iter()
        .map(|point| point.map(|x| x * power))
        .collect()
}

/// The sum of the areas of the fan, as a vector: Newell's normal, without what is far from the first corner cancelling out.
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

/// The corners along the axis nearest to the normal, so that the polygon as a whole goes round counterclockwise.
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

/// Twice the area of a triangle that goes round counterclockwise.
fn area(a: Flat, b: Flat, c: Flat) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// The triangles inside, by numbers of corners, sorted; none unless they are as many as those of a fan.
fn delaunay(flat: &[Flat], same: impl Fn(usize, usize) -> bool) -> Option<Vec<[usize; 3]>> {
    // Corners by place: the first of those at one place stands for all of them, which are one vertex.
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

/// The faces inside, counterclockwise: an odd number of constraint edges parts them from the outside.
fn inner_faces(made: &Triangulation<Point2<f64>>) -> impl Iterator<Item = [usize; 3]> + '_ {
    let mut is_inside: Vec<Option<bool>> = vec![None; made.num_all_faces()];
    let outside = made.outer_face().fix().index();
    is_inside[outside] = Some(false);
    let mut open = Vec::new();
    for hull in made.convex_hull() {
        open.extend([hull.fix(), hull.rev().fix()]);
    }
    // Every directed edge here has a face that is known, or its opposite has.
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

    /// A polygon in the plane, and the same turned and moved in space.
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

    /// Triangles go round as the polygon does, and cover as much.
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
        // Corners on a line, and an L that its fan fits.
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
        // A comb, with corners on lines.
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
        // Corners at one place that are two vertices could be mistaken for each other.
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

    /// Random stars round a point are cut, at any magnitude that a file can have.
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
