//! Lists: a check a line, its bodies separated by tabs; a shard takes every N-th line.

use super::row::Line;
use crate::check::list_arguments::Shard;
use anyhow::Context;
use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::Path;

/// A line, or why it is none.
pub(super) type Read = Result<Line, (Line, String)>;

/// Reads the lines of a shard. Empty ones are no checks.
pub(super) fn lines(
    list: &Path,
    shard: Shard,
) -> anyhow::Result<impl Iterator<Item = anyhow::Result<Read>> + Send + use<>> {
    let mut read: Box<dyn BufRead + Send> = if list == Path::new("-") {
        Box::new(BufReader::new(io::stdin()))
    } else {
        Box::new(BufReader::new(
            File::open(list).with_context(|| cannot(list))?,
        ))
    };
    let list = list.to_owned();
    let mut number = 0;
    let mut next = move || -> anyhow::Result<Option<Read>> {
        loop {
            let mut bytes = Vec::new();
            if read
                .read_until(b'\n', &mut bytes)
                .with_context(|| cannot(&list))?
                == 0
            {
                return Ok(None);
            }
            number += 1;
            if shard.has(number) && !bytes.trim_ascii().is_empty() {
                return Ok(Some(parse(number, bytes)));
            }
        }
    };
    Ok(std::iter::from_fn(move || next().transpose()))
}

fn cannot(list: &Path) -> String {
    format!("cannot read the list {}", pliant_io::shown(list))
}

fn parse(line: u64, mut bytes: Vec<u8>) -> Read {
    while bytes.last().is_some_and(|byte| b"\r\n".contains(byte)) {
        bytes.pop();
    }
    let bodies = |text: &str| text.split('\t').map(str::to_owned).collect::<Vec<_>>();
    match String::from_utf8(bytes) {
        Ok(text) => {
            let bodies = bodies(&text);
            if bodies.iter().any(String::is_empty) {
                let error = "a body has no name: tabs separate bodies".to_owned();
                return Err((Line { line, bodies }, error));
            }
            Ok(Line { line, bodies })
        }
        Err(error) => {
            let bodies = bodies(&String::from_utf8_lossy(error.as_bytes()));
            Err((Line { line, bodies }, "the line is not UTF-8".to_owned()))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bodies_are_separated_by_tabs() {
        let read = |text: &[u8]| parse(7, text.to_vec());
        assert_eq!(
            read(b"a b.obj\tc.ply\r\n").unwrap().bodies,
            ["a b.obj", "c.ply"]
        );
        assert_eq!(read(b"last.obj").unwrap().line, 7);
        assert!(read(b"a.obj\t\n").unwrap_err().1.contains("tabs"));
        assert!(read(b"\xff.obj\n").unwrap_err().1.contains("UTF-8"));
    }
}
