//! Close triangles: pairs that are at most a distance apart, decided exactly. Triangles that
//! intersect are at distance 0.
//!
//! Candidates are triangles whose boxes, grown by half the distance, overlap. Within a body, pairs
//! that share a vertex of the mesh are left out as in `intersections`. Each pair is decided between
//! two proven bounds (`kernels::closest`); where the distance lies between them, exact arithmetic
//! (`pliant_exact::distance`) decides.

use super::closest::{ACCURACY, half};
use super::hit::CloseTriangles;
use super::measured::{Measurable, measure_all};
use crate::geometry::{Real, Shape};
use crate::ids::TreeTriangle;
use crate::kernels::closest::{TwoClosest, apart_along, of_triangles};
use crate::kernels::{Coordinate, Instructions, Simd, dispatch};
use crate::queries::{
    Batch, CallerIds, Candidate, FoundBy, Intersections, Kind, LeafTest, Margin, Needs,
    OF_GROWN_SHAPES, Pair,
};
use crate::threads::Interrupt;
use pliant_exact::barycentric;
use pliant_exact::distance::{
    SomePoints, TrianglesClosest, are_triangles_within, closest_triangles,
};
use pliant_exact::{Length, Triangle};
use std::marker::PhantomData;

/// Kind of query: pairs of triangles that are at most a distance apart.
#[derive(Debug)]
pub(crate) struct NearTriangles<S> {
    margin: Margin,
    distance: f64,
    scalar: PhantomData<S>,
}

impl<S> NearTriangles<S> {
    /// Close triangles within a distance, finite and at least 0.
    pub(crate) fn within(distance: f64) -> Self {
        Self {
            margin: Margin::new(half(distance)),
            distance,
            scalar: PhantomData,
        }
    }
}

/// Corners of a triangle, each with padding.
pub(crate) type ThreeCorners<'c, S> = [&'c [S; 4]; 3];

/// The nearest pair of triangles of two bodies so far, as pairs are measured one after the other.
pub(crate) struct NearestPair {
    cut_off: f64,
    nearest: Option<(Candidate, TrianglesClosest)>,
}

impl NearestPair {
    /// Search for the nearest pair that is at most `cut_off` apart, which may be infinite.
    pub(crate) fn within(cut_off: f64) -> Self {
        Self {
            cut_off,
            nearest: None,
        }
    }

    /// The nearest pair and its closest points.
    pub(crate) fn found(self) -> Option<(Candidate, TrianglesClosest)> {
        self.nearest
    }

    /// Square of the distance beyond which pairs need not be measured. Pairs nearer by no more than
    /// 2^-31 of the distance count as beyond.
    pub(crate) fn limit(&self) -> f64 {
        match &self.nearest {
            Some((_, nearest)) => {
                let enough = enough(nearest);
                enough * enough
            }
            None => self.cut_off * self.cut_off * (1.0 + 4.0 * f64::EPSILON),
        }
    }

    /// Measures two triangles, and keeps them if they are nearer than all before.
    pub(crate) fn measure<S: Coordinate>(
        &mut self,
        instructions: Instructions,
        pair: Candidate,
        corners: &[ThreeCorners<S>; 2],
        interrupt: &Interrupt,
        exact_decisions: &mut u64,
    ) {
        let [a, b] = corners;
        // Mostly a plane between the nearest triangles separates both bodies, and the corners of
        // all other pairs show it.
        if let Some((_, nearest)) = &self.nearest
            && apart_along(nearest.direction, a, b) >= enough(nearest)
        {
            return;
        }
        let measured = dispatch!(instructions, i => of_triangles(i, a, b));
        let is_nearer = match &self.nearest {
            Some((_, nearest)) => measured.least < nearest.distance,
            None => is_within(&measured, corners, self.cut_off.into(), exact_decisions),
        };
        if is_nearer
            && let Some(found) = closest(measured, corners, interrupt)
            && self
                .nearest
                .as_ref()
                .is_none_or(|(_, nearest)| found.distance < nearest.distance)
        {
            self.nearest = Some((pair, found));
        }
    }
}

/// Distance from which on other pairs are not nearer by more than the promised accuracy.
fn enough(nearest: &TrianglesClosest) -> f64 {
    nearest.distance * (1.0 - f64::powi(0.5, 31))
}

/// Closest points of two triangles. None if interrupted.
#[inline(always)]
pub(crate) fn closest_of_triangles<I: Simd, S: Real>(
    i: I,
    corners: &[ThreeCorners<S>; 2],
    interrupt: &Interrupt,
) -> Option<TrianglesClosest> {
    let [a, b] = corners;
    closest(of_triangles(i, a, b), corners, interrupt)
}

/// Closest points of two triangles that plain arithmetic has measured. None if interrupted.
///
/// Exact arithmetic measures the undecided. That takes long enough to look at the interruption
/// before.
fn closest<S: Real>(
    measured: TwoClosest,
    [a, b]: &[ThreeCorners<S>; 2],
    interrupt: &Interrupt,
) -> Option<TrianglesClosest> {
    let (which, along, distance) = (measured.which, measured.along, measured.distance);
    if measured.most - measured.least <= ACCURACY * distance {
        return Some(TrianglesClosest {
            distance,
            direction: measured.way.map(|x| x / distance),
            barycentric: barycentric(which, along),
        });
    }
    let known = SomePoints {
        which,
        along,
        apart: measured.most,
    };
    (!interrupt.is_set()).then(|| closest_triangles(S::PRECISION, &exact(a), &exact(b), known))
}

/// A triangle for exact arithmetic, from padded corners.
fn exact<S: Real>(corners: &ThreeCorners<S>) -> Triangle {
    corners.map(|&[x, y, z, _]| [x, y, z].map(Real::to_f64))
}

/// Corners of a triangle of a shape.
#[inline(always)]
pub(crate) fn corners_of<'q, S: Coordinate>(
    shape: &Shape<'q, S>,
    triangle: TreeTriangle,
) -> ThreeCorners<'q, S> {
    let [a, b, c] = shape.triangles[triangle.index()];
    [
        shape.positions.padded(a),
        shape.positions.padded(b),
        shape.positions.padded(c),
    ]
}

impl Measurable for Pair {
    type Close = CloseTriangles;
    type Corners<'c, S: Coordinate> = [ThreeCorners<'c, S>; 2];

    fn unmeasured(self) -> CloseTriangles {
        CloseTriangles {
            pair: self,
            distance: 0.0,
            direction: None,
            barycentric_a: [0.0; 3],
            barycentric_b: [0.0; 3],
            point_a: [0.0; 3],
            point_b: [0.0; 3],
        }
    }

    #[inline(always)]
    fn measure<I: Simd, S: Coordinate>(
        i: I,
        hits: &[Self],
        corners: &[Self::Corners<'_, S>; 4],
        interrupt: &Interrupt,
        mut take: impl FnMut(CloseTriangles),
    ) -> bool {
        for (hit, corners) in hits.iter().zip(corners) {
            let Some(closest) = closest_of_triangles(i, corners, interrupt) else {
                return false;
            };
            take(close(*hit, corners, &closest));
        }
        true
    }
}

/// A pair with its measurements, from its corners.
pub(crate) fn close<S: Real>(
    pair: Pair,
    [a, b]: &[ThreeCorners<S>; 2],
    closest: &TrianglesClosest,
) -> CloseTriangles {
    let [barycentric_a, barycentric_b] = closest.barycentric;
    CloseTriangles {
        pair,
        distance: closest.distance,
        direction: (closest.distance != 0.0).then_some(closest.direction),
        barycentric_a,
        barycentric_b,
        point_a: point(a, barycentric_a),
        point_b: point(b, barycentric_b),
    }
}

/// Point of a triangle with these barycentric coordinates.
fn point<S: Real>(corners: &ThreeCorners<S>, counts: [f64; 3]) -> [f64; 3] {
    let [a, b, c] = exact(corners);
    let [x, y, z] = counts;
    std::array::from_fn(|axis| x * a[axis] + y * b[axis] + z * c[axis])
}

impl<S: Coordinate> Kind for NearTriangles<S> {
    type Scalar = S;
    type Hit = Pair;
    type Shown = CloseTriangles;
    type TreeHit = Candidate;
    type Buffers = ();

    fn needs(&self) -> Needs {
        Needs {
            box_set: OF_GROWN_SHAPES,
            grows_by: Some(self.margin.grown_by()),
            counts_thickness: 1.0,
            ..Needs::TRIANGLES
        }
    }

    fn test(&self, leaves: &LeafTest<S>, batch: Batch, found: &mut FoundBy<Self>) {
        let candidates = batch.triangles();
        let before = found.hits.len();
        dispatch!(leaves.instructions, i => {
            for &[a, b] in candidates.as_slice() {
                if leaves.interrupt.is_set() {
                    break;
                }
                let corners = [corners_of(leaves.shapes[0], a), corners_of(leaves.shapes[1], b)];
                let measured = of_triangles(i, &corners[0], &corners[1]);
                let exact = &mut found.statistics.exact_decisions;
                let distance = if leaves.thickness.are_any() {
                    let [a, b] = [(0, a), (1, b)].map(|(side, triangle)| {
                        (side, &leaves.shapes[side].triangles[triangle.index()][..])
                    });
                    leaves.thickness.length(self.distance, [a, b])
                } else {
                    self.distance.into()
                };
                if !is_within(&measured, &corners, distance, exact) {
                    continue;
                }
                if let Some(rest) = leaves.rest {
                    let at_rest = Shape { positions: rest, ..*leaves.shapes[0] };
                    let corners = [a, b].map(|triangle| corners_of(&at_rest, triangle));
                    let measured = of_triangles(i, &corners[0], &corners[1]);
                    if is_within(&measured, &corners, distance, exact) {
                        continue;
                    }
                }
                found.hits.push([a, b]);
            }
        });
        found.statistics.candidate_pairs += candidates.len() as u64;
        found.statistics.pairs += (found.hits.len() - before) as u64;
    }

    #[inline]
    fn to_caller(&self, ids: &CallerIds, candidate: Candidate) -> Pair {
        Intersections::<S>::default().to_caller(ids, candidate)
    }

    fn show(&self, leaves: &LeafTest<S>, hits: &[Candidate], shown: &mut Vec<CloseTriangles>) {
        let [first, second] = leaves.shapes;
        let order = leaves.ids.orders[0];
        let corners = |[a, b]: Candidate| {
            let mut corners = [corners_of(first, a), corners_of(second, b)];
            if leaves.is_one_body && order.caller_triangle(b) < order.caller_triangle(a) {
                corners.swap(0, 1);
            }
            Some(corners)
        };
        let what = (|hit| self.to_caller(&leaves.ids, hit), corners);
        let (how, interrupt) = (leaves.instructions, leaves.interrupt);
        dispatch!(how, i => measure_all(i, hits, interrupt, what, |close| shown.push(close)));
    }
}

/// Whether two triangles, which plain arithmetic has measured, are at most `distance` apart. Counts
/// exact decisions.
fn is_within<S: Real>(
    measured: &TwoClosest,
    [a, b]: &[ThreeCorners<S>; 2],
    distance: Length,
    exact_decisions: &mut u64,
) -> bool {
    let [least, most] = distance.bounds();
    if (measured.most <= least) | (measured.least > most) {
        return measured.most <= least;
    }
    *exact_decisions += 1;
    are_triangles_within(S::PRECISION, &exact(a), &exact(b), distance)
}

#[cfg(test)]
mod tests {
    use super::*;
    use pliant_oracle::{Class, Random, compare_distance, compare_dot, compare_length, intersect};
    use std::cmp::Ordering;

    /// The largest coordinate of any difference of corners.
    fn size(a: &Triangle, b: &Triangle) -> f64 {
        let corners = || a.iter().chain(b);
        let pairs = corners().flat_map(|p| corners().map(move |q| (p, q)));
        let largest = pairs.flat_map(|(p, q)| (0..3).map(|axis| (p[axis] - q[axis]).abs()));
        largest.fold(0.0, f64::max)
    }

    fn check_points(a: &Triangle, b: &Triangle, closest: &TrianglesClosest, apart: f64) {
        let [of_a, of_b] = closest.barycentric;
        assert!(of_a.iter().chain(&of_b).all(|&x| (0.0..=1.0).contains(&x)));
        for of_one in [of_a, of_b] {
            assert!(
                (of_one.iter().sum::<f64>() - 1.0).abs() < 1e-15,
                "{of_one:?}"
            );
        }
        let mut sum = Vec::new();
        for (sign, [_, x, y], corners) in [(1.0, of_a, a), (-1.0, of_b, b)] {
            let [a, b, c] = *corners;
            sum.extend([(sign, a), (sign * x, b), (0.0 - sign * x, a)]);
            sum.extend([(sign * y, c), (0.0 - sign * y, a)]);
        }
        assert_ne!(
            compare_length(&sum, apart),
            Ordering::Greater,
            "{a:?} {b:?} {closest:?}"
        );
        for (counts, corners) in [(of_a, a), (of_b, b)] {
            check_coordinates(counts, corners);
        }
    }

    /// Checks that a point's coordinates are its weighted corners, within 2^-50 of the largest
    /// coordinate of these.
    fn check_coordinates(counts: [f64; 3], corners: &Triangle) {
        let padded = corners.map(|[x, y, z]| [x, y, z, z]);
        let found = point(&padded.each_ref(), counts);
        let largest = corners
            .as_flattened()
            .iter()
            .fold(0.0, |most: f64, x| most.max(x.abs()));
        let ([a, b, c], [_, y, z]) = (*corners, counts);
        for axis in 0..3 {
            let only = |p: [f64; 3]| [p[axis], 0.0, 0.0];
            let sum = [
                (1.0, a),
                (y, b),
                (0.0 - y, a),
                (z, c),
                (0.0 - z, a),
                (-1.0, found),
            ];
            let off = sum.map(|(by, p)| (by, only(p)));
            let most = 2f64.powi(-50) * largest + 2.0 * f64::from_bits(1);
            assert_ne!(
                compare_length(&off, most),
                Ordering::Greater,
                "{corners:?} {counts:?}"
            );
        }
    }

    #[test]
    fn triangles_are_as_far_apart_as_the_oracle_says() {
        let mut random = Random::new(43);
        let never = Interrupt::default();
        let [mut apart, mut crossing, mut quick, mut decided] = [0; 4];
        for round in 0..6_000 {
            let [a, b] = Class::ALL[round % Class::ALL.len()].pair(&mut random);
            let padded = [a, b].map(|it| it.map(|[x, y, z]| [x, y, z, z]));
            let corners = padded.each_ref().map(<[_; 3]>::each_ref);
            let mut of_all: Option<TrianglesClosest> = None;
            for instructions in Instructions::all() {
                let found = dispatch!(instructions, i => closest_of_triangles(i, &corners, &never));
                let found = found.expect("nothing interrupts it");
                assert_eq!(*of_all.get_or_insert(found), found);
            }
            let found = of_all.expect("there are instructions");
            let d = found.distance;
            let [nearly, hardly] = [2f64.powi(-30), 2f64.powi(-48)];
            let s = size(&a, &b);
            let least = f64::from_bits(1);
            assert_ne!(
                compare_distance(&a, &b, d * (1.0 + nearly) + least),
                Ordering::Greater
            );
            let below = (d * (1.0 - nearly) - least).max(0.0);
            assert_ne!(compare_distance(&a, &b, below), Ordering::Less);
            assert_eq!(intersect(&a, &b), d == 0.0, "{a:?} {b:?}");
            crossing += u64::from(d == 0.0);
            check_points(
                &a,
                &b,
                &found,
                d * (1.0 + nearly) + 2f64.powi(-40) * s + least,
            );
            if d > 0.0 {
                apart += 1;
                let slack = nearly * d + hardly * s + least;
                for p in &a {
                    for q in &b {
                        let by = compare_dot(found.direction, *p, *q, d - slack);
                        assert_ne!(by, Ordering::Less, "{a:?} {b:?} {found:?}");
                    }
                }
            } else {
                assert_eq!(found.direction, [0.0; 3]);
            }
            for x in [
                d,
                d.next_up(),
                d.next_down().max(0.0),
                d * (1.0 + 1e-9),
                d * (1.0 - 1e-9),
                0.0,
                0.3,
            ] {
                let expected = compare_distance(&a, &b, x) != Ordering::Greater;
                let mut exact = 0;
                let instructions = Instructions::widest();
                let [p, q] = &corners;
                let measured = dispatch!(instructions, i => of_triangles(i, p, q));
                let found = is_within(&measured, &corners, x.into(), &mut exact);
                assert_eq!(found, expected, "{a:?} {b:?} {x}");
                decided += exact;
                quick += 1 - exact;
            }
        }
        let rest = [apart, crossing, quick, decided];
        assert!(
            apart > 1_500 && crossing > 1_500 && quick > 9_000 && decided > 9_000,
            "{rest:?}"
        );
    }

    #[test]
    fn points_in_common_are_found_in_integers_too() {
        let mut random = Random::new(44);
        let mut through = 0;
        for round in 0..3_000 {
            let [a, b] = Class::ALL[round % Class::ALL.len()].pair(&mut random);
            if !intersect(&a, &b) {
                continue;
            }
            let unknown = SomePoints {
                which: 0,
                along: [0.0; 2],
                apart: f64::INFINITY,
            };
            let least = f64::from_bits(1);
            let found = closest_triangles(f64::PRECISION, &a, &b, unknown);
            check_points(&a, &b, &found, 2f64.powi(-40) * size(&a, &b) + least);
            let barycentric = pliant_exact::distance::point_in_common(&a, &b);
            let found = TrianglesClosest {
                barycentric,
                ..found
            };
            check_points(&a, &b, &found, 2f64.powi(-48) * size(&a, &b) + least);
            let touches = barycentric
                .iter()
                .any(|it| it.iter().filter(|&&x| x > 0.0).count() == 3);
            through += u32::from(touches);
        }
        assert!(through > 200, "{through}");
    }
}
