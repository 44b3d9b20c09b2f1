//! The bodies of a world, and which of them may meet.

use super::body::Body;
use super::{BodyId, Selection};
use crate::error::{Error, ErrorKind};
use crate::ids::Place;
use crate::kernels::Coordinate;
use std::collections::{BTreeMap, BTreeSet};

pub(super) struct Bodies<const N: usize, S> {
    /// In no order that matters: a removed body's place is taken by the last.
    pub(super) list: Vec<Body<N, S>>,
    pub(super) places: BTreeMap<BodyId, Place>,
    next_id: Option<u32>,
    /// Pairs of bodies that do not meet in queries of the whole world, each pair in both orders.
    ignored: BTreeSet<(BodyId, BodyId)>,
}

impl<const N: usize, S> Default for Bodies<N, S> {
    fn default() -> Self {
        Self {
            list: Vec::new(),
            places: BTreeMap::new(),
            next_id: Some(0),
            ignored: BTreeSet::new(),
        }
    }
}

impl<const N: usize, S: Coordinate> Bodies<N, S> {
    /// The id of the next body.
    pub(super) fn next_id(&self) -> Result<BodyId, ErrorKind> {
        self.next_id.map(BodyId).ok_or(ErrorKind::TooManyBodies)
    }

    /// Adds a body that has the next id.
    pub(super) fn push(&mut self, body: Body<N, S>) {
        self.next_id = body.id.0.checked_add(1);
        let place = Place(self.list.len() as u32);
        self.places.insert(body.id, place);
        self.list.push(body);
    }

    /// Removes a body. Returns its place, which the last body has now.
    pub(super) fn remove(&mut self, id: BodyId) -> Result<Place, Error> {
        let place = self.place(id)?;
        self.places.remove(&id);
        self.list.swap_remove(place.index());
        if let Some(moved) = self.list.get(place.index()) {
            self.places.insert(moved.id, place);
        }
        let ends = (id, BodyId(0))..=(id, BodyId(u32::MAX));
        let others: Vec<_> = self.ignored.range(ends).copied().collect();
        for (_, other) in others {
            self.meet_again(id, other);
        }
        Ok(place)
    }

    /// Where a body stands in the list.
    pub(super) fn place(&self, id: BodyId) -> Result<Place, Error> {
        self.places.get(&id).copied().ok_or(Error {
            body: Some(id),
            kind: ErrorKind::NoSuchBody,
        })
    }

    pub(super) fn get(&self, id: BodyId) -> Result<&Body<N, S>, Error> {
        Ok(&self.list[self.place(id)?.index()])
    }

    pub(super) fn get_mut(&mut self, id: BodyId) -> Result<&mut Body<N, S>, Error> {
        let place = self.place(id)?;
        Ok(&mut self.list[place.index()])
    }

    /// The bodies at two different places.
    pub(super) fn two(&mut self, places: [Place; 2]) -> [&mut Body<N, S>; 2] {
        let places = places.map(Place::index);
        let both = self.list.get_disjoint_mut(places);
        both.expect("two different places of bodies")
    }

    /// From now on two bodies, or one with itself, do not meet.
    pub(super) fn ignore(&mut self, a: BodyId, b: BodyId) {
        self.ignored.extend([(a, b), (b, a)]);
    }

    /// Takes that back.
    pub(super) fn meet_again(&mut self, a: BodyId, b: BodyId) {
        self.ignored.remove(&(a, b));
        self.ignored.remove(&(b, a));
    }

    /// Whether two bodies, or one and itself, meet in queries of the whole world.
    pub(super) fn do_meet(&self, a: &Body<N, S>, b: &Body<N, S>) -> bool {
        a.may_meet(b) && !self.ignored.contains(&(a.id, b.id))
    }

    /// Refuses a selection that names what is not there.
    pub(super) fn validate(&self, of: Selection) -> Result<(), Error> {
        match of {
            Selection::World | Selection::Everything => Ok(()),
            Selection::Within(a) => self.place(a).map(|_| ()),
            Selection::Between(a, b) => {
                self.place(a)?;
                self.place(b)?;
                if a == b {
                    return Err(Error {
                        body: Some(a),
                        kind: ErrorKind::SameBody,
                    });
                }
                Ok(())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Options;

    #[test]
    fn numbers_of_bodies_run_out_with_an_error() {
        let mut bodies = Bodies::<8, f32> {
            next_id: Some(u32::MAX),
            ..Bodies::default()
        };
        let last = bodies.next_id().unwrap();
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        bodies.push(Body::new(last, &[[0, 1, 2]], &corners, &Options::default()));
        assert_eq!(bodies.next_id(), Err(ErrorKind::TooManyBodies));
        assert_eq!(bodies.get(last).unwrap().triangle_count(), 1);
    }
}
