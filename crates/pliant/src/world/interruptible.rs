//! Interruption of questions with one answer, and of other calls that take long.

use super::contained::Containment;
use super::depth::Depth;
use super::free_step::FreeStep;
use super::handle::World;
use super::scalar::Scalar;
use crate::edit::Edited;
use crate::error::Error;
use crate::ids::BodyId;
use crate::points::{ClosestPoint, InsideRule, Located};
use crate::queries::{CloseTriangles, Impact};
use crate::selection::Selection;
use crate::threads::Question;
use std::collections::BTreeMap;
use std::fmt;

/// World whose next call ends early when a question says so, from
/// [`World::interruptible`](crate::World::interruptible).
///
/// # Errors
///
/// The errors that the methods of [`World`](crate::World) say, and
/// [`Interrupted`](crate::ErrorKind::Interrupted). The world stays usable.
#[must_use = "nothing is asked yet"]
pub struct Interruptible<'w, S: Scalar> {
    pub(super) world: &'w mut World<S>,
    pub(super) question: Question<'w>,
}

/// # Questions: ended early
impl<S: Scalar> World<S> {
    /// Returns this world for one call that is to end early, with an error, when `question` says
    /// so.
    ///
    /// How often it is asked is said at [`Query::interrupt_if`](crate::Query::interrupt_if), which
    /// is for queries.
    ///
    /// ```
    /// # use pliant::{ErrorKind, World};
    /// use std::time::{Duration, Instant};
    ///
    /// # let mut world = World::<f32>::new();
    /// # let at = |z| [[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]];
    /// # let [robot, wall] = [0.0, 1.0].map(|z| world.add(&[[0, 1, 2]], &at(z)).unwrap());
    /// let end = Instant::now() + Duration::from_secs(1);
    /// let is_late = || Instant::now() > end;
    /// let nearest = world.interruptible(&is_late).distance(robot, wall, 9.0)?;
    /// # assert_eq!(nearest.unwrap().distance, 1.0);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn interruptible<'w>(
        &'w mut self,
        question: &'w (dyn Fn() -> bool + Sync),
    ) -> Interruptible<'w, S> {
        Interruptible {
            world: self,
            question,
        }
    }
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
        let verbs = &mut self.world.verbs;
        verbs.distance([a, b], cut_off, Some(self.question))
    }

    /// [`World::nearest_body`](crate::World::nearest_body).
    ///
    /// # Errors
    ///
    /// See [`Interruptible`].
    pub fn nearest_body(self, body: BodyId, cut_off: f64) -> Result<Option<CloseTriangles>, Error> {
        let verbs = &mut self.world.verbs;
        verbs.nearest_body(body, cut_off, Some(self.question))
    }

    /// [`World::first_impact`](crate::World::first_impact).
    ///
    /// # Errors
    ///
    /// See [`Interruptible`].
    pub fn first_impact(self, of: Selection, width: f64) -> Result<Option<Impact>, Error> {
        let verbs = &mut self.world.verbs;
        verbs.first_impact(of, width, Some(self.question))
    }

    /// [`World::collision_free_step`](crate::World::collision_free_step).
    ///
    /// # Errors
    ///
    /// See [`Interruptible`].
    pub fn collision_free_step(self, of: Selection, min_distance: f64) -> Result<f64, Error> {
        let verbs = &mut self.world.verbs;
        verbs.collision_free_step(of, min_distance, Some(self.question))
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
        self.world.find_clearance(of, cut_off, Some(self.question))
    }

    /// [`World::points_inside`](crate::World::points_inside).
    ///
    /// # Errors
    ///
    /// See [`Interruptible`].
    pub fn points_inside(
        self,
        points: &[[S; 3]],
        body: BodyId,
        rule: InsideRule,
    ) -> Result<Vec<Located>, Error> {
        let question = Some(self.question);
        self.world.find_points_inside(points, body, rule, question)
    }

    /// [`World::inside`](crate::World::inside).
    ///
    /// # Errors
    ///
    /// See [`Interruptible`].
    pub fn inside(self, a: BodyId, b: BodyId, rule: InsideRule) -> Result<Vec<Located>, Error> {
        self.world.find_inside(a, b, rule, Some(self.question))
    }

    /// [`World::contained`](crate::World::contained).
    ///
    /// # Errors
    ///
    /// See [`Interruptible`].
    pub fn contained(self, of: Selection) -> Result<Containment, Error> {
        self.world.find_contained(of, Some(self.question))
    }

    /// [`World::closest_points`](crate::World::closest_points).
    ///
    /// # Errors
    ///
    /// See [`Interruptible`].
    pub fn closest_points(
        self,
        points: &[[S; 3]],
        of: Option<BodyId>,
        cut_off: f64,
    ) -> Result<Vec<Option<ClosestPoint>>, Error> {
        let verbs = &mut self.world.verbs;
        verbs.closest_points(points, of, cut_off, Some(self.question))
    }

    /// [`World::signed_closest_points`](crate::World::signed_closest_points).
    ///
    /// # Errors
    ///
    /// See [`Interruptible`].
    pub fn signed_closest_points(
        self,
        points: &[[S; 3]],
        body: BodyId,
        cut_off: f64,
    ) -> Result<Vec<Option<ClosestPoint>>, Error> {
        let question = Some(self.question);
        self.world
            .find_signed_closest_points(points, body, cut_off, question)
    }

    /// [`World::depth`](crate::World::depth).
    ///
    /// # Errors
    ///
    /// See [`Interruptible`].
    pub fn depth(self, a: BodyId, b: BodyId) -> Result<Depth, Error> {
        self.world.find_depth(a, b, Some(self.question))
    }

    /// [`World::weld`](crate::World::weld), until it is known which vertices are welded. If it is
    /// ended, nothing has changed.
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
