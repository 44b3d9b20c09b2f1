//! Closest points of elements: in double precision where that reaches the promised accuracy, else
//! in integers.

use crate::geometry::Real;
use crate::kernels::Simd;
use crate::kernels::closest::{FourCorners, along_normal, of_elements};
use crate::threads::Interrupt;
use pliant_exact::distance::{Closest, Primitives, closest};

/// Promised accuracy of distances: 2^-30 of themselves.
pub(in crate::queries) const ACCURACY: f64 = f64::from_bits((1023 - 30) << 52);

/// Half of a distance, rounded up: half of the smallest number is no number.
pub(in crate::queries) fn half(distance: f64) -> f64 {
    let half = distance / 2.0;
    if 2.0 * half < distance {
        half.next_up()
    } else {
        half
    }
}

/// Two edges by their ends, or a vertex and the corners of a triangle, for exact arithmetic.
pub(in crate::queries) fn primitives(are_edges: bool, corners: [[f64; 3]; 4]) -> Primitives {
    if are_edges {
        Primitives::EdgeEdge(corners)
    } else {
        Primitives::VertexTriangle(corners)
    }
}

/// A pair of elements for exact arithmetic, from padded corners.
pub(in crate::queries) fn exactly<S: Real>(
    are_edges: bool,
    corners: &FourCorners<S>,
) -> Primitives {
    let corners = corners.map(|&[x, y, z, _]| [x, y, z].map(Real::to_f64));
    primitives(are_edges, corners)
}

/// Shows `take` the closest points of the first `count` of four pairs, in order. Returns false if
/// interrupted.
///
/// If both bounds are within the promised accuracy, the computed points are used, if need be with
/// the common normal for a direction. The few others, slivers and pairs that touch, are measured in
/// integers. That takes long enough to look at the interruption before each.
#[inline(always)]
pub(crate) fn closest_of<I: Simd, S: Real>(
    i: I,
    are_edges: bool,
    pairs: &[FourCorners<S>; 4],
    count: usize,
    interrupt: &Interrupt,
    mut take: impl FnMut(usize, &Closest),
) -> bool {
    let found = of_elements(i, are_edges, pairs);
    for lane in 0..count {
        let (distance, most) = (found.distance[lane], found.most[lane]);
        let along = found.along.map(|lanes| lanes[lane]);
        let way = found.way.map(|lanes| lanes[lane]);
        let in_direction = |direction| Closest {
            distance,
            along,
            direction,
        };
        let one = if most - found.least[lane] <= ACCURACY * distance {
            in_direction(way.map(|x| x / distance))
        } else if let Some((direction, least)) = along_normal(are_edges, &pairs[lane])
            && most - least <= ACCURACY * distance
            && is_the_way(direction, way, distance)
        {
            in_direction(direction)
        } else if interrupt.is_set() {
            return false;
        } else {
            closest(&exactly(are_edges, &pairs[lane]))
        };
        take(lane, &one);
    }
    true
}

/// Whether the way between the points has this direction, within the promised accuracy of its
/// length.
///
/// Of nearly parallel elements, points may be the nearest by length and yet be some way off to the
/// side.
fn is_the_way(direction: [f64; 3], way: [f64; 3], distance: f64) -> bool {
    let off = |axis: usize| (direction[axis] * distance - way[axis]).abs();
    (0..3).all(|axis| off(axis) <= ACCURACY * distance)
}
