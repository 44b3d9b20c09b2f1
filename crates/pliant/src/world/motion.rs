//! Motions of bodies from their present shape to the end of a step, and how far all may go.

use super::handle::World;
use super::scalar::Scalar;
use crate::error::Error;
use crate::ids::BodyId;
use crate::queries::Impact;
use crate::selection::Selection;

/// # Motions: where bodies go, and how far they may
impl<S: Scalar> World<S> {
    /// Begins a motion: gives the positions of a body's vertices at the end of the step, shape (n,
    /// 3).
    ///
    /// Vertices move on straight lines from the present shape to these. Queries for candidates and
    /// impacts look at the whole way; queries for intersections and close pairs look at the present
    /// shape. A body without a motion stands still.
    ///
    /// A motion replaces the one before. It ends with [`finish_motion`](Self::finish_motion),
    /// [`advance_motion`](Self::advance_motion), or the next new shape or mesh.
    ///
    /// Cost: O(n); the positions are checked as by [`set_positions`](Self::set_positions).
    ///
    /// # Errors
    ///
    /// The errors of [`set_positions`](Self::set_positions); the body then keeps the motion that it
    /// has.
    #[doc(alias = "set_velocity")]
    pub fn set_motion(&mut self, body: BodyId, end: &[[S; 3]]) -> Result<(), Error> {
        self.verbs.set_motion(body, end)
    }

    /// Positions at the end of a body's motion, shape (n, 3); `None` if it has none.
    ///
    /// Cost: O(n).
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn end_positions(&self, body: BodyId) -> Result<Option<Vec<[S; 3]>>, Error> {
        let end = self.state().body(body)?.end_positions();
        Ok(end.map(std::borrow::Cow::into_owned))
    }

    /// Finds the first contact on the way to the end of the motions, over both kinds of impacts.
    ///
    /// It has the least exact time of all
    /// [`vertex_triangle_impacts`](Self::vertex_triangle_impacts) and
    /// [`edge_edge_impacts`](Self::edge_edge_impacts). Of several at one time, a vertex and a
    /// triangle come before edges, then the order of lists decides. The interval of its time is at
    /// most `width` wide: see [`Query::width`](crate::Query::width).
    ///
    /// Cost: a short part of the motion is looked at first, and no list is made.
    ///
    /// # Errors
    ///
    /// The errors of [`Query`](crate::Query).
    pub fn first_impact(&mut self, of: Selection, width: f64) -> Result<Option<Impact>, Error> {
        self.verbs.first_impact(of, width, None)
    }

    /// Computes how far everything may go on its way and stay further apart than `min_distance`.
    ///
    /// Returns a time t from 0 (the present shape) to 1 (the end of the motion), to call
    /// [`advance_motion`](Self::advance_motion) with. On straight ways to the shape that this
    /// makes, rounded as it is, no vertex meets a triangle and no edge another: that is proven. The
    /// time is 1 if this holds for the whole motion; then [`finish_motion`](Self::finish_motion)
    /// does as much. It is also 1 if nothing moves. If the start intersects, it may be small
    /// without saying why; [`free_step`](Self::free_step) says so.
    ///
    /// With a `min_distance` of 0, t is at least 0.9 of the exact time of the first contact, if
    /// there is some room. The condition: up to 0.91 of that time everything is apart by 9 units in
    /// the last place of the largest coordinate. Otherwise t may be smaller, or 0. Elements that
    /// meet at the start do not count: they are in the lists of impacts, with time 0. So a world
    /// that begins without intersections, and is advanced by such steps alone, never has any.
    ///
    /// A `min_distance` above 0 is a Euclidean distance, in the unit of the positions. Then the
    /// factor 0.9 applies to the time up to which everything is further apart than 1.001 times
    /// that. Elements that are not further apart than it at the start may come nearer; they are
    /// kept from contact alone.
    ///
    /// ```
    /// # use pliant::{Selection, World};
    /// # let mut world = World::<f64>::new();
    /// # let large = [[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]];
    /// # let floor = world.add(&[[0, 1, 2]], &large)?;
    /// # let leaf = world.add(&[[0, 1, 2]], &[[0.0, 0.0, 2.0], [1.0, 0.0, 3.0], [0.0, 1.0, 3.0]])?;
    /// # world.set_motion(leaf, &[[0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])?;
    /// let step = world.collision_free_step(Selection::Everything, 0.0)?;
    /// assert!(step > 0.6 && step < 2.0 / 3.0);
    /// world.advance_motion(step)?;
    /// assert!(world.intersections(Selection::Everything).first()?.is_none());
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// The errors of [`Query`](crate::Query).
    #[doc(alias = "compute_collision_free_stepsize")]
    pub fn collision_free_step(&mut self, of: Selection, min_distance: f64) -> Result<f64, Error> {
        self.verbs.collision_free_step(of, min_distance, None)
    }

    /// Ends all motions on the way: every body that has one gets its shape at time `t`.
    ///
    /// Time goes from 0 (the present shape) to 1 (the end). Each coordinate is x0 + t (x1 - x0),
    /// computed in `f64`, each operation rounded, kept between x0 and x1, and rounded to `S`. At 1
    /// it is x1, as after [`finish_motion`](Self::finish_motion).
    ///
    /// Cost: O(n) for each body that moves.
    ///
    /// ```
    /// # use pliant::World;
    /// let mut world = World::<f32>::new();
    /// let body = world.add(&[[0, 1, 2]], &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])?;
    /// world.set_motion(body, &[[0.0, 0.0, 4.0], [1.0, 0.0, 4.0], [0.0, 1.0, 4.0]])?;
    /// world.advance_motion(0.25)?;
    /// assert_eq!(world.positions(body)?[1], [1.0, 0.0, 1.0]);
    /// assert_eq!(world.end_positions(body)?, None);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`BadTime`](crate::ErrorKind::BadTime) if `t` is not from 0 to 1; then nothing has moved.
    pub fn advance_motion(&mut self, t: f64) -> Result<(), Error> {
        self.verbs.advance_motion(t)
    }

    /// Ends all motions: every body that has one gets the shape at its end, without a copy.
    ///
    /// Bodies without a motion stand still. Cost: O(b) for b bodies.
    pub fn finish_motion(&mut self) {
        self.verbs.finish_motion();
    }
}
