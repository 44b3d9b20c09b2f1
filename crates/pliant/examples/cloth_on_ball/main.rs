//! A cloth falls on a ball that swings to and fro: the loop of the paper's figure 1, with a response to what is found.
//!
//! Position-based dynamics (Müller et al. 2007): points keep their velocity, fall, and are then put where edges have their
//! length again. Contacts come from the pairs alone: where a triangle of the cloth meets one of the ball, its corners are pushed
//! out along the ball triangle's normal, and rub. In one small step nothing moves further than a triangle is wide.
//!
//! With `apart` the cloth keeps a thickness: contacts are the vertices and triangles, and edges and edges, that are closer than that, and
//! each is put as far apart along the direction in which it is closest, again and again until all are. In a small step nothing moves
//! further than the cloth is thick.
//!
//! With `free` nothing gets through however fast it is, and the cloth does not meet itself either: a step is eight times as long, and goes
//! only as far as is proven to be free of contact. What is left of it is planned anew from there.
//!
//! ```sh
//! cargo run --release -p pliant --example cloth_on_ball                # ten seconds of it
//! cargo run --release -p pliant --example cloth_on_ball -- 10 frames   # and OBJ files, 30 a second, into a folder
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
    Ok(())
}
