//! A file beside its place, until it is whole.
//!
//! It has a name that nobody waits for, in the same folder, so that renaming it is one step of the file system. Without leave to
//! write over a file, renaming fails if one has come into being meanwhile. What is not renamed goes away, also if a signal ends the
//! program: all such files are on one list, which [`remove_staged_files`] goes through.

use std::fs;
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::mem;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::NamedTempFile;

use crate::error::{Error, Reason};

/// A new file, which has no name of its own until it is whole.
///
/// ```
/// # use std::io::Write;
/// # let folder = std::env::temp_dir().join(format!("pliant-io-staged-{}", std::process::id()));
/// # std::fs::create_dir_all(&folder)?;
/// # let path = folder.join("notes.txt");
/// let mut file = pliant_io::StagedFile::create(&path)?;
/// file.write_all(b"all or nothing")?;
/// assert!(!path.exists());
/// file.commit(false)?;
/// assert_eq!(std::fs::read(&path)?, b"all or nothing");
/// # std::fs::remove_dir_all(&folder)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct StagedFile {
    path: PathBuf,
    file: BufWriter<NamedTempFile>,
    /// Dropped after the file.
    listed: Listed,
    /// Whether a coordinate in it was rounded.
    pub(super) rounded: bool,
    /// A write has failed, and its error was handed on: the file will never have a name. What is written after that is passed over,
    /// so that whoever writes once more when it is dropped has nothing to complain of.
    has_failed: bool,
    /// Where the next byte goes, or would go.
    position: u64,
}

/// Where the files are that are not whole yet.
static STAGED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn staged() -> MutexGuard<'static, Vec<PathBuf>> {
    STAGED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A file on that list, for as long as this lives.
#[derive(Debug)]
struct Listed(PathBuf);

impl Drop for Listed {
    fn drop(&mut self) {
        staged().retain(|path| *path != self.0);
    }
}

/// Removes every [`StagedFile`] of this process that has no name of its own yet, and lets no other come into being: who makes one
/// or lets one go from now on waits for ever. For a program that is about to end without unwinding, as a signal ends it.
///
/// It waits for locks and so is for a thread that handles signals, not for a signal handler.
pub fn remove_staged_files() {
    let staged = staged();
    for path in &*staged {
        // One that is gone, or has its name by now, needs nothing; for any other there is nothing left to do.
        let _ = fs::remove_file(path);
    }
    mem::forget(staged);
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

impl StagedFile {
    /// A file beside its place. Dropped before it is [committed](Self::commit), it goes away.
    ///
    /// # Errors
    ///
    /// [`Reason::Write`] if no file can be made in that folder.
    pub fn create(path: &Path) -> Result<Self, Error> {
        let mut builder = tempfile::Builder::new();
        builder.prefix(".pliant-");
        // As any other new file; those of this crate are otherwise for their owner alone.
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            builder.permissions(std::fs::Permissions::from_mode(0o666));
        }
        // The list is held meanwhile, so that no file is ever there without being on it.
        let mut staged = staged();
        let file = builder.tempfile_in(folder(path));
        let file = file.map_err(|error| Error::new(path, Reason::Write(error)))?;
        staged.push(file.path().to_owned());
        drop(staged);
        Ok(Self {
            path: path.to_owned(),
            listed: Listed(file.path().to_owned()),
            file: BufWriter::with_capacity(1 << 16, file),
            rounded: false,
            has_failed: false,
            position: 0,
        })
    }

    /// The name that it will have.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Gives the file its name, with `force` in place of a file that has it: a link is replaced, not what it leads to. Returns whether
    /// a coordinate in it was rounded.
    ///
    /// # Errors
    ///
    /// [`Reason::Exists`] if there is such a file and no `force`; [`Reason::Write`] if what is left could not be written.
    pub fn commit(self, force: bool) -> Result<bool, Error> {
        let Self {
            path,
            file,
            listed: _listed,
            rounded,
            has_failed,
            position: _,
        } = self;
        if has_failed {
            let error = io::Error::other("an earlier part of it could not be written");
            return Err(Error::new(path, Reason::Write(error)));
        }
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

impl StagedFile {
    /// Does something with the file, unless that failed before.
    fn unless_failed<T>(
        &mut self,
        instead: T,
        work: impl FnOnce(&mut BufWriter<NamedTempFile>) -> io::Result<T>,
    ) -> io::Result<T> {
        if self.has_failed {
            return Ok(instead);
        }
        let done = work(&mut self.file);
        let is_final = |error: &io::Error| error.kind() != io::ErrorKind::Interrupted;
        self.has_failed = done.as_ref().is_err_and(is_final);
        done
    }
}

impl Write for StagedFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.unless_failed(bytes.len(), |file| file.write(bytes))?;
        self.position += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.unless_failed((), Write::flush)
    }
}

impl Seek for StagedFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let would_be = match to {
            SeekFrom::Start(position) => position,
            SeekFrom::Current(by) => self.position.saturating_add_signed(by),
            SeekFrom::End(_) => self.position,
        };
        self.position = self.unless_failed(would_be, |file| file.seek(to))?;
        Ok(self.position)
    }
}
