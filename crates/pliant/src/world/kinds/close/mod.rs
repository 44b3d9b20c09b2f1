//! Queries for close pairs of elements: at most a distance apart, with their closest points.

pub(crate) mod reference;

use super::ask::first_seen;
use crate::bodies::Places;
use crate::collide::{Ask, InBodies, Request};
use crate::error::Error;
use crate::ids::BodyId;
use crate::kernels::Coordinate;
use crate::queries::{
    Close, CloseEdgeEdge, CloseVertexTriangle, EdgeEdge, EdgeEdgeCandidates, Kind, VertexTriangle,
    VertexTriangleCandidates,
};
use crate::selection::Selection;
use crate::traversal::Visitor;
use crate::world::handle::World;
use crate::world::query::Query;
use crate::world::scalar::Scalar;
use crate::world::state::State;

/// # Questions: close vertices, edges and triangles
impl<S: Scalar> World<S> {
    /// Asks which vertices are at most `distance` from which triangles in the present shape, with
    /// closest points.
    ///
    /// Penalty, barrier and position-based solvers push these apart. See
    /// [`close_edge_edge_pairs`](Self::close_edge_edge_pairs) for the other half. The distance is
    /// in the unit of the positions.
    ///
    /// Whether a pair is that close is decided exactly, in real arithmetic on the numbers given.
    /// [`CloseVertexTriangle`] says how good distance, direction and closest points are. Which
    /// pairs are looked at is said at
    /// [`vertex_triangle_candidates`](Self::vertex_triangle_candidates): no corner of a triangle is
    /// close to it, and vertex groups and filters count. Of one body, pairs that are as close in
    /// its [rest shape](Self::set_rest_positions) are left out. A motion changes no answer, but
    /// while there is one, more candidates are looked at.
    ///
    /// ```
    /// # use pliant::{Selection, World};
    /// let mut world = World::<f64>::new();
    /// let large = [[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]];
    /// let floor = world.add(&[[0, 1, 2]], &large)?;
    /// let leaf = world.add(&[[0, 1, 2]], &[[0.0, 0.0, 0.25], [1.0, 0.0, 3.0], [0.0, 1.0, 3.0]])?;
    /// let thickness = 0.5;
    /// for close in world.close_vertex_triangle_pairs(Selection::World, thickness).all()? {
    ///     assert_eq!((close.pair.vertex_body, close.pair.vertex), (leaf, 0));
    ///     assert_eq!(close.distance, 0.25);
    ///     assert_eq!(close.direction, Some([0.0, 0.0, 1.0]));
    ///     // How far to push, shared by the vertex and the corners of the triangle.
    ///     let push = thickness - close.distance;
    ///     let weights = 1.0 + close.barycentric.iter().map(|b| b * b).sum::<f64>();
    ///     assert!(push / weights < 0.25);
    /// }
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// The errors of [`Query`].
    #[doc(alias = "NormalCollisions")]
    #[doc(alias = "point_triangle_distance")]
    pub fn close_vertex_triangle_pairs(
        &mut self,
        of: Selection,
        distance: f64,
    ) -> Query<'_, CloseVertexTriangle> {
        Query::<CloseVertexTriangle>::new(&mut *self.verbs, of).within(distance)
    }

    /// Asks which edges are at most `distance` from which edges in the present shape, with closest
    /// points.
    ///
    /// All is as for [`close_vertex_triangle_pairs`](Self::close_vertex_triangle_pairs). Edges have
    /// the numbers that [`edges`](Self::edges) gives them; two that have an end in common are not
    /// looked at.
    ///
    /// # Errors
    ///
    /// The errors of [`Query`].
    #[doc(alias = "edge_edge_distance")]
    pub fn close_edge_edge_pairs(
        &mut self,
        of: Selection,
        distance: f64,
    ) -> Query<'_, CloseEdgeEdge> {
        Query::<CloseEdgeEdge>::new(&mut *self.verbs, of).within(distance)
    }
}

ask!(
    CloseVertexTriangle,
    close_vertex_triangle.all_measured,
    |request| {
        let candidates = VertexTriangleCandidates::<S>::within;
        Close::within(request.distance()?, request.leaves_out, candidates)
    }
);
ask!(CloseEdgeEdge, close_edge_edge.all_measured, |request| {
    let candidates = EdgeEdgeCandidates::<S>::within;
    Close::within(request.distance()?, request.leaves_out, candidates)
});
impl InBodies for VertexTriangle {
    fn bodies(&self) -> [BodyId; 2] {
        [self.vertex_body, self.triangle_body]
    }

    #[inline]
    fn corners<'b, S: Coordinate>(
        &self,
        [of_vertex, of_triangle]: [&Places<'b, S>; 2],
    ) -> Self::Corners<'b, S> {
        let [a, b, c] = of_triangle.triangle(self.triangle);
        [of_vertex.vertex(self.vertex), a, b, c]
    }
}

impl InBodies for EdgeEdge {
    fn bodies(&self) -> [BodyId; 2] {
        [self.body_a, self.body_b]
    }

    #[inline]
    fn corners<'b, S: Coordinate>(
        &self,
        [of_a, of_b]: [&Places<'b, S>; 2],
    ) -> Self::Corners<'b, S> {
        let [a0, a1] = of_a.edge(self.edge_a);
        let [b0, b1] = of_b.edge(self.edge_b);
        [a0, a1, b0, b1]
    }
}
