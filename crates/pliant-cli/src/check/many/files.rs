//! Files of rows: lines of JSON, or Parquet, whichever they are.

use super::out::{Rows, cannot_write, in_the_way};
use super::parquet;
use super::row::Row;
use crate::output::{self, Overwrite};
use anyhow::Context;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Beginning of a Parquet file.
const MARK: &str = "PAR1";

/// Rows of a file.
pub(crate) type SomeRows = Box<dyn Iterator<Item = anyhow::Result<Row>>>;

/// Opens a file of rows. Of lines, a last one that is cut is left out: see [`is_cut`].
pub(crate) fn open(path: &Path) -> anyhow::Result<SomeRows> {
    if is_parquet(path) {
        return Ok(Box::new(parquet::read(File::open(path)?)?));
    }
    Ok(Box::new(Rows::read(path)?))
}

/// Whether a file ends in the middle of a row.
pub(crate) fn is_cut(path: &Path) -> bool {
    let last = || {
        let mut file = File::open(path)?;
        file.seek(SeekFrom::End(-1))?;
        first_bytes(file)
    };
    !is_parquet(path) && last().is_ok_and(|[last]| last != b'\n')
}

/// Whether a file is of Parquet, as its first bytes say.
fn is_parquet(path: &Path) -> bool {
    let is_file = fs::metadata(path).is_ok_and(|it| it.is_file());
    let first = || first_bytes(File::open(path)?);
    is_file && first().is_ok_and(|first: [u8; 4]| first == *MARK.as_bytes())
}

fn first_bytes<const N: usize>(mut file: File) -> std::io::Result<[u8; N]> {
    let mut bytes = [0; N];
    file.read_exact(&mut bytes).map(|()| bytes)
}

/// The file of lines in which rows of a Parquet file wait until there are all.
pub(super) fn beside(path: &Path) -> PathBuf {
    let mut name = OsString::from(path);
    name.push(".rows");
    name.into()
}

/// Begins a Parquet file: takes its rows into the lines beside it, to go on with them.
pub(super) fn begin(path: &Path, resume: bool, over: Overwrite) -> anyhow::Result<()> {
    parquet::is_here()?;
    let lines = beside(path);
    if !path.exists() || resume && lines.exists() || !resume && over.force {
        return Ok(());
    }
    if !resume {
        return Err(in_the_way(path));
    }
    let cannot = || cannot_write(&lines);
    let mut out = BufWriter::new(File::create(&lines).with_context(cannot)?);
    for row in open(path)? {
        serde_json::to_writer(&mut out, &row?)?;
        out.write_all(b"\n").with_context(cannot)?;
    }
    out.flush().with_context(cannot)
}

/// Writes the Parquet file of all rows, and removes the lines.
pub(super) fn end(path: &Path) -> anyhow::Result<()> {
    let lines = beside(path);
    let mut bytes = Vec::new();
    parquet::write(&mut bytes, Rows::read(&lines)?)?;
    // What is there has been looked at before.
    let over = Overwrite { force: true };
    output::write(path, MARK, over, |out| out.write_all(&bytes))?;
    fs::remove_file(&lines).with_context(|| format!("cannot remove {}", lines.display()))
}
