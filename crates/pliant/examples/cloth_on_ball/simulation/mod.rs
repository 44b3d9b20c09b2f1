//! Cloth, ball and how they move. The three responses to contact are a file each.

mod apart;
mod by_pairs;
mod free;

pub(crate) use free::FREE_STEPS_A_SECOND;
#[allow(unused_imports, reason = "what tests alone ask")]
pub(crate) use free::GAP;

use glam::Vec3;
use pliant::{BodyId, Error, Selection, World};
use std::collections::BTreeSet;
use std::{fs, io, io::Write};

pub(crate) const STEPS_A_SECOND: usize = 240;
const STEP: f32 = 1.0 / STEPS_A_SECOND as f32;
pub(crate) const RADIUS: f32 = 0.5;
const SIDE: f32 = 1.6;
/// Thickness of the cloth in metres: [`Simulation::step_apart`] keeps it, [`Simulation::step_free`]
/// aims at it.
pub(crate) const THICK: f32 = 0.02;
/// The share of its sliding that a point in contact loses in a step.
const FRICTION: f32 = 0.9;

pub(crate) struct Surface {
    body: BodyId,
    triangles: Vec<[u32; 3]>,
    points: Vec<Vec3>,
    /// Points of the cloth one step ago, or points of the ball at the start.
    before: Vec<Vec3>,
}

pub(crate) struct Simulation {
    world: World<f32>,
    pub(crate) cloth: Surface,
    pub(crate) ball: Surface,
    /// Two points of the cloth and their distance at rest.
    edges: Vec<([usize; 2], f32)>,
    /// The edges of cloth and ball as the library numbers them, each as its two vertices.
    numbered: [Vec<[u32; 2]>; 2],
    pub(crate) steps: usize,
    /// Seconds.
    time: f32,
}

impl Surface {
    /// Adds a surface over the unit square: `squares` on a side, each cut into two triangles.
    ///
    /// If it is closed, each side of the square is folded in its middle. Of two points that come
    /// together one is left.
    fn add(
        world: &mut World<f32>,
        squares: u32,
        is_closed: bool,
        at: fn(f32, f32) -> Vec3,
    ) -> Result<Self, Error> {
        let (across, size) = (squares + 1, squares as f32);
        let corner = |i| at((i % across) as f32 / size, (i / across) as f32 / size);
        let points: Vec<_> = (0..across * across).map(corner).collect();
        let mut triangles = Vec::new();
        for square in 0..squares * squares {
            let low = square / squares * across + square % squares;
            let high = low + across;
            triangles.extend([[low, low + 1, high + 1], [low, high + 1, high]]);
        }
        if is_closed {
            let is_end = |place: u32| place == 0 || place == squares;
            for corner in triangles.as_flattened_mut() {
                let (mut row, mut column) = (*corner / across, *corner % across);
                if is_end(row) {
                    column = column.min(squares - column);
                }
                if is_end(column) {
                    row = row.min(squares - row);
                }
                *corner = row * across + column;
            }
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

    pub(crate) fn write_obj(&self, path: String) -> io::Result<()> {
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

/// Centre of the ball after this many seconds.
fn centre(time: f32) -> Vec3 {
    0.15 * Vec3::new(1.0 - (3.0 * time).cos(), (2.0 * time).sin(), 0.0)
}

/// Moves the ends of each edge until it has its length at rest.
fn give_length(edges: &[([usize; 2], f32)], points: &mut [Vec3]) {
    for &([a, b], rest) in edges {
        let apart = points[b] - points[a];
        let half = 0.5 * (apart - rest * apart.normalize_or_zero());
        points[a] += half;
        points[b] -= half;
    }
}

impl Simulation {
    pub(crate) fn new() -> Result<Self, Error> {
        let mut world = World::new();
        let cloth = Surface::add(&mut world, 24, false, |u, v| {
            Vec3::new(u - 0.5, v - 0.5, 0.4) * SIDE
        })?;
        let ball = Surface::add(&mut world, 40, true, |u, v| {
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
            time: 0.0,
        })
    }

    /// Moves the bodies, as the application does: the cloth falls, the ball swings.
    fn move_bodies(&mut self) -> Result<(), Error> {
        let (cloth, ball) = (&mut self.cloth, &mut self.ball);
        for (point, before) in cloth.points.iter_mut().zip(&mut cloth.before) {
            let velocity = 0.999 * (*point - *before);
            *before = *point;
            *point += velocity - 9.81 * STEP * STEP * Vec3::Z;
        }
        for _ in 0..10 {
            give_length(&self.edges, &mut cloth.points);
        }
        self.steps += 1;
        self.time = self.steps as f32 * STEP;
        for (point, from) in ball.points.iter_mut().zip(&ball.before) {
            *point = *from + centre(self.time);
        }
        cloth.show(&mut self.world)?;
        ball.show(&mut self.world)
    }

    /// How far the ball moved in this step.
    fn swing(&self) -> Vec3 {
        centre(self.time) - centre(self.time - STEP)
    }

    /// Distance of the cloth from the ball.
    pub(crate) fn gap(&mut self) -> Result<f64, Error> {
        let (cloth, ball) = (self.cloth.body, self.ball.body);
        let nearest = self.world.distance(cloth, ball, f64::from(SIDE))?;
        Ok(nearest.map_or(f64::INFINITY, |nearest| nearest.distance))
    }

    /// Whether anything intersects, the cloth with itself included.
    pub(crate) fn intersects(&mut self) -> Result<bool, Error> {
        let pairs = self.world.intersections(Selection::Everything);
        Ok(pairs.first()?.is_some())
    }

    /// Depth of the deepest point of the cloth in the ball; negated distance of the nearest if none
    /// is.
    pub(crate) fn depth(&self) -> f32 {
        let inside = |point: &Vec3| RADIUS - point.distance(centre(self.time));
        let depths = self.cloth.points.iter().map(inside);
        depths.fold(f32::NEG_INFINITY, f32::max)
    }

    /// Hash of the cloth's points, equal only if every bit is: FNV-1a of 32 bits at a time.
    pub(crate) fn hash(&self) -> u64 {
        let numbers = self.cloth.points.iter().flat_map(Vec3::to_array);
        numbers.fold(0xcbf2_9ce4_8422_2325, |hash, x| {
            (hash ^ u64::from(x.to_bits())).wrapping_mul(0x100_0000_01b3)
        })
    }

    /// Height of the cloth's middle above the ball's.
    pub(crate) fn height(&self) -> f32 {
        self.cloth.points[self.cloth.points.len() / 2].z - centre(self.time).z
    }
}
