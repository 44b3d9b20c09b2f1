//! What `pliant check` prints, frame by frame as it goes: a table for people, or one JSON object.
//!
//! ```json
//! {"format":1,"bodies":[{"name":"a.ply","vertices":8,"triangles":12}],
//!  "frames":[{"frame":0,"count":1,"pairs":[[0,3,0,9]]}]}
//! ```
//!
//! All numbers count from 0; a pair is body, triangle, body, triangle, the smaller (body, triangle) first, sorted. `faces` of a
//! body (triangle to polygon) stands where its polygons were made into fans, `welded` where vertices were welded away. With
//! `--count` there are no `pairs`; with `--first`, `count` is 0 or 1 and `"complete": false` says that the list was not meant
//! to be complete. If a frame cannot be checked, the object ends with `"error"`.

use super::pairs::Pairs;
use super::sequence::Sequence;
use super::{Arguments, Format};
use crate::Outcome;
use anyhow::Context;
use pliant_io::Body;
use serde::Serialize;
use std::io::{self, BufWriter, Stdout, Write};

/// What a failing write is the failure of.
const WRITING: &str = "cannot write to standard output";

/// Where answers go.
pub(super) struct Output {
    out: BufWriter<Stdout>,
    format: Format,
    count_only: bool,
    first_only: bool,
    frames: usize,
    intersecting: usize,
    /// The frame with the most pairs, and their number.
    worst: Option<(usize, usize)>,
}

#[derive(Serialize)]
struct BodyEntry<'a> {
    name: &'a str,
    vertices: usize,
    triangles: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    faces: Option<&'a [u32]>,
    #[serde(skip_serializing_if = "is_zero")]
    welded: usize,
}

#[derive(Serialize)]
struct FrameEntry<'a> {
    frame: usize,
    count: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    complete: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pairs: Option<&'a [[u32; 4]]>,
}

#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "the signature is serde's"
)]
fn is_zero(number: &usize) -> bool {
    *number == 0
}

impl Output {
    /// Prints what is known before the first frame.
    pub(super) fn begin(arguments: &Arguments, sequence: &Sequence) -> anyhow::Result<Self> {
        let mut output = Self {
            out: BufWriter::new(io::stdout()),
            format: arguments.format,
            count_only: arguments.count,
            first_only: arguments.first,
            frames: 0,
            intersecting: 0,
            worst: None,
        };
        output
            .print_head(arguments, sequence.bodies())
            .context(WRITING)?;
        Ok(output)
    }

    fn print_head(&mut self, arguments: &Arguments, bodies: &[Body]) -> io::Result<()> {
        let out = &mut self.out;
        if self.format == Format::Json {
            let entries: Vec<_> = bodies.iter().map(entry).collect();
            write!(out, r#"{{"format":1,"bodies":"#)?;
            serde_json::to_writer(&mut *out, &entries)?;
            return write!(out, r#","frames":["#);
        }
        for (number, body) in bodies.iter().enumerate() {
            let [vertices, triangles] = [
                (body.vertex_count(), "vertex", "vertices"),
                (body.triangles().len(), "triangle", "triangles"),
            ]
            .map(counted);
            write!(
                out,
                "body {number}: {}, {vertices}, {triangles}",
                printable(body.name())
            )?;
            if body.welded() > 0 {
                let welded = counted((body.welded(), "vertex", "vertices"));
                write!(out, ", {welded} welded where boundary edges coincide")?;
            }
            writeln!(out)?;
        }
        let asked = match (bodies.len(), arguments.itself) {
            (1, _) => "the body with itself",
            (_, true) => "the bodies with each other, and each with itself",
            (_, false) => "the bodies with each other, not with themselves",
        };
        let first_pair = if self.count_only { "" } else { "  first pair" };
        writeln!(
            out,
            "checked: {asked}\n\n{:>8}{:>10}{first_pair}",
            "frame", "pairs"
        )
    }

    /// Prints one frame.
    pub(super) fn frame(&mut self, frame: usize, pairs: &Pairs) -> anyhow::Result<()> {
        self.print_frame(frame, pairs).context(WRITING)?;
        let count = pairs.count;
        self.frames += 1;
        self.intersecting += usize::from(count > 0);
        if count > self.worst.map_or(0, |(_, most)| most) {
            self.worst = Some((frame, count));
        }
        Ok(())
    }

    fn print_frame(&mut self, frame: usize, pairs: &Pairs) -> io::Result<()> {
        let count = pairs.count;
        let out = &mut self.out;
        if self.format == Format::Json {
            let complete = self.first_only.then_some(false);
            let entry = FrameEntry {
                frame,
                count,
                complete,
                pairs: (!self.count_only).then_some(&pairs.list),
            };
            let separator = if self.frames > 0 { "," } else { "" };
            writeln!(out, "{separator}")?;
            serde_json::to_writer(&mut *out, &entry)?;
        } else {
            write!(out, "{frame:>8}{count:>10}")?;
            if let Some([body_a, a, body_b, b]) = pairs.smallest.filter(|_| !self.count_only) {
                write!(
                    out,
                    "  triangle {a} of body {body_a}, triangle {b} of body {body_b}"
                )?;
            }
            writeln!(out)?;
        }
        // Someone is looking, or reading: each frame is shown when it is done.
        out.flush()
    }

    /// Prints the end, of a check that was completed or of one that could not be.
    pub(super) fn end(mut self, checked: anyhow::Result<()>) -> anyhow::Result<Outcome> {
        let printed = self.print_end(checked.as_ref().err()).context(WRITING);
        // If both went wrong, what stopped the check comes first.
        checked.and(printed)?;
        Ok(if self.intersecting > 0 {
            Outcome::Intersects
        } else {
            Outcome::Clear
        })
    }

    fn print_end(&mut self, error: Option<&anyhow::Error>) -> io::Result<()> {
        let out = &mut self.out;
        match (self.format, error) {
            (Format::Json, None) => writeln!(out, "\n]}}")?,
            (Format::Json, Some(error)) => {
                writeln!(
                    out,
                    "\n],\"error\":{}}}",
                    serde_json::to_string(&format!("{error:#}"))?
                )?;
            }
            (Format::Table, None) => {
                write!(
                    out,
                    "\n{} of {} frames intersect",
                    self.intersecting, self.frames
                )?;
                if let Some((frame, count)) = self.worst.filter(|_| !self.first_only) {
                    write!(out, "; most pairs: {count} in frame {frame}")?;
                }
                writeln!(out)?;
            }
            (Format::Table, Some(_)) => {}
        }
        out.flush()
    }
}

/// `1 vertex`, `2 vertices`.
fn counted((number, one, many): (usize, &str, &str)) -> String {
    format!("{number} {}", if number == 1 { one } else { many })
}

/// A name without characters that would steer a terminal.
fn printable(name: &str) -> String {
    name.chars()
        .flat_map(|c| {
            if c.is_control() {
                c.escape_default().collect::<Vec<_>>()
            } else {
                vec![c]
            }
        })
        .collect()
}

fn entry(body: &Body) -> BodyEntry<'_> {
    BodyEntry {
        name: body.name(),
        vertices: body.vertex_count(),
        triangles: body.triangles().len(),
        faces: body.faces(),
        welded: body.welded(),
    }
}
