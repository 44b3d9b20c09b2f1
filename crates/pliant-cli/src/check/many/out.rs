//! Output of many checks: a JSON object a line, written as a check ends, and read to go on.
//!
//! A row is written at once, so an output that was left early has whole rows and at most a part of
//! one. To go on, that part is cut off, and the lines that have rows are left out.

use super::row::{Line, Row};
use crate::check::arguments::Arguments;
use anyhow::{Context, bail};
use pliant_io::shown;
use std::collections::HashMap;
use std::fs::{File, OpenOptions};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};

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

/// Output that rows are appended to.
pub(super) struct Out {
    path: PathBuf,
    file: File,
    /// Lines that have rows, each with a hash of its bodies.
    done: HashMap<u64, u64>,
    /// How many rows there are, with the ones from before.
    pub(super) tally: Tally,
    solid: bool,
}

impl Out {
    /// Begins an output, or goes on with one.
    pub(super) fn open(path: &Path, resume: bool, arguments: &Arguments) -> anyhow::Result<Self> {
        let over = arguments.pictures.over;
        let there = path.try_exists().with_context(|| cannot_write(path))?;
        let (mut done, mut end) = (HashMap::new(), 0);
        let (mut tally, solid) = (Tally::default(), arguments.solid);
        if there && resume {
            for row in Rows::read(path)? {
                let (row, behind) = row?;
                done.insert(row.line, hash_of(&row.bodies));
                tally.add(&row, solid);
                end = behind;
            }
        } else if there && !over.force {
            bail!(
                "{}: a file is there; go on with it by `--resume`, choose another name, or use \
                 `--force` to write over it",
                cannot_write(path)
            );
        }
        let file = OpenOptions::new().create(true).append(true).open(path);
        let file = file.with_context(|| cannot_write(path))?;
        file.set_len(end).with_context(|| cannot_write(path))?;
        Ok(Self {
            path: path.to_owned(),
            file,
            done,
            tally,
            solid,
        })
    }

    /// Whether a line has its row. Refuses an output of another list.
    pub(super) fn has(&self, line: &Line) -> anyhow::Result<bool> {
        match self.done.get(&line.line) {
            None => Ok(false),
            Some(&hash) if hash == hash_of(&line.bodies) => Ok(true),
            Some(_) => bail!(
                "{} has other bodies for line {} than the list; go on with the list that it was \
                 begun with, or begin another output",
                shown(&self.path),
                line.line
            ),
        }
    }

    pub(super) fn write(&mut self, row: &Row) -> anyhow::Result<()> {
        let mut text = serde_json::to_vec(row)?;
        text.push(b'\n');
        let written = self.file.write_all(&text);
        written.with_context(|| cannot_write(&self.path))?;
        self.tally.add(row, self.solid);
        Ok(())
    }
}

/// Rows of an output, each with the number of bytes to its end.
pub(crate) struct Rows {
    path: PathBuf,
    read: BufReader<File>,
    line: u64,
    end: u64,
}

impl Rows {
    pub(crate) fn read(path: &Path) -> anyhow::Result<Self> {
        let file = File::open(path).with_context(|| format!("cannot read {}", shown(path)))?;
        Ok(Self {
            path: path.to_owned(),
            read: BufReader::new(file),
            line: 0,
            end: 0,
        })
    }

    fn next_row(&mut self) -> anyhow::Result<Option<(Row, u64)>> {
        let mut text = Vec::new();
        let read = self.read.read_until(b'\n', &mut text);
        let read = read.with_context(|| format!("cannot read {}", shown(&self.path)))?;
        // The last line is a part of a row where a check was left early.
        if text.last() != Some(&b'\n') {
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
        Ok(Some((row, self.end)))
    }
}

impl Iterator for Rows {
    type Item = anyhow::Result<(Row, u64)>;

    fn next(&mut self) -> Option<Self::Item> {
        self.next_row().transpose()
    }
}

fn cannot_write(path: &Path) -> String {
    format!("cannot write {}", shown(path))
}

fn hash_of(bodies: &[String]) -> u64 {
    let mut hasher = DefaultHasher::new();
    bodies.hash(&mut hasher);
    hasher.finish()
}
