//! Selections: which bodies a question is about.

use crate::ids::BodyId;

/// Selection: which bodies a query looks at, and against which others.
///
/// Every kind of query takes every selection.
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
    /// Every two different bodies that may meet, as filters say.
    ///
    /// See [`World::set_filter`](crate::World::set_filter) and [`ignore`](crate::World::ignore).
    World,
    /// Every two bodies that may meet, and each body with itself: what a step of a simulator asks.
    ///
    /// A body meets itself unless its own membership and mask have no bit in common, or it is
    /// ignored with itself.
    Everything,
    /// Two different bodies, whatever filters say.
    ///
    /// The first is the first of every hit. In pairs of a vertex and a triangle the vertex comes
    /// first.
    Between(BodyId, BodyId),
    /// One body with itself, whatever filters say.
    Within(BodyId),
}
