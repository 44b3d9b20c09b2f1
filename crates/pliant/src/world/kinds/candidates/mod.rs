//! Queries for candidates: elements whose boxes are within a margin.

pub(crate) mod reference;

use super::ask::first_seen;
use crate::collide::{Ask, Request};
use crate::error::Error;
use crate::kernels::Coordinate;
use crate::queries::{
    EdgeEdge, EdgeEdgeCandidates, Kind, VertexTriangle, VertexTriangleCandidates,
};
use crate::selection::Selection;
use crate::traversal::Visitor;
use crate::world::handle::World;
use crate::world::query::Query;
use crate::world::scalar::Scalar;
use crate::world::state::State;

/// # Questions: candidates, now or on the way
///
/// The [crate's page](crate#candidates-close-pairs-impacts) shows how candidates, close pairs and
/// impacts differ.
impl<S: Scalar> World<S> {
    /// Asks which vertices are near which triangles, now or on the way to the end of a motion.
    ///
    /// This is the search of a solver that then decides by distance, or when they touch. See
    /// [`edge_edge_candidates`](Self::edge_edge_candidates) for the other half.
    ///
    /// The box of an element is the hull of its corners, at both ends of the motion where there is
    /// one. A vertex and a triangle are a candidate if the vertex is no corner of the triangle, and
    /// their boxes are near. That is: on every axis the gap of the boxes is at most twice `radius`,
    /// in real arithmetic on the numbers given. The radius is in the unit of the positions. With
    /// half the distance at which things are to be found, nothing is missed that comes as near as
    /// that. Degenerate triangles and triangles that come twice count; vertices that no triangle
    /// uses are in no candidate.
    ///
    /// Between two bodies, the vertices of either are paired with the triangles of the other.
    /// Filters keep bodies apart as in [`intersections`](Self::intersections), and
    /// [`set_vertex_groups`](Self::set_vertex_groups) keeps apart parts of them.
    ///
    /// [`Query`] says the errors, [`Query::all`] the cost.
    ///
    /// ```
    /// # use pliant::{Selection, World};
    /// let mut world = World::<f64>::new();
    /// let large = [[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]];
    /// let floor = world.add(&[[0, 1, 2]], &large)?;
    /// let leaf = world.add(&[[0, 1, 2]], &[[0.0, 0.0, 2.0], [1.0, 0.0, 3.0], [0.0, 1.0, 3.0]])?;
    /// // Within 0.1 of each other: 0.05 round each.
    /// assert!(world.vertex_triangle_candidates(Selection::World, 0.05).all()?.is_empty());
    /// world.set_motion(leaf, &[[0.0, 0.0, 0.05], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]])?;
    /// let near = world.vertex_triangle_candidates(Selection::World, 0.05).all()?;
    /// assert_eq!((near[0].vertex_body, near[0].vertex, near[0].triangle_body), (leaf, 0, floor));
    /// # Ok::<(), pliant::Error>(())
    /// ```
    #[doc(alias = "broad_phase")]
    #[doc(alias = "detect_face_vertex_candidates")]
    pub fn vertex_triangle_candidates(
        &mut self,
        of: Selection,
        radius: f64,
    ) -> Query<'_, VertexTriangle> {
        Query::<VertexTriangle>::new(&mut *self.verbs, of).within(radius)
    }

    /// Asks which edges are near which edges, now or on the way to the end of a motion.
    ///
    /// All is as for [`vertex_triangle_candidates`](Self::vertex_triangle_candidates). Edges have
    /// the numbers that [`edges`](Self::edges) gives them; two that have an end in common are no
    /// candidate.
    #[doc(alias = "detect_edge_edge_candidates")]
    pub fn edge_edge_candidates(&mut self, of: Selection, radius: f64) -> Query<'_, EdgeEdge> {
        Query::<EdgeEdge>::new(&mut *self.verbs, of).within(radius)
    }
}

ask!(VertexTriangle, vertex_triangle.all, |request| {
    VertexTriangleCandidates::<S>::within(request.margin()?)
});
ask!(EdgeEdge, edge_edge.all, |request| {
    EdgeEdgeCandidates::<S>::within(request.margin()?)
});
