//! [`ChangingScene`]: the interface of all scenes whose meshes change.

use super::change::Event;
use super::timeline::Timeline;
use crate::limits;
use crate::motion::Moment;
use crate::scene::About;
use std::fmt;

/// A rule that moves the vertices of a scene.
pub(super) trait Rule: Send + Sync {
    /// Writes the positions of the first vertices of a body, as many as `out` has room for.
    fn place(&self, body: usize, now: Moment, out: &mut [[f32; 3]]);
}

/// A scene whose meshes change: equal events and positions on every machine.
///
/// They depend on name, size, seed and step alone.
///
/// | name | bodies | triangles | steps | what happens |
/// |---|---|---|---|---|
/// | `cut` | 1 | 20,480 | 200 | a bumpy sphere is sliced into two pieces that part |
/// | `tear` | 1 | 79,202 | 250 | a sheet is torn along a wandering line, then folds |
/// | `fuse` | 2 | 20,480 each | 200 | two bumpy spheres meet, merge at step 100 and go on as one |
/// | `shuffle` | 1 | 81,920 | 200 | 1,024 pieces go far away from their neighbours |
/// | `remesh` | 2 | 20,480 each | 200 | bumpy spheres overlap while triangles split and collapse |
///
/// In a step of `cut` a few triangles are sliced, and in `tear` a vertex or two are split. In
/// `remesh` 100 triangles of each body are split at each step, and 100 collapsed.
///
/// ```
/// use pliant_scenes::{ChangingScene, Event};
///
/// let scene = ChangingScene::new("cut", Some(1280), ChangingScene::DEFAULT_SEED)?;
/// let mut positions = Vec::new();
/// for step in 1..=scene.steps() {
///     for event in scene.events(step) {
///         assert!(matches!(event, Event::Edit { body: 0, .. }));
///     }
///     scene.positions(0, step, &mut positions);
/// }
/// assert!(positions.len() > scene.vertex_count(0, 0));
/// # Ok::<(), pliant_scenes::SceneError>(())
/// ```
pub struct ChangingScene {
    pub(super) about: About,
    /// Triangles of each body at the beginning.
    pub(super) triangles: Vec<Vec<[u32; 3]>>,
    pub(super) timeline: Timeline,
    pub(super) rule: Box<dyn Rule>,
}

impl ChangingScene {
    /// Names that [`new`](Self::new) knows.
    pub const NAMES: [&'static str; 5] = limits::CHANGING_NAMES;

    /// Seed for which the descriptions hold.
    pub const DEFAULT_SEED: u64 = crate::Scene::DEFAULT_SEED;

    /// The scene without its events: equal positions of the vertices that it has at the beginning.
    ///
    /// Vertices that events would add are left out. For a scene without [`Event::Fuse`].
    #[must_use]
    pub fn without_events(mut self) -> Self {
        self.timeline = Timeline::new(self.timeline.counts[0].clone(), self.about.steps);
        self
    }

    /// Name of the scene, one of [`NAMES`](Self::NAMES).
    pub fn name(&self) -> &'static str {
        self.about.name
    }

    /// Number of steps: from step 1 to this one, both included.
    pub fn steps(&self) -> u32 {
        self.about.steps
    }

    /// Number of bodies at the beginning, which are numbered from 0.
    pub fn body_count(&self) -> usize {
        self.triangles.len()
    }

    /// Triangles of a body at the beginning.
    ///
    /// # Panics
    ///
    /// If there is no such body.
    pub fn triangles(&self, body: usize) -> &[[u32; 3]] {
        &self.triangles[body]
    }

    /// Events at the beginning of a step, in order; none for a step that does not exist.
    pub fn events(&self, step: u32) -> &[Event] {
        let events = (step as usize).checked_sub(1);
        let events = events.and_then(|step| self.timeline.events.get(step));
        events.map_or(&[], Vec::as_slice)
    }

    /// Number of vertices of a body, empty numbers included, after the events of a step.
    ///
    /// Step 0 is the beginning. Zero once the body is fused with another.
    ///
    /// # Panics
    ///
    /// If there is no such body.
    pub fn vertex_count(&self, body: usize, step: u32) -> usize {
        self.timeline.counts[step.min(self.steps()) as usize][body]
    }

    /// Writes the positions of a body's vertices, after the events of a step, to `out`.
    ///
    /// They replace its contents. Positions of empty vertices are meaningless. Takes O(vertices).
    ///
    /// # Panics
    ///
    /// If there is no such body.
    pub fn positions(&self, body: usize, step: u32, out: &mut Vec<[f32; 3]>) {
        out.resize(self.vertex_count(body, step), [0.0; 3]);
        let now = Moment::of(step, self.steps());
        self.rule.place(body, now, out);
    }

    /// Positions of a body before the first step, with which it is made.
    ///
    /// # Panics
    ///
    /// If there is no such body.
    pub fn first_positions(&self, body: usize) -> Vec<[f32; 3]> {
        let mut out = vec![[0.0; 3]; self.vertex_count(body, 0)];
        self.rule.place(body, Moment::of(1, self.steps()), &mut out);
        out
    }
}

impl fmt::Debug for ChangingScene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ChangingScene")
            .field("about", &self.about)
            .field("bodies", &self.triangles.len())
            .finish_non_exhaustive()
    }
}
