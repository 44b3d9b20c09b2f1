//! Which bodies may meet: the broad phase, filters and exact boxes.
//!
//! Pairs come in batches, each found when the one before has met, so many bodies in one place cost time and no memory, and a query that
//! ends early has not looked for pairs that it does not need. If one batch holds all pairs it is kept for as long as nothing moves.

use crate::bodies::Bodies;
use crate::broad_phase::{BroadPhase, Overlap};
use crate::error::Error;
use crate::geometry::{Aabb, Origin};
use crate::held::held;
use crate::ids::{Place, Rank};
use crate::kernels::{Coordinate, Instructions};
use crate::options;
use crate::queries::BodyBoxes;
use crate::selection::Selection;
use crate::threads::Interrupt;

/// Two bodies by their places, or one twice: a body with itself.
pub(crate) type BodyPair = [Place; 2];

/// Pairs of a batch, or of the bodies if there are more of these, times [`PAIRS_A_BODY`]; and those of one body more.
const BATCH: usize = 1 << 16;
const PAIRS_A_BODY: usize = 4;

/// The batches of one query, and what is kept from query to query.
#[derive(Debug)]
pub(crate) struct BodyPairs {
    broad_phase: BroadPhase,
    /// Of every body, by its rank: its exact box, and the one that the broad phase works with, which is the loose one if there is one.
    exact: Vec<Aabb>,
    broad: Vec<Aabb>,
    /// Scratch: the last row of the broad phase.
    row: Vec<Overlap>,
    /// The last batch of different bodies of the whole world, in the order of ids, the smaller first.
    of_world: Vec<BodyPair>,
    /// What bodies' boxes were for it, if it holds all pairs and nothing has happened since that could change it.
    holds_for: Option<BodyBoxes>,
    /// What a query asked for by name.
    named: Vec<BodyPair>,
    /// What the query has not been given yet, and what boxes of bodies are for it.
    next: Next,
    boxes: BodyBoxes,
}

/// What comes after the batches that a query was given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Next {
    /// Those named, and then perhaps those of the whole world.
    Named {
        and_world: bool,
    },
    /// All pairs of the whole world, which are known.
    Known,
    /// Pairs of the whole world that are still to be found: all, or those after the last batch.
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
            row: Vec::new(),
            of_world: Vec::new(),
            holds_for: None,
            named: Vec::new(),
            next: Next::Nothing,
            boxes: BodyBoxes::default(),
        }
    }

    /// A body has moved, or a filter has changed.
    pub(crate) fn forget(&mut self) {
        self.holds_for = None;
    }

    /// The body of a rank is gone, and those after it are one rank higher.
    pub(crate) fn remove(&mut self, rank: Rank) {
        self.broad_phase.remove(rank);
        self.forget();
    }

    /// Begins with the pairs of a selection whose boxes overlap: bodies with themselves first, for which all their boxes are refitted,
    /// and then different bodies; each in the order of ids.
    pub(crate) fn begin<S: Coordinate>(
        &mut self,
        of: Selection,
        bodies: &Bodies<S>,
        boxes: BodyBoxes,
        origin: Origin,
        interrupt: &Interrupt,
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
            self.take_boxes(bodies, boxes, origin);
            self.broad_phase.begin(&self.broad, interrupt);
        }
        Ok(())
    }

    /// The next batch of the query that has begun, which may be empty; none after the last. Interrupted, it is the last.
    pub(crate) fn next<S: Coordinate>(
        &mut self,
        bodies: &Bodies<S>,
        instructions: Instructions,
        interrupt: &Interrupt,
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
                let are_more = self.find(bodies, instructions, interrupt);
                self.next = if are_more {
                    Next::Found { is_first: false }
                } else {
                    Next::Nothing
                };
                if is_first && !are_more && !interrupt.is_set() {
                    self.holds_for = Some(self.boxes);
                }
                Some(&self.of_world)
            }
            Next::Nothing => None,
        }
    }

    /// Finds the next batch of the whole world, or, interrupted, some of it. Returns whether there may be more.
    fn find<S: Coordinate>(
        &mut self,
        bodies: &Bodies<S>,
        instructions: Instructions,
        interrupt: &Interrupt,
    ) -> bool {
        let (exact, row, of_world) = (&self.exact, &mut self.row, &mut self.of_world);
        let that_meet = |&pair: &Overlap| {
            let [exact_a, exact_b] = pair.map(|rank| &exact[rank.index()]);
            let places = pair.map(|rank| bodies.places()[rank.index()]);
            let [a, b] = places.map(|place| bodies.at(place));
            (exact_a.overlaps(exact_b) && bodies.do_meet(a, b)).then_some(places)
        };
        let most = BATCH.max(PAIRS_A_BODY * bodies.len());
        of_world.clear();
        while of_world.len() < most && !interrupt.is_set() {
            row.clear();
            let are_more = self.broad_phase.next(instructions, &self.broad, row);
            of_world.extend(row.iter().filter_map(that_meet));
            if !are_more {
                return false;
            }
        }
        !interrupt.is_set()
    }

    /// The boxes of all bodies as they are now.
    fn take_boxes<S: Coordinate>(&mut self, bodies: &Bodies<S>, boxes: BodyBoxes, origin: Origin) {
        let Self { exact, broad, .. } = self;
        exact.clear();
        let list = bodies.in_order();
        exact.extend(list.map(|body| body.box_for(boxes, origin)));
        broad.clear();
        broad.extend(bodies.in_order().zip(&*exact).map(|(body, &exact)| {
            let loose = body.loose_box(origin);
            loose.map_or(exact, |loose| boxes.of(loose))
        }));
    }
}

held!(BodyPairs: exact[], broad[], row[], of_world[], named[], broad_phase);
