//! Reader of a baseline file: pairs of an earlier check, as `pliant check --format json` wrote
//! them.
//!
//! A pair of any frame of the file is left out of all frames. Bodies are matched by name and number
//! of triangles, not by their numbers. A file that lacks pairs, or names other bodies, is refused.

use crate::bodies::Bodies;
use crate::error::Error;
use crate::filter::Names;
use crate::row::Row;
use pliant_io::Body as Source;
use serde::Deserialize;
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

/// The parts of the file that are read.
#[derive(Deserialize)]
struct Written {
    format: u64,
    bodies: Vec<WrittenBody>,
    frames: Vec<WrittenFrame>,
    error: Option<String>,
}

#[derive(Deserialize)]
struct WrittenBody {
    name: String,
    triangles: usize,
}

#[derive(Deserialize)]
struct WrittenFrame {
    /// `None` between frames whose meshes differ.
    count: Option<usize>,
    complete: Option<bool>,
    pairs: Option<Vec<Row>>,
    changed: Option<serde::de::IgnoredAny>,
    /// Present in intervals between frames only.
    until: Option<serde::de::IgnoredAny>,
}

/// Reads the pairs, sorted, with the bodies' current numbers. `most` is the limit of the file's
/// size, in bytes.
pub(crate) fn read(
    path: &Path,
    sources: &[Source],
    bodies: &Bodies,
    most: u64,
) -> Result<Vec<Row>, Error> {
    let bad = |why: String| Error::BadBaseline {
        file: path.to_owned(),
        why,
    };
    let written = parse(path, most).map_err(bad)?;
    let names = Names::new(sources, bodies, &[])?;
    let mut numbers = Vec::new();
    for body in &written.bodies {
        let Some(number) = names.of_body(&body.name) else {
            return Err(bad(names.unknown("body", &body.name).to_string()));
        };
        let triangles = bodies.facts(sources, number).triangles;
        if triangles != body.triangles {
            return Err(bad(format!(
                "{} has {} triangles there, and {triangles} here",
                crate::error::quoted(&body.name),
                body.triangles
            )));
        }
        numbers.push(number);
    }
    let row_now = |[body_a, a, body_b, b]: Row| {
        let now = |body: u32, triangle: u32| {
            let number = *numbers.get(body as usize)?;
            let source = bodies.source_of(number);
            let is_there = (triangle as usize) < sources[source].triangles().len()
                && bodies.of_triangle(source as u32, triangle) == Some(number);
            is_there.then_some((number, triangle))
        };
        let (one, other) = (now(body_a, a)?, now(body_b, b)?);
        let ((body_a, a), (body_b, b)) = (one.min(other), one.max(other));
        Some([body_a, a, body_b, b])
    };
    let pairs = written.frames.into_iter().filter_map(|frame| frame.pairs);
    let rows = pairs.flatten().map(row_now).collect::<Option<Vec<_>>>();
    let mut rows =
        rows.ok_or_else(|| bad("a pair of it names a triangle that is not there".into()))?;
    rows.sort_unstable();
    rows.dedup();
    Ok(rows)
}

/// Parses the file, and refuses it if it lacks pairs.
fn parse(path: &Path, most: u64) -> Result<Written, String> {
    let is_file = path
        .metadata()
        .map_err(|error| error.to_string())?
        .is_file();
    if !is_file {
        return Err("it is no file".into());
    }
    let file = File::open(path).map_err(|error| error.to_string())?;
    // Reading is bounded, not the length in the metadata: the file may grow.
    let mut text = Vec::new();
    let read = BufReader::new(file)
        .take(most.saturating_add(1))
        .read_to_end(&mut text);
    read.map_err(|error| error.to_string())?;
    if text.len() as u64 > most {
        return Err("it is larger than is allowed".into());
    }
    let mut written: Written = serde_json::from_slice(&text)
        .map_err(|error| format!("it is not what a check writes as JSON ({error})"))?;
    drop(text);
    // Impacts between frames are not pairs of triangles.
    written.frames.retain(|frame| frame.until.is_none());
    let has_all = |frame: &WrittenFrame| {
        frame.complete != Some(false)
            && frame.pairs.as_ref().map(Vec::len).or(Some(0)) == frame.count
    };
    if written.format != 1 {
        return Err(format!(
            "it has format {}, which is not known",
            written.format
        ));
    }
    if written.error.is_some() {
        return Err("the check that wrote it failed".into());
    }
    if written.frames.iter().any(|frame| frame.changed.is_some()) {
        return Err("a mesh changes in it from frame to frame, and so do its triangles".into());
    }
    if !written.frames.iter().all(has_all) {
        return Err(
            "it does not list all pairs that it counted; write it again with all of them".into(),
        );
    }
    Ok(written)
}
