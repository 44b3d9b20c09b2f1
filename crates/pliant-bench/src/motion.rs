//! What every method is given: bodies, and their shapes at some steps of a scene.

use pliant_scenes::{ChangingMesh, ChangingScene, Event, Scene};

/// A body to be built: triangles over vertices, and the shape it begins with.
#[derive(Clone, Copy, Debug)]
pub struct BodyMesh<'a> {
    /// Corners as vertex numbers.
    pub triangles: &'a [[u32; 3]],
    /// The first shape.
    pub shape: Shape<'a>,
}

/// A body at one step.
#[derive(Clone, Copy, Debug)]
pub struct Shape<'a> {
    /// World positions of its vertices: what is true, whatever a method computes with.
    pub world: &'a [[f32; 3]],
    /// The same shape in a frame of its own, for methods that work there.
    pub rigid: Option<Rigid<'a>>,
    /// Where its vertices are going during the step, if it is asked what is near on the way.
    pub end: Option<&'a [[f32; 3]]>,
}

/// A shape in a local frame and where that frame is.
///
/// There is one point in the local frame that both positions of a vertex come from: `local` is it, and `world` the place of
/// it, each rounded once to f32. So placing a local position gives the world position but for two roundings; methods that
/// compute in the local frame rely on that.
#[derive(Clone, Copy, Debug)]
pub struct Rigid<'a> {
    /// From the local frame to the world.
    pub pose: Pose,
    /// Local positions of the vertices.
    pub local: &'a [[f32; 3]],
}

/// A rotation, then a translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Rows of the rotation matrix, orthonormal but for rounding.
    pub rotation: [[f64; 3]; 3],
    /// Where the local origin is.
    pub translation: [f64; 3],
}

impl Pose {
    /// The local frame is the world.
    pub const IDENTITY: Self = Self {
        rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        translation: [0.0; 3],
    };

    /// A local point in the world.
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

/// A body of a motion.
#[derive(Clone, Debug)]
pub struct MotionBody {
    /// Corners as vertex numbers.
    pub triangles: Vec<[u32; 3]>,
    /// The shape trees are built on, in the world: step 1, whatever steps are played.
    pub first: Placed,
}

/// A shape that owns its positions.
#[derive(Clone, Debug, Default)]
pub struct Placed {
    /// World positions.
    pub world: Vec<[f32; 3]>,
    /// Pose and local positions, where the scene has them.
    pub rigid: Option<(Pose, Vec<[f32; 3]>)>,
    /// Positions at the end of the step's motion, if it has one.
    pub end: Option<Vec<[f32; 3]>>,
}

impl Placed {
    /// As methods are given it.
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

    /// Makes this a copy of another, in the memory it has.
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
    /// What it is called in tables.
    pub name: String,
    /// The bodies.
    pub bodies: Vec<MotionBody>,
    /// The numbers of the steps.
    pub steps: Vec<u32>,
    /// For each step, the shape of each body.
    pub frames: Vec<Vec<Placed>>,
    /// For each step, what happens to meshes before; empty if nothing ever does.
    pub events: Vec<Vec<Event>>,
}

impl Motion {
    /// Some steps of a scene.
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

    /// The steps of a scene whose meshes change, up to one.
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

    /// What happens to meshes before a step, by its place.
    pub fn events(&self, place: usize) -> &[Event] {
        self.events.get(place).map_or(&[], Vec::as_slice)
    }

    /// The meshes before the first step, as events change them; none if nothing ever happens.
    pub fn changing_meshes(&self) -> Vec<ChangingMesh> {
        let bodies = self.bodies.iter().filter(|_| !self.events.is_empty());
        let mesh = |body: &MotionBody| ChangingMesh::new(&body.triangles, body.first.world.len());
        bodies.map(mesh).collect()
    }

    /// The same motion, with bodies at every step on a part of their way to where the scene has them at the next.
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

    /// The mean length of the sides of all triangles in their first shape.
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

    /// The same motion with the vertices of every body numbered anew: vertex i of body b is what was vertex `orders[b][i]`.
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

    /// The bodies as [`Method::build`](crate::method::Method::build) is given them.
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
