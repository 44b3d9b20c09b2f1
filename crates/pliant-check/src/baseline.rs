//! Reader of a baseline file: pairs of an earlier check, as `pliant check --format json` wrote
//! them.
//!
//! A pair of any frame of the file is left out of all frames. Bodies are matched by name and number
//! of triangles, not by their numbers. A file that lacks pairs, or names other bodies, is refused.

use crate::bodies::Bodies;
use crate::error::{Error, quoted};
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
    frame: Option<usize>,
    /// `None` between frames whose meshes differ.
    count: Option<usize>,
    complete: Option<bool>,
    pairs: Option<Vec<Row>>,
    /// `None` in files from before such pairs were found, or where they were not asked for.
    adjacent: Option<usize>,
    adjacent_pairs: Option<Vec<Row>>,
    changed: Option<serde::de::IgnoredAny>,
    /// Present in intervals between frames only.
    until: Option<serde::de::IgnoredAny>,
}

/// Known pairs, sorted: those that share no vertex, and those that do.
#[derive(Clone, Debug, Default)]
pub(crate) struct Known {
    pub(crate) pairs: Vec<Row>,
    /// `None` if the baseline does not have them.
    pub(crate) adjacent: Option<Vec<Row>>,
}

/// Reads the pairs, sorted, with the bodies' current numbers. `most` is the limit of the file's
/// size, in bytes.
pub(crate) fn read(
    path: &Path,
    sources: &[Source],
    bodies: &Bodies,
    most: u64,
) -> Result<Known, Error> {
    let bad = |why: String| Error::BadBaseline {
        file: path.to_owned(),
        why,
    };
    let written = parse(path, most).map_err(bad)?;
    let names = Names::new(sources, bodies, &[])?;
    let mut numbers = Vec::new();
    for (body, place) in written.bodies.iter().zip(0..) {
        let name = quoted(&body.name);
        let Some(number) = names.of_body(&body.name) else {
            return Err(bad(format!(
                "its body {place}, {name}, is not checked here: {}",
                names.unknown("body", &body.name)
            )));
        };
        let triangles = bodies.facts(sources, number).triangles;
        if triangles != body.triangles {
            return Err(bad(format!(
                "its body {place}, {name}, has {} triangles there and {triangles} here, and pairs \
                 are known for the same mesh only",
                body.triangles
            )));
        }
        numbers.push(number);
    }
    let now = |body: u32, triangle: u32| {
        let Some(&number) = numbers.get(body as usize) else {
            return Err(format!(
                "there is no body {body}; its bodies are 0 to {}",
                numbers.len().saturating_sub(1)
            ));
        };
        let source = bodies.source_of(number);
        let is_there = (triangle as usize) < sources[source].triangles().len()
            && bodies.of_triangle(source as u32, triangle) == Some(number);
        if is_there {
            return Ok((number, triangle));
        }
        let facts = bodies.facts(sources, number);
        Err(format!(
            "body {body}, {}, has no triangle {triangle}; it has {}, the first is {}",
            quoted(&facts.name),
            facts.triangles,
            facts.first_triangle
        ))
    };
    let row_now = |[body_a, a, body_b, b]: Row| {
        let (one, other) = (now(body_a, a)?, now(body_b, b)?);
        let ((body_a, a), (body_b, b)) = (one.min(other), one.max(other));
        Ok([body_a, a, body_b, b])
    };
    let rows_of = |list: fn(&WrittenFrame) -> &Option<Vec<Row>>, what: &str| {
        let mut rows = Vec::new();
        for (frame, place) in written.frames.iter().zip(0..) {
            for (&row, pair) in list(frame).iter().flatten().zip(0_usize..) {
                let row_now = row_now(row);
                let of_frame = frame.frame.unwrap_or(place);
                let why =
                    |why: String| bad(format!("frame {of_frame}, {what} {pair}, {row:?}: {why}"));
                rows.push(row_now.map_err(why)?);
            }
        }
        rows.sort_unstable();
        rows.dedup();
        Ok::<_, Error>(rows)
    };
    let mut frames = written.frames.iter();
    let has_adjacent = frames.all(|frame| frame.adjacent_pairs.is_some());
    Ok(Known {
        pairs: rows_of(|frame| &frame.pairs, "pair")?,
        adjacent: if has_adjacent {
            Some(rows_of(|frame| &frame.adjacent_pairs, "adjacent pair")?)
        } else {
            None
        },
    })
}

/// Parses the file, and refuses it if it lacks pairs.
fn parse(path: &Path, most: u64) -> Result<Written, String> {
    let is_file = path
        .metadata()
        .map_err(|error| error.to_string())?
        .is_file();
    if !is_file {
        return Err("it is not a regular file".into());
    }
    let file = File::open(path).map_err(|error| error.to_string())?;
    // Reading is bounded, not the length in the metadata: the file may grow.
    let mut text = Vec::new();
    let read = BufReader::new(file)
        .take(most.saturating_add(1))
        .read_to_end(&mut text);
    read.map_err(|error| error.to_string())?;
    if text.len() as u64 > most {
        return Err(format!(
            "it has more than {most} bytes, the most that it may take"
        ));
    }
    let mut written: Written = serde_json::from_slice(&text)
        .map_err(|error| format!("it is not the JSON that a check writes: {error}"))?;
    drop(text);
    // Impacts between frames are not pairs of triangles.
    written.frames.retain(|frame| frame.until.is_none());
    if written.format != 1 {
        return Err(format!(
            "it has format {}, and only format 1 is read",
            written.format
        ));
    }
    if let Some(error) = &written.error {
        return Err(format!("the check that wrote it failed: {error}"));
    }
    for (frame, place) in written.frames.iter().zip(0..) {
        let number = frame.frame.unwrap_or(place);
        if frame.changed.is_some() {
            return Err(format!(
                "in its frame {number} a mesh is another than before, and its triangles have other \
                 numbers; a baseline needs meshes that stay"
            ));
        }
        let differ = |count: usize, list: &Option<Vec<Row>>, pairs: &str| {
            let listed = list.as_ref().map_or(0, Vec::len);
            (count != listed).then(|| {
                format!(
                    "in its frame {number} it counts {count} {pairs} and lists {listed}; write it \
                     again with all of them"
                )
            })
        };
        let adjacent = frame.adjacent.unwrap_or_default();
        if let Some(why) = differ(adjacent, &frame.adjacent_pairs, "adjacent pairs") {
            return Err(why);
        }
        if let Some(count) = frame.count
            && let Some(why) = differ(count, &frame.pairs, "pairs")
        {
            return Err(why);
        }
        match frame.count {
            Some(_) if frame.complete != Some(false) => {}
            _ => {
                return Err(format!(
                    "it does not have all pairs of its frame {number}; write it again with all of \
                     them"
                ));
            }
        }
    }
    Ok(written)
}
