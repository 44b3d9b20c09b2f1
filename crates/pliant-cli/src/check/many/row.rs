//! Rows: what a check of one line of a list found, or why there was none.

use super::list::Line;
use crate::check::arguments::Arguments;
use crate::check::settings::settings;
use anyhow::anyhow;
use pliant_check::{Check, Counts};
use pliant_io::{Files, shown};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::num::NonZeroUsize;
use std::time::Instant;

/// A row of the output. Counts are sums over the frames that were checked.
///
/// Where there is an error, counts are absent.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub(crate) struct Row {
    /// Line of the list, from 1.
    pub(crate) line: u64,
    pub(crate) bodies: Vec<String>,
    /// Size and hash of the files named, one after the other. Absent if they cannot be read.
    pub(crate) bytes: Option<u64>,
    pub(crate) sha256: Option<String>,
    /// Triangles of all bodies, in the first frame.
    pub(crate) triangles: Option<u64>,
    /// Intersecting pairs, or close ones with `--within`.
    pub(crate) pairs: Option<u64>,
    /// Edges of one body that cross triangles of another or of the same.
    pub(crate) crossing_edges: Option<u64>,
    /// Pairs that share a vertex.
    pub(crate) adjacent: Option<u64>,
    /// Pairs, among these, that only touch.
    pub(crate) touching: Option<u64>,
    /// Pairs with a triangle without area.
    pub(crate) degenerate: Option<u64>,
    /// Components inside bodies.
    pub(crate) inside: Option<u64>,
    pub(crate) ms: Option<f64>,
    /// The most memory that the process held, where the system says so.
    pub(crate) peak_bytes: Option<u64>,
    pub(crate) error: Option<String>,
}

impl Row {
    fn empty(line: &Line) -> Self {
        Self {
            line: line.number,
            bodies: line.bodies.clone(),
            bytes: None,
            sha256: None,
            triangles: None,
            pairs: None,
            crossing_edges: None,
            adjacent: None,
            touching: None,
            degenerate: None,
            inside: None,
            ms: None,
            peak_bytes: None,
            error: None,
        }
    }

    /// Row of a line that has no answer.
    pub(super) fn failed(line: &Line, error: impl Into<String>) -> Self {
        Self {
            error: Some(error.into()),
            ..Self::empty(line)
        }
    }

    /// Checks the bodies of a line.
    pub(super) fn of(arguments: &Arguments, line: &Line) -> Self {
        let begun = Instant::now();
        let mut row = Self::empty(line);
        let found = crate::edge::caught(|| row.fill(arguments));
        row.error = found.err().map(|error| crate::advice::with_advice(&error));
        let microseconds = begun.elapsed().as_micros();
        row.ms = Some(microseconds as f64 / 1e3);
        row
    }

    fn fill(&mut self, arguments: &Arguments) -> anyhow::Result<()> {
        let (bytes, hash) = hashed(&self.bodies)?;
        (self.bytes, self.sha256) = (Some(bytes), Some(hash));
        let (reading, mut settings) = settings(arguments);
        settings.crossing_edges = arguments.within.is_none();
        settings.inside = true;
        settings.places = arguments.crossing;
        (settings.first, settings.listed) = (arguments.first, false);
        // The other cores have jobs of their own.
        settings.options.threads = NonZeroUsize::MIN;
        let mut check = Check::open(&self.bodies, &reading, &settings)?;
        check.begin()?;
        let triangles = check.sources().iter().map(|it| it.triangles().len() as u64);
        let triangles = triangles.sum();
        let counts = Counts::of(&mut check)?;
        self.triangles = Some(triangles);
        self.pairs = Some(counts.pairs);
        self.crossing_edges = counts.crossing_edges;
        self.adjacent = counts.adjacent;
        self.touching = counts.touching;
        self.degenerate = Some(counts.degenerate);
        self.inside = Some(counts.inside);
        Ok(())
    }

    /// Whether anything intersects, or, among solids, lies inside another.
    pub(crate) fn meets(&self, solid: bool) -> bool {
        let some = |count: Option<u64>| count.is_some_and(|count| count > 0);
        some(self.pairs) || some(self.adjacent) || solid && some(self.inside)
    }
}

/// Number of bytes in the files that arguments name, and their hash.
fn hashed(bodies: &[String]) -> anyhow::Result<(u64, String)> {
    let (mut hash, mut bytes) = (Sha256::new(), 0);
    for body in bodies {
        for path in pliant_io::files(body, &Files::default())? {
            let cannot = |error| anyhow!("{}: cannot be read: {error}", shown(&path));
            let file = File::open(&path).map_err(cannot)?;
            let mut file = BufReader::with_capacity(1 << 16, file);
            loop {
                let some = file.fill_buf().map_err(cannot)?;
                let count = some.len();
                if count == 0 {
                    break;
                }
                hash.update(some);
                file.consume(count);
                bytes += count as u64;
            }
        }
    }
    let digits = hash.finalize().iter().fold(String::new(), |digits, byte| {
        digits + &format!("{byte:02x}")
    });
    Ok((bytes, digits))
}
