//! Staged files: a new file gets its name only when it is complete.
//!
//! Until then it has a temporary name in the same folder, so that renaming is one atomic step of
//! the file system. Unless overwriting is allowed, renaming fails if the name has been taken
//! meanwhile. A file that is not renamed is removed, even if a signal ends the program. For that,
//! all staged files are on one list, which [`remove_staged_files`] goes through.

use std::fs;
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::mem;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::NamedTempFile;

use crate::error::{Error, Reason};

/// A new file, with a temporary name until it is complete.
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
    file: BufWriter<Temporary>,
    /// Entry in the list; declared behind the file, so that it is dropped after it.
    listed: Listed,
    /// Whether a coordinate in the file was rounded.
    pub(super) rounded: bool,
    /// Whether a write has failed and its error was returned: the file will never get its name.
    ///
    /// Later writes are ignored, so that a wrapper that writes once more when dropped cannot fail.
    has_failed: bool,
    /// Offset of the next byte, kept up even after a failure.
    position: u64,
}

/// A file with a temporary name, which no error names.
///
/// The errors of [`NamedTempFile`] itself end in that name, which nobody asked for.
#[derive(Debug)]
struct Temporary(NamedTempFile);

impl Write for Temporary {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.as_file_mut().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.as_file_mut().flush()
    }
}

impl Seek for Temporary {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.0.as_file_mut().seek(to)
    }
}

/// Paths of all files that are not complete yet.
static STAGED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn staged() -> MutexGuard<'static, Vec<PathBuf>> {
    STAGED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Entry of a file in that list; removed when dropped.
#[derive(Debug)]
struct Listed(PathBuf);

impl Drop for Listed {
    fn drop(&mut self) {
        staged().retain(|path| *path != self.0);
    }
}

/// Removes all [`StagedFile`]s of this process that have no name yet, and prevents new ones.
///
/// For a program that a signal ends without unwinding. Afterwards a thread that creates or drops a
/// staged file waits for ever. The function waits for locks: call it from a thread that handles
/// signals, not from a signal handler.
pub fn remove_staged_files() {
    let staged = staged();
    for path in &*staged {
        // A file that is gone, or has its name by now, needs nothing. For any other nothing is left
        // to do.
        let _ = fs::remove_file(path);
    }
    mem::forget(staged);
}

/// Refuses an existing file unless `force`, and a file whose folder does not exist.
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
    /// Creates a file beside its final place; removed if dropped before it is
    /// [committed](Self::commit).
    ///
    /// # Errors
    ///
    /// [`Reason::Write`] if no file can be made in that folder.
    pub fn create(path: &Path) -> Result<Self, Error> {
        let mut builder = tempfile::Builder::new();
        builder.prefix(".pliant-");
        // Opened here, so that it has the usual permissions of a new file, and an error is the
        // system's alone. The crate tempfile would allow only the owner, and name the file.
        let mut options = fs::OpenOptions::new();
        options.read(true).write(true).create_new(true);
        // The list stays locked, so that no file ever exists without being listed.
        let mut staged = staged();
        let file = builder.make_in(folder(path), |path| options.open(path));
        let file = file.map_err(|error| Error::new(path, Reason::Write(error)))?;
        staged.push(file.path().to_owned());
        drop(staged);
        Ok(Self {
            path: path.to_owned(),
            listed: Listed(file.path().to_owned()),
            file: BufWriter::with_capacity(1 << 16, Temporary(file)),
            rounded: false,
            has_failed: false,
            position: 0,
        })
    }

    /// The name that the file will get.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Gives the file its name; returns whether a coordinate in it was rounded.
    ///
    /// With `force` it replaces a file of that name. A symbolic link is replaced, not its target.
    ///
    /// # Errors
    ///
    /// - [`Reason::Exists`] if the name is taken, without `force`.
    /// - [`Reason::Write`] if the rest could not be written.
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
            let error = io::Error::other("an earlier write to it failed");
            return Err(Error::new(path, Reason::Write(error)));
        }
        let error = |error: io::Error| Error::new(&path, Reason::Write(error));
        let Temporary(file) = file
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
    /// Works on the file, unless that failed before; then returns `instead`.
    fn unless_failed<T>(
        &mut self,
        instead: T,
        work: impl FnOnce(&mut BufWriter<Temporary>) -> io::Result<T>,
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
