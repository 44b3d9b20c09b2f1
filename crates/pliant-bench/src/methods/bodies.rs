//! Bodies of the older methods: a copy of all shapes, boxes, and brute force over pairs of bodies.

use super::aabb::Aabb;
use super::triangle_box::triangle_box;
use crate::decision::Triangle;
use crate::motion::{BodyMesh, Shape};

/// World positions and triangles of all bodies, in the shape of the last step.
#[derive(Debug, Default)]
pub(crate) struct Bodies {
    pub(crate) triangles: Vec<Vec<[u32; 3]>>,
    pub(crate) positions: Vec<Vec<[f32; 3]>>,
    /// Boxes of whole bodies.
    pub(crate) boxes: Vec<Aabb>,
}

impl Bodies {
    pub(crate) fn build(bodies: &[BodyMesh<'_>]) -> Self {
        let mut all = Self {
            triangles: bodies.iter().map(|body| body.triangles.to_vec()).collect(),
            positions: bodies
                .iter()
                .map(|body| body.shape.world.to_vec())
                .collect(),
            boxes: Vec::new(),
        };
        all.boxes = all
            .positions
            .iter()
            .map(|positions| Aabb::of(positions))
            .collect();
        all
    }

    /// Copies the shapes, and makes the boxes of the bodies.
    pub(crate) fn take_over(&mut self, shapes: &[Shape<'_>]) {
        for ((positions, own_box), shape) in
            self.positions.iter_mut().zip(&mut self.boxes).zip(shapes)
        {
            positions.copy_from_slice(shape.world);
            *own_box = Aabb::of(positions);
        }
    }

    #[inline]
    pub(crate) fn corners(&self, body: usize, triangle: u32) -> Triangle {
        self.triangles[body][triangle as usize].map(|vertex| self.positions[body][vertex as usize])
    }

    #[inline]
    pub(crate) fn triangle_box(&self, body: usize, triangle: u32) -> Aabb {
        triangle_box(
            self.triangles[body][triangle as usize],
            &self.positions[body],
        )
    }

    /// Pairs of bodies whose boxes overlap, the smaller number first.
    pub(crate) fn overlapping_pairs(&self) -> impl Iterator<Item = [usize; 2]> {
        let count = self.boxes.len();
        (0..count)
            .flat_map(move |a| (a + 1..count).map(move |b| [a, b]))
            .filter(|&[a, b]| self.boxes[a].overlaps(&self.boxes[b]))
    }
}

/// Whether two triangles of one body share a vertex.
#[inline]
pub(crate) fn share_a_vertex(a: [u32; 3], b: [u32; 3]) -> bool {
    a.iter().any(|vertex| b.contains(vertex))
}
