//! Writes the bodies of a scene at a step as OBJ files: `write_obj NAME TRIANGLES STEP FOLDER`.
//!
//! The files are `NAME-0.obj` and so on. A reader of 64-bit numbers gets exactly the scene's 32-bit
//! coordinates.

use pliant_scenes::Scene;
use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [name, triangles, step, folder] = &arguments[..] else {
        return Err("say write_obj NAME TRIANGLES STEP FOLDER".into());
    };
    let scene = Scene::new(name, Some(triangles.parse()?), Scene::DEFAULT_SEED)?;
    let step = step.parse()?;
    let mut positions = Vec::new();
    for body in 0..scene.body_count() {
        scene.positions(body, step, &mut positions);
        let mut text = String::new();
        for [x, y, z] in positions.iter().map(|position| position.map(f64::from)) {
            writeln!(text, "v {x:?} {y:?} {z:?}")?;
        }
        // OBJ counts from 1.
        for [a, b, c] in scene
            .triangles(body)
            .iter()
            .map(|corners| corners.map(|vertex| vertex + 1))
        {
            writeln!(text, "f {a} {b} {c}")?;
        }
        std::fs::write(Path::new(folder).join(format!("{name}-{body}.obj")), text)?;
    }
    Ok(())
}
