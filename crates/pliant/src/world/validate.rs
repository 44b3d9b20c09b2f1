//! Every invariant of a world, looked at one by one.

use super::World;
use super::forest::with_trees;
use crate::geometry::{Scalar, Shape};

impl<S: Scalar> World<S> {
    /// Checks every invariant of every tree: the structure, that each box that claims to be true is the box of the vertices
    /// below it as they are now, and that the nodes of mesh connectivity trees are connected pieces or whole components. For tests and bug reports; no sequence of calls should ever make it fail.
    ///
    /// Cost: every triangle once a level.
    ///
    /// # Errors
    ///
    /// A sentence that names the body and what is wrong.
    pub fn validate(&self) -> Result<(), String> {
        with_trees!(&self.forest, trees => {
            if trees.len() != self.bodies.len() {
                return Err(format!("{} trees for {} bodies", trees.len(), self.bodies.len()));
            }
            for (tree, body) in trees.iter().zip(&self.bodies) {
                let positions = body.in_tree_order();
                let shape = Shape { positions: &positions, triangles: body.mesh.corners(), origin: self.origin, epoch: body.epoch() };
                tree.validate(&body.mesh, &shape, self.options.partition).map_err(|what| format!("{}: {what}", body.id()))?;
            }
        });
        Ok(())
    }
}
