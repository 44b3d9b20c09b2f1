//! The program `pliant`: one file or folder a verb, this one chooses among them.
//!
//! Whatever goes wrong ends in one line on standard error that says what, where and what to do, and in exit code 2.

mod check;
mod run;
mod tree_options;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// Find which triangles of deforming meshes intersect, exactly.
#[derive(Parser)]
#[command(name = "pliant", version, after_help = EXAMPLES)]
struct Arguments {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Subcommand)]
enum Verb {
    /// Play a built-in scene of deforming bodies and report what intersects and how long it took
    Run(run::Arguments),
    /// Check your own meshes or mesh sequences for intersections
    Check(check::Arguments),
}

const EXAMPLES: &str = "\
Examples:
  pliant run                                  two bumpy spheres that move into each other, 200 steps
  pliant run cloth --steps 30 --format json   a folding sheet with itself
  pliant check shirt.ply                      one body: does it intersect itself?
  pliant check 'shirt_*.obj' 'body_*.obj'     two sequences, frame by frame, against each other
  pliant check walk.npz --count               how many pairs in each frame";

/// What the caller of the program learns from its exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Outcome {
    /// 0: nothing intersects, or nothing was asked.
    Clear,
    /// 1: something intersects.
    Intersects,
}

fn main() -> ExitCode {
    let outcome = match Arguments::parse().verb {
        Verb::Run(arguments) => run::run(&arguments),
        Verb::Check(arguments) => check::check(&arguments),
    };
    match outcome {
        Ok(Outcome::Clear) => ExitCode::SUCCESS,
        Ok(Outcome::Intersects) => ExitCode::from(1),
        Err(error) => {
            eprintln!("pliant: {error:#}");
            ExitCode::from(2)
        }
    }
}
