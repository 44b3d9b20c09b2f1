//! Queries for close triangles: at most a distance apart, with their closest points.

pub(crate) mod reference;

use super::ask::first_seen;
use crate::bodies::Places;
use crate::collide::{Ask, InBodies, Request};
use crate::error::Error;
use crate::ids::BodyId;
use crate::kernels::Coordinate;
use crate::queries::{CloseTriangles, Kind, NearTriangles, Pair};
use crate::selection::Selection;
use crate::traversal::Visitor;
use crate::world::handle::World;
use crate::world::query::Query;
use crate::world::scalar::Scalar;
use crate::world::state::State;

/// # Questions: close triangles of bodies
impl<S: Scalar> World<S> {
    /// Asks which triangles are at most `distance` apart in the present shape, with their closest
    /// points.
    ///
    /// Triangles that intersect are at distance 0. The distance is in the unit of the positions.
    /// Whether a pair is that close is decided exactly, in real arithmetic on the numbers given. As
    /// with [`intersections`](Self::intersections), triangles of one body that share a vertex of
    /// the mesh are left out. Their next neighbours are always close. So this question is for
    /// bodies that should keep a distance from each other. Of a body with a
    /// [rest shape](Self::set_rest_positions), pairs that are as close in it are left out.
    ///
    /// ```
    /// # use pliant::{Selection, World};
    /// let mut world = World::<f64>::new();
    /// let large = [[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]];
    /// let skin = world.add(&[[0, 1, 2]], &large)?;
    /// let pointed = [[0.0, 0.0, 0.002], [1.0, 0.0, 3.0], [0.0, 1.0, 3.0]];
    /// let shirt = world.add(&[[0, 1, 2]], &pointed)?;
    /// let close = world.close_triangle_pairs(Selection::Between(shirt, skin), 0.004).all()?;
    /// assert_eq!((close[0].distance, close[0].barycentric_a), (0.002, [1.0, 0.0, 0.0]));
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// The errors of [`Query`].
    #[doc(alias = "within_distance")]
    pub fn close_triangle_pairs(
        &mut self,
        of: Selection,
        distance: f64,
    ) -> Query<'_, CloseTriangles> {
        Query::<CloseTriangles>::new(&mut *self.verbs, of).within(distance)
    }
}

ask!(CloseTriangles, close_triangles.all_measured, |request| {
    NearTriangles::<S>::within(request.distance()?)
});

impl InBodies for Pair {
    fn bodies(&self) -> [BodyId; 2] {
        [self.body_a, self.body_b]
    }

    #[inline]
    fn corners<'b, S: Coordinate>(
        &self,
        [of_a, of_b]: [&Places<'b, S>; 2],
    ) -> Self::Corners<'b, S> {
        [
            of_a.triangle(self.triangle_a),
            of_b.triangle(self.triangle_b),
        ]
    }
}
