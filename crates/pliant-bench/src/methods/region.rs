//! Triangles of a body that reach into a region, with their boxes: the input of methods without a
//! tree.
//!
//! Nothing is kept from step to step, except memory.

use super::aabb::Aabb;
use super::bodies::Bodies;

/// Triangles and their boxes, in structure-of-arrays form.
#[derive(Debug, Default)]
pub(super) struct Region {
    pub(super) triangles: Vec<u32>,
    pub(super) boxes: Vec<Aabb>,
}

impl Region {
    /// Collects the triangles of a body whose boxes meet `region`. Makes a box for every triangle,
    /// O(n).
    ///
    /// A box that meets a box of the other body meets the overlap of the two bodies' boxes, since
    /// both hold the common point.
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

/// Regions of both bodies of a pair.
pub(super) fn gather_overlap(
    bodies: &Bodies,
    [a, b]: [usize; 2],
    [region_a, region_b]: &mut [Region; 2],
) {
    let overlap = bodies.boxes[a].overlap(&bodies.boxes[b]);
    region_a.gather(bodies, a, &overlap);
    region_b.gather(bodies, b, &overlap);
}
