//! The shape that a body has now.

use super::positions::{NewShape, Positions};
use crate::error::ErrorKind;
use crate::geometry::{Bounds, Origin, Points, Shape};
use crate::held::held;
use crate::ids::{CallerVertex, TreeVertex};
use crate::kernels::{Coordinate, Instructions};
use crate::mesh::{Moved, Order};
use crate::threads::Executor;

/// Where the vertices of a body are now, and a box that holds it in every pose.
pub(crate) struct BodyShape<S> {
    positions: Positions<S>,
    loose: Option<Bounds<S>>,
    /// Counts changes of shape, and of the origin that boxes are relative to. Boxes of other versions
    /// are stale.
    version: u64,
}

impl<S: Coordinate> BodyShape<S> {
    /// The first of a body, whose mesh is in this order.
    pub(crate) fn new(positions: &[[S; 3]], order: &Order) -> Self {
        Self {
            positions: Positions::new(positions, order),
            loose: None,
            version: 1,
        }
    }

    /// The first of another mesh of the same body.
    pub(crate) fn after(&self, positions: &[[S; 3]], order: &Order) -> Self {
        Self {
            positions: Positions::new(positions, order),
            loose: self.loose,
            version: self.version + 1,
        }
    }

    pub(crate) fn copy(&self, order: &Order) -> Self {
        Self {
            positions: self.positions.copy(order),
            ..*self
        }
    }

    #[inline]
    pub(crate) fn positions(&self) -> &Positions<S> {
        &self.positions
    }

    #[inline]
    pub(crate) fn version(&self) -> u64 {
        self.version
    }

    /// The box that holds it in every pose, if there is one.
    pub(crate) fn loose(&self) -> Option<Bounds<S>> {
        self.loose
    }

    /// Gives it such a box, which was checked.
    pub(crate) fn set_loose(&mut self, loose: Option<Bounds<S>>) {
        self.loose = loose;
    }

    /// The shape, which was brought into tree order.
    pub(crate) fn view<'s>(&'s self, order: &'s Order, origin: Origin) -> Shape<'s, S> {
        self.view_of(self.positions.in_tree_order(), order, origin)
    }

    /// The shape, of which `positions` are in tree order.
    pub(crate) fn view_of<'s>(
        &self,
        positions: &'s Points<S>,
        order: &'s Order,
        origin: Origin,
    ) -> Shape<'s, S> {
        Shape {
            positions,
            triangles: order.all_corners(),
            origin,
            epoch: self.version,
        }
    }

    /// Checks another shape and takes it over; or stays as it is and says what was wrong.
    pub(crate) fn set(
        &mut self,
        new: &NewShape<S>,
        threads: (Instructions, Executor),
    ) -> Result<(), ErrorKind> {
        self.positions.take(new, self.loose, threads)?;
        self.version += 1;
        Ok(())
    }

    /// Has these positions from now on, and leaves the others in their place.
    pub(crate) fn exchange(&mut self, positions: &mut Positions<S>) {
        std::mem::swap(&mut self.positions, positions);
        self.version += 1;
    }

    /// Boxes made so far are stale, though the shape is the same: the origin moved.
    pub(crate) fn origin_moved(&mut self) {
        self.version += 1;
    }

    /// Tree order is going to be another than `order`.
    pub(crate) fn forget_tree_order(&mut self, order: &Order) {
        self.positions.forget_tree_order(order);
        self.version += 1;
    }

    /// Brings it into tree order. Returns false if it was interrupted.
    pub(crate) fn bring_into_tree_order(
        &mut self,
        (instructions, executor): (Instructions, Executor),
        order: &Order,
    ) -> bool {
        let order = order.vertex_order();
        self.positions
            .bring_into_tree_order(instructions, executor, order)
    }

    /// Vertices come behind all others.
    pub(crate) fn push(&mut self, new: &[[S; 3]]) {
        self.positions.push(new);
    }

    /// A vertex that was empty is somewhere. One that went and came within one edit still has triangles
    /// that were taken out, whose boxes were made.
    pub(crate) fn place(
        &mut self,
        vertex: CallerVertex,
        slot: TreeVertex,
        position: [S; 3],
        order: &Order,
    ) {
        self.positions.place(vertex, slot, position);
        self.version += u64::from(slot.index() < order.used_vertices());
    }

    /// A vertex that no triangle used is used now.
    pub(crate) fn include(&mut self, vertex: TreeVertex, order: &Order) {
        self.positions.include(vertex, order.vertex_order());
    }

    /// Numbers in tree order are others.
    pub(crate) fn follow(&mut self, moved: &Moved) {
        self.positions.follow(moved);
    }

    /// A vertex has a number at the end of tree order too.
    pub(crate) fn follow_to_the_end(&mut self, slot: TreeVertex) {
        self.positions.follow_to_the_end(slot);
    }
}

held!(BodyShape<S>: positions);
