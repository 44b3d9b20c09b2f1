//! Remarks about the seams of a source: seams that are nearly closed, and seams that open in later
//! frames.
//!
//! Files of exact modellers often have vertices that differ in the last digits where two faces
//! meet. Then every seam is full of pairs that nobody looks for. So in the first frame in which a
//! source meets itself, its pairs at nearly closed seams are counted. These are pairs that would be
//! neighbours if boundary edges that nearly coincide were one.

use crate::row::Row;
use pliant_io::{Body as Source, NearSeams, PartedSeams};
use std::fmt;

/// Largest distance of boundary edges that nearly coincide, in diagonals of the body's box.
const NEARLY: f64 = 1e-4;

/// Pairs of a source with itself at seams that are nearly closed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtSeams {
    /// First frame in which the source meets itself.
    pub frame: usize,
    /// Number of pairs at such seams in that frame.
    pub pairs: usize,
    /// Number of all pairs of the source with itself in that frame.
    pub of: usize,
    /// Largest distance of vertices that welding would join, in diagonals of the source's box.
    pub farthest: f64,
}

/// Seams of a source that are closed in its first frame and open in others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parted {
    /// Number of checked frames with open seams.
    pub frames: usize,
    /// First of these frames.
    pub first: usize,
    /// Last of these frames.
    pub last: usize,
    /// Frame in which vertices are farthest apart, in diagonals of the body's box.
    pub worst: usize,
    /// Vertices that are apart in that frame: how many, which, and where.
    pub seams: PartedSeams,
}

/// Facts about the seams of one source.
#[derive(Default)]
struct Seams {
    frame: Option<usize>,
    pairs: usize,
    of: usize,
    /// Nearly closed seams in that frame; `None` before it, or if there are none.
    near: Option<NearSeams>,
    parted: Option<Box<Parted>>,
}

/// Facts about the seams of all sources.
#[derive(Default)]
pub(crate) struct Remarks {
    seams: Vec<Seams>,
}

impl Remarks {
    pub(crate) fn of(sources: usize) -> Self {
        let mut seams = Vec::new();
        seams.resize_with(sources, Seams::default);
        Self { seams }
    }

    /// Begins a frame, or begins it again.
    pub(crate) fn begin(&mut self, frame: usize) {
        for seams in &mut self.seams {
            if seams.frame == Some(frame) {
                let parted = seams.parted.take();
                *seams = Seams {
                    parted,
                    ..Seams::default()
                };
            }
        }
    }

    /// Takes a pair of triangles of sources, which are in this frame.
    pub(crate) fn take(&mut self, frame: usize, sources: &mut [Source], row: Row) {
        let [source, a, other, b] = row;
        if source != other {
            return;
        }
        let seams = &mut self.seams[source as usize];
        let source = &mut sources[source as usize];
        if seams.frame.is_none() {
            seams.frame = Some(frame);
            // A source whose seams cannot be examined gets no remark.
            seams.near = source.near_seams(NEARLY).ok().flatten();
        }
        if seams.frame != Some(frame) {
            return;
        }
        seams.of += 1;
        if let Some(near) = &seams.near {
            let leaders = |triangle: u32| {
                source.triangles()[triangle as usize].map(|vertex| near.leader(vertex))
            };
            let (a, b) = (leaders(a), leaders(b));
            seams.pairs += usize::from(a.iter().any(|vertex| b.contains(vertex)));
        }
    }

    /// Ends a frame. The sources are still in it.
    pub(crate) fn end(&mut self, frame: usize, sources: &[Source]) {
        for (known, source) in self.seams.iter_mut().zip(sources) {
            let Some(seams) = source.parted_seams() else {
                continue;
            };
            let parted = known.parted.get_or_insert_with(|| {
                Box::new(Parted {
                    frames: 0,
                    first: frame,
                    last: frame,
                    worst: frame,
                    seams,
                })
            });
            parted.frames += 1;
            parted.last = frame;
            if seams.farthest > parted.seams.farthest {
                (parted.worst, parted.seams) = (frame, seams);
            }
        }
    }

    /// Open seams of a source, over the frames so far.
    pub(crate) fn parted(&self, source: usize) -> Option<Parted> {
        self.seams.get(source)?.parted.as_deref().copied()
    }

    /// Pairs at nearly closed seams of a source, if that is worth a remark.
    pub(crate) fn at_seams(&self, source: usize) -> Option<AtSeams> {
        let Seams {
            frame,
            pairs,
            of,
            near,
            ..
        } = self.seams.get(source)?;
        let farthest = near.as_ref()?.farthest();
        // Edges that coincide exactly are apart only because that was asked for.
        let is_worth_it = *pairs > 0 && farthest > 0.0;
        is_worth_it.then_some(AtSeams {
            frame: (*frame)?,
            pairs: *pairs,
            of: *of,
            farthest,
        })
    }
}

impl AtSeams {
    /// Tolerance that closes these seams: 1, 2 or 5 times a power of ten.
    pub fn tolerance(&self) -> f64 {
        tolerance(self.farthest)
    }
}

impl Parted {
    /// Tolerance that keeps rounded vertices together: 1e-6, or more if the seams are nearly
    /// closed.
    pub fn tolerance(&self) -> f64 {
        let farthest = self.seams.farthest;
        f64::max(
            1e-6,
            if farthest < NEARLY {
                tolerance(farthest)
            } else {
                0.0
            },
        )
    }
}

impl fmt::Display for Parted {
    /// Writes what is apart, where and when, as the end of a sentence that names the source.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            frames,
            first,
            last,
            worst,
            seams,
        } = self;
        let [a, b] = seams.vertices;
        let [x, y, z] = seams.positions[0];
        let vertices = match seams.count {
            1 => "1 vertex parts".to_owned(),
            count => format!("{count} vertices part"),
        };
        write!(f, "seams that are closed in the first frame are open in ")?;
        match frames {
            1 => write!(f, "frame {first}: {vertices} there")?,
            _ => write!(
                f,
                "{frames} frames, {first} to {last}, and widest in frame {worst}: {vertices} there"
            )?,
        }
        write!(
            f,
            ", {a} and {b} at ({x:?}, {y:?}, {z:?}) farthest, by {:.1e} of the body's size; the \
             sides of an open seam may intersect",
            seams.farthest
        )
    }
}

/// Tolerance that closes a gap of `farthest`: 1, 2 or 5 times a power of ten.
fn tolerance(farthest: f64) -> f64 {
    let wanted = farthest * 1.01;
    let power = wanted.log10().floor() as i32;
    let steps = [1.0, 2.0, 5.0, 10.0].map(|step: f64| format!("{step}e{power}"));
    let steps = steps.map(|step| step.parse().unwrap_or(NEARLY));
    steps
        .into_iter()
        .find(|step| *step >= wanted)
        .unwrap_or(NEARLY)
}

/// Whether a triangle of a pair of sources has no area.
pub(crate) fn has_degenerate(sources: &[Source], row: Row) -> bool {
    let [source_a, a, source_b, b] = row;
    [(source_a, a), (source_b, b)]
        .iter()
        .any(|&(source, triangle)| {
            let source = &sources[source as usize];
            let positions = source.positions();
            let corners = source.triangles()[triangle as usize];
            pliant::exact::is_degenerate(corners.map(|vertex| positions.get(vertex)))
        })
}
