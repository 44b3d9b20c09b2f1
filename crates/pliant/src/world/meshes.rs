//! Meshes that change.

use super::handle::World;
use super::scalar::Scalar;
use crate::edit::Edit;
use crate::edit::Edited;
use crate::error::Error;
use crate::ids::BodyId;

/// Meshes that change.
impl<S: Scalar> World<S> {
    /// Gives a body another mesh and its shape, shapes (m, 3) and (n, 3), of any size. Id, filter, ignored pairs and loose box stay;
    /// triangles and vertices are numbered as these are, and none is empty. A mesh that is not that which the body has ends a motion, and
    /// takes the vertices their groups.
    ///
    /// What is equal by number stays, what differs is edited. So this costs a comparison of all triangles, which is as quick as
    /// [`set_positions`](Self::set_positions), and what [`apply`](Self::apply) costs for those that differ. Where they are more than an
    /// eighth, or vertices fewer than before, all is made anew, which costs as much as [`add`](Self::add): edges have other numbers then.
    ///
    /// ```
    /// use pliant::{Selection, World};
    ///
    /// let mut world = World::<f32>::new();
    /// let body = world.add(&[[0, 1, 2]], &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])?;
    /// // Cut from corner 0 to the middle of the side across.
    /// let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.5, 0.5, 0.0], [0.0, 1.0, 0.0]];
    /// world.set_mesh(body, &[[0, 1, 2], [0, 2, 3]], &positions)?;
    /// assert_eq!(world.triangle_count(body)?, 2);
    /// assert!(world.intersections(Selection::Within(body)).first()?.is_none());
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody), those of [`add`](Self::add), and
    /// [`OutsideLooseBox`](crate::ErrorKind::OutsideLooseBox); the body keeps its mesh and its shape.
    pub fn set_mesh(
        &mut self,
        body: BodyId,
        triangles: &[[u32; 3]],
        positions: &[[S; 3]],
    ) -> Result<(), Error> {
        self.verbs.set_mesh(body, triangles, positions)
    }

    /// Begins an edit of a body's mesh: changes that [`apply`](Self::apply) makes all at once, or not at all. See [`Edit`].
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    #[doc(alias = "cut")]
    #[doc(alias = "tear")]
    pub fn edit(&self, body: BodyId) -> Result<Edit<S>, Error> {
        Ok(self
            .state()
            .body(body)?
            .mesh()
            .begin_edit(self.state().number))
    }

    /// Makes the changes of an edit, and says by number what has changed. Triangles and vertices that it does not name keep their numbers,
    /// edges their numbers if they stay: see [`edges`](Self::edges).
    ///
    /// A number that is left empty is [`u32::MAX`] three times in [`triangles`](Self::triangles), and nothing in any answer. Positions keep
    /// one row for every number; rows of empty vertices are not looked at when they are set, and NaN when they are asked for. Filter,
    /// ignored pairs and loose box stay; a new vertex has group 0, or that of the vertex that it was split from; a motion ends if anything
    /// changes.
    ///
    /// Cost: by what the edit names, and the triangles at the vertices of that, whatever the size of the mesh; but O(m) for the first edit
    /// of a body, and when a sixteenth of the triangles were changed since, for the tree is then built anew.
    ///
    /// # Errors
    ///
    /// [`OutdatedEdit`](crate::ErrorKind::OutdatedEdit) if the mesh was changed since the edit was begun, or another
    /// world began it; [`NoTriangles`](crate::ErrorKind::NoTriangles) if none would be left;
    /// [`NoSuchTriangle`](crate::ErrorKind::NoSuchTriangle), [`EmptyTriangle`](crate::ErrorKind::EmptyTriangle),
    /// [`NoSuchVertex`](crate::ErrorKind::NoSuchVertex), [`EmptyVertex`](crate::ErrorKind::EmptyVertex),
    /// [`VertexOutOfRange`](crate::ErrorKind::VertexOutOfRange), [`VertexInUse`](crate::ErrorKind::VertexInUse),
    /// [`NotACorner`](crate::ErrorKind::NotACorner), and for new positions those of [`set_positions`](Self::set_positions).
    pub fn apply(&mut self, edit: &Edit<S>) -> Result<Edited, Error> {
        self.verbs.apply(edit)
    }

    /// For each number whether it is that of a triangle, shape (m,): false where an edit has left it empty.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn live_triangles(&self, body: BodyId) -> Result<Vec<bool>, Error> {
        Ok(self.state().body(body)?.mesh().live_triangles())
    }

    /// For each number whether it is that of a vertex, shape (n,): false where an edit has left it empty.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn live_vertices(&self, body: BodyId) -> Result<Vec<bool>, Error> {
        Ok(self.state().body(body)?.mesh().live_vertices())
    }

    /// Counts the meshes of a body, and the orders that its trees bring them into: whoever keeps what [`vertex_order`](Self::vertex_order),
    /// [`edges`](Self::edges) or [`triangles`](Self::triangles) says asks for them again when this is another.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn mesh_revision(&self, body: BodyId) -> Result<u64, Error> {
        Ok(self.state().body(body)?.mesh().order_version())
    }

    /// Builds the tree of a body anew, on the shape it has now. Id, filters and loose box stay. Worth it when a shape has
    /// become very different from the one it was built on; never needed for right answers.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn rebuild(&mut self, body: BodyId) -> Result<(), Error> {
        self.verbs.rebuild(body)
    }

    /// How much more the tree of a body does than a fresh one would, estimated from what queries for triangles did in the shape of now: pairs
    /// of nodes that were looked at, for one that a fresh tree would look at. 1 before a query says anything, or where little was looked at.
    ///
    /// The first queries after the body was added tell what a fresh tree does. With [`Options::mending`](crate::Options::mending) trees that have decayed are built
    /// anew, a part of the work whenever the body has a new shape (by [`set_positions`](Self::set_positions) or the end of a motion), as
    /// soon as that would have paid by now; a tree along the mesh ([`Partition::Connectivity`](crate::Partition::Connectivity)) is not, for
    /// it would be the same again.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn tree_quality(&self, body: BodyId) -> Result<f64, Error> {
        Ok(self.state().body(body)?.tree_quality())
    }
}
