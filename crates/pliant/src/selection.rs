//! Who is asked about.

use crate::ids::BodyId;

/// Who meets whom in a query. Every kind of query takes every selection.
///
/// ```
/// use pliant::{Selection, World};
///
/// let mut world = World::<f32>::new();
/// let triangle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let a = world.add(&[[0, 1, 2]], &triangle)?;
/// let b = world.add(&[[0, 1, 2]], &triangle)?;
/// for of in [Selection::World, Selection::Everything, Selection::Between(a, b)] {
///     assert_eq!(world.intersections(of).all()?.len(), 1);
/// }
/// assert!(world.intersections(Selection::Within(a)).all()?.is_empty());
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Selection {
    /// Every two bodies that may meet, as [`World::set_filter`](crate::World::set_filter) and
    /// [`ignore`](crate::World::ignore) say; no body with itself.
    World,
    /// Every two bodies that may meet, and each body with itself: what a step of a simulator asks. A body meets itself
    /// unless its own membership and mask have no bit in common, or it is ignored with itself.
    Everything,
    /// Two different bodies, whatever filters say. The first is the first of every hit; but a vertex comes before a triangle.
    Between(BodyId, BodyId),
    /// One body with itself, whatever filters say.
    Within(BodyId),
}
