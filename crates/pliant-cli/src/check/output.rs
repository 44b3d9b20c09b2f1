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

use super::Format;
use super::sequence::Sequence;
use crate::Outcome;
use pliant_io::Body;
use serde::Serialize;
use std::io::{self, BufWriter, Stdout, Write};

/// One frame's answer.
pub(super) struct Frame {
    pub(super) frame: usize,
    pub(super) pairs: Vec<[u32; 4]>,
}

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
    pub(super) fn begin(
        format: Format,
        count_only: bool,
        first_only: bool,
        sequence: &Sequence,
    ) -> anyhow::Result<Self> {
        let mut out = BufWriter::new(io::stdout());
        let bodies = sequence.bodies();
        match format {
            Format::Json => {
                let entries: Vec<_> = bodies.iter().map(entry).collect();
                write!(
                    out,
                    r#"{{"format":1,"bodies":{},"frames":["#,
                    serde_json::to_string(&entries)?
                )?;
            }
            Format::Table => {
                for (number, body) in bodies.iter().enumerate() {
                    let (vertices, triangles) = (body.vertex_count(), body.triangles().len());
                    write!(
                        out,
                        "body {number}: {}, {vertices} vertices, {triangles} triangles",
                        body.name()
                    )?;
                    if body.welded() > 0 {
                        write!(
                            out,
                            ", {} vertices welded where boundary edges coincide",
                            body.welded()
                        )?;
                    }
                    writeln!(out)?;
                }
                let first_pair = if count_only { "" } else { "  first pair" };
                writeln!(out, "\n{:>8}{:>10}{first_pair}", "frame", "pairs")?;
            }
        }
        Ok(Self {
            out,
            format,
            count_only,
            first_only,
            frames: 0,
            intersecting: 0,
            worst: None,
        })
    }

    /// Prints one frame.
    pub(super) fn frame(&mut self, answer: &Frame) -> anyhow::Result<()> {
        let Frame { frame, pairs } = answer;
        let count = pairs.len();
        match self.format {
            Format::Json => {
                let entry = FrameEntry {
                    frame: *frame,
                    count,
                    complete: self.first_only.then_some(false),
                    pairs: (!self.count_only).then_some(pairs),
                };
                let separator = if self.frames > 0 { "," } else { "" };
                write!(self.out, "{separator}\n{}", serde_json::to_string(&entry)?)?;
            }
            Format::Table => {
                write!(self.out, "{frame:>8}{count:>10}")?;
                if let Some([body_a, a, body_b, b]) = pairs.first().filter(|_| !self.count_only) {
                    write!(
                        self.out,
                        "  triangle {a} of body {body_a}, triangle {b} of body {body_b}"
                    )?;
                }
                writeln!(self.out)?;
                // Someone is looking: a long sequence shows each frame when it is done.
                self.out.flush()?;
            }
        }
        self.frames += 1;
        self.intersecting += usize::from(count > 0);
        if count > self.worst.map_or(0, |(_, most)| most) {
            self.worst = Some((*frame, count));
        }
        Ok(())
    }

    /// Prints the end, of a check that was completed or of one that could not be.
    pub(super) fn end(mut self, checked: anyhow::Result<()>) -> anyhow::Result<Outcome> {
        match (self.format, &checked) {
            (Format::Json, Ok(())) => writeln!(self.out, "\n]}}")?,
            (Format::Json, Err(error)) => {
                writeln!(
                    self.out,
                    "\n],\"error\":{}}}",
                    serde_json::to_string(&format!("{error:#}"))?
                )?;
            }
            (Format::Table, Ok(())) => {
                write!(
                    self.out,
                    "\n{} of {} frames intersect",
                    self.intersecting, self.frames
                )?;
                match self.worst.filter(|_| !self.first_only) {
                    Some((frame, count)) => {
                        writeln!(self.out, "; most pairs: {count} in frame {frame}")?;
                    }
                    None => writeln!(self.out)?,
                }
            }
            (Format::Table, Err(_)) => {}
        }
        self.out.flush()?;
        checked?;
        Ok(if self.intersecting > 0 {
            Outcome::Intersects
        } else {
            Outcome::Clear
        })
    }
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
