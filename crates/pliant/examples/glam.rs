//! Vectors of glam (bevy's mathematics) as positions, without a copy.
//!
//! `cargo run -p pliant --example glam`

use glam::{Quat, UVec3, Vec3, vec3};
use pliant::{Selection, World};

fn main() -> Result<(), pliant::Error> {
    let triangles = [UVec3::new(0, 1, 2)];
    let rest = [
        vec3(-1.0, -1.0, 0.0),
        vec3(1.0, -1.0, 0.0),
        vec3(0.0, 1.0, 0.0),
    ];

    // A cast may become anything, so the world says that it is one of f32.
    let mut world = World::<f32>::new();
    let fixed = world.add(
        bytemuck::cast_slice(&triangles),
        bytemuck::cast_slice(&rest),
    )?;
    let turned = world.add(
        bytemuck::cast_slice(&triangles),
        bytemuck::cast_slice(&rest),
    )?;

    for degrees in (0..=90).step_by(30) {
        let turn = Quat::from_rotation_x((degrees as f32).to_radians());
        let points = rest.map(|point| turn * point + 0.5 * Vec3::Z);
        world.set_positions(turned, bytemuck::cast_slice(&points))?;
        let first = world
            .intersections(Selection::Between(fixed, turned))
            .first()?;
        println!(
            "turned by {degrees:2} degrees: they meet: {}",
            first.is_some()
        );
    }
    Ok(())
}
