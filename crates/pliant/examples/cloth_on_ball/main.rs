//! Cloth on a swinging ball: the loop of the paper's figure 1, with three responses to contact.
//!
//! The cloth moves by position-based dynamics (Müller et al. 2007). Points keep their velocity and
//! fall; then edges get their lengths back. The responses differ in what they ask of the library:
//!
//! - By default: pairs of triangles that intersect. The corners of the cloth's triangle are pushed
//!   out along the normal of the ball's triangle, with friction. In one small step nothing moves
//!   further than a triangle is wide.
//! - `apart`: close pairs, so that the cloth keeps a thickness. Vertices and triangles, and edges
//!   and edges, that are closer than it are contacts. Each is put apart along its closest
//!   direction, in rounds, until all are. In a small step nothing moves further than the cloth is
//!   thick.
//! - `free`: free steps. Nothing gets through them, however fast it is, and the cloth does not meet
//!   itself. A step is eight times as long, and goes only as far as is proven to be free of
//!   contact. What is left of it is planned anew from there.
//!
//! ```sh
//! cargo run --release -p pliant --example cloth_on_ball              # ten seconds of it
//! cargo run --release -p pliant --example cloth_on_ball -- 10 frames # OBJ files too, 30 a second
//! pliant check 'frames/cloth_*.obj' 'frames/ball_*.obj' --count        # what each frame shows
//! cargo run --release -p pliant --example cloth_on_ball -- 10 frames apart
//! pliant check 'frames/cloth_*.obj' 'frames/ball_*.obj' --within 0.018 # nothing
//! cargo run --release -p pliant --example cloth_on_ball -- 10 frames free
//! pliant check 'frames/cloth_*.obj' 'frames/ball_*.obj' --self --swept # nothing
//! ```

#[allow(dead_code, reason = "what tests alone ask")]
mod simulation;

use simulation::{FREE_STEPS_A_SECOND, STEPS_A_SECOND, Simulation};
use std::{env, fs};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = env::args().skip(1);
    let seconds: usize = arguments.next().map_or(Ok(10), |text| text.parse())?;
    let folder = arguments.next();
    let way = arguments.next().unwrap_or_default();
    folder.as_ref().map_or(Ok(()), fs::create_dir_all)?;
    let a_second = if way == "free" {
        FREE_STEPS_A_SECOND
    } else {
        STEPS_A_SECOND
    };
    let mut simulation = Simulation::new()?;
    for step in 1..=seconds * a_second {
        let met = match way.as_str() {
            "apart" => simulation.step_apart()?,
            "free" => simulation.step_free()?,
            _ => simulation.step()?,
        };
        if let (Some(folder), true) = (&folder, step.is_multiple_of(a_second / 30)) {
            let frame = step / (a_second / 30);
            let Simulation { cloth, ball, .. } = &simulation;
            cloth.write_obj(format!("{folder}/cloth_{frame:04}.obj"))?;
            ball.write_obj(format!("{folder}/ball_{frame:04}.obj"))?;
        }
        if step.is_multiple_of(a_second / 4) {
            let (time, height) = (step as f32 / a_second as f32, simulation.height());
            let depth = 1e3 * simulation.depth();
            print!("{time:5.2} s: cloth at {height:.3} m, ");
            match way.as_str() {
                "apart" => println!("{:.3} mm apart", 1e3 * simulation.gap()?),
                "free" => println!("{:.3} mm apart, {met} plans", 1e3 * simulation.gap()?),
                _ => println!("{met:3} pairs, {depth:6.1} mm inside"),
            }
        }
    }
    println!("hash of the cloth: {:016x}", simulation.hash());
    Ok(())
}
