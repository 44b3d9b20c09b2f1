//! Closest points as callers get them, measured once the nearest triangle is known.

use super::candidates::Nearest;
use crate::geometry::{Real, padded};
use crate::ids::BodyId;
use crate::kernels::closest::certain_parts;
use crate::kernels::{Coordinate, Instructions, dispatch};
use crate::queries::{closest_of, direction, weights};
use crate::threads::{Executor, Grain};
use pliant_exact::Feature;
use pliant_exact::distance::{Closest, Primitives, are_within_distance, closest_features};

/// The point of a body that is closest to a point of the caller, and the triangle that has it.
///
/// The triangle is exactly the nearest, and of equally near ones the first, by body and number. The
/// distance is off by at most 2^-30 of itself and 2^-1074, the smallest number. It is 0 exactly if
/// the point is on the surface. Points and direction are as good as in
/// [`CloseTriangles`](crate::CloseTriangles).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosestPoint {
    /// Body that has the triangle.
    pub body: BodyId,
    /// Its nearest triangle.
    pub triangle: u32,
    /// Distance, in the unit of the positions. Of signed distances below 0 inside the body.
    pub distance: f64,
    /// The closest point, rounded.
    pub point: [f64; 3],
    /// Part of the triangle that has the closest point, exactly: the smallest one.
    pub feature: Feature,
    /// Barycentric coordinates of the closest point: the weight of each corner, in order. Each is
    /// at least 0. Their sum is 1, up to rounding.
    pub barycentric: [f64; 3],
    /// Unit vector from the closest point to the caller's. None at distance 0.
    pub direction: Option<[f64; 3]>,
}

/// Measures the nearest triangles. None for a point that has none within the cut-off.
pub(crate) fn measure<S: Coordinate>(
    (instructions, executor): (Instructions, Executor),
    points: &[[S; 3]],
    nearest: &[Nearest],
    cut_off: f64,
) -> Vec<Option<ClosestPoint>> {
    let grain = Grain::MEASURED;
    let mut measured = vec![None; points.len()];
    let some = measured.chunks_mut(grain.items);
    let jobs = some
        .zip(points.chunks(grain.items))
        .zip(nearest.chunks(grain.items));
    let work = |((measured, points), nearest): &mut (
        (&mut [Option<ClosestPoint>], &[[S; 3]]),
        &[Nearest],
    )| {
        let places: Vec<usize> = (0..points.len())
            .filter(|&it| nearest[it].found.is_some())
            .collect();
        for four in places.chunks(4) {
            measure_four(
                (instructions, executor),
                four,
                points,
                nearest,
                cut_off,
                measured,
            );
        }
    };
    executor.run_each(jobs, grain, work, |_| {});
    measured
}

/// Measures up to four points.
fn measure_four<S: Coordinate>(
    (instructions, executor): (Instructions, Executor),
    places: &[usize],
    points: &[[S; 3]],
    nearest: &[Nearest],
    cut_off: f64,
    measured: &mut [Option<ClosestPoint>],
) {
    let corners = |&place: &usize| {
        let found = nearest[place].found?;
        let [a, b, c] = found.corners.map(padded);
        Some([padded(points[place].map(Real::to_f64)), a, b, c])
    };
    let Some(first) = places.first().and_then(corners) else {
        return;
    };
    let mut four = [first; 4];
    for (lane, place) in places.iter().enumerate() {
        four[lane] = corners(place).unwrap_or(first);
    }
    let pairs = four.each_ref().map(<[_; 4]>::each_ref);
    let parts = dispatch!(instructions, i => certain_parts(i, &pairs));
    let take = |lane: usize, closest: &Closest| {
        let place = places[lane];
        let Some(found) = nearest[place].found else {
            return;
        };
        let [p, a, b, c] = four[lane].map(|[x, y, z, _]| [x, y, z]);
        let elements = Primitives::VertexTriangle([p, a, b, c]);
        // Distances are off by 2^-30 of themselves.
        let is_near = closest.distance * (1.0 + f64::powi(0.5, 29)) <= cut_off;
        if !is_near && !are_within_distance(&elements, cut_off) {
            return;
        }
        let feature = parts[lane].unwrap_or_else(|| {
            let mut smallest = Feature::Inside;
            closest_features(&elements, |[_, on]| smallest = smallest.min(on));
            smallest
        });
        let [_, x, y, z] = weights(false, closest);
        measured[place] = Some(ClosestPoint {
            body: found.body,
            triangle: found.triangle,
            distance: closest.distance,
            point: [0, 1, 2].map(|k| a[k] + y * (b[k] - a[k]) + z * (c[k] - a[k])),
            feature,
            barycentric: [x, y, z],
            direction: direction(closest),
        });
    };
    dispatch!(instructions, i => {
        let _ = closest_of(i, false, &pairs, places.len(), executor.interrupt, take);
    });
}
