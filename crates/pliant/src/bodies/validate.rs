//! Every invariant of a body, looked at one by one.

use super::body::Body;
use crate::geometry::{Origin, Shape};
use crate::kernels::Coordinate;
use crate::options::Options;
use crate::queries::{OF_MOTIONS, OF_SHAPES};
use crate::tree::Grown;

impl<S: Coordinate> Body<S> {
    /// Checks the structure of the tree, and that each box that claims to be valid is the box over the vertices below it as they
    /// are now. A sentence says what is wrong.
    pub(crate) fn validate(&self, options: &Options, origin: Origin) -> Result<(), String> {
        let positions = self.in_tree_order();
        let from = self.shape(&positions, origin);
        let end = self.end_in_tree_order();
        let to = end.as_ref().map(|(positions, epoch)| Shape {
            positions,
            epoch: *epoch,
            ..from
        });
        let mut next = 0;
        for part in self.parts.all() {
            if part.triangles.start != next {
                return Err(format!(
                    "a part begins at {}, not {next}",
                    part.triangles.start
                ));
            }
            next = part.triangles.end;
            let triangles = part.triangles.start as usize..part.triangles.end as usize;
            let tree = &part.tree;
            tree.validate(&self.order, triangles, options.partition)?;
            if let Some(boxes) = part.boxes(OF_SHAPES) {
                tree.validate_boxes(boxes, &from)?;
            }
            if let Some(boxes) = part.boxes(OF_MOTIONS) {
                let distance = boxes.grown_by();
                let source = Grown { from, to, distance };
                tree.validate_boxes(boxes, &source)?;
            }
        }
        if next as usize != self.triangle_count() {
            return Err("the parts do not hold all triangles".into());
        }
        self.validate_edits()
    }
}
