//! How often a closed surface winds round a point, by segments in general position.
//!
//! A segment from the point to one far outside crosses triangles in their insides, or another end
//! is tried. So no rule for borders is needed, and none can be wrong.

use super::{Random, Triangle, intersect, orientation, orientation_2d};

/// How often a closed surface winds round a point; `None` if the point is on it.
///
/// Outward is where (b - a) x (c - a) points to. The surface is closed: each edge belongs to as
/// many triangles in one direction as in the other.
///
/// # Panics
///
/// If a coordinate is not finite.
pub fn winding_number(point: [f64; 3], surface: &[Triangle]) -> Option<i32> {
    if surface.iter().any(|it| intersect(&[point; 3], it)) {
        return None;
    }
    let has_area = |it: &&Triangle| {
        let seen = |x: usize, y: usize| it.map(|corner| [corner[x], corner[y]]);
        let planes = [seen(0, 1), seen(1, 2), seen(2, 0)];
        planes.iter().any(|&[a, b, c]| orientation_2d(a, b, c) != 0)
    };
    // Segments in general position pass the others by.
    let surface: Vec<&Triangle> = surface.iter().filter(has_area).collect();
    let largest = surface.iter().flat_map(|it| it.as_flattened());
    let largest = largest.chain(&point).fold(1.0, |m: f64, x| m.max(x.abs()));
    let mut random = Random::new(97);
    loop {
        let mut part = || f64::from(random.below(2000)) / 1000.0 - 1.0;
        let outside = [8.0 * largest, part() * largest, part() * largest];
        let crossings = surface.iter().map(|&it| crossing(point, outside, it));
        if let Some(number) = crossings.sum() {
            return Some(number);
        }
    }
}

/// 1 if the segment from p to q leaves through a triangle that p is not on, -1 if it enters. None
/// if it meets its border or its plane in q.
fn crossing(p: [f64; 3], q: [f64; 3], [a, b, c]: &Triangle) -> Option<i32> {
    let [from, to] = [p, q].map(|end| orientation(a, b, c, &end));
    if from == to && from != 0 {
        return Some(0);
    }
    let passes = [[a, b], [b, c], [c, a]].map(|[u, v]| orientation(&p, &q, u, v));
    match (passes.contains(&1), passes.contains(&-1)) {
        (true, true) => Some(0),
        _ if passes.contains(&0) || to == 0 => None,
        // In the plane of the triangle, and not on it, is only the beginning.
        _ if from == 0 => Some(0),
        _ => Some(i32::from(to)),
    }
}
