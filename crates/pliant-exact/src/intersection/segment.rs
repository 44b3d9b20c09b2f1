//! Segment in which two triangles of different planes meet: on which features it ends.
//!
//! Idea: both triangles meet the line of the two planes in a segment each, and have the overlap of
//! these in common. Ends are compared along the line by orientations of edges alone. Source: the
//! interval test of Guigue and Devillers (2003), with all that is degenerate.

use super::feature::{Feature, place};
use crate::orientation::Orientation;
use crate::point::{Sign, Triangle};
use std::cmp::Ordering::{self, Equal, Greater, Less};

/// A point of a triangle's outline on the plane of another.
#[derive(Clone, Copy)]
struct Crossing {
    on: Feature,
    /// Corners of an edge through it. The first is in front of the plane or on it, the second
    /// behind or on it; not both are on it.
    line: [usize; 2],
}

/// Where the ends lie on both triangles; one place twice if they meet in a point. None if they do
/// not meet. The corners of each are on these sides of the other's plane.
///
/// The ends run along n_a x n_b, the cross product of the normals. One triangle has no corner in
/// the plane of the other, or not all. A triangle that has all has no area, and meets the other in
/// a point.
pub(super) fn ends(
    [a, b]: [&Triangle; 2],
    [of_a, of_b]: [[Sign; 3]; 2],
    orientation: &mut impl Orientation,
) -> Option<[[Feature; 2]; 2]> {
    if of_a == [0; 3] {
        let [of_b, of_a] = pierced(b, of_b, a, orientation)?;
        return Some([[of_a, of_b]; 2]);
    }
    if of_b == [0; 3] {
        return Some([pierced(a, of_a, b, orientation)?; 2]);
    }
    // Against the line the first triangle begins where its outline goes behind the other's plane.
    // The second begins where its outline comes in front.
    let ([start_a, end_a], [end_b, start_b]) = (outline(of_a)?, outline(of_b)?);
    let mut order = |one: Crossing, other: Crossing| {
        let ([p, q], [r, s]) = (one.line.map(|i| &a[i]), other.line.map(|j| &b[j]));
        orientation.sign(p, q, r, s).cmp(&0)
    };
    let inner = [inner(of_a), inner(of_b)];
    let (starts, stops) = (order(start_a, start_b), order(end_a, end_b));
    // They meet from the later start to the earlier end, and surely if these are of one triangle.
    let between = match (starts, stops) {
        (Less, Less) => (order(end_a, start_b).reverse(), [end_a.on, start_b.on]),
        (Greater, Greater) => (order(start_a, end_b), [start_a.on, end_b.on]),
        _ => (Less, [start_a.on, start_b.on]),
    };
    match between {
        (Less, _) => {}
        (Equal, point) => return Some([point; 2]),
        (Greater, _) => return None,
    }
    // A corner alone, at an end of the other's segment or inside it.
    let at_an_end = match (starts, stops) {
        (Equal, _) => Some([start_a.on, start_b.on]),
        (_, Equal) => Some([end_a.on, end_b.on]),
        _ => None,
    };
    if start_a.on == end_a.on {
        return Some([at_an_end.unwrap_or([start_a.on, inner[1]]); 2]);
    }
    if start_b.on == end_b.on {
        return Some([at_an_end.unwrap_or([inner[0], start_b.on]); 2]);
    }
    let end = |one: Crossing, other: Crossing, order: Ordering, of_a: Ordering| match order {
        Equal => [one.on, other.on],
        order if order == of_a => [one.on, inner[1]],
        _ => [inner[0], other.on],
    };
    Some([
        end(end_a, end_b, stops, Less),
        end(start_a, start_b, starts, Greater),
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
    Some([down.on.min(up.on), place(past)?])
}
