//! The program `pliant`: parses the arguments and runs one verb, each in a file or folder of its
//! own.
//!
//! Every error, wrong usage included, ends in one line on standard error and exit code 2. The line
//! says what is wrong, where, and what to do. Without any arguments the help is shown. If standard
//! output is closed early, as `head` does, the exit code is 2 without a line.

mod advice;
mod bench;
mod check;
mod completions;
mod convert;
mod edge;
#[cfg(test)]
mod examples;
mod formats;
mod frames;
mod man;
mod outcome;
mod output;
mod rate;
mod report;
mod run;
mod size;
mod summary;
mod table;
mod terminal;
mod tree_options;
mod usage;

use clap::{CommandFactory, Parser, Subcommand};
use outcome::Outcome;
use std::io;
use std::process::ExitCode;
use terminal::complain;

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
    Check(Box<check::Arguments>),
    /// Say how many of what many checks have found
    Summary(summary::Arguments),
    /// Write a mesh or a sequence in another format
    Convert(convert::Arguments),
    /// Compare methods side by side: the paper's experiments and ours
    Bench(bench::Arguments),
    /// Say what is read of each kind of file, and as which surface
    Formats(formats::Arguments),
    /// Print completions for a shell
    Completions(completions::Arguments),
    /// Write manual pages
    Man(man::Arguments),
}

const EXAMPLES: &str = "\
Examples:
  pliant run                                 two spheres move into each other
  pliant run cloth --steps 30 --format json  a folding sheet with itself
  pliant check shirt.ply                     does it intersect itself?
  pliant check 'shirt_*.obj' 'body_*.obj'    two sequences against each other
  pliant check walk.npz --count              how many pairs in each frame
  pliant check fox.glb --clip Run            an animation of a glTF file
  pliant convert fox.glb fox.npz             the same in another format
  pliant bench table-1                       the paper's table 1

`pliant VERB --help` has more. Exit code 0: nothing intersects, or nothing was asked. \
1: something does. 2: it could not be done.";

fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => return usage::said(&error),
    };
    edge::be_silent();
    edge::clean_up_after_signals();
    let outcome = edge::caught(|| match arguments.verb {
        Verb::Run(arguments) => run::run(&arguments),
        Verb::Check(arguments) => check::check(&arguments),
        Verb::Summary(arguments) => summary::print(&arguments),
        Verb::Convert(arguments) => convert::convert(&arguments),
        Verb::Bench(arguments) => bench::bench(&arguments),
        Verb::Formats(arguments) => formats::print(&arguments),
        Verb::Completions(arguments) => completions::print(&arguments, command()),
        Verb::Man(arguments) => man::write(&arguments, command()),
    });
    match outcome {
        Ok(Outcome::Clear) => ExitCode::SUCCESS,
        Ok(Outcome::Intersects) => ExitCode::from(1),
        Err(error) => {
            // The reader has gone (`| head`): nobody to tell.
            if !is_broken_pipe(&error) {
                complain(&advice::with_advice(&error));
            }
            ExitCode::from(2)
        }
    }
}

/// Definition of the program's arguments, for texts generated from it.
fn command() -> clap::Command {
    Arguments::command()
}

fn is_broken_pipe(error: &anyhow::Error) -> bool {
    error
        .chain()
        .filter_map(|cause| cause.downcast_ref::<io::Error>())
        .any(|cause| cause.kind() == io::ErrorKind::BrokenPipe)
}
