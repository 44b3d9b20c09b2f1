//! Conservative advancement: how long two moving elements surely stay further apart than a
//! distance.
//!
//! For any direction n the projections of the polygon's corners (see `motion`) are affine in t. As
//! long as all are above d |n|, every point of it is further from the origin than d. From a time up
//! to which that is known, n is the way to the point of the polygon that is nearest then. It is
//! known up to the time at which the first projection has fallen to d |n|, less a 2^-20th of the
//! gain. It ends when the pair is within 1.001 d and little is gained; so each step gains 0.001 d
//! over the largest speed at least.

use super::super::Point;
use super::super::float::{U, power};
use super::super::vector::{dot, minus};
use super::certain::Polygon;
use super::moving::Moving;
use std::cmp::Ordering;

// With u = 2^-53 and M as in `certain`, a corner's projection at a time is off by less than 4 u
// n.M. Products and sums add 3 u n.M. The allowance is 8 u, and more than what can be lost below
// the normal range. A length is off by 3 u of itself. A gain is rounded to 2^-53 of the new time;
// gains below 2^-32 of it do not count.
const OF_PROJECTION: f64 = 8.0 * U;
const LOST: f64 = power(-850);
/// The number of directions that are looked at, at most.
const MOST_DIRECTIONS: usize = 4096;
/// A pair that is nearer than this many times the distance has come near it.
const NEAR: f64 = 1.001;
/// Then gains below this part of the time are little.
const LITTLE: f64 = 1.0 / 1024.0;

/// A time from 0 to 1 up to which two elements surely stay further apart than `distance`.
///
/// The distance is above 0, in the unit of the coordinates. The time is 0 where perhaps they are
/// not further apart at the start, and 1 where they stay so. Any such time after `of_interest` may
/// end the search. A pair that is further apart than 1.001 times the distance up to some time is
/// known to be so up to that time. Cost: a fraction of a microsecond a direction, of which there
/// are few, and at most 4096.
pub fn distant_until(moving: &Moving, distance: f64, of_interest: f64) -> f64 {
    let polygon = Polygon::new(&in_order(moving));
    let mut known: f64 = 0.0;
    for _ in 0..MOST_DIRECTIONS {
        let n = nearest(&polygon.at(known)[..polygon.count], moving.are_edges);
        let length = dot(&n, &n).sqrt();
        let level = distance * length * (1.0 + 8.0 * f64::EPSILON);
        let mut gain: f64 = 1.0;
        let mut is_known = true;
        for i in 0..polygon.count {
            let (start, end, most) = polygon.corner(i);
            let allowed = level + dot(&n.map(f64::abs), &most) * OF_PROJECTION + LOST;
            let [at_start, at_end] = [dot(&n, &start), dot(&n, &end)];
            let now = (1.0 - known) * at_start + known * at_end - allowed;
            let last = at_end - allowed;
            // No number is above zero.
            is_known &= now > 0.0;
            if last <= 0.0 {
                gain = gain.min(now / (now - last));
            }
        }
        if !is_known {
            return known;
        }
        if gain >= 1.0 {
            return 1.0;
        }
        let gain = gain * (1.0 - known) * (1.0 - power(-20));
        let next = known + gain;
        let is_little = length <= distance * NEAR && gain < next * LITTLE;
        if gain.is_nan() || gain <= next * power(-32) || gain < power(-1000) {
            return known;
        }
        known = next;
        if is_little || known > of_interest {
            return known;
        }
    }
    known
}

/// Whether two corners are surely at most `distance` apart at the start: most pairs that are nearer
/// than it need no exact decision.
///
/// The distance is in the unit of the coordinates; the answer false says nothing. Cost:
/// nanoseconds. With u = 2^-53 a component of a difference is off by u of itself. The square of a
/// length is off by 6 u of itself; 16 u are allowed. What is lost below the normal range is at most
/// 2^-1018 of the distance. That is less than the rest of the allowance if the square of the
/// distance is above 2^-900.
pub fn starts_surely_within(moving: &Moving, distance: f64) -> bool {
    let square = distance * distance;
    let limit = square * (1.0 - 16.0 * U);
    let polygon = Polygon::new(moving);
    let [start, _] = polygon.part([0.0, 1.0]);
    let mut corners = start[..polygon.count].iter();
    let is_normal = square > power(-900) && square.is_finite();
    is_normal && corners.any(|corner| dot(corner, corner) <= limit)
}

/// Two moving elements with their corners in an order of their own, however they came. The nearest
/// point is found by arithmetic that depends on the order of corners; the answer is not to depend
/// on it.
fn in_order(moving: &Moving) -> Moving {
    let [start, end] = moving.corners;
    let mut corners: [[Point; 2]; 4] = std::array::from_fn(|i| [start[i], end[i]]);
    let compare = |p: &[Point; 2], q: &[Point; 2]| {
        let both = p.as_flattened().iter().zip(q.as_flattened());
        both.fold(Ordering::Equal, |order, (x, y)| order.then(x.total_cmp(y)))
    };
    if moving.are_edges {
        corners[..2].sort_unstable_by(compare);
        corners[2..].sort_unstable_by(compare);
        if compare(&corners[0], &corners[2])
            .then_with(|| compare(&corners[1], &corners[3]))
            .is_gt()
        {
            corners.rotate_left(2);
        }
    } else {
        corners[1..].sort_unstable_by(compare);
    }
    Moving {
        are_edges: moving.are_edges,
        corners: [corners.map(|[start, _]| start), corners.map(|[_, end]| end)],
    }
}

/// About the point of the polygon that is nearest to the origin.
fn nearest(corners: &[Point], is_parallelogram: bool) -> Point {
    let along = |p: &Point, t: f64, e: &Point| [p[0] + t * e[0], p[1] + t * e[1], p[2] + t * e[2]];
    let on_segment = |p: &Point, q: &Point| {
        let e = minus(q, p);
        let (part, whole) = (0.0 - dot(p, &e), dot(&e, &e));
        let t = if part <= 0.0 {
            0.0
        } else if part < whole {
            part / whole
        } else {
            1.0
        };
        along(p, t, &e)
    };
    let [a, b, last] = [0, 1, corners.len() - 1].map(|i| &corners[i]);
    let mut best = on_segment(a, b);
    let mut take = |point: Point| {
        if dot(&point, &point) < dot(&best, &best) {
            best = point;
        }
    };
    for i in 1..corners.len() {
        take(on_segment(&corners[i], &corners[(i + 1) % corners.len()]));
    }
    let (e, f) = (minus(b, a), minus(last, a));
    let (ee, ef, ff) = (dot(&e, &e), dot(&e, &f), dot(&f, &f));
    let (ae, af) = (0.0 - dot(a, &e), 0.0 - dot(a, &f));
    let whole = ee * ff - ef * ef;
    let [x, y] = [(ff * ae - ef * af) / whole, (ee * af - ef * ae) / whole];
    let is_below = if is_parallelogram {
        x <= 1.0 && y <= 1.0
    } else {
        x + y <= 1.0
    };
    if whole > 0.0 && x >= 0.0 && y >= 0.0 && is_below {
        take(along(&along(a, x, &e), y, &f));
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distance::{Primitives, are_within_distance};
    use pliant_oracle::Random;

    /// The corners at a time, exactly, if these are multiples of 2^-20 and the time of 2^-20.
    fn at(moving: &Moving, t: f64) -> Primitives {
        let [start, end] = moving.corners;
        let corners = std::array::from_fn(|i| {
            std::array::from_fn(|axis| start[i][axis] + t * (end[i][axis] - start[i][axis]))
        });
        if moving.are_edges {
            Primitives::EdgeEdge(corners)
        } else {
            Primitives::VertexTriangle(corners)
        }
    }

    #[test]
    fn it_is_distant_up_to_then_and_near_soon_after() {
        let mut random = Random::new(21);
        let [mut reached, mut stopped] = [0; 2];
        for round in 0..6_000 {
            let mut x = || (random.bits() >> 44) as f64 / f64::powi(2.0, 20);
            let mut moving = Moving {
                are_edges: round % 2 == 0,
                corners: [0; 2].map(|_| [0; 4].map(|_| [0; 3].map(|_| x()))),
            };
            if round % 3 == 0 {
                // Sliding past each other, near.
                for corner in 0..4 {
                    moving.corners[1][corner][2] = moving.corners[0][corner][2];
                }
            }
            let distance = [0.01, 0.1, 0.3][round % 3];
            let known = distant_until(&moving, distance, 1.0);
            // The order of corners does not matter.
            let [start, end] = moving.corners;
            let turned = |[a, b, c, d]: [Point; 4]| {
                if moving.are_edges {
                    [d, c, a, b]
                } else {
                    [a, d, b, c]
                }
            };
            let other = Moving {
                corners: [turned(start), turned(end)],
                ..moving
            };
            assert_eq!(distant_until(&other, distance, 1.0), known);
            // If it is near too early, then soon before that time: there ticks are close.
            let ticks = (0..=128).map(|tick| f64::from(tick) / 128.0);
            let last = (0..16).map(|tick| known - f64::from(tick) / 1024.0);
            for t in ticks.chain(last).filter(|&t| t >= 0.0 && t <= known) {
                if known > 0.0 {
                    assert!(
                        !are_within_distance(&at(&moving, t), distance),
                        "{moving:?} {t}"
                    );
                }
            }
            if known == 1.0 {
                reached += 1;
                continue;
            }
            // It has been nearer than a thousandth more than the distance, not much later.
            stopped += 1;
            let nearest = (0..=1024).map(f64::from).map(|tick| tick / 1024.0);
            let mut soon = nearest.filter(|&t| t >= known - 0.001 && t <= known + 0.003);
            let is_near = |t: f64| are_within_distance(&at(&moving, t), distance * 1.02 + 0.012);
            assert!(soon.any(is_near), "{moving:?} {known}");
        }
        assert!(reached > 500 && stopped > 500, "{reached} {stopped}");
    }

    #[test]
    fn what_starts_surely_within_a_distance_does() {
        let mut random = Random::new(22);
        let [mut surely, mut just_not] = [0; 2];
        for round in 0..40_000 {
            let mut x = || (random.bits() >> 11) as f64 / f64::powi(2.0, 53);
            let mut start = [0; 4].map(|_| [0; 3].map(|_| x()));
            let scale = f64::powi(2.0, round % 900 - 450);
            let are_edges = round % 2 == 0;
            // The distance of two corners, or some numbers more or less.
            let [p, q] = [start[0], start[if are_edges { 2 } else { 1 }]];
            let far = [0, 1, 2].map(|axis| p[axis] - q[axis]);
            let mut distance = dot(&far, &far).sqrt();
            for _ in 0..round % 32 {
                distance = if round % 64 < 32 {
                    distance.next_up()
                } else {
                    distance.next_down()
                };
            }
            start = start.map(|corner| corner.map(|x| x * scale));
            distance *= scale;
            let moving = Moving {
                are_edges,
                corners: [start; 2],
            };
            let exact = if are_edges {
                Primitives::EdgeEdge(start)
            } else {
                Primitives::VertexTriangle(start)
            };
            if starts_surely_within(&moving, distance) {
                surely += 1;
                assert!(
                    are_within_distance(&exact, distance),
                    "{moving:?} {distance}"
                );
            } else {
                just_not += 1;
            }
        }
        assert!(surely > 5_000 && just_not > 5_000, "{surely} {just_not}");
        // Where squares are lost or too large, nothing is sure.
        let apart = Moving {
            are_edges: true,
            corners: [[[0.0; 3], [0.0; 3], [1e300, 0.0, 0.0], [1e300, 0.0, 0.0]]; 2],
        };
        assert!(!starts_surely_within(&apart, 1e299) && !starts_surely_within(&apart, 1e301));
        let same = Moving {
            corners: [[[0.0; 3]; 4]; 2],
            ..apart
        };
        assert!(starts_surely_within(&same, 1e-100) && !starts_surely_within(&same, 1e-200));
    }
}
