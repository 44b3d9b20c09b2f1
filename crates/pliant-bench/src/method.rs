//! What every method can do, and how it is asked.

use crate::motion::{BodyMesh, Shape};
use pliant_scenes::{ChangingMesh, Event};

/// Two intersecting triangles: body, triangle, body, triangle, the smaller (body, triangle) first.
pub type Pair = [u32; 4];

/// What a method did since it was built, or since the counters were last taken: its own account of its work.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Counters {
    /// Boxes (cells, buckets) made or made anew.
    pub boxes: u64,
    /// Pairs of boxes compared, of any kind but of whole bodies.
    pub box_tests: u64,
    /// Pairs of triangles decided.
    pub decisions: u64,
}

/// A method of collision detection: one world of bodies that change their shape.
///
/// Bodies and triangles are numbered as given. Triangles intersect as closed sets; within a body, triangles that share a
/// vertex are left out. Lists are sorted and without duplicates, and equal those of every other method.
pub trait Method {
    /// The name and every parameter, as it stands in tables: `van den Bergen (local frame, binary)`.
    fn name(&self) -> String;

    /// Takes bodies over, in their first shape. Called before everything else, and again before every round where meshes change: then the
    /// method has nothing any more of what it had. Not part of any time.
    fn build(&mut self, bodies: &[BodyMesh<'_>]);

    /// What happens to meshes before a step, the shapes of that step, and what the meshes are then. Part of the time of the step. A method
    /// that has no such mode builds anew; it is never given meshes with empty numbers.
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

    /// What a method does between a step and its query that is no part of any time.
    fn untimed(&mut self) {}

    /// Takes over the shapes of all bodies at the next step, and does whatever has to be done once a step.
    fn step(&mut self, shapes: &[Shape<'_>]);

    /// All pairs of triangles of different bodies that intersect, sorted.
    fn all_pairs(&mut self) -> &[Pair];

    /// Some pair of triangles of different bodies that intersect.
    fn first_pair(&mut self) -> Option<Pair>;

    /// All pairs of each body with itself, sorted; `None` for a method that has no such mode.
    fn self_pairs(&mut self) -> Option<&[Pair]> {
        None
    }

    /// Vertices near triangles, then edges near edges, all bodies and each with itself: rows as the library's, either kind sorted.
    /// `None` for a method that has no such mode; how near is near, and whether of boxes, of the elements themselves or of those that meet on
    /// their way, it was told when it was made.
    fn candidates(&mut self) -> Option<&[Pair]> {
        None
    }

    /// How far the surfaces of the first two bodies are apart, which do not intersect. `None` for a method that has no such mode.
    fn distance(&mut self) -> Option<f64> {
        None
    }

    /// The work since the last call; the counters begin at zero again.
    fn take_counters(&mut self) -> Counters;
}
