//! [`Scene`]: the interface of all scenes with constant meshes.
//!
//! A scene is one surface, shared by all its bodies, and a rule for each body that deforms and
//! moves it. The rules are drawn from the seed when the scene is made, and do not change
//! afterwards. So positions can be asked for in any order and from any number of threads.

use std::fmt;

use crate::error::SceneError;
use crate::limits;
use crate::motion::{Moment, Pose};
use crate::surface::{MAX_TRIANGLES, Nearest, Surface};
use crate::vector::Vec3;

/// A rule that deforms and moves one body.
pub(crate) trait Body: Send + Sync {
    /// Writes the world positions of the vertices of `rest`; both slices have the same length.
    fn place(&self, now: Moment, rest: &[Vec3], out: &mut [[f32; 3]]);

    /// Pose of the frame in which the body deforms; None if it deforms in the world.
    fn pose(&self, _now: Moment) -> Option<Pose> {
        None
    }

    /// Like [`place`](Self::place), but in the body's own frame.
    fn place_in_own_frame(&self, now: Moment, rest: &[Vec3], out: &mut [[f32; 3]]) {
        self.place(now, rest, out);
    }
}

/// Properties of a scene that do not depend on size and seed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct About {
    pub(crate) name: &'static str,
    pub(crate) asks: Asks,
    pub(crate) steps: u32,
}

impl About {
    /// Makes a surface of `triangles` triangles, if one exists.
    pub(crate) fn surface(
        self,
        triangles: usize,
        of: fn(usize) -> Result<Surface, Nearest>,
    ) -> Result<Surface, SceneError> {
        of(triangles).map_err(|nearest| SceneError::ImpossibleSize {
            scene: self.name,
            asked: triangles,
            below: nearest.below,
            above: nearest.above,
        })
    }
}

/// Kind of intersections that a scene is made for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Asks {
    /// Triangles of different bodies that intersect.
    BetweenBodies,
    /// Triangles of one body that intersect each other.
    Itself,
}

/// A deforming scene: the same positions for the same name, size, seed and step, on every machine.
///
/// ```
/// use pliant_scenes::Scene;
///
/// let scene = Scene::new("spheres", Some(1280), Scene::DEFAULT_SEED)?;
/// let mut positions = Vec::new();
/// for step in 1..=scene.steps() {
///     for body in 0..scene.body_count() {
///         scene.positions(body, step, &mut positions);
///         assert_eq!(positions.len(), scene.vertex_count(body));
///     }
/// }
/// # Ok::<(), pliant_scenes::SceneError>(())
/// ```
pub struct Scene {
    about: About,
    surface: Surface,
    bodies: Vec<Box<dyn Body>>,
}

impl Scene {
    /// Names that [`new`](Self::new) knows.
    pub const NAMES: [&'static str; 5] = limits::NAMES;

    /// Seed for which the scenes are calibrated: the figures in their descriptions hold for it.
    ///
    /// With most other seeds `spheres` first touches at steps 53 to 73.
    pub const DEFAULT_SEED: u64 = 751;

    /// Most triangles of a body: an icosahedron divided ten times.
    pub const MAX_TRIANGLES: usize = MAX_TRIANGLES;

    /// Most bodies of a scene.
    pub const MAX_BODIES: usize = limits::MAX_BODIES;

    /// Name of the scene, one of [`NAMES`](Self::NAMES).
    pub fn name(&self) -> &'static str {
        self.about.name
    }

    /// Number of steps: the motion runs from step 1 to this one, both included.
    pub fn steps(&self) -> u32 {
        self.about.steps
    }

    /// Kind of intersections that the scene is made for.
    pub fn asks(&self) -> Asks {
        self.about.asks
    }

    /// Number of bodies, which are numbered from 0.
    pub fn body_count(&self) -> usize {
        self.bodies.len()
    }

    /// Triangles of a body, as indices of its vertices; they never change.
    ///
    /// Surfaces made from spheres are closed, and counter-clockwise seen from outside.
    ///
    /// # Panics
    ///
    /// If there is no such body.
    pub fn triangles(&self, body: usize) -> &[[u32; 3]] {
        self.assert_body(body);
        &self.surface.triangles
    }

    /// Number of vertices of a body.
    ///
    /// # Panics
    ///
    /// If there is no such body.
    pub fn vertex_count(&self, body: usize) -> usize {
        self.assert_body(body);
        self.surface.rest.len()
    }

    /// Writes the positions of a body's vertices at a step to `out`, in place of its contents.
    ///
    /// Allocates nothing if `out` has the capacity. Steps before 1 are like step 1, and steps after
    /// the last like the last. Takes O(vertices).
    ///
    /// # Panics
    ///
    /// If there is no such body.
    pub fn positions(&self, body: usize, step: u32, out: &mut Vec<[f32; 3]>) {
        out.resize(self.vertex_count(body), [0.0; 3]);
        self.write_positions(body, step, out);
    }

    /// Writes the positions of a body's vertices at a step to a slice: see
    /// [`positions`](Self::positions).
    ///
    /// # Panics
    ///
    /// If there is no such body, or if `out` is not exactly as long as the body has vertices.
    pub fn write_positions(&self, body: usize, step: u32, out: &mut [[f32; 3]]) {
        let vertices = self.vertex_count(body);
        assert_eq!(out.len(), vertices, "body {body} has {vertices} vertices");
        self.bodies[body].place(self.moment(step), &self.surface.rest, out);
    }

    /// Pose of a body at a step, for methods that treat rigid motion and deformation separately.
    ///
    /// It is the pose of the frame in which the body deforms. None for a body that deforms in the
    /// world, as the cloth does.
    ///
    /// # Panics
    ///
    /// If there is no such body.
    ///
    /// ```
    /// use pliant_scenes::Scene;
    ///
    /// let scene = Scene::new("crowd", Some(80), Scene::DEFAULT_SEED)?;
    /// let (mut world, mut local) = (Vec::new(), Vec::new());
    /// scene.positions(3, 17, &mut world);
    /// scene.local_positions(3, 17, &mut local);
    /// let pose = scene.pose(3, 17).expect("spheres turn and move");
    /// for (w, l) in world.iter().zip(&local) {
    ///     for axis in 0..3 {
    ///         let row = pose.rotation[axis];
    ///         let turned: f64 = (0..3).map(|i| row[i] * f64::from(l[i])).sum();
    ///         let placed = turned + pose.translation[axis];
    ///         assert!((placed - f64::from(w[axis])).abs() < 1e-6);
    ///     }
    /// }
    /// # Ok::<(), pliant_scenes::SceneError>(())
    /// ```
    pub fn pose(&self, body: usize, step: u32) -> Option<Pose> {
        self.assert_body(body);
        self.bodies[body].pose(self.moment(step))
    }

    /// Writes the positions of a body's vertices at a step in its own frame.
    ///
    /// [`Pose`] maps them to the world. Without a [`pose`](Self::pose) they equal
    /// [`positions`](Self::positions).
    ///
    /// # Panics
    ///
    /// If there is no such body.
    pub fn local_positions(&self, body: usize, step: u32, out: &mut Vec<[f32; 3]>) {
        out.resize(self.vertex_count(body), [0.0; 3]);
        self.bodies[body].place_in_own_frame(self.moment(step), &self.surface.rest, out);
    }

    /// Builds a scene from its bodies and a surface of `triangles` triangles, if one exists.
    pub(crate) fn assemble<B: Body + 'static>(
        about: About,
        triangles: usize,
        surface: fn(usize) -> Result<Surface, Nearest>,
        bodies: impl Iterator<Item = B>,
    ) -> Result<Self, SceneError> {
        let surface = about.surface(triangles, surface)?;
        let bodies = bodies.map(|body| Box::new(body) as Box<dyn Body>).collect();
        Ok(Self {
            about,
            surface,
            bodies,
        })
    }

    fn moment(&self, step: u32) -> Moment {
        Moment::of(step, self.about.steps)
    }

    fn assert_body(&self, body: usize) {
        let bodies = self.bodies.len();
        assert!(body < bodies, "there is no body {body} among {bodies}");
    }
}

impl fmt::Debug for Scene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Scene")
            .field("about", &self.about)
            .field("bodies", &self.bodies.len())
            .field("triangles", &self.surface.triangles.len())
            .field("vertices", &self.surface.rest.len())
            .finish_non_exhaustive()
    }
}
