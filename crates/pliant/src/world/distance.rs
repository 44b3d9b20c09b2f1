//! How far bodies of a world are apart.

use super::handle::World;
use super::scalar::Scalar;
use crate::error::Error;
use crate::ids::BodyId;
use crate::queries::CloseTriangles;

/// How far bodies are apart.
impl<S: Scalar> World<S> {
    /// How far the surfaces of two bodies are apart, in the shape of now: their closest triangles, with the closest points, the first of
    /// the first body; none if they are further apart than `cut_off`, which may be infinite.
    ///
    /// The distance is 0 exactly if any of their triangles intersect, and whether it is at most the cut-off
    /// is decided exactly; it is as good as [`CloseTriangles`] says. Where several triangles are the closest, or others nearer by no more
    /// than 2^-31 of it, it is some of them. Surfaces only: a body wholly inside another is as far from it as its surface is. Filters are
    /// not looked at, and a motion is not.
    ///
    /// Cost: what a query for intersections does ahead, and the nodes and triangles whose boxes are nearer to each other than the bodies
    /// are. The triangles that were the closest the last time are measured first.
    ///
    /// ```
    /// # use pliant::World;
    /// let mut world = World::<f64>::new();
    /// let wall = world.add(&[[0, 1, 2]], &[[0.0, -9.0, -9.0], [0.0, 9.0, -9.0], [0.0, 0.0, 9.0]])?;
    /// let gripper = world.add(&[[0, 1, 2]], &[[3.0, 0.0, 0.0], [5.0, 1.0, 0.0], [5.0, 0.0, 1.0]])?;
    /// let nearest = world.distance(gripper, wall, f64::INFINITY)?.expect("nothing is further apart");
    /// assert_eq!((nearest.distance, nearest.direction), (3.0, Some([1.0, 0.0, 0.0])));
    /// assert_eq!((nearest.point_a, nearest.point_b), ([3.0, 0.0, 0.0], [0.0; 3]));
    /// assert!(world.distance(gripper, wall, 2.0)?.is_none());
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody), [`SameBody`](crate::ErrorKind::SameBody) if both are one,
    /// [`BadDistance`](crate::ErrorKind::BadDistance) if the cut-off is negative or NaN.
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

    /// How far a body is from all others that may meet it, as filters say: [`distance`](Self::distance) to the nearest of them, which
    /// [`pair`](CloseTriangles::pair) names; none if no other is within `cut_off`. Of several that are equally near, it is some of them.
    ///
    /// Cost: that of the distance from those whose boxes are nearer than the nearest is.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody), and [`BadDistance`](crate::ErrorKind::BadDistance) if the cut-off is negative or NaN.
    pub fn nearest_body(
        &mut self,
        body: BodyId,
        cut_off: f64,
    ) -> Result<Option<CloseTriangles>, Error> {
        self.verbs.nearest_body(body, cut_off, None)
    }
}
