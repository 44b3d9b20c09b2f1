//! Pairs of bodies that may meet: the broad phase, filters and exact boxes.
//!
//! Pairs come in batches, each found when the previous one has been processed. Many bodies in one
//! place thus cost time but no memory. A query that ends early searches for no pairs that it does
//! not need. If one batch holds all pairs, it is kept until something moves.

use crate::bodies::Bodies;
use crate::broad_phase::{Boxes, BroadPhase, Keep, Overlap, Show};
use crate::error::Error;
use crate::geometry::{Aabb, Origin};
use crate::held::held;
use crate::ids::{Place, Rank};
use crate::kernels::{Coordinate, Instructions};
use crate::options;
use crate::queries::BodyBoxes;
use crate::selection::Selection;
use crate::threads::{Executor, Grain};

/// Two bodies by their places, or one twice: a body with itself.
pub(crate) type BodyPair = [Place; 2];

/// Most pairs in a batch: this, or [`PAIRS_A_BODY`] times the bodies if that is more. One more row
/// of the broad phase may be added.
const BATCH: usize = 1 << 16;
const PAIRS_A_BODY: usize = 4;

/// Batches of one query, and state kept from query to query.
#[derive(Debug)]
pub(crate) struct BodyPairs {
    broad_phase: BroadPhase,
    /// Exact box of every body, by rank. `broad` holds the boxes of the broad phase, which are the
    /// loose ones where there are any.
    exact: Vec<Aabb>,
    broad: Vec<Aabb>,
    /// Environment of every body, by rank. Empty if all are in one.
    environments: Vec<u32>,
    /// Last batch of different bodies of the whole world, in the order of ids, the smaller first.
    of_world: Vec<BodyPair>,
    /// Kind of bodies' boxes behind `of_world`, if that holds all pairs and nothing has changed
    /// since.
    holds_for: Option<BodyBoxes>,
    /// Pairs that the query names: a body with itself, or two bodies.
    named: Vec<BodyPair>,
    /// Next batch of the query. `boxes` is the kind of bodies' boxes it uses.
    next: Next,
    boxes: BodyBoxes,
}

/// Batch that follows the batches already given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Next {
    /// Named pairs, and then perhaps the pairs of the whole world.
    Named {
        and_world: bool,
    },
    /// All pairs of the whole world, which are known.
    Known,
    /// Pairs of the whole world that are still to be found: all, or the rest after the last batch.
    Found {
        is_first: bool,
    },
    Nothing,
}

impl BodyPairs {
    pub(crate) fn new(rule: options::BroadPhase) -> Self {
        Self {
            broad_phase: BroadPhase::new(rule),
            exact: Vec::new(),
            broad: Vec::new(),
            environments: Vec::new(),
            of_world: Vec::new(),
            holds_for: None,
            named: Vec::new(),
            next: Next::Nothing,
            boxes: BodyBoxes::default(),
        }
    }

    /// Drops the known pairs: a body has moved, or a filter has changed.
    pub(crate) fn forget(&mut self) {
        self.holds_for = None;
    }

    /// Drops the known pairs, because a body is in another environment.
    pub(crate) fn regroup(&mut self) {
        self.broad_phase.regroup();
        self.forget();
    }

    /// Removes the body of a rank; the ranks of later bodies decrease by one.
    pub(crate) fn remove(&mut self, rank: Rank) {
        self.broad_phase.remove(rank);
        self.forget();
    }

    /// Begins with the pairs of a selection whose boxes overlap. Bodies with themselves come first,
    /// since all their boxes are refitted. Different bodies follow; both are in the order of ids.
    pub(crate) fn begin<S: Coordinate>(
        &mut self,
        of: Selection,
        bodies: &Bodies<S>,
        boxes: BodyBoxes,
        origin: Origin,
        executor: Executor,
    ) -> Result<(), Error> {
        self.named.clear();
        match of {
            Selection::Within(a) => self.named.push([bodies.place(a)?; 2]),
            Selection::Between(a, b) => {
                let places = [bodies.place(a)?, bodies.place(b)?];
                let [box_a, box_b] = places.map(|place| bodies.at(place).box_for(boxes, origin));
                if box_a.overlaps(&box_b) {
                    self.named.push(places);
                }
            }
            Selection::World => {}
            Selection::Everything => {
                let meet = |place: &Place| {
                    let body = bodies.at(*place);
                    bodies.do_meet(body, body)
                };
                let places = bodies.places().iter().copied();
                self.named
                    .extend(places.filter(meet).map(|place| [place; 2]));
            }
        }
        let and_world = matches!(of, Selection::World | Selection::Everything);
        self.next = Next::Named { and_world };
        self.boxes = boxes;
        if and_world && self.holds_for != Some(self.boxes) {
            self.holds_for = None;
            self.take_boxes(bodies, boxes, origin, executor);
            if executor.is_interrupted() {
                // Some boxes may be missing, and the broad phase would keep what it made of them.
                return Ok(());
            }
            let boxes = Boxes {
                of_bodies: &self.broad,
                environments: &self.environments,
            };
            self.broad_phase.begin(boxes, executor.interrupt);
        }
        Ok(())
    }

    /// Next batch of the query that has begun, which may be empty; none after the last. An
    /// interrupt makes a batch the last.
    pub(crate) fn next<S: Coordinate>(
        &mut self,
        bodies: &Bodies<S>,
        (executor, instructions): (Executor, Instructions),
    ) -> Option<&[BodyPair]> {
        match self.next {
            Next::Named { and_world } => {
                self.next = match and_world {
                    false => Next::Nothing,
                    true if self.holds_for == Some(self.boxes) => Next::Known,
                    true => Next::Found { is_first: true },
                };
                Some(&self.named)
            }
            Next::Known => {
                self.next = Next::Nothing;
                Some(&self.of_world)
            }
            Next::Found { is_first } => {
                let are_more = self.find(bodies, (executor, instructions));
                self.next = if are_more {
                    Next::Found { is_first: false }
                } else {
                    Next::Nothing
                };
                if is_first && !are_more && !executor.is_interrupted() {
                    self.holds_for = Some(self.boxes);
                }
                Some(&self.of_world)
            }
            Next::Nothing => None,
        }
    }

    /// Finds the next batch of the whole world, or a part of it if interrupted. Returns whether
    /// there may be more.
    fn find<S: Coordinate>(
        &mut self,
        bodies: &Bodies<S>,
        (executor, instructions): (Executor, Instructions),
    ) -> bool {
        let Self {
            exact,
            of_world,
            broad_phase,
            broad,
            environments,
            ..
        } = self;
        let boxes = Boxes {
            of_bodies: broad,
            environments,
        };
        let places = |pair: Overlap| pair.map(|rank| bodies.places()[rank.index()]);
        let keep = |pair: Overlap| {
            let [exact_a, exact_b] = pair.map(|rank| &exact[rank.index()]);
            let [a, b] = places(pair).map(|place| bodies.at(place));
            exact_a.overlaps(exact_b) && bodies.do_meet(a, b)
        };
        let most = BATCH.max(PAIRS_A_BODY * bodies.len());
        of_world.clear();
        while of_world.len() < most && !executor.is_interrupted() {
            let more = (most - of_world.len(), &keep as Keep);
            let show: Show = &mut |found| of_world.extend(found.iter().map(|&pair| places(pair)));
            let are_more = broad_phase.next((executor, instructions), boxes, more, show);
            if !are_more {
                return false;
            }
        }
        !executor.is_interrupted()
    }

    /// Copies the present boxes of all bodies.
    fn take_boxes<S: Coordinate>(
        &mut self,
        bodies: &Bodies<S>,
        boxes: BodyBoxes,
        origin: Origin,
        executor: Executor,
    ) {
        let Self {
            exact,
            broad,
            environments,
            ..
        } = self;
        let ranks = bodies.places();
        environments.clear();
        environments.extend(bodies.environments());
        if environments.iter().all(|it| *it == environments[0]) {
            environments.clear();
        }
        for list in [&mut *exact, &mut *broad] {
            list.resize(ranks.len(), Aabb::EMPTY);
        }
        let copy = |ranks: &[Place], exact: &mut [Aabb], broad: &mut [Aabb]| {
            for ((&place, exact), broad) in ranks.iter().zip(exact).zip(broad) {
                let body = bodies.at(place);
                *exact = body.box_for(boxes, origin);
                let loose = body.loose_box(origin);
                *broad = loose.map_or(*exact, |loose| boxes.of(loose, body.thickest()));
            }
        };
        let nanoseconds = Grain::BOXES.time(ranks.len());
        if !executor.pays(nanoseconds) {
            return copy(ranks, exact, broad);
        }
        let size = Grain::BOXES.items;
        let lists = exact.chunks_mut(size).zip(broad.chunks_mut(size));
        let mut jobs: Vec<_> = ranks.chunks(size).zip(lists).collect();
        executor.run(&mut jobs, nanoseconds, |_, (ranks, (exact, broad))| {
            copy(ranks, exact, broad);
        });
    }
}

held!(BodyPairs: exact[], broad[], environments[], of_world[], named[], broad_phase);
