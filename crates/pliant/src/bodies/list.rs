//! List of the bodies of a world, and of the pairs that may not meet.

use super::body::Body;
use crate::error::{Error, ErrorKind};
use crate::held::{self, held};
use crate::ids::BodyId;
use crate::ids::{Place, Rank};
use crate::kernels::Coordinate;
use crate::selection::Selection;
use std::collections::BTreeSet;

/// Bodies of a world.
pub(crate) struct Bodies<S> {
    /// Bodies in no order that matters: the last takes a removed body's place.
    ///
    /// Each is in memory of its own, so that a growing list holds no room for bodies that are not
    /// there.
    list: Vec<Box<Body<S>>>,
    /// Ids in order, and places of the bodies in the list, both by rank.
    ids: Vec<BodyId>,
    places: Vec<Place>,
    next_id: Option<u32>,
    /// Pairs of bodies that do not meet in queries of the whole world, each pair in both orders.
    ignored: BTreeSet<(BodyId, BodyId)>,
    /// Whether a body was ever put into an environment.
    have_environments: bool,
}

impl<S> Default for Bodies<S> {
    fn default() -> Self {
        Self {
            list: Vec::new(),
            ids: Vec::new(),
            places: Vec::new(),
            next_id: Some(0),
            ignored: BTreeSet::new(),
            have_environments: false,
        }
    }
}

impl<S: Coordinate> Bodies<S> {
    /// Id of the next body.
    pub(crate) fn next_id(&self) -> Result<BodyId, ErrorKind> {
        self.next_id.map(BodyId).ok_or(ErrorKind::TooManyBodies)
    }

    /// Raises the next id. With none, no body can be added any more. Ids never go back.
    pub(crate) fn skip_ids(&mut self, next: Option<u32>) {
        self.next_id = match (self.next_id, next) {
            (Some(now), Some(next)) => Some(now.max(next)),
            _ => None,
        };
    }

    /// Copies all bodies. Their boxes are made anew.
    pub(crate) fn copy(&self) -> Self {
        Self {
            list: self.list.iter().map(|body| Box::new(body.copy())).collect(),
            ids: self.ids.clone(),
            places: self.places.clone(),
            next_id: self.next_id,
            ignored: self.ignored.clone(),
            have_environments: self.have_environments,
        }
    }

    /// Adds a body that has the next id.
    pub(crate) fn push(&mut self, body: Body<S>) {
        self.next_id = body.id().0.checked_add(1);
        self.ids.push(body.id());
        self.places.push(Place(self.list.len() as u32));
        self.list.push(Box::new(body));
    }

    /// Removes a body. Returns its former rank; the ranks of later bodies move down by one. O(n).
    pub(crate) fn remove(&mut self, id: BodyId) -> Result<Rank, Error> {
        let rank = self.rank(id)?;
        self.ids.remove(rank.index());
        let place = self.places.remove(rank.index());
        self.list.swap_remove(place.index());
        if let Some(moved) = self.list.get(place.index()) {
            let rank = self.rank(moved.id())?;
            self.places[rank.index()] = place;
        }
        let ends = (id, BodyId(0))..=(id, BodyId(u32::MAX));
        let others: Vec<_> = self.ignored.range(ends).copied().collect();
        for (_, other) in others {
            self.meet_again(id, other);
        }
        Ok(rank)
    }

    /// Rank of a body among the present ones. O(log n).
    fn rank(&self, id: BodyId) -> Result<Rank, Error> {
        let rank = self.ids.binary_search(&id);
        rank.map(|rank| Rank(rank as u32)).map_err(|_| Error {
            body: Some(id),
            kind: ErrorKind::NoSuchBody,
        })
    }

    /// Place of a body in the list. O(log n).
    pub(crate) fn place(&self, id: BodyId) -> Result<Place, Error> {
        Ok(self.places[self.rank(id)?.index()])
    }

    pub(crate) fn len(&self) -> usize {
        self.list.len()
    }

    /// Ids of all bodies, in order.
    pub(crate) fn ids(&self) -> &[BodyId] {
        &self.ids
    }

    /// Places of the bodies in the list, by rank.
    #[inline]
    pub(crate) fn places(&self) -> &[Place] {
        &self.places
    }

    #[inline]
    pub(crate) fn at(&self, place: Place) -> &Body<S> {
        &self.list[place.index()]
    }

    #[inline]
    pub(crate) fn at_mut(&mut self, place: Place) -> &mut Body<S> {
        &mut self.list[place.index()]
    }

    /// All bodies, in the order of the list.
    pub(crate) fn all(&self) -> impl Iterator<Item = &Body<S>> {
        self.list.iter().map(Box::as_ref)
    }

    /// All bodies, mutable, in the order of the list.
    pub(crate) fn all_mut(&mut self) -> impl Iterator<Item = &mut Body<S>> {
        self.list.iter_mut().map(Box::as_mut)
    }

    /// Bodies at some places, which ascend, mutable. O(all bodies).
    pub(crate) fn some_mut(
        &mut self,
        places: impl IntoIterator<Item = Place>,
    ) -> impl Iterator<Item = &mut Body<S>> {
        let mut places = places.into_iter().peekable();
        let all = (0..).map(Place).zip(self.all_mut());
        all.filter_map(move |(place, body)| places.next_if_eq(&place).map(|_| body))
    }

    /// All bodies in the order of their ids.
    pub(crate) fn in_order(&self) -> impl Iterator<Item = &Body<S>> {
        self.places.iter().map(|&place| self.at(place))
    }

    pub(crate) fn get(&self, id: BodyId) -> Result<&Body<S>, Error> {
        Ok(self.at(self.place(id)?))
    }

    pub(crate) fn get_mut(&mut self, id: BodyId) -> Result<&mut Body<S>, Error> {
        let place = self.place(id)?;
        Ok(self.at_mut(place))
    }

    /// Bodies at two different places.
    pub(crate) fn two(&mut self, places: [Place; 2]) -> [&mut Body<S>; 2] {
        let places = places.map(Place::index);
        let both = self.list.get_disjoint_mut(places);
        let [a, b] = both.expect("two different places of bodies");
        [a, b]
    }

    /// Makes two bodies, or one with itself, not meet from now on.
    pub(crate) fn ignore(&mut self, a: BodyId, b: BodyId) {
        self.ignored.extend([(a, b), (b, a)]);
    }

    /// Makes two ignored bodies meet again.
    pub(crate) fn meet_again(&mut self, a: BodyId, b: BodyId) {
        self.ignored.remove(&(a, b));
        self.ignored.remove(&(b, a));
    }

    /// Pairs of bodies that do not meet, each once, the lower id first, sorted.
    pub(crate) fn ignored(&self) -> Vec<[BodyId; 2]> {
        let once = self.ignored.iter().filter(|(a, b)| a <= b);
        once.map(|&(a, b)| [a, b]).collect()
    }

    /// Puts a body into an environment.
    pub(crate) fn set_environment(&mut self, id: BodyId, environment: u32) -> Result<(), Error> {
        self.get_mut(id)?.set_environment(environment);
        self.have_environments = true;
        Ok(())
    }

    /// Environments of all bodies, in the order of their ids; none if none was ever put into one.
    pub(crate) fn environments(&self) -> impl Iterator<Item = u32> {
        let some = if self.have_environments {
            self.len()
        } else {
            0
        };
        self.in_order().take(some).map(Body::environment)
    }

    /// Whether two bodies, or one and itself, meet in queries of the whole world.
    pub(crate) fn do_meet(&self, a: &Body<S>, b: &Body<S>) -> bool {
        a.may_meet(b) && !self.ignored.contains(&(a.id(), b.id()))
    }

    /// Refuses a selection that names bodies that are not there, or one body twice.
    pub(crate) fn validate(&self, of: Selection) -> Result<(), Error> {
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

held!(Bodies<S>: ids[], places[]; |bodies| {
    held::list(&bodies.list)
        + held::boxes(&bodies.list)
        + held::entries::<(BodyId, BodyId)>(bodies.ignored.len())
});

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Options;

    #[test]
    fn numbers_of_bodies_run_out_with_an_error() {
        let mut bodies = Bodies::<f32> {
            next_id: Some(u32::MAX),
            ..Bodies::default()
        };
        let last = bodies.next_id().unwrap();
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        bodies.push(Body::new(last, &[[0, 1, 2]], &corners, &Options::default()));
        assert_eq!(bodies.next_id(), Err(ErrorKind::TooManyBodies));
        assert_eq!(bodies.get(last).unwrap().triangle_count(), 1);
    }

    #[test]
    fn numbers_of_bodies_can_be_skipped_and_never_go_back() {
        let mut bodies = Bodies::<f32>::default();
        for (next, expected) in [(7, 7), (3, 7), (8, 8)] {
            bodies.skip_ids(Some(next));
            assert_eq!(bodies.next_id(), Ok(BodyId(expected)));
        }
        bodies.skip_ids(None);
        bodies.skip_ids(Some(9));
        assert_eq!(bodies.next_id(), Err(ErrorKind::TooManyBodies));
    }
}
