//! Scenes whose meshes change: [`ChangingScene`], and what happens in them.
//!
//! What happens is known when the scene is made; after that nothing changes, so events and positions can be asked for in any order.
//! Numbers stay: what goes leaves its number empty, what comes is numbered behind all others, or uses an empty number again.

mod cut;
mod fuse;
mod mesh;
mod remesh;
mod shuffle;
mod tear;

pub use mesh::ChangingMesh;

use crate::error::SceneError;
use crate::motion::Moment;
use crate::scene::About;
use crate::surface::{Nearest, Surface};
use std::fmt;

/// Something that happens to the mesh of a body.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Change {
    /// So many vertices come, numbered behind all others.
    AddVertices(usize),
    /// An empty number of a vertex is used again.
    PlaceVertex(u32),
    /// A vertex comes where another is, which these triangles have for a corner from now on.
    SplitVertex {
        /// The other.
        vertex: u32,
        /// Those that leave it.
        triangles: Vec<u32>,
    },
    /// Two vertices become one.
    MergeVertices {
        /// The one that stays.
        kept: u32,
        /// The one that goes.
        gone: u32,
    },
    /// Triangles come, numbered behind all others.
    AddTriangles(Vec<[u32; 3]>),
    /// A triangle has other corners, or an empty number is used again.
    SetTriangle {
        /// Its number.
        triangle: u32,
        /// Its corners.
        corners: [u32; 3],
    },
    /// Triangles go, and with them the vertices that no other triangle has.
    RemoveTriangles(Vec<u32>),
}

/// Something that happens at the beginning of a step.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Event {
    /// The mesh of a body changes.
    Edit {
        /// Its number.
        body: usize,
        /// In this order. Vertices that come are where [`ChangingScene::positions`] says for the step.
        changes: Vec<Change>,
    },
    /// What one body has comes behind what another has, in order, and that body is no more.
    Fuse {
        /// The body that stays.
        kept: usize,
        /// The other.
        gone: usize,
    },
}

/// Where vertices are.
trait Rule: Send + Sync {
    /// The first vertices of a body: as many as there is room for.
    fn place(&self, body: usize, now: Moment, out: &mut [[f32; 3]]);
}

/// A scene whose meshes change: the same events and positions for the same name, size, seed and step, on every machine.
///
/// | name | bodies | triangles | steps | what happens |
/// |---|---|---|---|---|
/// | `cut` | 1 | 20,480 | 200 | a bumpy sphere is sliced, a few triangles a step, into two pieces that part |
/// | `tear` | 1 | 79,202 | 250 | a sheet is torn along a wandering line, a vertex or two a step, then folds |
/// | `fuse` | 2 | 20,480 each | 200 | two bumpy spheres meet, merge at step 100 and go on as one |
/// | `shuffle` | 1 | 81,920 | 200 | a body of 1,024 pieces, all of which go far away from their neighbours |
/// | `remesh` | 2 | 20,480 each | 200 | bumpy spheres that overlap; each step 100 triangles of each are split, and 100 collapsed |
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
    about: About,
    /// Of each body at the beginning.
    triangles: Vec<Vec<[u32; 3]>>,
    timeline: Timeline,
    rule: Box<dyn Rule>,
}

impl ChangingScene {
    /// The names that [`new`](Self::new) knows.
    pub const NAMES: [&'static str; 5] = ["cut", "tear", "fuse", "shuffle", "remesh"];

    /// The seed that the descriptions hold for.
    pub const DEFAULT_SEED: u64 = crate::Scene::DEFAULT_SEED;

    /// The scene called `name`, with `triangles` triangles a body at the beginning, or the scene's own number. Possible sizes are those of
    /// [`Scene::new`](crate::Scene::new): the sheet is torn, the others are made of spheres; of `shuffle` a piece has a 1,024th of them.
    ///
    /// # Errors
    ///
    /// [`SceneError::UnknownName`], and [`SceneError::ImpossibleSize`] with the nearest possible sizes.
    pub fn new(name: &str, triangles: Option<usize>, seed: u64) -> Result<Self, SceneError> {
        match name {
            "cut" => cut::scene(triangles, seed),
            "tear" => tear::scene(triangles, seed),
            "fuse" => fuse::scene(triangles, seed),
            "shuffle" => shuffle::scene(triangles, seed),
            "remesh" => remesh::scene(triangles, seed),
            _ => Err(SceneError::UnknownName {
                asked: name.to_owned(),
            }),
        }
    }

    /// The same positions, in which nothing happens: vertices that would come are left out. For a scene without
    /// [`Event::Fuse`].
    #[must_use]
    pub fn without_events(mut self) -> Self {
        self.timeline = Timeline::new(self.timeline.counts[0].clone(), self.about.steps);
        self
    }

    /// The scene's name, one of [`NAMES`](Self::NAMES).
    pub fn name(&self) -> &'static str {
        self.about.name
    }

    /// The number of steps: from step 1 to this one, both included.
    pub fn steps(&self) -> u32 {
        self.about.steps
    }

    /// The number of bodies at the beginning, numbered from 0.
    pub fn body_count(&self) -> usize {
        self.triangles.len()
    }

    /// The triangles of a body at the beginning.
    ///
    /// # Panics
    ///
    /// If there is no such body.
    pub fn triangles(&self, body: usize) -> &[[u32; 3]] {
        &self.triangles[body]
    }

    /// What happens at the beginning of a step, in this order; nothing in steps that there are none of.
    pub fn events(&self, step: u32) -> &[Event] {
        let events = (step as usize).checked_sub(1);
        let events = events.and_then(|step| self.timeline.events.get(step));
        events.map_or(&[], Vec::as_slice)
    }

    /// The number of vertices of a body, counted by number, after what happens in a step; step 0 is the beginning. None once the body is
    /// fused with another.
    ///
    /// # Panics
    ///
    /// If there is no such body.
    pub fn vertex_count(&self, body: usize, step: u32) -> usize {
        self.timeline.counts[step.min(self.steps()) as usize][body]
    }

    /// The positions of a body's vertices at a step, after what happens in it; `out` then holds these and nothing else. What it holds for
    /// vertices that are empty means nothing.
    ///
    /// # Panics
    ///
    /// If there is no such body.
    pub fn positions(&self, body: usize, step: u32, out: &mut Vec<[f32; 3]>) {
        out.resize(self.vertex_count(body, step), [0.0; 3]);
        let now = Moment::of(step, self.steps());
        self.rule.place(body, now, out);
    }

    /// The positions that a body has before the first step, when it is made.
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

/// What happens when, and how many vertices there are then.
struct Timeline {
    /// Of each step the number of vertices of each body; before step 1 first.
    counts: Vec<Vec<usize>>,
    /// Of each step.
    events: Vec<Vec<Event>>,
}

impl Timeline {
    /// Of bodies with so many vertices, to which nothing happens.
    fn new(vertices: Vec<usize>, steps: u32) -> Self {
        Self {
            counts: vec![vertices; steps as usize + 1],
            events: vec![Vec::new(); steps as usize],
        }
    }

    /// Something happens to a body in a step, after which it has so many vertices; nothing, if these changes are none.
    fn edit(&mut self, step: u32, body: usize, changes: Vec<Change>, vertices: usize) {
        if changes.is_empty() {
            return;
        }
        self.events[step as usize - 1].push(Event::Edit { body, changes });
        for counts in &mut self.counts[step as usize..] {
            counts[body] = vertices;
        }
    }

    /// Two bodies become one in a step.
    fn fuse(&mut self, step: u32, kept: usize, gone: usize) {
        self.events[step as usize - 1].push(Event::Fuse { kept, gone });
        for counts in &mut self.counts[step as usize..] {
            counts[kept] += counts[gone];
            counts[gone] = 0;
        }
    }
}

/// A surface of so many triangles, if there is one.
fn surface(
    about: About,
    triangles: usize,
    of: fn(usize) -> Result<Surface, Nearest>,
) -> Result<Surface, SceneError> {
    of(triangles).map_err(|nearest| SceneError::ImpossibleSize {
        scene: about.name,
        asked: triangles,
        below: nearest.below,
        above: nearest.above,
    })
}
