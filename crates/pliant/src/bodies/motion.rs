//! Motion of a body: straight lines of its vertices from the present shape to another.

use super::shape::{BodyShape, NewShape};
use crate::error::ErrorKind;
use crate::geometry::{Bounds, Origin, Points, Shape};
use crate::held::{self, held};
use crate::kernels::{Coordinate, Instructions};
use crate::mesh::Order;
use crate::queries::Reach;
use crate::threads::Executor;

/// Motion of a body, if it has one.
#[derive(Default)]
pub(crate) struct Motion<S> {
    /// The present motion, or the memory of an ended one for the next. None before the first.
    way: Option<Box<Way<S>>>,
    /// The last version of motions that were forgotten. Boxes of one motion must not pass for boxes
    /// of another.
    forgotten: u64,
}

/// Motion from the present shape to another.
pub(crate) struct Way<S> {
    /// Shape at the end. Its version is the number of this motion.
    end: BodyShape<S>,
    /// Version counter of motions, and of shapes on the way.
    versions: u64,
    is_on: bool,
    /// The last shape on the way that was asked for.
    partway: Option<Partway<S>>,
}

/// Shape on the way, for queries whose view ends before the motion does.
struct Partway<S> {
    /// Positions in tree order.
    points: Points<S>,
    /// Key: the versions of shape and motion that it lies between, and how far it is.
    of: (u64, u64, Reach),
    /// Version of this shape among motions.
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

    /// Checks a shape and begins a motion to it, in place of any other. On an error all stays as it
    /// is.
    ///
    /// The shape must not leave the loose box, if there is one.
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
        // The copy gives memory of the right length only; its positions are overwritten.
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

    /// Brings the motion, as far as `reach`, into tree order, if there is one. Returns false if
    /// interrupted.
    ///
    /// The shape `from` must be in tree order.
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

    /// Shape at the end.
    pub(crate) fn end(&self) -> &BodyShape<S> {
        &self.end
    }

    /// Second shape that boxes hold, besides the present one.
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

    /// Positions that vertices are going to, for kinds that look along motions.
    pub(crate) fn going(&self, reach: Reach) -> &Points<S> {
        match (&self.partway, reach) {
            (Some(partway), Reach::To(_)) => &partway.points,
            _ => self.end.in_tree_order(),
        }
    }

    /// Makes the shape on the way at which `reach` ends, unless it is there.
    ///
    /// Both ends of the motion must be in tree order.
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
