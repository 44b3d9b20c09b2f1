//! Annotations for GitHub Actions: the runner reads `::error file=...::message` from standard output.
//!
//! One for each of the first frames that intersect, on the file of the frame; then a summary. The runner shows ten errors of a
//! step, so no more are printed.

use super::{Form, Tally, counted};
use crate::advice;
use crate::table::grouped;
use pliant_check::{Check, Found, Row};
use pliant_io::{shown, shown_within};
use std::io::{self, Write};

/// So many errors of one step are shown.
const MOST_ANNOTATIONS: usize = 10;

#[derive(Default)]
pub(super) struct Github {
    annotated: usize,
}

impl Form for Github {
    fn head(&mut self, _: &mut dyn Write, _: &Check) -> io::Result<()> {
        Ok(())
    }

    fn frame(&mut self, out: &mut dyn Write, check: &Check, found: &Found) -> io::Result<()> {
        let Some([body_a, a, body_b, b]) = found.smallest else {
            return Ok(());
        };
        if self.annotated == MOST_ANNOTATIONS {
            return Ok(());
        }
        self.annotated += 1;
        let file = file_of(check, found.frame, [body_a, a, body_b, b]);
        let file = file.map_or_else(String::new, |file| format!("file={},", property(&file)));
        let name = |body| {
            check
                .body(body)
                .map_or_else(String::new, |body| shown(body.name))
        };
        let pairs = if found.complete {
            counted((
                found.count,
                "pair of triangles intersects",
                "pairs of triangles intersect",
            ))
        } else {
            "at least 1 pair of triangles intersects".to_owned()
        };
        let left_out = match found.left_out {
            Some(left_out @ 1..) => format!(" ({} more left out)", grouped(left_out as u64)),
            _ => String::new(),
        };
        let message = format!(
            "frame {}: {pairs}{left_out}; the first: triangle {a} of {} and triangle {b} of {}",
            found.frame,
            name(body_a),
            name(body_b)
        );
        writeln!(out, "::error {file}title=pliant::{}", data(&message))
    }

    fn end(
        &mut self,
        out: &mut dyn Write,
        tally: &Tally,
        error: Option<&anyhow::Error>,
    ) -> io::Result<()> {
        if let Some(error) = error {
            return out.write_all(failure(error).as_bytes());
        }
        write!(out, "pliant: {}", tally.summary())?;
        if tally.intersecting > MOST_ANNOTATIONS {
            write!(out, "; the first {MOST_ANNOTATIONS} are annotated")?;
        }
        writeln!(out)
    }
}

/// That the check could not begin, or go on.
pub(super) fn failure(error: &anyhow::Error) -> String {
    format!(
        "::error title=pliant::{}\n",
        data(&advice::with_advice(error))
    )
}

/// The file of the frame of the source with the first triangle, or the only one that it has.
fn file_of(check: &Check, frame: usize, [body, ..]: Row) -> Option<String> {
    let source = &check.sources()[check.source_of(body)?];
    let file = source.frame_file(frame).or_else(|| source.frame_file(0))?;
    // Whole: the runner looks for the file.
    Some(shown_within(file, usize::MAX))
}

/// What a message, which is a line already, may hold: `%` begins an escape.
fn data(text: &str) -> String {
    let escaped = text.chars().map(|c| match c {
        '%' => "%25".to_owned(),
        c => c.to_string(),
    });
    escaped.collect()
}

/// What a property may hold: colons and commas end it.
fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}
