//! Every invariant of a body, looked at one by one.

use super::body::Body;
use crate::geometry::Origin;
use crate::kernels::Coordinate;
use crate::options::Options;
use crate::queries::{Intersections, Kind};

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
        Ok(())
    }
}
