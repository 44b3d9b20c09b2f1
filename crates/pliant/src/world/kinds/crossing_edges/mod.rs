//! Queries for crossing edges: edges and triangles whose insides meet.

pub(crate) mod reference;

use super::ask::first_seen;
use crate::collide::{Ask, Request};
use crate::error::Error;
use crate::kernels::Coordinate;
use crate::queries::{AdjacentContact, CrossingEdge, Pair};
use crate::selection::Selection;
use crate::traversal::Visitor;
use crate::world::handle::World;
use crate::world::query::Query;
use crate::world::scalar::Scalar;
use crate::world::state::State;

/// # Questions: edges that cross triangles
impl<S: Scalar> World<S> {
    /// Asks which edges cross which triangles.
    ///
    /// An edge crosses a triangle if the open edge meets the open triangle, and not in its plane.
    /// That is decided exactly, and stays after every small enough move. An edge that touches, or
    /// lies in the plane, does not cross. Within a body, triangles at the edge may share a vertex
    /// with the other. Where surfaces go through each other, crossing edges say where: each curve
    /// of intersection passes from one to the next.
    ///
    /// ```
    /// # use pliant::{Selection, World};
    /// let mut world = World::new();
    /// let large = [[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]];
    /// let floor = world.add(&[[0, 1, 2]], &large)?;
    /// let leaf = world.add(&[[0, 1, 2]], &[[0.0, 0.0, -1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]])?;
    /// let crossing = world.crossing_edges(Selection::Between(floor, leaf)).all()?.to_vec();
    /// let edges = world.edges(leaf)?;
    /// let ends: Vec<_> = crossing.iter().map(|it| edges[it.edge as usize]).collect();
    /// assert_eq!(ends, [[0, 1], [0, 2]]);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// Cost: that of intersections and, within bodies, of adjacent intersections, and a quarter of
    /// a microsecond for each of their hits.
    ///
    /// # Errors
    ///
    /// The errors of [`Query`].
    pub fn crossing_edges(&mut self, of: Selection) -> Query<'_, CrossingEdge> {
        Query::new(&mut *self.verbs, of)
    }
}

impl<S: Coordinate> Ask<CrossingEdge> for State<S> {
    fn all(&mut self, request: &Request) -> Result<&[CrossingEdge], Error> {
        self.kinds.crossing_edges.all(&mut self.common, request)
    }

    fn first(&mut self, request: &Request) -> Result<Option<CrossingEdge>, Error> {
        first_seen(|visitor| Ask::<CrossingEdge>::visit(self, request, visitor))
    }

    fn visit(&mut self, request: &Request, visitor: Visitor<CrossingEdge>) -> Result<(), Error> {
        self.kinds
            .crossing_edges
            .visit(&mut self.common, request, visitor)
    }

    fn prepare(&mut self, request: &Request) -> Result<(), Error> {
        Ask::<Pair>::prepare(self, request)?;
        Ask::<AdjacentContact>::prepare(self, request)
    }
}
