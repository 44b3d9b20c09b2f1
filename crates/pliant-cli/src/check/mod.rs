//! `pliant check`: somebody's meshes, frame by frame.

mod hits;
mod moments;
mod names;
mod output;
mod pictures;
pub(crate) mod size;

use crate::Outcome;
use crate::frames::Frames;
use crate::report::PictureOptions;
use crate::tree_options::at_least_one;
use anyhow::{anyhow, bail};
use clap::{Args, ValueEnum, ValueHint};
use hits::Hits;
use output::Output;
use pictures::Pictures;
use pliant::Options;
use pliant_check::{Baseline, Check, Error, Group, Settings};
use pliant_io::{OpenOptions, shown};
use std::num::NonZeroUsize;
use std::path::PathBuf;

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "each is a flag of the program"
)]
pub(crate) struct Arguments {
    /// One body each: a mesh (.obj, .ply, .stl), a sequence (.npz), a mesh with its positions (mesh.obj+walk.pc2, .mdd, .npy), or a quoted pattern whose files in natural order are its frames ('cloth_*.obj'); each body of a glTF file (.glb, .gltf, .vrm), or one of them (scene.glb#arm); a group of an OBJ file, a solid of an STL file, or of a pattern (scan.obj#arm)
    #[arg(value_name = "BODY", required = true, value_hint = ValueHint::FilePath)]
    bodies: Vec<String>,
    /// Check each body against itself too; one body alone always is
    #[arg(long = "self")]
    itself: bool,
    /// Instead of what intersects, the triangles of different bodies that are at most D apart, in the unit of the files; those that intersect are 0 apart. Of one body neighbours always are that close: not with --self
    #[arg(long, value_name = "D", allow_negative_numbers = true, value_parser = distance, conflicts_with = "png")]
    within: Option<f64>,
    /// Leave out places where surfaces only touch, as along a cut: where no triangles cross and no surface passes through another, not even exactly at edges and vertices. Where it is not clear what a side is, a place stays. Not with --within
    #[arg(long, conflicts_with = "within")]
    crossing: bool,
    /// Only these frames: 100..200 are 100 to 199; 100.. and ..200 are open; 100 is one; 100..200:10 is every tenth, and what meets on the way to the next goes ten frames on
    #[arg(
        long,
        value_name = "A..B:STEP",
        default_value = "..",
        allow_negative_numbers = true
    )]
    frames: Frames,
    /// Besides what intersects in a frame, what meets on the way from it to the next, every corner on a straight line: a vertex and a triangle, or two edges, and when first. Costs many times what a check of the frames alone does. Not with --within, --baseline, --hits, --format lines or github
    #[arg(long)]
    swept: bool,
    /// Only how many pairs, not which
    #[arg(long)]
    count: bool,
    /// Stop at the first pair of each frame; with --within the nearest pair; with --swept the first to meet on the way to the next, too
    #[arg(long)]
    first: bool,
    /// Make every connected piece of a file a body: FILE#1, FILE#2, ...; or every group of an OBJ file, every solid of an STL file: FILE#NAME; in the order of their lowest triangle. Triangles keep their numbers, and those that share a vertex of the file are left out
    #[arg(long, value_enum, value_name = "INTO")]
    split: Option<Split>,
    /// Give several bodies a name, for --ignore; each by its name, or by its number, from 0; a glTF file stands for all its bodies
    #[arg(long = "group", value_name = "NAME=BODY,BODY", value_parser = names::group)]
    groups: Vec<Group>,
    /// Bodies, or groups, that do not meet; A,A means that those of A do not meet each other, nor themselves
    #[arg(long, value_name = "A,B", value_parser = names::two)]
    ignore: Vec<Names>,
    /// Only what is new: leave out the pairs that intersect in this frame, from 0, or in any frame of an earlier check, whose --format json was written to a file
    #[arg(long, value_name = "FRAME|FILE", allow_negative_numbers = true, value_parser = names::baseline, value_hint = ValueHint::FilePath)]
    baseline: Option<Baseline>,
    /// Leave out pairs with a triangle that has no area
    #[arg(long)]
    skip_degenerate: bool,
    /// Keep vertices apart where boundary edges coincide; seams are then intersections
    #[arg(long)]
    no_weld: bool,
    /// Join boundary edges besides that are no further apart than TOL times the diagonal of their body, in each frame: 1e-6
    #[arg(
        long,
        value_name = "TOL",
        default_value = "0",
        allow_negative_numbers = true,
        conflicts_with = "no_weld"
    )]
    weld: f64,
    /// The most memory that a frame may take, seam finding included, and again that a list of pairs may (4GiB, 512MiB, 1G, bytes); a frame that says it is larger is refused before it is read
    #[arg(long, value_name = "SIZE", default_value = "4GiB", value_parser = size::parse)]
    max_memory: u64,
    /// The animation of glTF files, by name; the first if none is named
    #[arg(long, value_name = "NAME")]
    clip: Option<String>,
    /// Frames a second at which animations of glTF files are evaluated
    #[arg(long, value_name = "N", default_value = "30", allow_negative_numbers = true, value_parser = crate::convert::rate)]
    fps: f64,
    /// How many threads share the work; no number changes an answer
    #[arg(long, value_name = "T", default_value = "1", value_parser = at_least_one::<NonZeroUsize>)]
    threads: NonZeroUsize,
    /// A table by frame, one JSON object, annotations for GitHub Actions, or a line for each pair: FRAME BODY TRIANGLE BODY TRIANGLE
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
    /// Write the triangles that intersect for ParaView, a .vtp or .vtu; of several frames a file each, and a .pvd that names them
    #[arg(long, value_name = "FILE")]
    hits: Option<PathBuf>,
    /// Nothing on standard output: the exit code says it
    #[arg(short, long)]
    quiet: bool,
    #[command(flatten)]
    pictures: PictureOptions,
}

const EXAMPLES: &str = "\
Examples:
  pliant check shirt.ply body.ply hair.ply --ignore hair.ply,body.ply
  pliant check a.ply b.ply c.ply --group soft=a.ply,c.ply --ignore soft,soft
  pliant check a,1.ply b.ply c.ply --ignore 0,2      by number: one has a comma
  pliant check teeth.ply --split components          which pieces meet?
  pliant check teeth.ply --split components --ignore 'teeth.ply#1,teeth.ply#2'
  pliant check scan.obj --split groups               which objects meet?
  pliant check 'scan.obj#arm' 'scan.obj#sleeve'      two of them
  pliant check scene.glb --ignore 'scene.glb#arm,scene.glb#sleeve'
  pliant check fox.glb --clip Run --baseline 0       what frame 0 does not have
  pliant check new.ply --baseline old.json           what an older check had not
  pliant check part.stl --weld 1e-6                  corners nearly coincide
  pliant check left.ply right.ply --crossing         not what only touches
  pliant check walk.npz --report walk.html           a page: in motion, hits red
  pliant check walk.npz --png worst.png --frame 50   its largest place
  pliant check a.ply --png a.png --view top --size 800x600
  pliant check walk.npz --frames 100..200:10         every tenth of these
  pliant check walk.npz --hits hits.vtp              hits_00.vtp, ... (ParaView)
  pliant check shirt.ply skin.ply --within 0.002     nothing closer than 2 mm?
  pliant check shirt.npz skin.npz --swept            nothing jumps through?
  pliant check walk.npz --swept --report walk.html   with the moments of contact
  pliant check walk.npz --quiet && echo clean

With --swept all elements that meet on the way count, but those that meet in the frame before already. They are of both bodies where two share them. It looks from each frame to the next only: where a mesh changes in between, nothing moves, and that is said.
Exit code 0: nothing intersects, is as close as that, or meets on the way. 1: something does. 2: it could not be checked; standard error says why.
Memory: at most 3.5 times two frames (positions and triangles) and 12 MB, however many frames there are, 7.5 times two frames where the mesh changes from file to file, and 11 times with --swept; beside it the pairs of one frame, where they are listed, left out or written, their places (up to 60 bytes a vertex that is hit), with --crossing 32 bytes a pair and 200 a triangle near one, and of glTF bodies that move the rest positions, joints, deltas and keys.
Too much? Check fewer bodies at once, or with --count or --first; --max-memory refuses larger frames before they are read.";

/// `A,B`.
type Names = [String; 2];

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Split {
    Components,
    Groups,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    Table,
    Json,
    Github,
    Lines,
}

/// Checks all frames and prints what intersects.
pub(crate) fn check(arguments: &Arguments) -> anyhow::Result<Outcome> {
    if let Some(pattern) = pliant_io::looks_like_a_series(&arguments.bodies) {
        crate::complain(&format!(
            "note: {} arguments are {0} bodies; if they are frames of one body, quote the pattern: '{}'",
            arguments.bodies.len(),
            shown(&pattern)
        ));
    }
    can_be_swept(arguments).or_else(|error| output::annotate(arguments, error))?;
    let mut check = open(arguments).or_else(|error| {
        let error = advise_names(arguments, error);
        output::annotate(arguments, error)
    })?;
    for source in check.sources() {
        crate::note(source, arguments.quiet);
    }
    let over = arguments.pictures.over;
    let hits = arguments.hits.as_deref();
    let hits = hits.map(|path| Hits::new(path, check.frames(), over));
    let mut hits = hits.transpose()?;
    let mut pictures = Pictures::new(arguments, &check)?;
    let begun = check.begin();
    let sizes = unlike_sizes(&check);
    let mut output = Output::begin(arguments, &check)?;
    let checked = begun.map_err(anyhow::Error::from).and_then(|()| {
        let (hits, pictures) = (hits.as_mut(), &mut pictures);
        frames(arguments, &mut check, hits, pictures, &mut output)
    });
    let checked = checked.and_then(|()| hits.map_or(Ok(()), Hits::end));
    let drawn = pictures.end(arguments, &check, &checked);
    let outcome = output.end(&check, checked)?;
    drawn?;
    if !arguments.quiet {
        if let (Outcome::Clear, Some(sizes)) = (outcome, sizes) {
            crate::complain(&sizes);
        }
        at_seams(&check);
        parted_seams(&check, arguments.weld);
    }
    Ok(outcome)
}

/// What to say of bodies of very different sizes if nothing is found.
fn unlike_sizes(check: &Check) -> Option<String> {
    let [(large, most), (small, least)] = check.unlike_sizes()?;
    let [large, small] = [large, small].map(shown);
    let [most, least] = [most, least].map(output::short);
    Some(format!(
        "note: nothing was found, and the longest side of {large} is {most}, that of {small} {least}: are they of one unit?"
    ))
}

/// Refuses what has no form for what meets between two frames.
fn can_be_swept(arguments: &Arguments) -> anyhow::Result<()> {
    let other = match (&arguments.hits, arguments.format) {
        _ if !arguments.swept => return Ok(()),
        (Some(_), _) => "--hits writes the triangles that intersect in a frame",
        (_, Format::Lines) => "--format lines has a line for each pair of triangles",
        (_, Format::Github) => "--format github annotates places of frames",
        _ => return Ok(()),
    };
    bail!(
        "--swept: {other}, and has no room for what meets between two; leave out one of them, or use `--format table` or `--format json`"
    )
}

fn open(arguments: &Arguments) -> Result<Check, Error> {
    let reading = OpenOptions {
        weld: !arguments.no_weld,
        weld_tolerance: arguments.weld,
        max_memory: arguments.max_memory,
        clip: arguments.clip.clone(),
        fps: arguments.fps,
    };
    let mut options = Options::default();
    options.threads = arguments.threads;
    let settings = Settings {
        itself: arguments.itself,
        within: arguments.within,
        crossing: arguments.crossing,
        swept: arguments.swept,
        closest_points: arguments.pictures.any(),
        max_list: arguments.max_memory,
        split: arguments.split.map(|split| match split {
            Split::Components => pliant_check::Split::Components,
            Split::Groups => pliant_check::Split::Groups,
        }),
        groups: arguments.groups.clone(),
        ignore: arguments.ignore.clone(),
        baseline: arguments.baseline.clone(),
        skip_degenerate: arguments.skip_degenerate,
        places: finds_places(arguments),
        frames: Some(arguments.frames.to_check()),
        options,
        ..Settings::default()
    };
    Check::open(&arguments.bodies, &reading, &settings)
}

/// A distance that triangles may have from each other.
fn distance(text: &str) -> Result<f64, String> {
    let distance = text.parse().ok();
    distance
        .filter(|distance: &f64| *distance >= 0.0 && distance.is_finite())
        .ok_or_else(|| "write a distance in the unit of the files, at least 0: 0.002".to_owned())
}

/// Whether anything shows places.
fn finds_places(arguments: &Arguments) -> bool {
    let printed = !arguments.quiet && !arguments.count && arguments.format != Format::Lines;
    printed || arguments.pictures.any()
}

fn frames(
    arguments: &Arguments,
    check: &mut Check,
    mut hits: Option<&mut Hits>,
    pictures: &mut Pictures,
    output: &mut Output,
) -> anyhow::Result<()> {
    let Arguments {
        first,
        count,
        quiet,
        format,
        ..
    } = *arguments;
    let printed = !quiet && !count && matches!(format, Format::Json | Format::Lines);
    let mut numbers = check.frames();
    loop {
        let frame = numbers.next().unwrap_or_default();
        let kept = hits.is_some() || pictures.looks_at(frame);
        // Where only the exit code is asked for, one pair says as much as all.
        check.ask(first || quiet && !kept, kept || printed);
        let Some(found) = check.next_frame()? else {
            break;
        };
        output.frame(check, &found)?;
        if let Some(hits) = &mut hits {
            hits.frame(check, &found)?;
        }
        pictures.frame(check, &found)?;
        let listed = printed && format == Format::Json || pictures.shows_moments();
        check.ask(first || quiet && !pictures.shows_moments(), listed);
        if let Some(interval) = check.next_interval()? {
            output.interval(check, &interval)?;
            pictures.interval(check, &interval);
        }
    }
    Ok(())
}

/// Says where pairs lie at seams that are not quite closed.
fn at_seams(check: &Check) {
    for (number, source) in check.sources().iter().enumerate() {
        if let Some(at_seams) = check.at_seams(number) {
            crate::complain(&format!(
                "note: {}: {} of its {} pairs with itself in frame {} lie where boundary edges nearly coincide, up to {:.1e} of its size apart; if those are seams, `--weld {:e}` joins them",
                shown(source.name()),
                at_seams.pairs,
                at_seams.of,
                at_seams.frame,
                at_seams.farthest,
                at_seams.tolerance()
            ));
        }
    }
}

/// Says where seams part from frame to frame.
fn parted_seams(check: &Check, tolerance: f64) {
    for (number, source) in check.sources().iter().enumerate() {
        if let Some(parted) = check.parted(number) {
            let advice = match parted.tolerance() {
                better if better > tolerance => {
                    format!("; `--weld {better:e}` keeps together what parts by rounding")
                }
                _ => String::new(),
            };
            let name = shown(source.name());
            crate::complain(&format!("note: {name}: {parted}{advice}"));
        }
    }
}

/// With what to do about the name of a piece, `FILE#1`, or of a group, `FILE.obj#NAME`, where no file is split; the error itself where
/// it is none.
fn advise_names(arguments: &Arguments, error: Error) -> anyhow::Error {
    match &error {
        Error::NoSuchName { name, .. }
            if arguments.split.is_none() && names::is_of_a_piece(name) =>
        {
            anyhow!(
                "{error}; choose one of these, or make the pieces of every file bodies with `--split components`"
            )
        }
        Error::NoSuchName { name, .. }
            if arguments.split.is_none() && pliant_io::group_argument(name).is_some() =>
        {
            anyhow!(
                "{error}; choose one of these, or make the groups of OBJ files bodies with `--split groups`"
            )
        }
        _ => error.into(),
    }
}
