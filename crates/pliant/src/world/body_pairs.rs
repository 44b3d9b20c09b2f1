//! Which bodies may meet: the broad phase, filters and exact boxes, into one list of pairs.

use super::bodies::Bodies;
use super::{BodyId, Selection};
use crate::broad_phase::BroadPhase;
use crate::geometry::{Aabb, Origin};
use crate::ids::Place;
use crate::kernels::Coordinate;
use crate::options;
use crate::queries::Kind;
use crate::threads::Interrupt;

/// Two bodies by their places, or one twice: a body with itself.
pub(super) type BodyPair = [Place; 2];

/// The list, kept from query to query.
#[derive(Debug)]
pub(super) struct BodyPairs {
    broad_phase: BroadPhase,
    /// Of every body, by its place: its exact box, and the one that the broad phase works with, which is the loose one if there is one.
    exact: Vec<Aabb>,
    broad: Vec<Aabb>,
    /// Of different bodies, the smaller id first, in the order of ids.
    of_world: Vec<BodyPair>,
    /// By how much bodies' boxes were grown for it, if nothing has happened since that could change it.
    holds_for: Option<f32>,
    /// What a query asked for last.
    selected: Vec<BodyPair>,
}

impl BodyPairs {
    pub(super) fn new(rule: options::BroadPhase) -> Self {
        Self {
            broad_phase: BroadPhase::new(rule),
            exact: Vec::new(),
            broad: Vec::new(),
            of_world: Vec::new(),
            holds_for: None,
            selected: Vec::new(),
        }
    }

    /// A body has moved, or a filter has changed.
    pub(super) fn forget(&mut self) {
        self.holds_for = None;
    }

    /// A body is gone from a place, and the last, whose place was `last`, is there now.
    pub(super) fn swap_remove(&mut self, place: Place, last: usize) {
        self.broad_phase.swap_remove(place.index(), last);
        self.forget();
    }

    /// The pairs of a valid selection whose boxes overlap: bodies with themselves first, for which all their boxes are refitted, and then
    /// different bodies; each in the order of ids. Interrupted, some of them.
    pub(super) fn select<const N: usize, S: Coordinate>(
        &mut self,
        of: Selection,
        bodies: &Bodies<N, S>,
        kind: &impl Kind,
        origin: Origin,
        interrupt: &Interrupt,
    ) -> &[BodyPair] {
        let place = |id: BodyId| bodies.places[&id];
        self.selected.clear();
        match of {
            Selection::Within(a) => self.selected.push([place(a); 2]),
            Selection::Between(a, b) => {
                let places = [place(a), place(b)];
                let [box_a, box_b] =
                    places.map(|place| kind.body_box(bodies.list[place.index()].exact_box(origin)));
                if box_a.overlaps(&box_b) {
                    self.selected.push(places);
                }
            }
            Selection::World => {
                self.find(bodies, kind, origin, interrupt);
                return &self.of_world;
            }
            Selection::Everything => {
                self.find(bodies, kind, origin, interrupt);
                for &place in bodies.places.values() {
                    let body = &bodies.list[place.index()];
                    if bodies.do_meet(body, body) {
                        self.selected.push([place; 2]);
                    }
                }
                self.selected.extend_from_slice(&self.of_world);
            }
        }
        &self.selected
    }

    /// The pairs of different bodies of the whole world, unless they are known.
    fn find<const N: usize, S: Coordinate>(
        &mut self,
        bodies: &Bodies<N, S>,
        kind: &impl Kind,
        origin: Origin,
        interrupt: &Interrupt,
    ) {
        if self.holds_for == Some(kind.grows_by()) {
            return;
        }
        self.holds_for = None;
        let Self {
            broad_phase,
            exact,
            broad,
            of_world,
            ..
        } = self;
        exact.clear();
        let list = bodies.list.iter();
        exact.extend(list.map(|body| kind.body_box(body.exact_box(origin))));
        broad.clear();
        broad.extend(bodies.list.iter().zip(&*exact).map(|(body, &exact)| {
            let loose = body.loose_box(origin);
            loose.map_or(exact, |loose| kind.body_box(loose))
        }));
        let in_order = |[a, b]: BodyPair| {
            let id = |place: Place| bodies.list[place.index()].id;
            if id(a) < id(b) { [a, b] } else { [b, a] }
        };
        let found = broad_phase.overlapping(broad, interrupt).iter();
        of_world.clear();
        of_world.extend(found.map(|&pair| in_order(pair)).filter(|pair| {
            let [a, b] = pair.map(Place::index);
            exact[a].overlaps(&exact[b]) && bodies.do_meet(&bodies.list[a], &bodies.list[b])
        }));
        of_world.sort_unstable_by_key(|pair| pair.map(|place| bodies.list[place.index()].id));
        if !interrupt.is_set() {
            self.holds_for = Some(kind.grows_by());
        }
    }
}
