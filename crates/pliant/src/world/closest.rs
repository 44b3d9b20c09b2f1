//! Closest points of bodies, and signed distances.

use super::handle::World;
use super::scalar::Scalar;
use crate::error::Error;
use crate::ids::BodyId;
use crate::points::{ClosestPoint, InsideRule, Side};
use crate::threads::Question;

/// # Questions: closest points
impl<S: Scalar> World<S> {
    /// Finds the closest point of a body, or of all bodies, for each of some points: shape (k,).
    ///
    /// None for points that are further from it than `cut_off`, which is decided exactly. That is a
    /// length in the unit of the positions, and may be infinite. Distances are at least 0, and
    /// bodies need not be closed. [`ClosestPoint`] says how good they are. Filters and motions do
    /// not count.
    ///
    /// Cost: refitting the body, in whole if points are many. For each point the nodes and
    /// triangles that are about as near as the nearest one. Triangles that were nearest the last
    /// time are measured first, if as many points were asked about.
    ///
    /// ```
    /// # use pliant::World;
    /// use pliant::Feature;
    ///
    /// let mut world = World::<f64>::new();
    /// let corners = [[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
    /// let floor = world.add(&[[0, 1, 2]], &corners)?;
    /// let points = [[1.0, 1.0, 2.0], [-3.0, 1.0, 4.0], [0.0, 0.0, 9.0]];
    /// let found = world.closest_points(&points, Some(floor), 6.0)?;
    /// let first = found[0].expect("the floor is near");
    /// assert_eq!((first.distance, first.point), (2.0, [1.0, 1.0, 0.0]));
    /// let second = found[1].expect("the floor is near");
    /// assert_eq!((second.distance, second.feature), (5.0, Feature::Edge(2)));
    /// assert!(found[2].is_none());
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody); [`BadPoint`](crate::ErrorKind::BadPoint);
    /// [`BadDistance`](crate::ErrorKind::BadDistance) if the cut-off is negative or NaN.
    #[doc(alias = "project")]
    #[doc(alias = "shrinkwrap")]
    pub fn closest_points(
        &mut self,
        points: &[[S; 3]],
        of: Option<BodyId>,
        cut_off: f64,
    ) -> Result<Vec<Option<ClosestPoint>>, Error> {
        self.verbs.closest_points(points, of, cut_off, None)
    }

    /// Finds the closest point of a closed body for each of some points, with signed distances.
    ///
    /// As [`closest_points`](Self::closest_points), but distances are negative for points inside.
    /// The sign is that of [`points_inside`](Self::points_inside), which is exact, with the rule
    /// [`NonZero`](InsideRule::NonZero). No normals are asked. Of a body that overlaps itself the
    /// closest point may be on a wall within.
    ///
    /// # Errors
    ///
    /// As [`closest_points`](Self::closest_points), and [`NotClosed`](crate::ErrorKind::NotClosed).
    #[doc(alias = "signed_distance")]
    #[doc(alias = "sdf")]
    pub fn signed_closest_points(
        &mut self,
        points: &[[S; 3]],
        body: BodyId,
        cut_off: f64,
    ) -> Result<Vec<Option<ClosestPoint>>, Error> {
        self.find_signed_closest_points(points, body, cut_off, None)
    }

    /// [`World::signed_closest_points`].
    pub(super) fn find_signed_closest_points(
        &mut self,
        points: &[[S; 3]],
        body: BodyId,
        cut_off: f64,
        question: Option<Question>,
    ) -> Result<Vec<Option<ClosestPoint>>, Error> {
        self.check_closed(body, InsideRule::NonZero)?;
        let mut found = self
            .verbs
            .closest_points(points, Some(body), cut_off, question)?;
        let mut statistics = *self.statistics();
        // Of the others nobody asks on which side they are.
        let near = || (0..points.len()).filter(|&place| found[place].is_some());
        let asked: Vec<[S; 3]> = near().map(|place| points[place]).collect();
        let located = self.find_points_inside(&asked, body, InsideRule::NonZero, question)?;
        for (closest, located) in found.iter_mut().flatten().zip(located) {
            if located.side == Side::Inside {
                closest.distance = -closest.distance;
            }
        }
        statistics += *self.statistics();
        self.verbs.state_mut().common.statistics = statistics;
        Ok(found)
    }
}
