//! Distance of two bodies, and of a body from its nearest neighbour.

use super::handle::World;
use super::scalar::Scalar;
use crate::error::Error;
use crate::ids::BodyId;
use crate::queries::CloseTriangles;

/// # Questions: distances of bodies
impl<S: Scalar> World<S> {
    /// Measures the distance between the surfaces of two bodies in their present shapes.
    ///
    /// Returns their closest triangles with the closest points, the first on the first body. `None`
    /// if they are further apart than `cut_off`, a length in the unit of the positions that may be
    /// infinite.
    ///
    /// The distance is 0 exactly if any of their triangles intersect. Whether it is at most the
    /// cut-off is decided exactly; [`CloseTriangles`] says how good the number is. Where several
    /// triangles are the closest, or others are nearer by at most 2^-31 of it, some of them are
    /// given. Surfaces only: a body wholly inside another is as far from it as its surface is.
    /// Filters and motions do not count.
    ///
    /// Cost: the work that a query for intersections does ahead, and the nodes and triangles whose
    /// boxes are nearer than the bodies. The triangles that were the closest the last time are
    /// measured first.
    ///
    /// ```
    /// # use pliant::World;
    /// let mut world = World::<f64>::new();
    /// let large = [[0.0, -9.0, -9.0], [0.0, 9.0, -9.0], [0.0, 0.0, 9.0]];
    /// let wall = world.add(&[[0, 1, 2]], &large)?;
    /// let pointed = [[3.0, 0.0, 0.0], [5.0, 1.0, 0.0], [5.0, 0.0, 1.0]];
    /// let gripper = world.add(&[[0, 1, 2]], &pointed)?;
    /// let nearest = world.distance(gripper, wall, f64::INFINITY)?;
    /// let nearest = nearest.expect("nothing is further apart");
    /// assert_eq!((nearest.distance, nearest.direction), (3.0, Some([1.0, 0.0, 0.0])));
    /// assert_eq!((nearest.point_a, nearest.point_b), ([3.0, 0.0, 0.0], [0.0; 3]));
    /// assert!(world.distance(gripper, wall, 2.0)?.is_none());
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody), [`SameBody`](crate::ErrorKind::SameBody) if
    /// both are one, [`BadDistance`](crate::ErrorKind::BadDistance) if the cut-off is negative or
    /// NaN.
    #[doc(alias = "separation")]
    #[doc(alias = "closest_points")]
    pub fn distance(
        &mut self,
        a: BodyId,
        b: BodyId,
        cut_off: f64,
    ) -> Result<Option<CloseTriangles>, Error> {
        self.verbs.distance([a, b], cut_off, None)
    }

    /// Finds the nearest body, of all that may meet this one as filters say, and measures the
    /// [`distance`](Self::distance).
    ///
    /// [`CloseTriangles::pair`](CloseTriangles::pair) names it. `None` if no other is within
    /// `cut_off`. Where several are equally near, one of them is given.
    ///
    /// Cost: one distance for each body whose box is nearer than the nearest body is.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody), [`BadDistance`](crate::ErrorKind::BadDistance)
    /// if the cut-off is negative or NaN.
    pub fn nearest_body(
        &mut self,
        body: BodyId,
        cut_off: f64,
    ) -> Result<Option<CloseTriangles>, Error> {
        self.verbs.nearest_body(body, cut_off, None)
    }
}
