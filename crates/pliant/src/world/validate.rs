//! Every invariant of a body, looked at one by one.

use super::body::Body;
use crate::geometry::{Origin, Shape};
use crate::kernels::Coordinate;
use crate::options::Options;
use crate::queries::{Intersections, Kind, VertexTriangleCandidates};
use crate::tree::{Grown, Swept};

impl<const N: usize, S: Coordinate> Body<N, S> {
    /// Checks the structure of the tree, and that each box that claims to be valid is the box over the vertices below it as they
    /// are now. A sentence says what is wrong.
    pub(super) fn validate(&self, options: &Options, origin: Origin) -> Result<(), String> {
        self.tree.validate(&self.order, options.partition)?;
        if let Some(boxes) = self.boxes(Intersections::<S>::BOX_SET) {
            let positions = self.in_tree_order();
            self.tree
                .validate_boxes(boxes, &self.shape(&positions, origin))?;
        }
        if let Some(boxes) = self.boxes(VertexTriangleCandidates::<S>::BOX_SET) {
            let positions = self.in_tree_order();
            let end = self.end_in_tree_order();
            let from = self.shape(&positions, origin);
            let to = end.as_ref().map(|(positions, epoch)| Shape {
                positions,
                epoch: *epoch,
                ..from
            });
            let source = Grown {
                source: Swept { from, to },
                distance: boxes.grown_by(),
            };
            self.tree.validate_boxes(boxes, &source)?;
        }
        Ok(())
    }
}
