//! Questions with one answer, and what else takes long, that may be ended early.

use super::{BodyId, FreeStep, Scalar, Selection, World, clearance};
use crate::close_pairs::CloseTriangles;
use crate::edit::Edited;
use crate::error::Error;
use crate::impacts::Impact;
use crate::threads::Question;
use std::collections::BTreeMap;
use std::fmt;

/// A world, for a question that is ended early when another says so: what
/// [`World::interruptible`](crate::World::interruptible) gives.
///
/// # Errors
///
/// Those that the methods of [`World`](crate::World) say, and [`Interrupted`](crate::ErrorKind::Interrupted). The world stays usable.
#[must_use = "nothing is asked yet"]
pub struct Interruptible<'w, S: Scalar> {
    pub(super) world: &'w mut World<S>,
    pub(super) question: Question<'w>,
}

impl<S: Scalar> Interruptible<'_, S> {
    /// [`World::distance`](crate::World::distance).
    ///
    /// # Errors
    ///
    /// See [`Interruptible`].
    pub fn distance(
        self,
        a: BodyId,
        b: BodyId,
        cut_off: f64,
    ) -> Result<Option<CloseTriangles>, Error> {
        let engine = &mut self.world.engine;
        engine.distance([a, b], cut_off, Some(self.question))
    }

    /// [`World::nearest_body`](crate::World::nearest_body).
    ///
    /// # Errors
    ///
    /// See [`Interruptible`].
    pub fn nearest_body(self, body: BodyId, cut_off: f64) -> Result<Option<CloseTriangles>, Error> {
        let engine = &mut self.world.engine;
        engine.nearest_body(body, cut_off, Some(self.question))
    }

    /// [`World::first_impact`](crate::World::first_impact).
    ///
    /// # Errors
    ///
    /// See [`Interruptible`].
    pub fn first_impact(self, of: Selection, width: f64) -> Result<Option<Impact>, Error> {
        let engine = &mut self.world.engine;
        engine.first_impact(of, width, Some(self.question))
    }

    /// [`World::collision_free_step`](crate::World::collision_free_step).
    ///
    /// # Errors
    ///
    /// See [`Interruptible`].
    pub fn collision_free_step(self, of: Selection, min_distance: f64) -> Result<f64, Error> {
        let engine = &mut self.world.engine;
        engine.collision_free_step(of, min_distance, Some(self.question))
    }

    /// [`World::free_step`](crate::World::free_step).
    ///
    /// # Errors
    ///
    /// See [`Interruptible`].
    pub fn free_step(self, of: Selection, min_distance: f64) -> Result<FreeStep, Error> {
        self.world
            .find_free_step(of, min_distance, Some(self.question))
    }

    /// [`World::clearance`](crate::World::clearance).
    ///
    /// # Errors
    ///
    /// See [`Interruptible`].
    pub fn clearance(
        self,
        of: Selection,
        cut_off: f64,
    ) -> Result<BTreeMap<BodyId, Vec<f64>>, Error> {
        clearance::clearance(self.world, of, cut_off, Some(self.question))
    }

    /// [`World::weld`](crate::World::weld), until it is known what is welded; nothing has changed if it is ended.
    ///
    /// # Errors
    ///
    /// See [`Interruptible`].
    pub fn weld(self, body: BodyId, tolerance: f64) -> Result<Edited, Error> {
        let question = Some(self.question);
        self.world.weld_unless(body, tolerance, question)
    }
}

impl<S: Scalar> fmt::Debug for Interruptible<'_, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Interruptible")
            .field("world", &self.world)
            .finish_non_exhaustive()
    }
}
