//! Triangles that are close to each other, as users ask for them.

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

/// Which triangles are close to each other.
impl<S: Scalar> World<S> {
    /// Asks which triangles are close to each other, in the shape of now: those at most `distance` apart, with their closest points. Those
    /// that intersect are, at distance 0.
    ///
    /// Whether a pair is that close is decided exactly, in real arithmetic on the numbers given. As with
    /// [`intersections`](Self::intersections), triangles of one body that share a vertex of the mesh are left out. Those that are
    /// neighbours but for that always are close: this is for bodies that should keep a distance from each other.
    ///
    /// ```
    /// # use pliant::{Selection, World};
    /// let mut world = World::<f64>::new();
    /// let skin = world.add(&[[0, 1, 2]], &[[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]])?;
    /// let shirt = world.add(&[[0, 1, 2]], &[[0.0, 0.0, 0.002], [1.0, 0.0, 3.0], [0.0, 1.0, 3.0]])?;
    /// let close = world.close_triangle_pairs(Selection::Between(shirt, skin), 0.004).all()?;
    /// assert_eq!((close[0].distance, close[0].barycentric_a), (0.002, [1.0, 0.0, 0.0]));
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Those of [`Query`].
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
