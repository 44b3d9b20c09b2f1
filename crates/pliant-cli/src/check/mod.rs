//! `pliant check`: somebody's meshes, frame by frame.

mod output;
mod pairs;
mod sequence;
mod size;

use crate::Outcome;
use crate::report::{PictureOptions, Watcher, fact};
use anyhow::Context;
use clap::{Args, ValueEnum};
use output::Output;
use pairs::Pairs;
use pliant::{Options, Scalar, World};
use pliant_io::{Body, OpenOptions, Precision};
use pliant_report::BodyLabel;
use sequence::Sequence;
use std::num::NonZeroUsize;

#[derive(Args, Debug)]
#[command(after_help = EXIT_CODES)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "each is a flag of the program"
)]
pub(crate) struct Arguments {
    /// One body each: a mesh (.obj, .ply), a sequence (.npz), or a quoted pattern whose files in natural order are its frames ('cloth_*.obj')
    #[arg(value_name = "BODY", required = true)]
    bodies: Vec<String>,
    /// Check each body against itself too; one body alone always is
    #[arg(long = "self")]
    itself: bool,
    /// Only how many pairs, not which
    #[arg(long)]
    count: bool,
    /// Stop at the first pair of each frame
    #[arg(long)]
    first: bool,
    /// Keep vertices apart where boundary edges coincide; seams are then intersections
    #[arg(long)]
    no_weld: bool,
    /// The most memory that a frame may take, seam finding included, and again that a list of pairs may (4GiB, 512MiB, 1G, bytes); a frame that says it is larger is refused before it is read
    #[arg(long, value_name = "SIZE", default_value = "4GiB", value_parser = size::parse)]
    max_memory: u64,
    /// How many threads share the work; no number changes an answer
    #[arg(long, value_name = "T", default_value = "1")]
    threads: NonZeroUsize,
    /// A table by frame, or one JSON object
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
    #[command(flatten)]
    pictures: PictureOptions,
}

const EXIT_CODES: &str = "\
Exit code 0: nothing intersects. 1: something does. 2: it could not be checked; standard error says why.
Memory: at most 3.5 times two frames (positions and triangles) and 8 MB, however many frames there are; beside it 16 bytes for each pair that is listed.";

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    Table,
    Json,
}

/// Checks all frames and prints what intersects.
pub(crate) fn check(arguments: &Arguments) -> anyhow::Result<Outcome> {
    if let Some(pattern) = pliant_io::looks_like_a_series(&arguments.bodies) {
        crate::complain(&format!(
            "pliant: note: {} arguments are {0} bodies; if they are frames of one body, quote the pattern: '{pattern}'",
            arguments.bodies.len()
        ));
    }
    let sequence = Sequence::open(
        &arguments.bodies,
        &OpenOptions {
            weld: !arguments.no_weld,
            max_memory: arguments.max_memory,
        },
    )?;
    match sequence.precision() {
        Precision::F32 => check_frames::<f32>(arguments, sequence),
        Precision::F64 => check_frames::<f64>(arguments, sequence),
    }
}

fn check_frames<S: Scalar + sequence::FromFile>(
    arguments: &Arguments,
    mut sequence: Sequence,
) -> anyhow::Result<Outcome> {
    let numbers = 0..sequence.frame_count() as u32;
    let mut watcher = Watcher::new(&arguments.pictures, || labels(&sequence), "frame", numbers)?;
    let mut output = Output::begin(arguments, &sequence)?;
    let mut options = Options::default();
    options.threads = arguments.threads;
    let mut world = World::<S>::with_options(options);
    let listed = watcher.is_looking() || (arguments.format == Format::Json && !arguments.count);
    let mut pairs = Pairs::new(listed, arguments.max_memory);
    let mut buffer = Vec::new();
    let checked = (0..sequence.frame_count()).try_for_each(|frame| {
        sequence.load_frame(frame, &mut world, &mut buffer)?;
        pairs
            .find(arguments, &mut world)
            .with_context(|| format!("frame {frame}"))?;
        if watcher.looks_at(frame as u32) {
            watcher.frame(frame as u32, &world, &pairs.list)?;
        }
        output.frame(frame, &pairs)
    });
    let written = watcher.finish("check", "frame", |_, play| {
        let precision = match sequence.precision() {
            Precision::F32 => "f32",
            Precision::F64 => "f64",
        };
        play.facts.extend([
            fact("query", asked(arguments, &sequence)),
            fact("precision", precision),
        ]);
        if let Err(error) = &checked {
            play.notes
                .push(format!("The check ended early: {error:#}."));
        }
    });
    let outcome = output.end(checked)?;
    written?;
    Ok(outcome)
}

/// What the page calls the bodies.
fn labels(sequence: &Sequence) -> Vec<BodyLabel> {
    let label = |body: &Body| BodyLabel {
        name: body.name().to_owned(),
        faces: body.faces().map(<[u32]>::to_vec),
    };
    sequence.bodies().iter().map(label).collect()
}

fn asked(arguments: &Arguments, sequence: &Sequence) -> &'static str {
    match (arguments.first, sequence.bodies().len(), arguments.itself) {
        (true, ..) => "the first pair of each frame",
        (_, 1, _) => "the body with itself",
        (_, _, true) => "the bodies with each other, and each with itself",
        _ => "the bodies with each other",
    }
}
