//! A file beside its place, until it is whole.
//!
//! It has a name that nobody waits for, in the same folder, so that renaming it is one step of the file system. Without leave to
//! write over a file, renaming fails if one has come into being meanwhile. What is not renamed goes away.

use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::error::{Error, Reason};

pub(super) struct Staged {
    path: PathBuf,
    file: BufWriter<NamedTempFile>,
    /// Whether a coordinate in it was rounded.
    pub(super) rounded: bool,
}

/// Refuses a file that is there, without leave to write over it, and one whose folder is not there.
pub(super) fn check(path: &Path, force: bool) -> Result<(), Error> {
    let error = |reason: Reason| Err(Error::new(path, reason));
    match path.symlink_metadata() {
        Ok(there) if there.is_dir() => return error(Reason::Directory),
        Ok(_) if !force => return error(Reason::Exists),
        _ => {}
    }
    if !folder(path).is_dir() {
        let reason = "its folder does not exist; make it first";
        return error(Reason::Unsupported(reason.into()));
    }
    Ok(())
}

fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}

impl Staged {
    pub(super) fn create(path: &Path) -> Result<Self, Error> {
        let mut builder = tempfile::Builder::new();
        builder.prefix(".pliant-");
        // As any other new file; those of this crate are otherwise for their owner alone.
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            builder.permissions(std::fs::Permissions::from_mode(0o666));
        }
        let file = builder.tempfile_in(folder(path));
        let file = file.map_err(|error| Error::new(path, Reason::Write(error)))?;
        Ok(Self {
            path: path.to_owned(),
            file: BufWriter::with_capacity(1 << 16, file),
            rounded: false,
        })
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Gives the file its name; returns whether a coordinate in it was rounded.
    pub(super) fn commit(self, force: bool) -> Result<bool, Error> {
        let Self {
            path,
            file,
            rounded,
        } = self;
        let error = |error: io::Error| Error::new(&path, Reason::Write(error));
        let file = file
            .into_inner()
            .map_err(|unwritten| error(unwritten.into_error()))?;
        let renamed = if force {
            file.persist(&path)
        } else {
            file.persist_noclobber(&path)
        };
        match renamed {
            Ok(_) => Ok(rounded),
            Err(failed) if failed.error.kind() == io::ErrorKind::AlreadyExists => {
                Err(Error::new(&path, Reason::Exists))
            }
            Err(failed) => Err(error(failed.error)),
        }
    }
}

impl Write for Staged {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for Staged {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}
