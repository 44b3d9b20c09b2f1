//! Response to pairs of triangles: corners of the cloth are pushed out of the ball, with friction.

use super::{FRICTION, Simulation};
use glam::Vec3;
use pliant::{Error, Pair, Selection};

/// The height above the ball at which a contact puts points, in metres.
const THICKNESS: f32 = 0.0005;

impl Simulation {
    /// Moves one time step. Returns how many pairs of triangles met.
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
                    // From now on it goes with the ball, except for some of its sliding.
                    let sliding = (*point - *before - swing).reject_from_normalized(normal);
                    *point += depth * normal - FRICTION * sliding;
                    *before = *point - swing - (1.0 - FRICTION) * sliding;
                }
            }
        }
        Ok(pairs.len())
    }
}
