//! What the pairs of a frame have in common that their owner would want to know: triangles without area, seams that are not
//! quite closed, and seams that part from frame to frame.
//!
//! Files of parts made by exact modellers often have corners that differ in the last digits where two faces meet. Then every seam is
//! full of pairs, and none of them is what anybody looks for. Of the first frame in which a source meets itself it is counted how
//! many pairs would be of neighbours if boundary edges that nearly coincide were one.

use crate::row::Row;
use pliant_io::{Body as Source, NearSeams, PartedSeams};
use std::fmt;

/// Boundary edges no further apart than this, in diagonals of the body's box, are looked for.
const NEARLY: f64 = 1e-4;

/// Pairs of a source with itself that lie where boundary edges nearly coincide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtSeams {
    /// The first frame in which the source meets itself.
    pub frame: usize,
    /// How many pairs there lie at such seams.
    pub pairs: usize,
    /// Of so many.
    pub of: usize,
    /// The largest distance of vertices that would be joined, in diagonals of the source's box.
    pub farthest: f64,
}

/// Seams of a source that are closed in its first frame, and open in others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parted {
    /// In how many of the frames checked, in the first of them and in the last.
    pub frames: usize,
    /// The first of them.
    pub first: usize,
    /// The last of them.
    pub last: usize,
    /// The frame in which vertices are furthest apart, in diagonals of the body's box.
    pub worst: usize,
    /// How many vertices are apart there, which, and where.
    pub seams: PartedSeams,
}

/// What is known of one source.
#[derive(Default)]
struct Seams {
    frame: Option<usize>,
    pairs: usize,
    of: usize,
    /// Of that frame; none before it was looked for, and none where there is none.
    near: Option<NearSeams>,
    parted: Option<Box<Parted>>,
}

/// What is known of all sources.
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

    /// Takes a pair of triangles of sources, which are in that frame.
    pub(crate) fn take(&mut self, frame: usize, sources: &mut [Source], row: Row) {
        let [source, a, other, b] = row;
        if source != other {
            return;
        }
        let seams = &mut self.seams[source as usize];
        let source = &mut sources[source as usize];
        if seams.frame.is_none() {
            seams.frame = Some(frame);
            // A source whose seams cannot be looked for has no remark.
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

    /// Ends a frame, which sources are in.
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

    /// The seams of a source that part.
    pub(crate) fn parted(&self, source: usize) -> Option<Parted> {
        self.seams.get(source)?.parted.as_deref().copied()
    }

    /// What is to be said of a source.
    pub(crate) fn at_seams(&self, source: usize) -> Option<AtSeams> {
        let Seams {
            frame,
            pairs,
            of,
            near,
            ..
        } = self.seams.get(source)?;
        let farthest = near.as_ref()?.farthest();
        // Edges that coincide are apart because that was asked for.
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
    /// A tolerance that joins them: 1, 2 or 5 times a power of ten.
    pub fn tolerance(&self) -> f64 {
        tolerance(self.farthest)
    }
}

impl Parted {
    /// A tolerance that keeps together what is apart by rounding: 1e-6, or more where seams are known to be nearly closed.
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
    /// What, where and when, as the end of a sentence that names the source.
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
            1 => "1 vertex that a seam joins".to_owned(),
            count => format!("{count} vertices that seams join"),
        };
        write!(f, "{vertices} in the first frame ")?;
        match (frames, seams.count) {
            (1, 1) => write!(f, "is apart in frame {first}")?,
            (1, _) => write!(f, "are apart in frame {first}")?,
            _ => write!(
                f,
                "are apart in frame {worst}, as some are in {frames} frames, {first} to {last}"
            )?,
        }
        write!(
            f,
            ": {a} and {b}, at ({x:?}, {y:?}, {z:?}), are {:.1e} of its size from each other; the seam is open there",
            seams.farthest
        )
    }
}

/// A tolerance that joins what is so far apart: 1, 2 or 5 times a power of ten.
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

/// Whether any triangle of a pair has no area.
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
