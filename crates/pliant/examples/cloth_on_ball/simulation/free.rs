//! Response by free steps: longer than the cloth is thick, and nothing gets through.
//!
//! Everything goes as far as [`World::free_step`](pliant::World::free_step) proves that it may. The
//! rest of the step is planned anew from there. In a plan each close pair is a linear constraint on
//! where the rest of the step ends. Some constraints hold only roughly, and a pair that was not
//! close at first has none. So a plan may be wrong: then the step that is taken is short, but never
//! wrong.

use super::{FRICTION, Simulation, THICK, centre, give_length};
use glam::Vec3;
use pliant::{BodyId, Error, InContact, Selection};

pub(crate) const FREE_STEPS_A_SECOND: usize = 30;
const FREE_STEP: f32 = 1.0 / FREE_STEPS_A_SECOND as f32;
/// The least distance that is ever reached, in metres.
pub(crate) const GAP: f64 = 0.1 * THICK as f64;
/// The distance from which on a pair makes a constraint, in metres.
const CLOSE: f64 = 2.0 * THICK as f64;
/// Plans of one step, at most; the motion that is left then is dropped, and all wait.
const PLANS: usize = 20;
/// Rounds over all constraints of a plan.
const ROUNDS: usize = 20;

/// A contact: two points that are close, each a mean of vertices.
struct Contact {
    /// Body, vertex and weight: positive for the one point, negative for the other.
    corners: Vec<(BodyId, u32, f32)>,
    /// Unit vector from the other point to the one.
    normal: Vec3,
}

impl Simulation {
    /// Moves one time step. Returns how many plans it took.
    pub(crate) fn step_free(&mut self) -> Result<usize, Error> {
        let begin = self.cloth.points.clone();
        let fall = 9.81 * FREE_STEP * FREE_STEP * Vec3::Z;
        let before = self.cloth.before.iter();
        let velocities = begin.iter().zip(before).map(|(a, b)| *a - *b);
        let ways: Vec<Vec3> = velocities.map(|velocity| 0.99 * velocity - fall).collect();
        self.steps += 1;
        self.time = self.steps as f32 * FREE_STEP;
        let ball_at_end = self.ball.before.iter();
        let ball_at_end: Vec<Vec3> = ball_at_end
            .map(|point| *point + centre(self.time))
            .collect();
        let (mut left, mut plans) = (1.0, 0);
        while left > 1e-3 && plans < PLANS {
            plans += 1;
            // The application says where everything is to be ...
            let contacts = self.contacts()?;
            let points = self.cloth.points.iter();
            let mut wanted: Vec<Vec3> =
                points.zip(&ways).map(|(p, way)| *p + left * *way).collect();
            let mut normals = vec![None; wanted.len()];
            for _ in 0..ROUNDS {
                give_length(&self.edges, &mut wanted);
                for contact in &contacts {
                    contact.push_apart(self.cloth.body, &mut wanted, &ball_at_end, &mut normals);
                }
            }
            let swing = ball_at_end[0] - self.ball.points[0];
            let points = self.cloth.points.iter();
            for ((wanted, point), normal) in wanted.iter_mut().zip(points).zip(normals) {
                if let Some(normal) = normal {
                    *wanted -= FRICTION * (*wanted - *point - swing).reject_from_normalized(normal);
                }
            }
            let ends = |points: &[Vec3]| points.iter().map(Vec3::to_array).collect::<Vec<_>>();
            self.world.set_motion(self.cloth.body, &ends(&wanted))?;
            self.world.set_motion(self.ball.body, &ends(&ball_at_end))?;
            // ... and the library how far on the way everything may go.
            let step = self.world.free_step(Selection::Everything, GAP)?;
            // At the poles of the ball its own elements are always nearer to each other than the
            // gap.
            let intersects = matches!(step.begins_in_contact, Some(InContact::Triangles(_)));
            assert!(!intersects, "{step:?}");
            self.world.advance_motion(step.t)?;
            for surface in [&mut self.cloth, &mut self.ball] {
                let reached = self.world.positions(surface.body)?;
                surface.points = reached.into_iter().map(Vec3::from).collect();
            }
            left *= 1.0 - step.t as f32;
        }
        self.cloth.before = begin;
        Ok(plans)
    }

    /// The close pairs of the cloth, with the ball and with itself.
    fn contacts(&mut self) -> Result<Vec<Contact>, Error> {
        let mut contacts = Vec::new();
        let (cloth, ball) = (&self.cloth, &self.ball);
        let of_body = |body: BodyId| if body == cloth.body { cloth } else { ball };
        let numbered = &self.numbered;
        let ends =
            |body: BodyId, edge: u32| numbered[usize::from(body != cloth.body)][edge as usize];
        let to_single = |direction: Option<[f64; 3]>| {
            direction.map(|direction| Vec3::from(direction.map(|x| x as f32)))
        };
        for of in [
            Selection::Between(cloth.body, ball.body),
            Selection::Within(cloth.body),
        ] {
            for close in self.world.close_vertex_triangle_pairs(of, CLOSE).all()? {
                let (body, other) = (close.pair.vertex_body, close.pair.triangle_body);
                let there = of_body(other).triangles[close.pair.triangle as usize];
                let there = there.into_iter().zip(close.barycentric);
                let there = there.map(|(corner, share)| (other, corner, -share as f32));
                let here = [(body, close.pair.vertex, 1.0)].into_iter();
                contacts.extend(to_single(close.direction).map(|normal| Contact {
                    corners: here.chain(there).collect(),
                    normal,
                }));
            }
            for close in self.world.close_edge_edge_pairs(of, CLOSE).all()? {
                let (a, b) = (close.pair.body_a, close.pair.body_b);
                let here = ends(a, close.pair.edge_a).into_iter();
                let there = ends(b, close.pair.edge_b).into_iter();
                let here = here.zip(close.barycentric_a);
                let there = there.zip(close.barycentric_b);
                let here = here.map(|(corner, share)| (a, corner, share as f32));
                let there = there.map(|(corner, share)| (b, corner, -share as f32));
                contacts.extend(to_single(close.direction).map(|normal| Contact {
                    corners: here.chain(there).collect(),
                    normal,
                }));
            }
        }
        Ok(contacts)
    }
}

impl Contact {
    /// Moves vertices of the cloth until the two points are [`THICK`] apart.
    ///
    /// Where the contact is with the ball, its normal is noted for each vertex that has none yet.
    fn push_apart(
        &self,
        cloth: BodyId,
        points: &mut [Vec3],
        ball: &[Vec3],
        normals: &mut [Option<Vec3>],
    ) {
        let place = |&(body, corner, share): &(BodyId, u32, f32)| {
            let surface = if body == cloth { &*points } else { ball };
            share * surface[corner as usize]
        };
        let apart: Vec3 = self.corners.iter().map(place).sum();
        let depth = THICK - apart.dot(self.normal);
        let is_balls = self.corners.iter().any(|&(body, ..)| body != cloth);
        let own = || self.corners.iter().filter(|&&(body, ..)| body == cloth);
        let weight: f32 = own().map(|(.., share)| share * share).sum();
        if depth > 0.0 && weight > 0.0 {
            for &(_, corner, share) in own() {
                let corner = corner as usize;
                points[corner] += depth * share / weight * self.normal;
                normals[corner] = normals[corner].or(is_balls.then_some(self.normal));
            }
        }
    }
}
