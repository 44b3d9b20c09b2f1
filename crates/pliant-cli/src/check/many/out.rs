//! Output of many checks: a JSON object a line, written as a check ends, and read to go on.
//!
//! A row is written at once, so an output that was left early has whole rows and at most the
//! beginning of one. To go on, that is cut off, and the lines that have rows are left out. One run
//! at a time writes to an output.

use super::list::Line;
use super::row::Row;
use crate::check::arguments::Arguments;
use anyhow::{Context, anyhow, bail};
use pliant_io::shown;
use std::collections::HashMap;
use std::fs::{self, File, OpenOptions};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};

/// How every row begins.
const BEGINNING: &[u8] = b"{\"line\":";
/// Most bytes of a row: many times the longest line.
const LONGEST: u64 = 1 << 20;

/// How many rows of an output are of which kind.
#[derive(Clone, Copy, Default)]
pub(super) struct Tally {
    pub(super) clear: u64,
    pub(super) meeting: u64,
    pub(super) failed: u64,
}

impl Tally {
    fn add(&mut self, row: &Row, solid: bool) {
        match (&row.error, row.meets(solid)) {
            (Some(_), _) => self.failed += 1,
            (None, true) => self.meeting += 1,
            (None, false) => self.clear += 1,
        }
    }
}

/// Lines that had rows when an output was opened, each with a hash of its bodies.
pub(super) struct Done {
    path: PathBuf,
    lines: HashMap<u64, u64>,
}

impl Done {
    /// Whether a line has its row. Refuses an output of another list.
    pub(super) fn has(&self, line: &Line) -> anyhow::Result<bool> {
        match self.lines.get(&line.number) {
            None => Ok(false),
            Some(&hash) if hash == hash_of(&line.bodies) => Ok(true),
            Some(_) => bail!(
                "{} has other bodies for line {} than the list; go on with the list that it was \
                 begun with, or begin another output",
                shown(&self.path),
                line.number
            ),
        }
    }
}

/// Output that rows are appended to.
pub(super) struct Out {
    path: PathBuf,
    file: File,
    /// Bytes of whole rows.
    end: u64,
    /// How many rows there are, with the ones from before.
    pub(super) tally: Tally,
    solid: bool,
}

impl Out {
    /// Begins an output, or goes on with one.
    pub(super) fn open(
        path: &Path,
        list: &Path,
        resume: bool,
        arguments: &Arguments,
    ) -> anyhow::Result<(Self, Done)> {
        let is_there = may_be_written(path, list)?;
        if is_there && !resume && !arguments.pictures.over.force {
            return Err(in_the_way(path));
        }
        let mut done = Done {
            path: path.to_owned(),
            lines: HashMap::new(),
        };
        let file = OpenOptions::new().create(true).append(true).open(path);
        let file = file.with_context(|| cannot_write(path))?;
        if file.try_lock().is_err() {
            bail!("{}: another check writes to it", cannot_write(path));
        }
        let mut out = Self {
            path: path.to_owned(),
            file,
            end: 0,
            tally: Tally::default(),
            solid: arguments.solid,
        };
        if is_there && resume {
            let mut rows = Rows::read(path)?;
            for row in &mut rows {
                let row = row?;
                let hash = hash_of(&row.bodies);
                if done.lines.insert(row.line, hash).is_some() {
                    bail!("{} has two rows for line {}", shown(path), row.line);
                }
                out.tally.add(&row, out.solid);
            }
            out.end = rows.end;
            let rest = &rows.rest;
            let common = rest.len().min(BEGINNING.len());
            if rest[..common] != BEGINNING[..common] {
                bail!(
                    "{} ends with no row of `pliant check --files-from`",
                    shown(path)
                );
            }
        }
        out.cut()?;
        Ok((out, done))
    }

    pub(super) fn write(&mut self, row: &Row) -> anyhow::Result<()> {
        let mut text = serde_json::to_vec(row)?;
        text.push(b'\n');
        if let Err(error) = self.file.write_all(&text) {
            // No row is appended to a part of one.
            let _ = self.cut();
            return Err(error).with_context(|| cannot_write(&self.path));
        }
        self.end += text.len() as u64;
        self.tally.add(row, self.solid);
        Ok(())
    }

    /// Cuts off what is no whole row.
    fn cut(&self) -> anyhow::Result<()> {
        let cut = self.file.set_len(self.end);
        cut.with_context(|| cannot_write(&self.path))
    }
}

/// Whether there is a file; refuses the list itself, and what is no file.
fn may_be_written(path: &Path, list: &Path) -> anyhow::Result<bool> {
    if path == Path::new("-") {
        bail!("--out -: rows go to a file, so that a check can go on; name one");
    }
    let Ok(there) = fs::metadata(path) else {
        return Ok(false);
    };
    if !there.is_file() {
        bail!("{}: it is no file; name one", cannot_write(path));
    }
    let same = fs::canonicalize(path).ok();
    if same.is_some() && same == fs::canonicalize(list).ok() {
        bail!(
            "{}: it is the list; choose another name",
            cannot_write(path)
        );
    }
    Ok(true)
}

/// Rows of an output.
pub(super) struct Rows {
    path: PathBuf,
    read: BufReader<File>,
    line: u64,
    /// Bytes of the rows so far.
    end: u64,
    /// Bytes behind the last row: the beginning of one, where a check was left early.
    rest: Vec<u8>,
}

impl Rows {
    pub(super) fn read(path: &Path) -> anyhow::Result<Self> {
        let cannot = |error| anyhow!("cannot read {}: {error}", shown(path));
        let file = File::open(path).map_err(cannot)?;
        if !file.metadata().is_ok_and(|it| it.is_file()) {
            bail!("cannot read {}: it is no file", shown(path));
        }
        Ok(Self {
            path: path.to_owned(),
            read: BufReader::new(file),
            line: 0,
            end: 0,
            rest: Vec::new(),
        })
    }

    fn next_row(&mut self) -> anyhow::Result<Option<Row>> {
        let mut text = Vec::new();
        let read = self
            .read
            .by_ref()
            .take(LONGEST)
            .read_until(b'\n', &mut text);
        let read = read.map_err(|error| anyhow!("cannot read {}: {error}", shown(&self.path)))?;
        if text.last() != Some(&b'\n') && (read as u64) < LONGEST {
            self.rest = text;
            return Ok(None);
        }
        self.line += 1;
        self.end += read as u64;
        let row = serde_json::from_slice(&text).with_context(|| {
            let path = shown(&self.path);
            format!(
                "{path}, line {}: no row of `pliant check --files-from`",
                self.line
            )
        })?;
        Ok(Some(row))
    }
}

impl Iterator for Rows {
    type Item = anyhow::Result<Row>;

    fn next(&mut self) -> Option<Self::Item> {
        self.next_row().transpose()
    }
}

/// Error of an output that is there already.
pub(super) fn in_the_way(path: &Path) -> anyhow::Error {
    anyhow!(
        "{}: a file is there; go on with it by `--resume`, choose another name, or use `--force` \
         to write over it",
        cannot_write(path)
    )
}

pub(super) fn cannot_write(path: &Path) -> String {
    format!("cannot write {}", shown(path))
}

fn hash_of(bodies: &[String]) -> u64 {
    let mut hasher = DefaultHasher::new();
    bodies.hash(&mut hasher);
    hasher.finish()
}
