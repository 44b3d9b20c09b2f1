//! Position of a corner of an intersection, and how far along its edges it is.
//!
//! Which features it lies on is exact; what is here is rounded, with a proven bound.

use super::feature::Feature;
use crate::float::scaled;
use crate::integer::{powers_of_all, quotient};
use crate::orientation::Plane;
use crate::point::{Point, Triangle};
use crate::ring::Ring;
use crate::triangles::edge;
use crate::vector::{determinant, in_units, minus};

/// Position of the point that lies on these features of both triangles, and its parameter on each
/// that is an edge.
pub(super) fn position([a, b]: [&Triangle; 2], on: [Feature; 2]) -> (Point, [Option<f64>; 2]) {
    let along = [along(a, on[0], b, on[1]), along(b, on[1], a, on[0])];
    let point = match on {
        [Feature::Corner(i), _] => a[i],
        [_, Feature::Corner(j)] => b[j],
        _ => {
            let known = along[0].as_ref().or(along[1].as_ref());
            known.map_or(a[0], Along::point)
        }
    };
    (point, along.map(|along| along.map(|it| it.parameter())))
}

/// A point of an edge, the same whichever triangle has the edge, and whichever way.
struct Along {
    /// Ends of the edge, the smaller first.
    ends: [Point; 2],
    /// Part of the way from the first to the second.
    part: f64,
    is_turned: bool,
}

impl Along {
    /// Part of the way from the edge's first corner to its second.
    fn parameter(&self) -> f64 {
        if self.is_turned {
            1.0 - self.part
        } else {
            self.part
        }
    }

    fn point(&self) -> Point {
        let [p, q] = &self.ends;
        [0, 1, 2].map(|axis| {
            let (from, to) = (p[axis], q[axis]);
            // From the nearer end, so that rounding does not leave the edge.
            let there = if self.part < 0.5 {
                from + self.part * (to - from)
            } else {
                to - (1.0 - self.part) * (to - from)
            };
            there.max(from.min(to)).min(from.max(to))
        })
    }
}

/// Where a point lies along an edge of a triangle, if it also is on this feature of the other.
fn along(triangle: &Triangle, on: Feature, other: &Triangle, place: Feature) -> Option<Along> {
    let Feature::Edge(i) = on else {
        return None;
    };
    let [p, q] = edge(triangle, i);
    let is_turned = p > q;
    let ends = if is_turned { [q, p] } else { [p, q] };
    let part = match place {
        Feature::Corner(j) => part_of(ends, &other[j]),
        Feature::Inside => on_plane(ends, other)?,
        Feature::Edge(j) => {
            let upright = |axis| on_plane(ends, &upright(edge(other, j), axis));
            on_plane(ends, other).or_else(|| (0..3).find_map(upright))?
        }
    };
    Some(Along {
        ends,
        part,
        is_turned,
    })
}

/// Part of the way from the first end to the second at which a point of the edge lies.
fn part_of([p, q]: [Point; 2], point: &Point) -> f64 {
    let length = |axis: usize| (q[axis] - p[axis]).abs();
    let longest = (1..3).fold(0, |best, axis| {
        if length(axis) > length(best) {
            axis
        } else {
            best
        }
    });
    ((point[longest] - p[longest]) / (q[longest] - p[longest])).clamp(0.0, 1.0)
}

/// A triangle in the plane through an edge along an axis. If they are parallel, it has no area.
fn upright([r, s]: [Point; 2], axis: usize) -> Triangle {
    let mut above = r;
    above[axis] = if r[axis] == 0.0 { 1.0 } else { -r[axis] };
    [r, s, above]
}

/// Part of the way from the first end to the second at which an edge meets a plane; off by less
/// than 2^-38. None if the plane is none.
fn on_plane([p, q]: [Point; 2], [a, b, c]: &Triangle) -> Option<f64> {
    // Each is off by at most 9 u of its size.
    let plane = Plane::of(a, b, c);
    let [(of_p, size_p), (of_q, size_q)] = [p, q].map(|end| plane.height(&end));
    let length = of_p.abs() + of_q.abs();
    let is_certain = size_p + size_q < MOST_TERMS * length && length > LEAST;
    if is_certain && of_p * of_q <= 0.0 {
        return Some(of_p.abs() / length);
    }
    let [unit, _] = powers_of_all([&p, &q, a, b, c].into_iter().flatten());
    let [p, q, a, b, c] = [&p, &q, a, b, c].map(|point| in_units(point, unit));
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
