//! `pliant check`: somebody's meshes, frame by frame.

mod output;
mod sequence;

use crate::Outcome;
use clap::{Args, ValueEnum};
use output::Output;
use pliant::{Scalar, World};
use pliant_io::{OpenOptions, Precision};
use sequence::Sequence;

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
    /// A table by frame, or one JSON object
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
}

const EXIT_CODES: &str = "\
Exit code 0: nothing intersects. 1: something does. 2: it could not be checked; standard error says why.";

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
            ..OpenOptions::default()
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
    let mut output = Output::begin(arguments, &sequence)?;
    let mut world = World::<S>::new();
    let (mut buffer, mut pairs) = (Vec::new(), Vec::new());
    let checked = (0..sequence.frame_count()).try_for_each(|frame| {
        sequence.load_frame(frame, &mut world, &mut buffer)?;
        find_pairs(arguments, &mut world, &mut pairs)?;
        output.frame(frame, &pairs)
    });
    output.end(checked)
}

/// (body, triangle, body, triangle), sorted; at most one of them if only the first is asked for.
fn find_pairs<S: Scalar>(
    arguments: &Arguments,
    world: &mut World<S>,
    pairs: &mut Vec<[u32; 4]>,
) -> anyhow::Result<()> {
    let bodies: Vec<_> = world.bodies().collect();
    let itself = arguments.itself || bodies.len() == 1;
    pairs.clear();
    if arguments.first {
        pairs.extend(world.first_intersection().map(row));
    } else {
        pairs.extend(world.intersection_pairs().iter().copied().map(row));
    }
    for body in bodies.into_iter().filter(|_| itself) {
        let of_body = |[a, b]: [u32; 2]| [body.0, a, body.0, b];
        if !arguments.first {
            pairs.extend(
                world
                    .self_intersection_pairs(body)?
                    .iter()
                    .copied()
                    .map(of_body),
            );
        } else if pairs.is_empty() {
            pairs.extend(world.first_self_intersection(body)?.map(of_body));
        }
    }
    pairs.sort_unstable();
    Ok(())
}

fn row(pair: pliant::Pair) -> [u32; 4] {
    [
        pair.body_a.0,
        pair.triangle_a,
        pair.body_b.0,
        pair.triangle_b,
    ]
}
