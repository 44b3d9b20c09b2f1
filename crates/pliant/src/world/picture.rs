//! What a body looks like now, for those who draw it or store it: triangles, positions, and the boxes of its tree.

use super::forest::with_trees;
use super::{BodyId, World};
use crate::error::Error;
use crate::geometry::{Bounds, Scalar};

/// A node of a tree, drawn as a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeBox<S> {
    /// The smallest coordinates of the triangles below the node, as the caller has them.
    pub lower: [S; 3],
    /// The largest coordinates.
    pub upper: [S; 3],
    /// Whether the tree holds this box: it was made for the shape that the body has now. A query makes the boxes that it
    /// needs; the others are as they were for some shape before, and nothing reads them.
    pub made: bool,
}

impl<S: Scalar> World<S> {
    /// The triangles of a body as they were added.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn triangles(&self, body: BodyId) -> Result<Vec<[u32; 3]>, Error> {
        Ok(self.bodies[self.place(body)?].triangles())
    }

    /// The shape that a body has now: the positions that it was given last.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn positions(&self, body: BodyId) -> Result<Vec<[S; 3]>, Error> {
        Ok(self.bodies[self.place(body)?].positions().into_owned())
    }

    /// The boxes of a level of a body's tree, and which of them the tree holds for the shape that the body has now: figure 2
    /// of the paper. One box a part, in the order of [`tree_parts`](Self::tree_parts): a leaf above the level stands for
    /// itself.
    ///
    /// The corners are those of the triangles; the tree's own boxes, in single precision, are the same or a rounding
    /// larger. Makes no box, and reads none.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    ///
    /// ```
    /// use pliant::World;
    ///
    /// let mut world = World::<f32>::new();
    /// let body = world.add(&[[0, 1, 2]], &[[0.0; 3], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0]])?;
    /// let root = world.tree_boxes(body, 0)?[0];
    /// assert_eq!((root.lower, root.upper, root.made), ([0.0; 3], [2.0, 1.0, 0.0], false));
    /// world.update_body(body)?;
    /// assert!(world.tree_boxes(body, 0)?[0].made);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn tree_boxes(&self, body: BodyId, level: u32) -> Result<Vec<NodeBox<S>>, Error> {
        let place = self.place(body)?;
        let body = &self.bodies[place];
        let (starts, made) = with_trees!(&self.forest, trees => {
            (trees[place].starts_of_parts(level), trees[place].made_parts(level, body.epoch()))
        });
        let ends = starts[1..]
            .iter()
            .copied()
            .chain([body.triangle_count() as u32]);
        let positions = body.positions();
        let boxes = starts.iter().zip(ends).zip(made);
        Ok(boxes
            .map(|((&start, end), made)| {
                let mut bounds = Bounds::EMPTY;
                for &vertex in body.mesh.corners()[start as usize..end as usize].as_flattened() {
                    let vertex = body.mesh.vertex_ids()[vertex as usize];
                    bounds.include(positions[vertex as usize]);
                }
                NodeBox {
                    lower: bounds.lo,
                    upper: bounds.hi,
                    made,
                }
            })
            .collect())
    }
}
