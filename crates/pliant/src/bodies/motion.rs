//! The motion of a body: where its vertices are going.

use super::shape::{BodyShape, NewShape};
use crate::error::ErrorKind;
use crate::geometry::{Bounds, Origin, Points, Shape};
use crate::held::{self, held};
use crate::kernels::{Coordinate, Instructions};
use crate::mesh::Order;
use crate::queries::Reach;
use crate::threads::Executor;

/// The motion of a body, if it has one.
#[derive(Default)]
pub(crate) struct Motion<S> {
    /// None before the first; memory for the next when one has ended.
    way: Option<Box<Way<S>>>,
    /// The last version of ways that were forgotten. Boxes of one motion must not pass for boxes of
    /// another.
    forgotten: u64,
}

/// A motion from the current shape to another.
pub(crate) struct Way<S> {
    /// The shape at the end. Its version is the number of this motion.
    end: BodyShape<S>,
    /// Counts motions, and shapes on the way.
    versions: u64,
    is_on: bool,
    /// The shape on the way that was asked for last.
    partway: Option<Partway<S>>,
}

/// The shape in which what is looked at ends before the motion does.
struct Partway<S> {
    /// In tree order.
    points: Points<S>,
    /// The versions of the shape and the motion that it lies between, and how far it is.
    of: (u64, u64, Reach),
    /// Its own number among motions.
    version: u64,
}

impl<S: Coordinate> Motion<S> {
    /// Copies the motion of a body whose mesh is in this order, without memory for the next.
    pub(crate) fn copy(&self, order: &Order) -> Self {
        let way = self.on().map(|way| {
            Box::new(Way {
                end: way.end.copy(order),
                partway: None,
                ..*way
            })
        });
        Self { way, ..*self }
    }

    /// The motion that the body has, if it does not stand still.
    #[inline]
    pub(crate) fn on(&self) -> Option<&Way<S>> {
        self.way.as_deref().filter(|way| way.is_on)
    }

    /// Begins one, in place of any other, to a shape that is checked first, in a box that it must
    /// not leave; or leaves all as it is and says what was wrong.
    pub(crate) fn begin(
        &mut self,
        from: &BodyShape<S>,
        end: &NewShape<S>,
        loose: Option<Bounds<S>>,
        threads: (Instructions, Executor),
    ) -> Result<(), ErrorKind> {
        if let Some(way) = &mut self.way {
            way.end.take(end, loose, threads)?;
            way.begin();
            return Ok(());
        }
        // The copy is only of the right length; its positions are overwritten.
        let mut place = from.copy(end.order);
        place.take(end, loose, threads)?;
        let way = self.way.insert(Box::new(Way {
            end: place,
            versions: self.forgotten,
            is_on: true,
            partway: None,
        }));
        way.begin();
        Ok(())
    }

    /// Ends the motion: the body stands still.
    pub(crate) fn stop(&mut self) {
        if let Some(way) = &mut self.way {
            way.is_on = false;
        }
    }

    /// Ends the motion and forgets its vertices, because the body has others.
    pub(crate) fn forget(&mut self) {
        if let Some(way) = self.way.take() {
            self.forgotten = way.versions;
        }
    }

    /// Ends the motion, and gives the shape at its end to the body.
    pub(crate) fn finish(&mut self, shape: &mut BodyShape<S>) {
        if let Some(way) = self.way.as_mut().filter(|way| way.is_on) {
            let version = shape.version();
            std::mem::swap(shape, &mut way.end);
            shape.set_version(version + 1);
            way.is_on = false;
        }
    }

    /// Leaves tree order, which is going to be another than `order`.
    pub(crate) fn forget_tree_order(&mut self, order: &Order) {
        if let Some(way) = &mut self.way {
            way.end.forget_tree_order(order);
            way.partway = None;
        }
    }

    /// Brings into tree order what is looked at of a motion, if there is one; the shape was brought
    /// into it. Returns false if it was interrupted.
    pub(crate) fn bring_into_tree_order(
        &mut self,
        from: &BodyShape<S>,
        reach: Reach,
        threads: (Instructions, Executor),
        order: &Order,
    ) -> bool {
        let Some(way) = self.way.as_mut().filter(|way| way.is_on) else {
            return true;
        };
        if !way.end.bring_into_tree_order(threads, order) {
            return false;
        }
        way.make_partway(from, reach);
        true
    }
}

impl<S: Coordinate> Way<S> {
    fn begin(&mut self) {
        self.versions += 1;
        self.end.set_version(self.versions);
        self.is_on = true;
    }

    /// The shape at the end.
    pub(crate) fn end(&self) -> &BodyShape<S> {
        &self.end
    }

    /// The other shape that boxes hold.
    pub(crate) fn held<'s>(
        &'s self,
        reach: Reach,
        order: &'s Order,
        origin: Origin,
    ) -> Shape<'s, S> {
        let end = self.end.view(order, origin);
        match (&self.partway, reach) {
            (Some(partway), Reach::Until(_) | Reach::To(_)) => Shape {
                positions: &partway.points,
                version: partway.version,
                ..end
            },
            _ => end,
        }
    }

    /// The positions that vertices are going to, for kinds that look along motions.
    pub(crate) fn going(&self, reach: Reach) -> &Points<S> {
        match (&self.partway, reach) {
            (Some(partway), Reach::To(_)) => &partway.points,
            _ => self.end.in_tree_order(),
        }
    }

    /// Makes the shape in which what is looked at ends before the motion does, unless it is there;
    /// both ends are in tree order.
    fn make_partway(&mut self, from: &BodyShape<S>, reach: Reach) {
        let (t, is_rounded) = match reach {
            Reach::End => return,
            Reach::Until(t) => (t, false),
            Reach::To(t) => (t, true),
        };
        let at = |from: S, to: S| {
            if is_rounded {
                from.toward(to, t)
            } else {
                from.past(to, t)
            }
        };
        let of = (from.version(), self.end.version(), reach);
        let partway = self.partway.as_ref();
        if partway.is_some_and(|partway| partway.of == of) {
            return;
        }
        self.versions += 1;
        let mut points = match self.partway.take() {
            Some(partway) => partway.points,
            None => Points::with_len(0),
        };
        let from = &from.in_tree_order().points;
        let ways = from.iter().zip(&self.end.in_tree_order().points);
        points.refill(ways.map(|(from, to)| std::array::from_fn(|axis| at(from[axis], to[axis]))));
        self.partway = Some(Partway {
            points,
            of,
            version: self.versions,
        });
    }
}

held!(Partway<S>: points);
held!(Way<S>: end, partway);
impl<S> held::Held for Motion<S> {
    fn held(&self) -> usize {
        held::boxes(&self.way)
    }
}
