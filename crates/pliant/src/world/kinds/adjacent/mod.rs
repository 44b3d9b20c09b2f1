//! Queries for adjacent contacts: triangles of a body that share a vertex and meet beyond it.

pub(crate) mod reference;

use super::ask::first_seen;
use crate::collide::{Ask, AskedAdjacent, Request};
use crate::error::Error;
use crate::kernels::Coordinate;
use crate::queries::{AdjacentContact, ContactKind};
use crate::selection::Selection;
use crate::traversal::Visitor;
use crate::world::handle::World;
use crate::world::query::Query;
use crate::world::scalar::Scalar;
use crate::world::state::State;

/// # Questions: triangles that share a vertex
impl<S: Scalar> World<S> {
    /// Asks which triangles that have a vertex in common meet beyond what they share, and how.
    ///
    /// [`intersections`](Self::intersections) leaves out all pairs with a vertex in common, as they
    /// always touch there. This question is about these pairs alone: whether one triangle goes
    /// through the other somewhere else, lies folded onto it, or is there twice. The two together
    /// say whether a body meets itself. [`AdjacentContact`] states it case by case.
    /// [`Query::only`] keeps one kind.
    ///
    /// Only bodies with themselves are asked: `Within` one, or `Everything`. Of two bodies, and of
    /// `World`, the answer is empty.
    ///
    /// ```
    /// # use pliant::{ContactKind, Selection, World};
    /// let mut world = World::new();
    /// // Two triangles with corner 0 in common, of which one goes through the other.
    /// let (a, b) = ([4.0, 1.0, -1.0], [4.0, 1.0, 1.0]);
    /// let corners = [[0.0; 3], a, b, [4.0, 0.0, 0.0], [4.0, 2.0, 0.0]];
    /// let bow = world.add(&[[0, 1, 2], [0, 3, 4]], &corners)?;
    /// assert!(world.intersections(Selection::Within(bow)).all()?.is_empty());
    /// let contacts = world.adjacent_intersections(Selection::Within(bow)).all()?;
    /// assert_eq!(contacts[0].pair.triangles(), [0, 1]);
    /// assert_eq!(contacts[0].kind, ContactKind::Crossing);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// Cost: O(m), some ten nanoseconds a triangle, and no tree is looked at. That is half of a
    /// query for intersections within a folded body, and as much as one within a flat body. The
    /// first time it finds which triangles are at each vertex. Where d triangles at a vertex are
    /// folded, O(d^2) pairs are decided.
    ///
    /// # Errors
    ///
    /// The errors of [`Query`].
    pub fn adjacent_intersections(&mut self, of: Selection) -> Query<'_, AdjacentContact> {
        Query::new(&mut *self.verbs, of)
    }
}

impl Query<'_, AdjacentContact> {
    /// Keeps contacts of this kind alone: others are no hits.
    pub fn only(mut self, kind: ContactKind) -> Self {
        self.request.only = Some(kind);
        self
    }
}

impl<S: Coordinate> Ask<AdjacentContact> for State<S> {
    fn all(&mut self, request: &Request) -> Result<&[AdjacentContact], Error> {
        self.kinds.adjacent.all(&mut self.common, request)
    }

    fn first(&mut self, request: &Request) -> Result<Option<AdjacentContact>, Error> {
        first_seen(|visitor| Ask::<AdjacentContact>::visit(self, request, visitor))
    }

    fn visit(&mut self, request: &Request, visitor: Visitor<AdjacentContact>) -> Result<(), Error> {
        self.kinds
            .adjacent
            .visit(&mut self.common, request, visitor)
    }

    fn prepare(&mut self, request: &Request) -> Result<(), Error> {
        AskedAdjacent::prepare(&mut self.common, request)
    }
}
