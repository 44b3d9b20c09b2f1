//! Lists: a check a line, its bodies separated by tabs.

use crate::check::list_arguments::Shard;
use anyhow::{anyhow, bail};
use pliant_io::shown;
use serde::{Deserialize, Serialize};
use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

/// Longest line in bytes: below what a pipe holds, so that a worker that has stopped stops nobody.
const LONGEST: usize = 16 << 10;

/// A line of a list: its number from 1, and the bodies that it names.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
pub(super) struct Line {
    pub(super) number: u64,
    pub(super) bodies: Vec<String>,
    /// Why it is no check.
    #[serde(skip)]
    pub(super) error: Option<&'static str>,
}

/// Lines of a list, of one shard, that are not empty.
pub(super) struct Lines {
    read: Box<dyn BufRead + Send>,
    name: String,
    shard: Shard,
    number: u64,
}

/// Whether a list can be read twice.
pub(super) fn is_file(list: &Path) -> bool {
    list != Path::new("-") && fs::metadata(list).is_ok_and(|it| it.is_file())
}

impl Lines {
    pub(super) fn of(list: &Path, shard: Shard) -> anyhow::Result<Self> {
        let name = format!("the list {}", shown(list));
        let read: Box<dyn BufRead + Send> = if list == Path::new("-") {
            Box::new(BufReader::new(io::stdin()))
        } else {
            let opened = File::open(list).map_err(|error| anyhow!("cannot read {name}: {error}"));
            Box::new(BufReader::new(opened?))
        };
        if list.is_dir() {
            bail!("cannot read {name}: it is a folder; name a file with a check a line");
        }
        Ok(Self {
            read,
            name,
            shard,
            number: 0,
        })
    }

    fn next_line(&mut self) -> io::Result<Option<Line>> {
        loop {
            let mut bytes = Vec::new();
            let most = LONGEST as u64 + 1;
            if self
                .read
                .by_ref()
                .take(most)
                .read_until(b'\n', &mut bytes)?
                == 0
            {
                return Ok(None);
            }
            let is_too_long = bytes.len() > LONGEST;
            if is_too_long && bytes.last() != Some(&b'\n') {
                self.read.skip_until(b'\n')?;
            }
            self.number += 1;
            if self.number == 1 && bytes.starts_with(b"\xef\xbb\xbf") {
                bytes.drain(..3);
            }
            if self.shard.has(self.number) && !bytes.trim_ascii().is_empty() {
                return Ok(Some(parse(self.number, bytes, is_too_long)));
            }
        }
    }
}

impl Iterator for Lines {
    type Item = anyhow::Result<Line>;

    fn next(&mut self) -> Option<Self::Item> {
        let line = self.next_line();
        let line = line.map_err(|error| anyhow!("cannot read {}: {error}", self.name));
        line.transpose()
    }
}

fn parse(number: u64, mut bytes: Vec<u8>, is_too_long: bool) -> Line {
    while bytes.last().is_some_and(|byte| b"\r\n".contains(byte)) {
        bytes.pop();
    }
    if is_too_long {
        bytes.truncate(100);
    }
    let text = String::from_utf8_lossy(&bytes);
    let bodies: Vec<String> = text.split('\t').map(str::to_owned).collect();
    let error = if is_too_long {
        Some("the line is longer than 16 KiB; this is how it begins")
    } else if str::from_utf8(&bytes).is_err() {
        Some("the line is not UTF-8")
    } else if bodies.iter().any(String::is_empty) {
        Some("a body has no name: tabs separate bodies")
    } else {
        None
    };
    Line {
        number,
        bodies,
        error,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &[u8]) -> Vec<Line> {
        let lines = Lines {
            read: Box::new(io::Cursor::new(text.to_vec())),
            name: String::new(),
            shard: Shard::ALL,
            number: 0,
        };
        lines.map(Result::unwrap).collect()
    }

    #[test]
    fn bodies_are_separated_by_tabs() {
        let lines = read(b"\xef\xbb\xbfa b.obj\tc.ply\r\n \r\n\nlast.obj");
        assert_eq!(lines[0].bodies, ["a b.obj", "c.ply"]);
        assert_eq!(
            (lines[1].number, &lines[1].bodies[..]),
            (4, &["last.obj".to_owned()][..])
        );
        assert_eq!(lines.len(), 2);
    }

    #[test]
    fn bad_lines_are_lines_with_an_error() {
        let long = [vec![b'x'; LONGEST + 1], b"\nnext.obj\n".to_vec()].concat();
        let lines = read(&long);
        assert!(lines[0].error.unwrap().contains("16 KiB"));
        assert_eq!(
            (lines[0].bodies[0].len(), lines[1].error, lines[1].number),
            (100, None, 2)
        );
        let just = [vec![b'x'; LONGEST], b"\nnext.obj\n".to_vec()].concat();
        assert_eq!(read(&just)[1].number, 2);
        assert!(read(b"a.obj\t\n")[0].error.unwrap().contains("tabs"));
        assert!(read(b"\xff.obj\n")[0].error.unwrap().contains("UTF-8"));
    }
}
