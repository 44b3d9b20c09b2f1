//! The interface of every method that takes part in a contest.

use crate::motion::{BodyMesh, Shape};
use pliant_scenes::{ChangingMesh, Event};

/// Two intersecting triangles: body, triangle, body, triangle, the smaller (body, triangle) first.
pub type Pair = [u32; 4];

/// Counters of a method's work, since it was built or since they were last taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Counters {
    /// Boxes (cells, buckets) made or made anew.
    pub boxes: u64,
    /// Pairs of boxes compared, of any kind except boxes of whole bodies.
    pub box_tests: u64,
    /// Pairs of triangles decided.
    pub decisions: u64,
}

/// A method of collision detection: one world of bodies that change their shape.
///
/// Bodies and triangles are numbered as given. Triangles intersect as closed sets. Within a body,
/// triangles that share a vertex are left out. Lists are sorted, without duplicates, and equal for
/// all methods.
pub trait Method {
    /// Name with every parameter, as in tables: `van den Bergen (local frame, binary)`.
    fn name(&self) -> String;

    /// Builds all data structures for bodies in their first shape. Not timed.
    ///
    /// Called before everything else, and again before every round where meshes change. The method
    /// then keeps nothing from before.
    fn build(&mut self, bodies: &[BodyMesh<'_>]);

    /// Applies the changes of meshes before a step, and is timed as part of the step.
    ///
    /// `shapes` are the shapes of that step, `meshes` the meshes after the change. The default
    /// builds anew, for methods that cannot edit; they are never given meshes with empty numbers.
    fn change(&mut self, events: &[Event], shapes: &[Shape<'_>], meshes: &[ChangingMesh]) {
        let _ = events;
        let bodies: Vec<_> = meshes
            .iter()
            .zip(shapes)
            .map(|(mesh, &shape)| BodyMesh {
                triangles: &mesh.triangles,
                shape,
            })
            .collect();
        self.build(&bodies);
    }

    /// Work between a step and its query that is not timed.
    fn untimed(&mut self) {}

    /// Takes the shapes of all bodies at the next step, and does the work that is due once a step.
    fn step(&mut self, shapes: &[Shape<'_>]);

    /// All pairs of intersecting triangles of different bodies, sorted.
    fn all_pairs(&mut self) -> &[Pair];

    /// Any pair of intersecting triangles of different bodies.
    fn first_pair(&mut self) -> Option<Pair>;

    /// All pairs of each body with itself, sorted. `None` for a method without this query.
    fn self_pairs(&mut self) -> Option<&[Pair]> {
        None
    }

    /// Vertices near triangles, then edges near edges, of all bodies and of each with itself.
    ///
    /// Rows are the library's, each kind sorted. `None` for a method without this query. The method
    /// was made with the distance, and with what it applies to: boxes of elements, the elements, or
    /// elements that meet during a motion.
    fn candidates(&mut self) -> Option<&[Pair]> {
        None
    }

    /// Distance of the surfaces of the first two bodies, which do not intersect. `None` for a
    /// method without this query.
    fn distance(&mut self) -> Option<f64> {
        None
    }

    /// Counters since the last call; they begin at zero again.
    fn take_counters(&mut self) -> Counters;
}
