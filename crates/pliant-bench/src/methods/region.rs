//! The triangles of a body that reach into a region, with their boxes: what methods without a tree work on. Nothing is kept
//! from step to step but memory.

use super::aabb::Aabb;
use super::bodies::Bodies;

/// Triangles and their boxes, side by side.
#[derive(Debug, Default)]
pub(super) struct Region {
    pub(super) triangles: Vec<u32>,
    pub(super) boxes: Vec<Aabb>,
}

impl Region {
    /// Takes the triangles of a body whose boxes meet `region`. A box that meets a box of the other body meets the overlap of
    /// the boxes of the two bodies: both hold the point that they have in common. Makes a box for every triangle.
    pub(super) fn gather(&mut self, bodies: &Bodies, body: usize, region: &Aabb) {
        self.triangles.clear();
        self.boxes.clear();
        for triangle in 0..bodies.triangles[body].len() as u32 {
            let own_box = bodies.triangle_box(body, triangle);
            if own_box.overlaps(region) {
                self.triangles.push(triangle);
                self.boxes.push(own_box);
            }
        }
    }
}

/// The regions of both bodies of a pair.
pub(super) fn gather_overlap(
    bodies: &Bodies,
    [a, b]: [usize; 2],
    [region_a, region_b]: &mut [Region; 2],
) {
    let overlap = bodies.boxes[a].overlap(&bodies.boxes[b]);
    region_a.gather(bodies, a, &overlap);
    region_b.gather(bodies, b, &overlap);
}
