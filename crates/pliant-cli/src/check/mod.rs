//! `pliant check`: checks meshes and sequences frame by frame.

mod adjacent;
mod arguments;
mod figures;
mod hits;
mod list_arguments;
pub(crate) mod many;
mod moments;
mod names;
mod output;
mod pictures;
mod settings;

pub(crate) use arguments::Arguments;

use crate::outcome::Outcome;
use crate::table::short;
use crate::terminal::{complain, note};
use anyhow::{anyhow, bail};
use arguments::Format;
use hits::Hits;
use output::Output;
use pictures::Pictures;
use pliant_check::{Baseline, Check, Error};
use pliant_io::{Files, shown};
use settings::settings;

/// Checks all frames and prints what intersects.
pub(crate) fn check(arguments: &Arguments) -> anyhow::Result<Outcome> {
    if let Some(outcome) = many::check(arguments) {
        return outcome;
    }
    if let Some(pattern) = pliant_io::looks_like_a_series(&arguments.bodies) {
        complain(&format!(
            "note: {} arguments are {0} bodies; \
             if they are frames of one body, quote the pattern: '{}'",
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
        note(source, arguments.quiet);
    }
    if let (Some(Baseline::File(file)), true, false) =
        (&arguments.baseline, check.lacks_adjacent(), arguments.quiet)
    {
        complain(&format!(
            "note: {} has no pairs that share a vertex, so all of these count as new; \
             write it again, or leave them out with `--ignore-adjacent`",
            shown(file)
        ));
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
            complain(&sizes);
        }
        at_seams(&check);
        parted_seams(&check, arguments.weld);
    }
    Ok(outcome)
}

/// A note about bodies of very different sizes, for a check that finds nothing.
fn unlike_sizes(check: &Check) -> Option<String> {
    let [(large, most), (small, least)] = check.unlike_sizes()?;
    let [large, small] = [large, small].map(shown);
    let [most, least] = [most, least].map(short);
    Some(format!(
        "note: nothing was found, and the longest side of {large} is {most}, \
         that of {small} {least}: are they of one unit?"
    ))
}

/// Refuses output formats that cannot express contacts between two frames.
fn can_be_swept(arguments: &Arguments) -> anyhow::Result<()> {
    let other = match (&arguments.hits, arguments.format) {
        _ if !arguments.swept => return Ok(()),
        (Some(_), _) => "--hits writes the triangles that intersect in a frame",
        (_, Format::Lines) => "--format lines has a line for each pair of triangles",
        (_, Format::Github) => "--format github annotates places of frames",
        _ => return Ok(()),
    };
    bail!(
        "--swept: {other}, and has no room for what meets between two; \
         leave out one of them, or use `--format table` or `--format json`"
    )
}

fn open(arguments: &Arguments) -> Result<Check, Error> {
    let (reading, settings) = settings(arguments);
    Check::open(&arguments.bodies, &reading, &settings)
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
        // For the exit code alone, one pair says as much as all.
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

/// Prints notes about pairs at seams that are not quite closed.
fn at_seams(check: &Check) {
    for (number, source) in check.sources().iter().enumerate() {
        if let Some(at_seams) = check.at_seams(number) {
            complain(&format!(
                "note: {}: {} of its {} pairs with itself in frame {} lie where boundary edges \
                 nearly coincide, up to {:.1e} of its size apart; if those are seams, \
                 `--weld {:e}` joins them",
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

/// Prints notes about seams that part from frame to frame.
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
            complain(&format!("note: {name}: {parted}{advice}"));
        }
    }
}

/// Adds advice to an error about an unknown name of a piece or group, where no file is split.
///
/// Pieces are named `FILE#1`, groups `FILE.obj#NAME`. Returns all other errors unchanged.
fn advise_names(arguments: &Arguments, error: Error) -> anyhow::Error {
    match &error {
        Error::NoSuchName { name, .. }
            if arguments.split.is_none() && names::is_of_a_piece(name) =>
        {
            anyhow!(
                "{error}; choose one of these, \
                 or make the pieces of every file bodies with `--split components`"
            )
        }
        Error::NoSuchName { name, .. }
            if arguments.split.is_none()
                && pliant_io::group_argument(name, &Files::default()).is_some() =>
        {
            anyhow!(
                "{error}; choose one of these, \
                 or make the groups of OBJ files bodies with `--split groups`"
            )
        }
        _ => error.into(),
    }
}
