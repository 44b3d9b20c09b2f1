//! Where bodies of a world are going, what meets first on the way, and how far all may go.

use super::handle::World;
use super::scalar::Scalar;
use crate::error::Error;
use crate::ids::BodyId;
use crate::queries::Impact;
use crate::selection::Selection;

/// Where bodies are going, what meets first on the way, and how far all may go.
impl<S: Scalar> World<S> {
    /// Begins a motion: says where the vertices of a body will be at the end of the step, shape (n, 3). On the way they move on straight
    /// lines, from the shape that the body has now. Queries for candidates look at the whole way; what intersects is asked of the shape
    /// of now, as ever. A body without a motion stands still.
    ///
    /// The positions are checked as those of [`set_positions`](Self::set_positions) are. A motion takes the place of the one before, and
    /// ends with [`finish_motion`](Self::finish_motion), [`advance_motion`](Self::advance_motion), the next new shape or mesh.
    ///
    /// # Errors
    ///
    /// Those of [`set_positions`](Self::set_positions); the body keeps the motion that it has.
    #[doc(alias = "set_velocity")]
    pub fn set_motion(&mut self, body: BodyId, end: &[[S; 3]]) -> Result<(), Error> {
        self.verbs.set_motion(body, end)
    }

    /// The shape that a body will have at the end of its motion; `None` if it has none.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn end_positions(&self, body: BodyId) -> Result<Option<Vec<[S; 3]>>, Error> {
        let end = self.state().body(body)?.end_positions();
        Ok(end.map(std::borrow::Cow::into_owned))
    }

    /// The first contact on the way to the end of a motion: that with the least exact time of all
    /// [`vertex_triangle_impacts`](Self::vertex_triangle_impacts) and [`edge_edge_impacts`](Self::edge_edge_impacts); of several at one
    /// time a vertex and a triangle rather than edges, the first in order. Its interval is at most `width` wide: see
    /// [`Query::width`](crate::Query::width).
    ///
    /// # Errors
    ///
    /// Those of [`Query`](crate::Query).
    pub fn first_impact(&mut self, of: Selection, width: f64) -> Result<Option<Impact>, Error> {
        self.verbs.first_impact(of, width, None)
    }

    /// How far everything may go on its way to the end of a motion and stay further apart than `min_distance`: a time t from 0 to 1 to call
    /// [`advance_motion`](Self::advance_motion) with. It is proven that on straight ways to the shape that this makes, rounded as it is, no
    /// vertex meets a triangle and no edge another. 1 if that is so of the whole motion; then [`finish_motion`](Self::finish_motion) does
    /// the same. 1 also if nothing moves, and less without a word if the start intersects: [`free_step`](Self::free_step) says so.
    ///
    /// With a `min_distance` of 0, t is at least 0.9 of the exact time of the first contact, if up to 0.91 of it everything is apart by 9 units
    /// in the last place of the largest coordinate; else perhaps smaller, or 0. What meets at the start already does not count: it is in
    /// the lists of impacts, with time 0. So a world that begins without intersections, and is advanced by such steps alone, never has any.
    ///
    /// Above 0 it is a Euclidean distance; and 0.9 is of the time up to which everything is further apart than 1.001 times that. Elements
    /// that are not further apart than it at the start may come nearer, and are kept from contact alone.
    ///
    /// ```
    /// # use pliant::{Selection, World};
    /// # let mut world = World::<f64>::new();
    /// # let floor = world.add(&[[0, 1, 2]], &[[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]])?;
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
    /// Those of [`Query`](crate::Query).
    #[doc(alias = "compute_collision_free_stepsize")]
    pub fn collision_free_step(&mut self, of: Selection, min_distance: f64) -> Result<f64, Error> {
        self.verbs.collision_free_step(of, min_distance, None)
    }

    /// Ends all motions on the way: every body that has one gets the shape in which it is at time `t`, from 0 (where it is) to 1 (the end).
    /// Each coordinate is x0 + t (x1 - x0), computed in `f64`, each operation rounded, kept between x0 and x1, and rounded to `S`; at 1 it
    /// is x1, as after [`finish_motion`](Self::finish_motion).
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
    /// [`BadTime`](crate::ErrorKind::BadTime) if `t` is not from 0 to 1; nothing has moved.
    pub fn advance_motion(&mut self, t: f64) -> Result<(), Error> {
        self.verbs.advance_motion(t)
    }

    /// Ends all motions: every body that has one gets the shape at its end, without a copy. The others stand still.
    pub fn finish_motion(&mut self) {
        self.verbs.finish_motion();
    }
}
