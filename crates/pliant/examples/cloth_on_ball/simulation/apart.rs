//! Response to close pairs: cloth and ball are put one thickness apart, in rounds.

use super::{FRICTION, Simulation, THICK};
use glam::Vec3;
use pliant::{Error, Selection};

/// Rounds over all contacts of a step, at most.
const ROUNDS: usize = 50;

/// A contact: a point of the cloth that is too close to a point of the ball.
struct Contact {
    /// The vertices of the cloth that the point is a mean of.
    corners: [u32; 3],
    /// The weight of each of these vertices.
    shares: [f32; 3],
    /// The point of the ball.
    there: Vec3,
    /// Unit vector from the ball to the cloth.
    normal: Vec3,
}

/// The point of a triangle with these barycentric coordinates.
fn at(points: &[Vec3], corners: [u32; 3], shares: [f32; 3]) -> Vec3 {
    let [a, b, c] = corners.map(|corner| points[corner as usize]);
    shares[0] * a + shares[1] * b + shares[2] * c
}

impl Simulation {
    /// Moves one time step, after which the cloth is [`THICK`] away from the ball.
    ///
    /// Returns how many elements were too close.
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
        // From now on it goes with the ball, except for some of its sliding.
        for ((point, before), normal) in cloth.points.iter().zip(&mut cloth.before).zip(normals) {
            if let Some(normal) = normal {
                let sliding = (*point - *before - swing).reject_from_normalized(normal);
                *before = *point - swing - (1.0 - FRICTION) * sliding;
            }
        }
        Ok(met)
    }
}
