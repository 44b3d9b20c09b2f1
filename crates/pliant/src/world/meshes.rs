//! Edits of meshes, and trees that are built anew.

use super::handle::World;
use super::scalar::Scalar;
use crate::edit::Edit;
use crate::edit::Edited;
use crate::error::Error;
use crate::ids::BodyId;

/// # Change: edits of meshes
impl<S: Scalar> World<S> {
    /// Gives a body another mesh and its shape: triangles, shape (m, 3), and positions, shape (n,
    /// 3), of any size.
    ///
    /// Id, filter, ignored pairs and loose box stay. Triangles and vertices are numbered as these
    /// are, and none is empty. If the mesh differs from the body's, its motion ends and its vertex
    /// groups are 0.
    ///
    /// Parts that are equal by number stay, and parts that differ are edited.
    ///
    /// Cost: O(m) to compare all triangles, as quick as [`set_positions`](Self::set_positions), and
    /// [`apply`](Self::apply) for the triangles that differ. If more than an eighth differ, or
    /// there are fewer vertices than before, all is made anew as by [`add`](Self::add). Edges then
    /// have other numbers.
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
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody),
    /// [`OutsideLooseBox`](crate::ErrorKind::OutsideLooseBox), and the errors of
    /// [`add`](Self::add). The body then keeps its mesh and its shape.
    pub fn set_mesh(
        &mut self,
        body: BodyId,
        triangles: &[[u32; 3]],
        positions: &[[S; 3]],
    ) -> Result<(), Error> {
        self.verbs.set_mesh(body, triangles, positions)
    }

    /// Numbers the edges of a body as given, shape (k, 2): two vertices a row, in either order.
    ///
    /// They must be the edges of the mesh, each once. From then on answers name edges by the row
    /// here, as a solver that has its own edges does. [`edges`](Self::edges) has the smaller end of
    /// each first, and so have weights and times along edges. A motion goes on.
    ///
    /// Cost: O(k log k).
    ///
    /// ```
    /// # use pliant::World;
    /// let mut world = World::<f32>::new();
    /// let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    /// let body = world.add(&[[0, 1, 2]], &corners)?;
    /// world.set_edges(body, &[[2, 1], [0, 1], [2, 0]])?;
    /// assert_eq!(world.edges(body)?, [[1, 2], [0, 1], [0, 2]]);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody),
    /// [`MissingEdge`](crate::ErrorKind::MissingEdge),
    /// [`NotAnEdge`](crate::ErrorKind::NotAnEdge).
    /// [`EditedMesh`](crate::ErrorKind::EditedMesh) once an edit has changed the mesh.
    pub fn set_edges(&mut self, body: BodyId, edges: &[[u32; 2]]) -> Result<(), Error> {
        self.verbs.set_edges(body, edges)
    }

    /// Begins an edit of a body's mesh, for [`apply`](Self::apply) to make all at once or not at
    /// all.
    ///
    /// [`Edit`] says which steps there are.
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

    /// Applies an edit, all at once or not at all, and says by number what has changed.
    ///
    /// Triangles and vertices that it does not name keep their numbers. Edges that stay keep
    /// theirs: see [`edges`](Self::edges). A triangle number that is left empty is [`u32::MAX`]
    /// three times in [`triangles`](Self::triangles), and in no answer. Positions keep one row for
    /// every number. Rows of empty vertices are not looked at when they are set, and are NaN when
    /// they are asked for.
    ///
    /// Filter, ignored pairs and loose box stay. A new vertex has group 0, or the group of the
    /// vertex that it was split from. A motion ends if anything changes.
    ///
    /// Cost: it grows with what the edit names and the triangles at its vertices, whatever the size
    /// of the mesh. The first edit of a body is O(m). When a sixteenth of the triangles were
    /// changed since, the tree is built anew.
    ///
    /// # Errors
    ///
    /// - [`OutdatedEdit`](crate::ErrorKind::OutdatedEdit) if the mesh was changed since the edit
    ///   was begun, or another world began it;
    /// - [`NoTriangles`](crate::ErrorKind::NoTriangles) if none would be left;
    /// - [`NoSuchTriangle`](crate::ErrorKind::NoSuchTriangle),
    ///   [`EmptyTriangle`](crate::ErrorKind::EmptyTriangle),
    ///   [`NoSuchVertex`](crate::ErrorKind::NoSuchVertex),
    ///   [`EmptyVertex`](crate::ErrorKind::EmptyVertex),
    ///   [`VertexOutOfRange`](crate::ErrorKind::VertexOutOfRange),
    ///   [`VertexInUse`](crate::ErrorKind::VertexInUse),
    ///   [`NotACorner`](crate::ErrorKind::NotACorner);
    /// - for new positions, the errors of [`set_positions`](Self::set_positions).
    pub fn apply(&mut self, edit: &Edit<S>) -> Result<Edited, Error> {
        self.verbs.apply(edit)
    }

    /// Flags of triangle numbers, shape (m,): false where an edit has left a number empty. Cost:
    /// O(m).
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn live_triangles(&self, body: BodyId) -> Result<Vec<bool>, Error> {
        Ok(self.state().body(body)?.mesh().live_triangles())
    }

    /// Flags of vertex numbers, shape (n,): false where an edit has left a number empty. Cost:
    /// O(n).
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn live_vertices(&self, body: BodyId) -> Result<Vec<bool>, Error> {
        Ok(self.state().body(body)?.mesh().live_vertices())
    }

    /// Revision of a body's mesh: another number after each change of the mesh or of its tree's
    /// order.
    ///
    /// Callers that keep [`vertex_order`](Self::vertex_order), [`edges`](Self::edges) or
    /// [`triangles`](Self::triangles) ask for them again when it is another.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn mesh_revision(&self, body: BodyId) -> Result<u64, Error> {
        Ok(self.state().body(body)?.mesh().order_version())
    }

    /// Builds the tree of a body anew, on its present shape. Id, filters and loose box stay.
    ///
    /// It pays when a shape has become very different from the one that the tree was built on.
    /// Right answers never need it.
    ///
    /// Cost: as in [`add`](Self::add).
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn rebuild(&mut self, body: BodyId) -> Result<(), Error> {
        self.verbs.rebuild(body)
    }

    /// Estimates how much more the tree of a body does than a fresh one would, as a factor.
    ///
    /// It comes from queries for triangles in the present shape: pairs of nodes that they looked
    /// at, for each that a fresh tree would. The first queries after the body was added tell what a
    /// fresh tree does. The factor is 1 before a query says anything, or where little was looked
    /// at.
    ///
    /// With [`Options::mending`](crate::Options::mending), trees that have decayed are built anew,
    /// as soon as that would have paid by now. A part of the work is done whenever the body gets a
    /// new shape, by [`set_positions`](Self::set_positions) or the end of a motion. A tree along
    /// the mesh ([`Partition::Connectivity`](crate::Partition::Connectivity)) is not, for it would
    /// be the same again.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn tree_quality(&self, body: BodyId) -> Result<f64, Error> {
        Ok(self.state().body(body)?.tree_quality())
    }
}
