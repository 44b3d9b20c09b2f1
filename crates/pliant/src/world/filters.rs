//! Filters, environments, ignored pairs, vertex groups, rest shapes, labels, thickness and loose
//! boxes: who may meet whom, and from how far.

use super::handle::World;
use super::scalar::Scalar;
use super::state::about;
use crate::error::Error;
use crate::geometry::Bounds;
use crate::ids::BodyId;
use crate::labels::Labels;

/// # Settings: who may meet whom
impl<S: Scalar> World<S> {
    /// Sets which bodies a body meets in queries of the whole world, by two sets of 32 bits.
    ///
    /// Two bodies meet if the membership of each has a bit in common with the mask of the other. At
    /// first both are all ones. A query that names its bodies does not look at them.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    #[doc(alias = "collision_groups")]
    pub fn set_filter(&mut self, body: BodyId, membership: u32, mask: u32) -> Result<(), Error> {
        let body = self.state_mut().common.bodies.get_mut(body)?;
        body.set_filter(membership, mask);
        self.state_mut().common.body_pairs.forget();
        Ok(())
    }

    /// Membership and mask of a body, as [`set_filter`](Self::set_filter) sets them.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn filter(&self, body: BodyId) -> Result<(u32, u32), Error> {
        Ok(self.state().body(body)?.filter())
    }

    /// Puts a body into an environment, a number: bodies of different ones do not meet in queries
    /// of the whole world.
    ///
    /// Masks cannot change that. At first all bodies are in environment 0. So thousands of small
    /// worlds fit into one, each in the same place, as learning needs them. More than 100 bodies
    /// then cost what they would cost if the environments were far apart, unless
    /// [`broad_phase`](crate::Options::broad_phase) says another way than `Auto` or `Tree`. A query
    /// that names its bodies does not look at environments.
    ///
    /// Cost: O(1). The next query orders all bodies anew, O(b log b) for b bodies.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    #[doc(alias = "world_index")]
    pub fn set_environment(&mut self, body: BodyId, environment: u32) -> Result<(), Error> {
        let common = &mut self.state_mut().common;
        common.bodies.set_environment(body, environment)?;
        common.body_pairs.regroup();
        Ok(())
    }

    /// Environment of a body, as [`set_environment`](Self::set_environment) sets it.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn environment(&self, body: BodyId) -> Result<u32, Error> {
        Ok(self.state().body(body)?.environment())
    }

    /// Ignores a pair of bodies: from now on they do not meet in queries of the whole world.
    ///
    /// A body that is named twice does not meet itself. A query that names its bodies does not look
    /// at this.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn ignore(&mut self, a: BodyId, b: BodyId) -> Result<(), Error> {
        self.state_mut().body(a)?;
        self.state_mut().body(b)?;
        self.state_mut().common.bodies.ignore(a, b);
        self.state_mut().common.body_pairs.forget();
        Ok(())
    }

    /// Lets two bodies meet again after [`ignore`](Self::ignore).
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn unignore(&mut self, a: BodyId, b: BodyId) -> Result<(), Error> {
        self.state_mut().body(a)?;
        self.state_mut().body(b)?;
        self.state_mut().common.bodies.meet_again(a, b);
        self.state_mut().common.body_pairs.forget();
        Ok(())
    }

    /// Pairs of bodies that [`ignore`](Self::ignore) keeps apart, each once, the lower id first;
    /// sorted.
    ///
    /// Cost: linear in these pairs.
    pub fn ignored(&self) -> Vec<[BodyId; 2]> {
        self.state().common.bodies.ignored()
    }

    /// Sets a group for every vertex of a body, shape (n,): elements whose vertices are all in one
    /// group do not meet.
    ///
    /// Candidates, close pairs and impacts leave such pairs out, in whichever bodies the vertices
    /// are. Vertices of group 0, as all are at first, meet all. It is for vertices that are pinned,
    /// or glued together.
    ///
    /// Groups stay with the body until [`set_mesh`](Self::set_mesh) gives it another mesh. A vertex
    /// that an [`Edit`](crate::Edit) splits from another has that one's group; other new vertices
    /// have group 0. Groups of empty vertices are not looked at.
    ///
    /// Cost: O(n).
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody),
    /// [`WrongLength`](crate::ErrorKind::WrongLength).
    #[doc(alias = "can_vertices_collide")]
    pub fn set_vertex_groups(&mut self, body: BodyId, groups: &[u32]) -> Result<(), Error> {
        let found = self.state_mut().common.bodies.get_mut(body)?;
        found.set_groups(groups).map_err(about(body))
    }

    /// Groups of the vertices of a body, shape (n,). Cost: O(n).
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn vertex_groups(&self, body: BodyId) -> Result<Vec<u32>, Error> {
        Ok(self.state().body(body)?.groups())
    }

    /// Gives a body a rest shape, positions of shape (n, 3): what is close in it is not close to
    /// itself. `None` takes it away.
    ///
    /// In a cloth all neighbours are closer than it is thick. With a rest shape, close pairs of one
    /// body are left out that are at most the distance apart in it, too. That is decided exactly.
    /// Pairs of two bodies, and other questions, do not look at it.
    ///
    /// It stays with the body until [`set_mesh`](Self::set_mesh) gives it another mesh. A vertex
    /// that an [`Edit`](crate::Edit) splits from another rests in that one's place; another new
    /// vertex rests where it was put. Rows of empty vertices are not looked at.
    ///
    /// ```
    /// # use pliant::{Selection, World};
    /// // A strip of four triangles, folded so that its ends are close.
    /// let strip = [[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4]];
    /// let flat = [0.0, 1.0, 2.0].map(|x| [[x, 0.0, 0.0], [x, 1.0, 0.0]]);
    /// let mut folded = flat;
    /// folded[2] = [[0.0, 0.0, 0.1], [0.0, 1.0, 0.1]];
    /// let mut world = World::<f64>::new();
    /// let cloth = world.add(&strip, flat.as_flattened())?;
    /// world.set_rest_positions(cloth, Some(flat.as_flattened()))?;
    /// let itself = Selection::Within(cloth);
    /// assert!(world.close_vertex_triangle_pairs(itself, 0.2).all()?.is_empty());
    /// world.set_positions(cloth, folded.as_flattened())?;
    /// assert!(world.close_vertex_triangle_pairs(itself, 0.2).first()?.is_some());
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// Cost: O(n).
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody), and the errors of
    /// [`set_positions`](Self::set_positions) but loose boxes.
    pub fn set_rest_positions(
        &mut self,
        body: BodyId,
        positions: Option<&[[S; 3]]>,
    ) -> Result<(), Error> {
        let found = self.state_mut().common.bodies.get_mut(body)?;
        found.set_rest(positions).map_err(about(body))
    }

    /// Positions of a body in its rest shape, as [`set_rest_positions`](Self::set_rest_positions)
    /// sets them; `None` if it has none.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn rest_positions(&self, body: BodyId) -> Result<Option<&[[S; 3]]>, Error> {
        Ok(self.state().body(body)?.rest())
    }

    /// Labels the triangles of a body: pairs of equal or neighbouring labels are left out of what
    /// it finds with itself. `None` takes the labels away.
    ///
    /// They are for the parts of a character: upper and lower arm always touch at the elbow. Labels
    /// are neighbours if a vertex has triangles of both, or if
    /// [`neighbours`](Labels::neighbours) says so. A vertex or an edge has the labels of all its
    /// triangles. A pair of elements is left out if each label of one is equal or next to each of
    /// the other.
    ///
    /// Intersections, contacts, adjacent contacts and close pairs leave them out. Other questions
    /// look past labels: crossing edges, candidates, impacts, free steps and clearance.
    ///
    /// They stay with the body until [`set_mesh`](Self::set_mesh) gives it another mesh. A triangle
    /// that an [`Edit`](crate::Edit) adds is [`NONE`](Labels::NONE), which is left out of nothing;
    /// others keep their labels. Labels of empty triangles are not looked at.
    ///
    /// ```
    /// # use pliant::{Labels, Selection, World};
    /// // A strip of six triangles that is folded flat onto itself: 0 and 1 meet 2 to 5.
    /// let strip = [[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4], [4, 5, 6], [5, 7, 6]];
    /// let fold = [0.0, 1.0, 0.2, 0.8].map(|x| [[x, 0.0, 0.0], [x, 1.0, 0.0]]);
    /// let mut world = World::<f64>::new();
    /// let arm = world.add(&strip, fold.as_flattened())?;
    /// let itself = Selection::Within(arm);
    /// assert_eq!(world.intersections(itself).all()?.len(), 6);
    /// // Upper arm, lower arm, hand: the hand still meets the upper arm.
    /// let parts = [0, 0, 1, 1, 2, 2];
    /// world.set_labels(arm, Some(Labels { of_triangles: &parts, neighbours: None }))?;
    /// let hits = world.intersections(itself).all()?;
    /// let of = |triangle: u32| parts[triangle as usize];
    /// assert!(hits.iter().all(|hit| [of(hit.triangle_a), of(hit.triangle_b)] == [0, 2]));
    /// assert_eq!(hits.len(), 4);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// Cost: O(n + m log m). As much again for the next question after edits.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody),
    /// [`WrongLength`](crate::ErrorKind::WrongLength).
    pub fn set_labels(&mut self, body: BodyId, labels: Option<Labels>) -> Result<(), Error> {
        let found = self.state_mut().common.bodies.get_mut(body)?;
        found.set_labels(labels).map_err(about(body))
    }

    /// Labels of the triangles of a body, as [`set_labels`](Self::set_labels) sets them; `None` if
    /// it has none.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn labels(&self, body: BodyId) -> Result<Option<Labels<'_>>, Error> {
        Ok(self.state().body(body)?.labels())
    }

    /// Makes a body thick: every vertex is a ball of this radius, in the unit of the positions.
    ///
    /// An element is as thick as the thickest of its vertices. Two elements of thickness s and t
    /// then count as close if they are at most `distance + s + t` apart, in real arithmetic. Their
    /// boxes are candidates with a gap of at most `2 radius + s + t`. Steps free of contact keep
    /// `min_distance + s + t`, and clearance is what is left of distances. Distances that are
    /// measured stay what they are. Intersections and impacts are of bodies without thickness.
    ///
    /// It stays with the body. A vertex that an [`Edit`](crate::Edit) splits from another is as
    /// thick as that. Other new vertices, and all of another mesh, are as thick as the thickest.
    ///
    /// A thick cloth is nearly always close to itself: see
    /// [`set_rest_positions`](Self::set_rest_positions).
    ///
    /// ```
    /// # use pliant::{Selection, World};
    /// let mut world = World::<f64>::new();
    /// let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    /// let shirt = world.add(&[[0, 1, 2]], &corners)?;
    /// let coat = world.add(&[[0, 1, 2]], &corners.map(|[x, y, z]| [x, y, z + 0.5]))?;
    /// world.set_thickness(shirt, 0.125)?;
    /// world.set_thickness(coat, 0.375)?;
    /// assert_eq!(world.close_triangle_pairs(Selection::World, 0.0).all()?.len(), 1);
    /// world.set_vertex_thickness(coat, &[0.3, 0.3, 0.37])?;
    /// assert!(world.close_triangle_pairs(Selection::World, 0.0).all()?.is_empty());
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// Cost: O(n).
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    /// [`BadThickness`](crate::ErrorKind::BadThickness) if it is negative, infinite or NaN.
    pub fn set_thickness(&mut self, body: BodyId, thickness: f64) -> Result<(), Error> {
        let vertices = self.vertex_count(body)?;
        self.set_vertex_thickness(body, &vec![thickness; vertices])
    }

    /// Gives every vertex of a body a thickness of its own, shape (n,): see
    /// [`set_thickness`](Self::set_thickness).
    ///
    /// Cost: O(n).
    ///
    /// # Errors
    ///
    /// The errors of [`set_thickness`](Self::set_thickness), and
    /// [`WrongLength`](crate::ErrorKind::WrongLength).
    pub fn set_vertex_thickness(&mut self, body: BodyId, thickness: &[f64]) -> Result<(), Error> {
        let found = self.state_mut().common.bodies.get_mut(body)?;
        found.set_thickness(thickness).map_err(about(body))?;
        self.state_mut().common.body_pairs.forget();
        Ok(())
    }

    /// Thickness of every vertex of a body, shape (n,). Cost: O(n).
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn thickness(&self, body: BodyId) -> Result<Vec<f64>, Error> {
        Ok(self.state().body(body)?.thickness())
    }

    /// Gives a body a loose box, lower and upper corner, that holds it in every pose to come;
    /// `None` takes it away.
    ///
    /// The broad phase then works with this box, which stands still, and looks at the exact box
    /// only where loose boxes overlap. Until it is taken away, a position outside it is refused. It
    /// pays for many bodies that move on their spot.
    ///
    /// Cost: O(n).
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody). [`BadLooseBox`](crate::ErrorKind::BadLooseBox)
    /// if a corner is not finite or above `f32::MAX` in magnitude, or the lower one is above the
    /// upper one on some axis. [`OutsideLooseBox`](crate::ErrorKind::OutsideLooseBox) if the body
    /// is not inside now.
    pub fn set_loose_box(
        &mut self,
        body: BodyId,
        corners: Option<([S; 3], [S; 3])>,
    ) -> Result<(), Error> {
        let loose = corners.map(|(lo, hi)| Bounds { lo, hi });
        let found = self.state_mut().common.bodies.get_mut(body)?;
        found.set_loose_box(loose).map_err(about(body))?;
        self.state_mut().common.note_movement();
        Ok(())
    }

    /// Lower and upper corner of a body's loose box, from [`set_loose_box`](Self::set_loose_box);
    /// `None` if it has none.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn loose_box(&self, body: BodyId) -> Result<Option<([S; 3], [S; 3])>, Error> {
        let loose = self.state().body(body)?.loose();
        Ok(loose.map(|Bounds { lo, hi }| (lo, hi)))
    }
}
