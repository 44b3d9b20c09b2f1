//! A cloth falls on a ball that swings to and fro: the loop of the paper's figure 1, with a response to what is found.
//!
//! Position-based dynamics (Müller et al. 2007): points keep their velocity, fall, and are then put where edges have their
//! length again. Contacts come from the pairs alone: where a triangle of the cloth meets one of the ball, its corners are pushed
//! out along the ball triangle's normal, and rub. In one small step nothing moves further than a triangle is wide.
//!
//! With `apart` the cloth keeps a thickness: contacts are the vertices and triangles, and edges and edges, that are closer than that, and
//! each is put as far apart along the direction in which it is closest, again and again until all are. In a small step nothing moves
//! further than the cloth is thick.
//!
//! ```sh
//! cargo run --release -p pliant --example cloth_on_ball                # ten seconds of it
//! cargo run --release -p pliant --example cloth_on_ball -- 10 frames   # and OBJ files, 30 a second, into a folder
//! pliant check 'frames/cloth_*.obj' 'frames/ball_*.obj' --count        # what each frame shows
//! cargo run --release -p pliant --example cloth_on_ball -- 10 frames apart
//! pliant check 'frames/cloth_*.obj' 'frames/ball_*.obj' --within 0.018 # nothing
//! ```

use glam::Vec3;
use pliant::{BodyId, Error, Pair, Selection, World};
use std::collections::BTreeSet;
use std::{env, fs, io, io::Write};

pub(crate) const STEPS_A_SECOND: usize = 240;
const STEP: f32 = 1.0 / STEPS_A_SECOND as f32;
pub(crate) const RADIUS: f32 = 0.5;
const SIDE: f32 = 1.6;
const THICKNESS: f32 = 0.0005; // so high above the ball do contacts put points
/// So far from the ball the cloth is kept by [`Simulation::step_apart`].
pub(crate) const THICK: f32 = 0.02;
const ROUNDS: usize = 50; // at most, to put everything apart
const FRICTION: f32 = 0.9; // how much of its sliding a point in contact loses in a step

struct Surface {
    body: BodyId,
    triangles: Vec<[u32; 3]>,
    points: Vec<Vec3>,
    /// Where the points of the cloth were a step ago, and those of the ball at first.
    before: Vec<Vec3>,
}

pub(crate) struct Simulation {
    world: World<f32>,
    cloth: Surface,
    ball: Surface,
    /// Two points of the cloth and their distance.
    edges: Vec<([usize; 2], f32)>,
    /// Those of the cloth and of the ball, as the library numbers them.
    numbered: [Vec<[u32; 2]>; 2],
    pub(crate) steps: usize,
}

impl Surface {
    /// A surface over the unit square: so many squares on a side, each cut in two.
    fn add(world: &mut World<f32>, squares: u32, at: fn(f32, f32) -> Vec3) -> Result<Self, Error> {
        let (across, size) = (squares + 1, squares as f32);
        let corner = |i| at((i % across) as f32 / size, (i / across) as f32 / size);
        let points: Vec<_> = (0..across * across).map(corner).collect();
        let mut triangles = Vec::new();
        for square in 0..squares * squares {
            let low = square / squares * across + square % squares;
            let high = low + across;
            triangles.extend([[low, low + 1, high + 1], [low, high + 1, high]]);
        }
        let positions: Vec<_> = points.iter().map(Vec3::to_array).collect();
        Ok(Self {
            body: world.add(&triangles, &positions)?,
            before: points.clone(),
            triangles,
            points,
        })
    }

    /// Tells the library where the points are.
    fn show(&self, world: &mut World<f32>) -> Result<(), Error> {
        world.write_positions(self.body, |positions| {
            for (position, point) in positions.iter_mut().zip(&self.points) {
                *position = point.to_array();
            }
        })
    }

    fn write_obj(&self, path: String) -> io::Result<()> {
        let mut file = io::BufWriter::new(fs::File::create(path)?);
        for Vec3 { x, y, z } in &self.points {
            writeln!(file, "v {x} {y} {z}")?;
        }
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|corner| corner + 1);
            writeln!(file, "f {a} {b} {c}")?;
        }
        file.flush()
    }
}

/// A point of the cloth, its corners and their shares in it, that is too close to one of the ball.
struct Contact {
    corners: [u32; 3],
    shares: [f32; 3],
    there: Vec3,
    /// From the ball to the cloth.
    normal: Vec3,
}

/// The point of a triangle with these shares of its corners.
fn at(points: &[Vec3], corners: [u32; 3], shares: [f32; 3]) -> Vec3 {
    let [a, b, c] = corners.map(|corner| points[corner as usize]);
    shares[0] * a + shares[1] * b + shares[2] * c
}

/// Where the ball is after so many steps.
fn centre(steps: usize) -> Vec3 {
    let time = steps as f32 * STEP;
    0.15 * Vec3::new(1.0 - (3.0 * time).cos(), (2.0 * time).sin(), 0.0)
}

impl Simulation {
    pub(crate) fn new() -> Result<Self, Error> {
        let mut world = World::new();
        let cloth = Surface::add(&mut world, 24, |u, v| {
            Vec3::new(u - 0.5, v - 0.5, 0.4) * SIDE
        })?;
        let ball = Surface::add(&mut world, 40, |u, v| {
            // The upper half of an octahedron, and the lower one folded out of its sides.
            let (x, y) = (2.0 * u - 1.0, 2.0 * v - 1.0);
            let (up, over) = (1.0 - x.abs() - y.abs(), (x.abs() + y.abs() - 1.0).max(0.0));
            RADIUS * Vec3::new(x - over.copysign(x), y - over.copysign(y), up).normalize()
        })?;
        let mut edges = BTreeSet::new();
        for triangle in &cloth.triangles {
            let [a, b, c] = triangle.map(|corner| corner as usize);
            edges.extend([[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)]));
        }
        let long = |[a, b]: [usize; 2]| cloth.points[a].distance(cloth.points[b]);
        let numbered = [
            world.edges(cloth.body)?.to_vec(),
            world.edges(ball.body)?.to_vec(),
        ];
        Ok(Self {
            numbered,
            edges: edges.into_iter().map(|ends| (ends, long(ends))).collect(),
            world,
            cloth,
            ball,
            steps: 0,
        })
    }

    /// The application moves the bodies.
    fn move_bodies(&mut self) -> Result<(), Error> {
        let (cloth, ball) = (&mut self.cloth, &mut self.ball);
        for (point, before) in cloth.points.iter_mut().zip(&mut cloth.before) {
            let velocity = 0.999 * (*point - *before);
            *before = *point;
            *point += velocity - 9.81 * STEP * STEP * Vec3::Z;
        }
        for _ in 0..10 {
            for &([a, b], rest) in &self.edges {
                let apart = cloth.points[b] - cloth.points[a];
                let half = 0.5 * (apart - rest * apart.normalize_or_zero());
                cloth.points[a] += half;
                cloth.points[b] -= half;
            }
        }
        self.steps += 1;
        for (point, from) in ball.points.iter_mut().zip(&ball.before) {
            *point = *from + centre(self.steps);
        }
        cloth.show(&mut self.world)?;
        ball.show(&mut self.world)
    }

    /// How far the ball went in this step.
    fn swing(&self) -> Vec3 {
        centre(self.steps) - centre(self.steps - 1)
    }

    /// One time step; returns how many pairs of triangles met.
    pub(crate) fn step(&mut self) -> Result<usize, Error> {
        // The application moves the bodies ...
        self.move_bodies()?;
        let swing = self.swing();
        let (world, cloth, ball) = (&mut self.world, &mut self.cloth, &mut self.ball);
        // ... the library answers ...
        let pairs = world
            .intersections(Selection::Between(cloth.body, ball.body))
            .all()?;
        // ... and the application reacts.
        for &Pair {
            triangle_a: of_cloth,
            triangle_b: of_ball,
            ..
        } in pairs
        {
            let [a, b, c] =
                ball.triangles[of_ball as usize].map(|corner| ball.points[corner as usize]);
            let normal = (b - a).cross(c - a).normalize_or(Vec3::Z);
            for corner in cloth.triangles[of_cloth as usize].map(|corner| corner as usize) {
                let (point, before) = (&mut cloth.points[corner], &mut cloth.before[corner]);
                let depth = THICKNESS - (*point - a).dot(normal);
                if depth > 0.0 {
                    // From now on it goes with the ball, but for some of its sliding.
                    let sliding = (*point - *before - swing).reject_from_normalized(normal);
                    *point += depth * normal - FRICTION * sliding;
                    *before = *point - swing - (1.0 - FRICTION) * sliding;
                }
            }
        }
        Ok(pairs.len())
    }

    /// One time step after which the cloth is [`THICK`] away from the ball; returns how many elements were too close.
    pub(crate) fn step_apart(&mut self) -> Result<usize, Error> {
        self.move_bodies()?;
        let swing = self.swing();
        let (world, cloth, ball) = (&mut self.world, &mut self.cloth, &mut self.ball);
        let between = Selection::Between(cloth.body, ball.body);
        let mut normals = vec![None; cloth.points.len()];
        let mut met = 0;
        for _ in 0..ROUNDS {
            // The library says what is close, and how ...
            let mut contacts = Vec::new();
            for close in world
                .close_vertex_triangle_pairs(between, f64::from(THICK))
                .all()?
            {
                let towards = Vec3::from(close.direction.unwrap_or_default().map(|x| x as f32));
                let shares = close.barycentric.map(|share| share as f32);
                let (vertex, triangle) = (close.pair.vertex, close.pair.triangle as usize);
                contacts.push(if close.pair.vertex_body == cloth.body {
                    let there = at(&ball.points, ball.triangles[triangle], shares);
                    Contact {
                        corners: [vertex; 3],
                        shares: [1.0, 0.0, 0.0],
                        there,
                        normal: towards,
                    }
                } else {
                    let there = ball.points[vertex as usize];
                    Contact {
                        corners: cloth.triangles[triangle],
                        shares,
                        there,
                        normal: -towards,
                    }
                });
            }
            // The body with the lower number comes first: the cloth.
            for close in world
                .close_edge_edge_pairs(between, f64::from(THICK))
                .all()?
            {
                let normal = Vec3::from(close.direction.unwrap_or_default().map(|x| x as f32));
                let [a, b] = self.numbered[0][close.pair.edge_a as usize];
                let [c, d] = self.numbered[1][close.pair.edge_b as usize];
                let [s, t] = close.barycentric_a.map(|share| share as f32);
                let [u, v] = close.barycentric_b.map(|share| share as f32);
                let there = at(&ball.points, [c, d, d], [u, v, 0.0]);
                contacts.push(Contact {
                    corners: [a, b, b],
                    shares: [s, t, 0.0],
                    there,
                    normal,
                });
            }
            // ... and the application puts it apart, one contact after the other.
            let mut deepest = 0.0_f32;
            for Contact {
                corners,
                shares,
                there,
                normal,
            } in &contacts
            {
                let depth = THICK - (at(&cloth.points, *corners, *shares) - there).dot(*normal);
                deepest = deepest.max(depth);
                let weight: f32 = shares.iter().map(|share| share * share).sum();
                for (&corner, share) in corners.iter().zip(shares).filter(|_| depth > 0.0) {
                    if *share > 0.0 {
                        cloth.points[corner as usize] += depth * share / weight * normal;
                        normals[corner as usize] = Some(*normal);
                    }
                }
            }
            cloth.show(world)?;
            met = met.max(contacts.len());
            if deepest < 0.02 * THICK {
                break;
            }
        }
        // What was put apart goes with the ball from now on, but for some of its sliding.
        for ((point, before), normal) in cloth.points.iter().zip(&mut cloth.before).zip(normals) {
            if let Some(normal) = normal {
                let sliding = (*point - *before - swing).reject_from_normalized(normal);
                *before = *point - swing - (1.0 - FRICTION) * sliding;
            }
        }
        Ok(met)
    }

    /// How far the cloth is from the ball.
    pub(crate) fn gap(&mut self) -> Result<f64, Error> {
        let (cloth, ball) = (self.cloth.body, self.ball.body);
        let nearest = self.world.distance(cloth, ball, f64::from(SIDE))?;
        Ok(nearest.map_or(f64::INFINITY, |nearest| nearest.distance))
    }

    /// How deep the deepest point of the cloth is inside the ball; negative: how far the nearest is outside.
    pub(crate) fn depth(&self) -> f32 {
        let inside = |point: &Vec3| RADIUS - point.distance(centre(self.steps));
        let depths = self.cloth.points.iter().map(inside);
        depths.fold(f32::NEG_INFINITY, f32::max)
    }

    /// How far the middle of the cloth is above the middle of the ball.
    pub(crate) fn height(&self) -> f32 {
        self.cloth.points[self.cloth.points.len() / 2].z - centre(self.steps).z
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = env::args().skip(1);
    let seconds: usize = arguments.next().map_or(Ok(10), |text| text.parse())?;
    let folder = arguments.next();
    let apart = arguments.next().is_some_and(|word| word == "apart");
    folder.as_ref().map_or(Ok(()), fs::create_dir_all)?;
    let mut simulation = Simulation::new()?;
    for step in 1..=seconds * STEPS_A_SECOND {
        let pairs = if apart {
            simulation.step_apart()?
        } else {
            simulation.step()?
        };
        if let (Some(folder), true) = (&folder, step.is_multiple_of(STEPS_A_SECOND / 30)) {
            let frame = step / (STEPS_A_SECOND / 30);
            let Simulation { cloth, ball, .. } = &simulation;
            cloth.write_obj(format!("{folder}/cloth_{frame:04}.obj"))?;
            ball.write_obj(format!("{folder}/ball_{frame:04}.obj"))?;
        }
        if step.is_multiple_of(STEPS_A_SECOND / 4) {
            let (time, height) = (step as f32 * STEP, simulation.height());
            let depth = 1e3 * simulation.depth();
            if apart {
                let gap = 1e3 * simulation.gap()?;
                println!("{time:5.2} s: cloth at {height:.3} m, {gap:.3} mm apart");
                continue;
            }
            println!(
                "{time:5.2} s: {pairs:3} pairs, cloth at {height:.3} m, {depth:6.1} mm inside"
            );
        }
    }
    Ok(())
}
