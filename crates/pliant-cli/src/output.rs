//! Output files (pages, pictures, charts): written whole or not at all, and never over foreign
//! files.
//!
//! A file is written under a temporary name beside its place and renamed when complete. A full disk
//! or an interruption leaves the earlier file as it was. A symbolic link is replaced itself, never
//! its target, so no mesh is lost through a name. An existing file is replaced if `pliant` wrote
//! it, which a mark near its beginning says; any other only with `--force`. Pipes and devices are
//! refused and never waited for.

use anyhow::{Context, bail};
use clap::Args;
use pliant_io::{StagedFile, shown};
use std::fs::{self, File};
use std::io::{self, BufWriter, Read, Write};
use std::path::Path;

/// Mark of this program in pages, pictures, charts and files for ParaView.
pub(crate) const MARK: &str = pliant_report::MARK;
/// Bytes at the beginning of a file that are searched for a mark.
const BEGINNING: u64 = 4096;

/// Permission to write over existing files.
#[derive(Args, Clone, Copy, Debug, Default)]
pub(crate) struct Overwrite {
    /// Write over files that pliant did not write
    #[arg(long)]
    pub(crate) force: bool,
}

/// Checks that a file can be written, before anything is computed. What is there stays as it is.
pub(crate) fn prepare(path: &Path, mark: &str, over: Overwrite) -> anyhow::Result<()> {
    may_be_replaced(path, mark, over)?;
    StagedFile::create(path)
        .map(drop)
        .map_err(|error| of_system(path, error))
}

/// Writes a file. `mark` stands at or near the beginning of files of this kind.
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

/// Takes the system's error out of an error of a staged file, so that advice can be given on it.
fn of_system(path: &Path, error: pliant_io::Error) -> anyhow::Error {
    match error.into_reason() {
        pliant_io::Reason::Write(error) => anyhow::Error::new(error),
        reason => anyhow::anyhow!("{reason}"),
    }
    .context(cannot_write(path))
}

/// Refuses a folder, pipe, device or foreign file that is in the way.
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
            "{}: a file that pliant did not write is there; choose another name, \
             or use `--force` to write over it",
            cannot_write(path)
        );
    }
    Ok(())
}

/// Whether a file has the mark near its beginning. A file that cannot be read has none.
fn bears(path: &Path, mark: &str) -> bool {
    // The target of a link may be a pipe, and reading it would block.
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
