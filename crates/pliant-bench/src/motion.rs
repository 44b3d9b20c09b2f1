//! Motions: bodies and their shapes at some steps of a scene, the input of every method.

use pliant_scenes::{ChangingMesh, ChangingScene, Event, Scene};

/// A body to build: triangles over vertices, and a first shape.
#[derive(Clone, Copy, Debug)]
pub struct BodyMesh<'a> {
    /// Corners of each triangle, as vertex numbers.
    pub triangles: &'a [[u32; 3]],
    /// First shape.
    pub shape: Shape<'a>,
}

/// Shape of a body at one step.
#[derive(Clone, Copy, Debug)]
pub struct Shape<'a> {
    /// World positions of the vertices. Truth is decided on these, whatever a method computes with.
    pub world: &'a [[f32; 3]],
    /// The shape in a local frame, for methods that work there.
    pub rigid: Option<Rigid<'a>>,
    /// World positions of the vertices at the end of the step, for queries along the motion.
    pub end: Option<&'a [[f32; 3]]>,
}

/// A shape in a local frame, and the place of that frame.
///
/// Both positions of a vertex come from one real point in the local frame. `local` is that point,
/// `world` its place, each rounded once to f32. So placing a local position gives the world
/// position except for two roundings. Methods that compute in the local frame rely on that.
#[derive(Clone, Copy, Debug)]
pub struct Rigid<'a> {
    /// Map from the local frame to the world.
    pub pose: Pose,
    /// Local positions of the vertices.
    pub local: &'a [[f32; 3]],
}

/// A rigid map: a rotation, then a translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Rows of the rotation matrix, orthonormal except for rounding.
    pub rotation: [[f64; 3]; 3],
    /// World position of the local origin.
    pub translation: [f64; 3],
}

impl Pose {
    /// The identity: the local frame is the world.
    pub const IDENTITY: Self = Self {
        rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        translation: [0.0; 3],
    };

    /// Maps a local point to the world.
    pub fn place(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|axis| {
            let [a, b, c] = self.rotation[axis];
            a * x + b * y + c * z + self.translation[axis]
        })
    }
}

impl From<pliant_scenes::Pose> for Pose {
    fn from(pose: pliant_scenes::Pose) -> Self {
        Self {
            rotation: pose.rotation,
            translation: pose.translation,
        }
    }
}

/// A body of a motion, with its first shape.
#[derive(Clone, Debug)]
pub struct MotionBody {
    /// Corners of each triangle, as vertex numbers.
    pub triangles: Vec<[u32; 3]>,
    /// The shape that trees are built on: step 1 in the world, whichever steps are played.
    pub first: Placed,
}

/// A shape that owns its positions.
#[derive(Clone, Debug, Default)]
pub struct Placed {
    /// World positions of the vertices.
    pub world: Vec<[f32; 3]>,
    /// Pose and local positions, where the scene has them.
    pub rigid: Option<(Pose, Vec<[f32; 3]>)>,
    /// World positions at the end of the step's motion, if it has one.
    pub end: Option<Vec<[f32; 3]>>,
}

impl Placed {
    /// The shape as a view, as methods take it.
    pub fn shape(&self) -> Shape<'_> {
        let rigid = self
            .rigid
            .as_ref()
            .map(|(pose, local)| Rigid { pose: *pose, local });
        Shape {
            world: &self.world,
            rigid,
            end: self.end.as_deref(),
        }
    }

    /// Copies another shape into the memory of this one.
    pub fn copy_from(&mut self, other: &Self) {
        self.world.clone_from(&other.world);
        self.end.clone_from(&other.end);
        match (&mut self.rigid, &other.rigid) {
            (Some((pose, local)), Some((new_pose, new_local))) => {
                *pose = *new_pose;
                local.clone_from(new_local);
            }
            (rigid, other) => rigid.clone_from(other),
        }
    }
}

/// Bodies and their shapes at some steps, all in memory.
#[derive(Clone, Debug)]
pub struct Motion {
    /// Name in tables.
    pub name: String,
    /// Bodies of the motion.
    pub bodies: Vec<MotionBody>,
    /// Numbers of the steps.
    pub steps: Vec<u32>,
    /// Shape of each body, for each step.
    pub frames: Vec<Vec<Placed>>,
    /// Changes of meshes before each step; empty if there are none at all.
    pub events: Vec<Vec<Event>>,
}

impl Motion {
    /// Motion of a scene, at the given steps.
    pub fn of_scene(scene: &Scene, steps: impl IntoIterator<Item = u32>) -> Self {
        let place = |body: usize, step: u32| {
            let mut world = Vec::new();
            scene.positions(body, step, &mut world);
            let rigid = scene.pose(body, step).map(|pose| {
                let mut local = Vec::new();
                scene.local_positions(body, step, &mut local);
                (Pose::from(pose), local)
            });
            Placed {
                world,
                rigid,
                end: None,
            }
        };
        let bodies = 0..scene.body_count();
        let steps: Vec<u32> = steps.into_iter().collect();
        Self {
            name: scene.name().to_owned(),
            bodies: bodies
                .clone()
                .map(|body| MotionBody {
                    triangles: scene.triangles(body).to_vec(),
                    first: place(body, 1),
                })
                .collect(),
            frames: steps
                .iter()
                .map(|&step| bodies.clone().map(|body| place(body, step)).collect())
                .collect(),
            steps,
            events: Vec::new(),
        }
    }

    /// Motion of a scene whose meshes change, from the first step to `last`.
    pub fn of_changing(scene: &ChangingScene, last: u32) -> Self {
        let placed = |world| Placed {
            world,
            rigid: None,
            end: None,
        };
        let place = |body: usize, step: u32| {
            let mut world = Vec::new();
            scene.positions(body, step, &mut world);
            placed(world)
        };
        let bodies = 0..scene.body_count();
        let steps: Vec<u32> = (1..=last.min(scene.steps())).collect();
        Self {
            name: scene.name().to_owned(),
            bodies: bodies
                .clone()
                .map(|body| MotionBody {
                    triangles: scene.triangles(body).to_vec(),
                    first: placed(scene.first_positions(body)),
                })
                .collect(),
            frames: steps
                .iter()
                .map(|&step| bodies.clone().map(|body| place(body, step)).collect())
                .collect(),
            events: steps
                .iter()
                .map(|&step| scene.events(step).to_vec())
                .collect(),
            steps,
        }
    }

    /// Changes of meshes before a step, by the step's place in the list.
    pub fn events(&self, place: usize) -> &[Event] {
        self.events.get(place).map_or(&[], Vec::as_slice)
    }

    /// Meshes before the first step, to be changed by events; none if there are no events.
    pub fn changing_meshes(&self) -> Vec<ChangingMesh> {
        let bodies = self.bodies.iter().filter(|_| !self.events.is_empty());
        let mesh = |body: &MotionBody| ChangingMesh::new(&body.triangles, body.first.world.len());
        bodies.map(mesh).collect()
    }

    /// Gives every body at every step a motion: the fraction `part` of the way to the scene's next
    /// step.
    #[must_use]
    pub fn on_the_way(mut self, scene: &Scene, part: f32) -> Self {
        for (&step, frame) in self.steps.iter().zip(&mut self.frames) {
            for (body, placed) in frame.iter_mut().enumerate() {
                let mut end = Vec::new();
                scene.positions(body, step + 1, &mut end);
                for (end, from) in end.iter_mut().zip(&placed.world) {
                    *end = std::array::from_fn(|axis| from[axis] + part * (end[axis] - from[axis]));
                }
                placed.end = Some(end);
            }
        }
        self
    }

    /// Mean side length of all triangles in their first shape.
    pub fn mean_side(&self) -> f64 {
        let (mut sum, mut count) = (0.0, 0.0);
        for body in &self.bodies {
            for &[a, b, c] in &body.triangles {
                for [i, j] in [[a, b], [b, c], [c, a]] {
                    let [p, q] = [i, j].map(|vertex| body.first.world[vertex as usize]);
                    let squares = (0..3).map(|axis| f64::from(q[axis] - p[axis]).powi(2));
                    sum += squares.sum::<f64>().sqrt();
                    count += 1.0;
                }
            }
        }
        sum / count
    }

    /// Renumbers the vertices of every body: the new vertex `i` of body `b` is the old
    /// `orders[b][i]`.
    #[must_use]
    pub fn renumbered(mut self, orders: &[Vec<u32>]) -> Self {
        let renumber = |placed: &mut Placed, order: &[u32]| {
            let in_order =
                |points: &[[f32; 3]]| order.iter().map(|&old| points[old as usize]).collect();
            placed.world = in_order(&placed.world);
            placed.end = placed.end.as_deref().map(in_order);
            if let Some((_, local)) = &mut placed.rigid {
                *local = in_order(local);
            }
        };
        for (body, order) in self.bodies.iter_mut().zip(orders) {
            let mut new_number = vec![0; order.len()];
            for (new, &old) in order.iter().enumerate() {
                new_number[old as usize] = new as u32;
            }
            for corner in body.triangles.as_flattened_mut() {
                *corner = new_number[*corner as usize];
            }
            renumber(&mut body.first, order);
        }
        for frame in &mut self.frames {
            for (placed, order) in frame.iter_mut().zip(orders) {
                renumber(placed, order);
            }
        }
        self
    }

    /// Bodies in the form that [`Method::build`](crate::method::Method::build) takes.
    pub fn meshes(&self) -> Vec<BodyMesh<'_>> {
        self.bodies
            .iter()
            .map(|body| BodyMesh {
                triangles: &body.triangles,
                shape: body.first.shape(),
            })
            .collect()
    }
}
