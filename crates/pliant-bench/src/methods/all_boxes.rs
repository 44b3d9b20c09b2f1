//! Distance of two bodies without a tree, by comparing boxes of triangles: the truth for that
//! query.
//!
//! Two corners near each other give a first bound. Then only triangles whose boxes are within the
//! bound of the other body's box are compared.

use super::aabb::Aabb;
use super::plain_distance::of_triangles;
use crate::method::{Counters, Method, Pair};
use crate::motion::{BodyMesh, Shape};

/// Distance query on the first two bodies.
#[derive(Default)]
pub struct AllBoxes {
    triangles: Vec<Vec<[u32; 3]>>,
    corners: [Vec<[[f32; 3]; 3]>; 2],
    counters: Counters,
}

impl Method for AllBoxes {
    fn name(&self) -> String {
        "boxes of all triangles".to_owned()
    }

    fn build(&mut self, bodies: &[BodyMesh<'_>]) {
        self.triangles = bodies.iter().map(|body| body.triangles.to_vec()).collect();
    }

    fn step(&mut self, shapes: &[Shape<'_>]) {
        for ((corners, triangles), shape) in
            self.corners.iter_mut().zip(&self.triangles).zip(shapes)
        {
            let of_shape = triangles
                .iter()
                .map(|triangle| triangle.map(|vertex| shape.world[vertex as usize]));
            corners.clear();
            corners.extend(of_shape);
        }
    }

    fn all_pairs(&mut self) -> &[Pair] {
        &[]
    }

    fn first_pair(&mut self) -> Option<Pair> {
        None
    }

    fn distance(&mut self) -> Option<f64> {
        let [of_a, of_b] = &self.corners;
        let all_b = Aabb::of(of_b.as_flattened());
        let centre = std::array::from_fn(|axis| f32::midpoint(all_b.lo[axis], all_b.hi[axis]));
        let near_b = nearest_corner(of_a, centre)?;
        let near_a = nearest_corner(of_b, near_b)?;
        let mut least = square(near_a, near_b).sqrt();
        let all_a = Aabb::of(of_a.as_flattened());
        let near = |triangles: &[[[f32; 3]; 3]], other: &Aabb| -> Vec<_> {
            let with_boxes = triangles
                .iter()
                .map(|corners| (*corners, Aabb::of(corners)));
            let is_near = |(_, own): &(_, Aabb)| gap_square(own, other) <= limit(least);
            with_boxes.filter(is_near).collect()
        };
        let [of_a, of_b] = [near(of_a, &all_b), near(of_b, &all_a)];
        let wide = |corners: &[[f32; 3]; 3]| corners.map(|corner| corner.map(f64::from));
        for (a, own) in &of_a {
            for (b, other) in &of_b {
                if gap_square(own, other) <= limit(least) {
                    self.counters.decisions += 1;
                    least = least.min(of_triangles(wide(a), wide(b)));
                }
            }
            self.counters.box_tests += of_b.len() as u64;
        }
        Some(least)
    }

    fn take_counters(&mut self) -> Counters {
        std::mem::take(&mut self.counters)
    }
}

/// Square of a distance, rounded up a little, so that rounding makes no pair pass unseen.
fn limit(distance: f64) -> f64 {
    distance * distance * 1.0001
}

/// Square of the distance of two points.
fn square(p: [f32; 3], q: [f32; 3]) -> f64 {
    let on = |axis: usize| (f64::from(p[axis]) - f64::from(q[axis])).powi(2);
    on(0) + on(1) + on(2)
}

/// Square of the gap between two boxes.
fn gap_square(a: &Aabb, b: &Aabb) -> f64 {
    let on = |axis: usize| {
        let below = f64::from(b.lo[axis]) - f64::from(a.hi[axis]);
        let above = f64::from(a.lo[axis]) - f64::from(b.hi[axis]);
        below.max(above).max(0.0).powi(2)
    };
    on(0) + on(1) + on(2)
}

/// Corner nearest to a point.
fn nearest_corner(triangles: &[[[f32; 3]; 3]], to: [f32; 3]) -> Option<[f32; 3]> {
    let corners = triangles.as_flattened().iter().copied();
    corners.min_by(|&p, &q| square(p, to).total_cmp(&square(q, to)))
}
