//! Continuous collision detection: a thin sheet that is fast does not jump through another.
//!
//! `cargo run -p pliant --example continuous_collision`

use pliant::{Selection, World};

/// Vertices of a square with this half width, at this height.
fn square(half: f64, z: f64) -> [[f64; 3]; 4] {
    [
        [-half, -half, z],
        [half, -half, z],
        [half, half, z],
        [-half, half, z],
    ]
}

fn main() -> Result<(), pliant::Error> {
    let triangles = [[0, 1, 2], [0, 2, 3]];
    let mut world = World::new();
    world.add(&triangles, &square(1.0, 0.0))?;
    let bullet = world.add(&triangles, &square(0.1, 1.0))?;

    // In one step it would be far behind the other, where the shapes do not intersect.
    world.set_motion(bullet, &square(0.1, -5.0))?;
    let first = world.first_impact(Selection::World, 1e-6)?;
    if let Some(impact) = first {
        println!("it meets between {} and {}", impact.low(), impact.high());
    }

    // How far may everything go, if nothing shall come nearer than 0.01?
    let step = world.free_step(Selection::World, 0.01)?;
    world.advance_motion(step.t)?;
    let [_, _, height] = world.positions(bullet)?[0];
    println!(
        "it may go {:.4} of the step, to a height of {height:.4}",
        step.t
    );
    assert!(world.intersections(Selection::World).first()?.is_none());
    Ok(())
}
