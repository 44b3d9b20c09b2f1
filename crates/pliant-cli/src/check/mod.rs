//! `pliant check`: somebody's meshes, frame by frame.

mod output;
mod pairs;
mod sequence;
pub(crate) mod size;

use crate::Outcome;
use anyhow::{Context, bail};
use clap::{Args, ValueEnum};
use output::Output;
use pairs::Pairs;
use pliant::{Options, Scalar, World};
use pliant_io::{OpenOptions, Precision};
use sequence::Sequence;
use std::num::NonZeroUsize;

#[derive(Args, Debug)]
#[command(after_help = EXIT_CODES)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "each is a flag of the program"
)]
pub(crate) struct Arguments {
    /// One body each: a mesh (.obj, .ply, .stl), a sequence (.npz), a mesh with its positions (mesh.obj+walk.pc2, .mdd), or a quoted pattern whose files in natural order are its frames ('cloth_*.obj'); each body of a glTF file (.glb, .gltf), or one of them (scene.glb#arm)
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
    /// The animation of glTF files, by name; the first if none is named
    #[arg(long, value_name = "NAME")]
    clip: Option<String>,
    /// Frames a second at which animations of glTF files are evaluated
    #[arg(long, value_name = "N", default_value = "30", value_parser = crate::convert::rate)]
    fps: f64,
    /// How many threads share the work; no number changes an answer
    #[arg(long, value_name = "T", default_value = "1")]
    threads: NonZeroUsize,
    /// A table by frame, or one JSON object
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
}

const EXIT_CODES: &str = "\
Exit code 0: nothing intersects. 1: something does. 2: it could not be checked; standard error says why.
Memory: at most 3.5 times two frames (positions and triangles) and 8 MB, however many frames there are; beside it 16 bytes for each pair that is listed, and what a glTF file says of shape and motion.";

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
            clip: arguments.clip.clone(),
            fps: arguments.fps,
        },
    )?;
    if arguments.clip.is_some() && sequence.bodies().iter().all(|body| body.clip().is_none()) {
        bail!("no body has an animation, so `--clip` has no meaning here");
    }
    match sequence.precision() {
        Precision::F32 => check_frames::<f32>(arguments, sequence),
        Precision::F64 => check_frames::<f64>(arguments, sequence),
    }
}

fn check_frames<S: Scalar + sequence::FromFile>(
    arguments: &Arguments,
    mut sequence: Sequence,
) -> anyhow::Result<Outcome> {
    let mut output = Output::begin(arguments, &sequence)?;
    let mut options = Options::default();
    options.threads = arguments.threads;
    let mut world = World::<S>::with_options(options);
    let listed = arguments.format == Format::Json && !arguments.count;
    let mut pairs = Pairs::new(listed, arguments.max_memory);
    let mut buffer = Vec::new();
    let checked = (0..sequence.frame_count()).try_for_each(|frame| {
        sequence.load_frame(frame, &mut world, &mut buffer)?;
        pairs
            .find(arguments, &mut world)
            .with_context(|| format!("frame {frame}"))?;
        output.frame(frame, &pairs)
    });
    output.end(checked)
}
