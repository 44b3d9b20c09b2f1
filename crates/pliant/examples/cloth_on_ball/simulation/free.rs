//! Nothing gets through, in steps that are longer than the cloth is thick: everything goes as far as `free_step` proves that it may, and
//! what is left of the step is planned anew from there.
//!
//! What is close is a constraint on where the rest of the step is to end, whatever its sides are of: vertices, triangles, edges, of the
//! cloth and of the ball. Such constraints are linear, some hold only roughly, and what was not close at first has none: so the plan may
//! be wrong, and then the step that is taken is short. It is never wrong.

use super::{FRICTION, Simulation, THICK, centre, give_length};
use glam::Vec3;
use pliant::{BodyId, Error, InContact, Selection};

pub(crate) const FREE_STEPS_A_SECOND: usize = 30;
const FREE_STEP: f32 = 1.0 / FREE_STEPS_A_SECOND as f32;
/// Nothing comes nearer than this, ever.
pub(crate) const GAP: f64 = 0.1 * THICK as f64;
/// What is so close makes a constraint.
const CLOSE: f64 = 2.0 * THICK as f64;
/// At most so often a step is planned anew; what is left then is left out: all wait.
const PLANS: usize = 20;
const ROUNDS: usize = 20; // over all constraints of a plan

/// Two points that are close, each a mean of corners.
struct Contact {
    /// Body, vertex, and its share: of the one point positive, of the other negative.
    corners: Vec<(BodyId, u32, f32)>,
    /// From the other to the one.
    normal: Vec3,
}

impl Simulation {
    /// One time step; returns how often it was planned.
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
            // At the poles of the ball its own elements are nearer to each other than that, always.
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

    /// What the cloth is close to: the ball, and itself.
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
    /// Puts the corners of the cloth where the two points are as far apart as it is thick; notes the normals of the ball where they are.
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
