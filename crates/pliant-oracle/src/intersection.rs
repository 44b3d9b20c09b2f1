//! Intersection of two triangles on a lattice, by fractions.
//!
//! Of all points where corners and edges may meet the other triangle, the ones that both hold are
//! kept. All are on the outline of what they have in common, so one that is no corner of it is
//! between two others.

use crate::adjacent::{Corners, Fraction, candidates, cross, dot, holds, minus, segment_holds};

/// A corner: where it lies on either triangle, and its position.
///
/// 0 to 2 is a corner, and 6 is inside. 3 to 5 is inside an edge, from the corner with that number
/// less three to the next.
type Corner = ([usize; 2], [f64; 3]);

/// The corners of what two triangles have in common, in any order. Coordinates are below 2^6 in
/// magnitude.
pub fn intersection(corners: [[[i64; 3]; 3]; 2]) -> Vec<Corner> {
    let [a, b] = corners.map(|triangle| triangle.map(|corner| corner.map(i128::from)));
    let mut both: Vec<Fraction> = Vec::new();
    for point in candidates(a, b).into_iter().map(reduced) {
        let is_new = !both.iter().any(|&other| apart(point, other) == [0; 3]);
        if is_new && holds(a, point) && holds(b, point) {
            both.push(point);
        }
    }
    let is_between = |point: Fraction| {
        let ways = both.iter().map(|&other| apart(other, point));
        let ways: Vec<[i128; 3]> = ways.collect();
        ways.iter().any(|&way| {
            let opposite = |&other: &[i128; 3]| cross(way, other) == [0; 3] && dot(way, other) < 0;
            ways.iter().any(opposite)
        })
    };
    let corners = both.iter().filter(|&&point| !is_between(point));
    let corner = |&(x, d): &Fraction| {
        let features = [a, b].map(|triangle| feature(triangle, (x, d)));
        (features, x.map(|x| x as f64 / d as f64))
    };
    corners.map(corner).collect()
}

/// A point with its smallest denominator.
fn reduced((x, d): Fraction) -> Fraction {
    let divisor = x.iter().fold(d, |mut a, &b| {
        let mut b = b.abs();
        while b != 0 {
            (a, b) = (b, a % b);
        }
        a
    });
    (x.map(|x| x / divisor), d / divisor)
}

/// From one point to another, times both denominators.
fn apart((x, d): Fraction, (y, e): Fraction) -> [i128; 3] {
    minus(x.map(|x| x * e), y.map(|y| y * d))
}

fn feature(triangle: Corners, (x, d): Fraction) -> usize {
    let is_at = |corner: &[i128; 3]| corner.map(|value| value * d) == x;
    let corner = triangle.iter().position(is_at);
    let edge = || {
        let edge = |i: usize| [triangle[i], triangle[(i + 1) % 3]];
        (0..3)
            .find(|&i| segment_holds(edge(i), (x, d)))
            .map(|i| 3 + i)
    };
    corner.or_else(edge).unwrap_or(6)
}
