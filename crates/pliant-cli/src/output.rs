//! Files that a command writes beside what it prints: whole or not at all, and over nobody's work.
//!
//! A file is made beside its place and moved there when it is whole, so a full disk or an end in between leaves what was there as it
//! was. It takes a name of its own: of a link the link is replaced, never the file that it leads to, so no mesh can be lost by a name.
//! What is there already is replaced if `pliant` wrote it, which a mark near its beginning says; anything else only with `--force`.
//! Pipes and devices are refused, and never waited for.

use anyhow::{Context, bail};
use clap::Args;
use pliant_io::{StagedFile, shown};
use std::fs::{self, File};
use std::io::{self, BufWriter, Read, Write};
use std::path::Path;

/// In pages, pictures, charts and files for ParaView.
pub(crate) const MARK: &str = pliant_report::MARK;
/// Where a mark is, at most.
const BEGINNING: u64 = 4096;

/// What may be written over.
#[derive(Args, Clone, Copy, Debug, Default)]
pub(crate) struct Overwrite {
    /// Write over files that pliant did not write
    #[arg(long)]
    pub(crate) force: bool,
}

/// Sees to it that a file can be written, before anything is computed; leaves what is there as it is.
pub(crate) fn prepare(path: &Path, mark: &str, over: Overwrite) -> anyhow::Result<()> {
    may_be_replaced(path, mark, over)?;
    StagedFile::create(path)
        .map(drop)
        .map_err(|error| of_system(path, error))
}

/// Writes a file. `mark` is what files of this kind begin with, or nearly.
pub(crate) fn write(
    path: &Path,
    mark: &str,
    over: Overwrite,
    content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> anyhow::Result<()> {
    may_be_replaced(path, mark, over)?;
    let mut file = StagedFile::create(path).map_err(|error| of_system(path, error))?;
    let written = {
        let mut out = BufWriter::new(&mut file);
        content(&mut out).and_then(|()| out.flush())
    };
    written.with_context(|| cannot_write(path))?;
    let committed = file.commit(true);
    committed.map(drop).map_err(|error| of_system(path, error))
}

fn cannot_write(path: &Path) -> String {
    format!("cannot write {}", shown(path))
}

/// The system's error behind one of a staged file, so that advice can be given on it.
fn of_system(path: &Path, error: pliant_io::Error) -> anyhow::Error {
    match error.into_reason() {
        pliant_io::Reason::Write(error) => anyhow::Error::new(error),
        reason => anyhow::anyhow!("{reason}"),
    }
    .context(cannot_write(path))
}

/// Refuses what is there and is not to be replaced.
fn may_be_replaced(path: &Path, mark: &str, over: Overwrite) -> anyhow::Result<()> {
    let kind = match path.symlink_metadata() {
        Err(absent) if absent.kind() == io::ErrorKind::NotFound => return Ok(()),
        there => there.with_context(|| cannot_write(path))?.file_type(),
    };
    if kind.is_dir() {
        return Err(io::Error::from(io::ErrorKind::IsADirectory))
            .with_context(|| cannot_write(path));
    }
    if !kind.is_file() && !kind.is_symlink() {
        bail!(
            "{}: it is a pipe or a device; name a file",
            cannot_write(path)
        );
    }
    if !over.force && !bears(path, mark) {
        bail!(
            "{}: a file that pliant did not write is there; choose another name, or use `--force` to write over it",
            cannot_write(path)
        );
    }
    Ok(())
}

/// Whether a file has a mark near its beginning. One that cannot be read has none.
fn bears(path: &Path, mark: &str) -> bool {
    // What a link leads to may be a pipe, which would be waited for.
    if !fs::metadata(path).is_ok_and(|its| its.is_file()) {
        return false;
    }
    let mut beginning = Vec::new();
    let read = File::open(path).and_then(|file| file.take(BEGINNING).read_to_end(&mut beginning));
    read.is_ok()
        && beginning
            .windows(mark.len())
            .any(|bytes| bytes == mark.as_bytes())
}
