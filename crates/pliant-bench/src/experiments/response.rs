//! Collision response of experiment 3, the application's part.
//!
//! "A simple collision response method was applied to prevent the bodies passing through each
//! other" (paper). A body is pushed away from every body that it meets, along the line of their
//! centres. The length grows with the number of pairs of triangles. It is then drawn back to its
//! place in the scene. The response is computed once, with our method, as part of the motion: every
//! method replays the same shapes.

use crate::motion::{Motion, Placed};
use pliant::{Options, Selection, World};
use pliant_scenes::Scene;
use std::collections::BTreeMap;

/// Push for each pair of triangles, and the largest push from one other body; in units of the
/// scene.
const PUSH: (f64, f64) = (0.0004, 0.03);

/// Fraction of a displacement that remains after a step without contact.
const DRAWN_BACK: f64 = 0.97;

/// Motion of a scene at some steps, with the response to all steps before.
pub(super) fn with_response(scene: &Scene, steps: &[u32]) -> Motion {
    let mut motion = Motion::of_scene(scene, []);
    motion.name = format!("{} with response", scene.name());
    let mut world = World::<f32>::with_options(Options::default());
    let ids: Vec<_> = motion
        .bodies
        .iter()
        .map(|body| {
            world
                .add(&body.triangles, &body.first.world)
                .expect("a scene's bodies are good")
        })
        .collect();
    let mut displacements = vec![[0.0; 3]; ids.len()];
    let last = steps.iter().copied().max().unwrap_or(0);
    for step in 1..=last {
        let mut frame = Motion::of_scene(scene, [step]).frames.remove(0);
        for (placed, displacement) in frame.iter_mut().zip(&displacements) {
            displace(placed, *displacement);
        }
        for (&id, placed) in ids.iter().zip(&frame) {
            world
                .set_positions(id, &placed.world)
                .expect("a scene's shapes are good");
        }
        let mut contacts: BTreeMap<[u32; 2], usize> = BTreeMap::new();
        let pairs = world.intersections(Selection::World).all();
        for pair in pairs.expect("the whole world is there") {
            *contacts.entry([pair.body_a.0, pair.body_b.0]).or_default() += 1;
        }
        let centres: Vec<[f64; 3]> = frame.iter().map(centre).collect();
        for displacement in &mut displacements {
            *displacement = displacement.map(|x| x * DRAWN_BACK);
        }
        for (pair, count) in contacts {
            let [a, b] = pair.map(|body| body as usize);
            let apart: [f64; 3] = std::array::from_fn(|axis| centres[b][axis] - centres[a][axis]);
            let distance = apart.iter().map(|x| x * x).sum::<f64>().sqrt().max(1e-9);
            let push = (PUSH.0 * count as f64).min(PUSH.1) / distance;
            for axis in 0..3 {
                displacements[a][axis] -= push * apart[axis];
                displacements[b][axis] += push * apart[axis];
            }
        }
        if steps.contains(&step) {
            motion.steps.push(step);
            motion.frames.push(frame);
        }
    }
    motion
}

/// Moves a shape and its frame.
fn displace(placed: &mut Placed, by: [f64; 3]) {
    for position in &mut placed.world {
        for axis in 0..3 {
            position[axis] = (f64::from(position[axis]) + by[axis]) as f32;
        }
    }
    if let Some((pose, _)) = &mut placed.rigid {
        for axis in 0..3 {
            pose.translation[axis] += by[axis];
        }
    }
}

fn centre(placed: &Placed) -> [f64; 3] {
    let sum = placed
        .world
        .iter()
        .fold([0.0; 3], |sum: [f64; 3], position| {
            std::array::from_fn(|axis| sum[axis] + f64::from(position[axis]))
        });
    sum.map(|x| x / placed.world.len() as f64)
}
