//! Queries for contacts: triangles that intersect, and how.

pub(crate) mod reference;

use super::ask::first_seen;
use crate::collide::{Ask, Request};
use crate::error::Error;
use crate::kernels::Coordinate;
use crate::queries::{Contact, ContactKind, Contacts, Kind};
use crate::selection::Selection;
use crate::traversal::Visitor;
use crate::world::handle::World;
use crate::world::query::Query;
use crate::world::scalar::Scalar;
use crate::world::state::State;

/// # Questions: how triangles intersect
impl<S: Scalar> World<S> {
    /// Asks which triangles intersect and how: whether they cross, overlap in one plane, or only
    /// touch.
    ///
    /// The pairs are those that [`intersections`](Self::intersections) finds; [`ContactKind`] shows
    /// the kinds. [`Query::only`] keeps one kind. Where surfaces lie on each other, along a cut or
    /// in a stack, it finds what goes through.
    ///
    /// ```
    /// # use pliant::{ContactKind, Selection, World};
    /// let mut world = World::new();
    /// let large = [[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]];
    /// let floor = world.add(&[[0, 1, 2]], &large)?;
    /// let leaf = world.add(&[[0, 1, 2]], &[[0.0, 0.0, 0.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]])?;
    /// let contacts = world.contacts(Selection::Between(floor, leaf)).all()?;
    /// assert_eq!(contacts[0].kind, ContactKind::Touching);
    /// world.set_positions(leaf, &[[0.0, 0.0, -0.1], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]])?;
    /// let crossing = world.contacts(Selection::World).only(ContactKind::Crossing);
    /// assert!(crossing.first()?.is_some());
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// Cost: as intersections. A pair whose kind no rounded sign tells takes its exact signs once
    /// more.
    pub fn contacts(&mut self, of: Selection) -> Query<'_, Contact> {
        Query::new(&mut *self.verbs, of)
    }
}

impl Query<'_, Contact> {
    /// Keeps contacts of this kind alone: others are no hits.
    pub fn only(mut self, kind: ContactKind) -> Self {
        self.request.only = Some(kind);
        self
    }
}

ask!(Contact, contacts.all_listed, |request| Contacts::<S>::of(
    request.only
));
