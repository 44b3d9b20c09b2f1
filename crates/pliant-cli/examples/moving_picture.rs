//! Draws a scene step by step, as PNG files of one scale, for a picture that moves.
//!
//! `moving_picture SCENE TRIANGLES FRAMES WIDTHxHEIGHT FOLDER` writes `FOLDER/000.png` and so on.
//! Every picture has room for all steps: two points at the ends of all bodies belong to each.

use anyhow::{Context, bail};
use pliant::{Selection, World};
use pliant_report::picture::{Picture, Shot};
use pliant_scenes::{Asks, Scene};
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

fn main() -> anyhow::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [name, triangles, frames, size, folder] = &arguments[..] else {
        bail!("say moving_picture SCENE TRIANGLES FRAMES WIDTHxHEIGHT FOLDER");
    };
    let (width, height) = size.split_once('x').context("write WIDTHxHEIGHT")?;
    let size = [width.parse()?, height.parse()?];
    let frames: u32 = frames.parse()?;
    let scene = Scene::new(name, Some(triangles.parse()?), Scene::DEFAULT_SEED)?;
    let step_of = |frame: u32| 1 + (scene.steps() - 1) * frame / frames.saturating_sub(1).max(1);

    let mut positions = Vec::new();
    let mut ends = [[f32::MAX; 3], [f32::MIN; 3]];
    for frame in 0..frames {
        for body in 0..scene.body_count() {
            scene.positions(body, step_of(frame), &mut positions);
            for position in &positions {
                for axis in 0..3 {
                    ends[0][axis] = ends[0][axis].min(position[axis]);
                    ends[1][axis] = ends[1][axis].max(position[axis]);
                }
            }
        }
    }

    let mut world = World::<f32>::new();
    let mut bodies = Vec::new();
    for body in 0..scene.body_count() {
        scene.positions(body, step_of(0), &mut positions);
        bodies.push(world.add(scene.triangles(body), &positions)?);
    }
    let ends = world.add(&[[0, 0, 0], [1, 1, 1]], &ends)?;
    world.set_filter(ends, 0, 0)?;
    std::fs::create_dir_all(folder)?;
    for frame in 0..frames {
        for (body, &id) in bodies.iter().enumerate() {
            scene.positions(body, step_of(frame), &mut positions);
            world.set_positions(id, &positions)?;
        }
        let asked = match scene.asks() {
            Asks::BetweenBodies => Selection::World,
            Asks::Itself => Selection::Everything,
        };
        let hits = world.intersections(asked).all()?.iter();
        let pairs: Vec<[u32; 4]> = hits.map(|&pair| pair.into()).collect();
        let shot = Shot {
            size,
            caption: format!("step {}: {} pairs", step_of(frame), pairs.len()),
            ..Shot::default()
        };
        let picture = Picture::shot(&world, &pairs, &shot);
        let file = Path::new(folder).join(format!("{frame:03}.png"));
        picture.write_png(BufWriter::new(File::create(file)?))?;
    }
    Ok(())
}
