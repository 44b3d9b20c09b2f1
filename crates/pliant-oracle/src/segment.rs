//! Segment in which two triangles of different planes meet, on a lattice, by fractions.
//!
//! Of all points where corners and edges may meet the other triangle, the ones that both hold are
//! kept. The two that are farthest along the line of the planes are the ends.

use crate::adjacent::{Corners, Fraction, candidates, cross, dot, holds, minus, segment_holds};

/// An end: where it lies on either triangle, and its position.
///
/// 0 to 2 is a corner, and 6 is inside. 3 to 5 is inside an edge, from the corner with that number
/// less three to the next.
type End = ([usize; 2], [f64; 3]);

/// The ends of the segment in which two triangles meet, or one point twice. None if they do not
/// meet or lie in one plane, or if neither has an area. Coordinates are below 2^6 in magnitude.
pub fn segment(corners: [[[i64; 3]; 3]; 2]) -> Option<[End; 2]> {
    let [a, b] = corners.map(|triangle| triangle.map(|corner| corner.map(i128::from)));
    let [of_a, of_b] = [a, b].map(|[p, q, r]| cross(minus(q, p), minus(r, p)));
    let is_in_plane = |normal: [i128; 3], origin: [i128; 3], triangle: Corners| {
        triangle
            .iter()
            .all(|&corner| dot(normal, minus(corner, origin)) == 0)
    };
    if is_in_plane(of_a, a[0], b) && is_in_plane(of_b, b[0], a) {
        return None;
    }
    let mut both = candidates(a, b);
    both.retain(|&point| holds(a, point) && holds(b, point));
    let line = cross(of_a, of_b);
    // Of two fractions the one that is farther along the line.
    let order =
        |&(x, d): &Fraction, &(y, e): &Fraction| (dot(line, x) * e).cmp(&(dot(line, y) * d));
    let ends = [
        both.iter().min_by(|x, y| order(x, y))?,
        both.iter().max_by(|x, y| order(x, y))?,
    ];
    Some(ends.map(|&(x, d)| {
        let features = [a, b].map(|triangle| feature(triangle, (x, d)));
        (features, x.map(|x| x as f64 / d as f64))
    }))
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
