//! Detection of files that change while they are read.
//!
//! A program may still be writing a file, a copy may not be done, or a frame may be replaced before
//! its turn. So a file's identity, length and modification time are recorded when it is found
//! ([`Found`]). They are compared when it is opened and after every frame. A change in place, of
//! equal length and within one tick of the file system's clock, goes unseen; NPZ files also have
//! checksums. Opening never waits: a pipe that has replaced a file is refused like any other
//! change.

use std::fs::{File, Metadata};
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::SystemTime;

use crate::error::Reason;

/// First bytes of a Git LFS pointer, which stands in for a file that was not fetched.
const LFS_POINTER: &[u8] = b"version https://git-lfs.github.com/spec/";

/// A regular file as it was found; not open.
#[derive(Debug, Clone)]
pub(crate) struct Found {
    path: Arc<Path>,
    state: State,
}

/// An open file, unchanged as far as the last [`unchanged`](Self::unchanged) could tell.
#[derive(Debug)]
pub(crate) struct Opened {
    file: File,
    state: State,
}

/// Properties of a file that reveal a change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct State {
    /// Device and inode number; zero on systems without them.
    identity: [u64; 2],
    length: u64,
    changed: Option<SystemTime>,
}

impl State {
    fn of(metadata: &Metadata) -> Self {
        #[cfg(unix)]
        let identity = {
            use std::os::unix::fs::MetadataExt;
            [metadata.dev(), metadata.ino()]
        };
        #[cfg(not(unix))]
        let identity = [0; 2];
        Self {
            identity,
            length: metadata.len(),
            changed: metadata.modified().ok(),
        }
    }
}

impl Found {
    /// Records the state of a regular file; `metadata` is its metadata.
    pub(crate) fn new(path: PathBuf, metadata: &Metadata) -> Self {
        let state = State::of(metadata);
        let path = path.into();
        Self { path, state }
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Shared path: the many bodies of one file need only one copy.
    pub(crate) fn shared_path(&self) -> Arc<Path> {
        self.path.clone()
    }

    /// Finds a file that was not named on its own but is needed by another.
    pub(crate) fn find(path: PathBuf) -> Result<Self, Reason> {
        let metadata = match path.metadata() {
            Err(absent) if absent.kind() == io::ErrorKind::NotFound => {
                return Err(Reason::NotFound);
            }
            metadata => metadata?,
        };
        if metadata.is_dir() {
            return Err(Reason::Directory);
        }
        if !metadata.is_file() {
            return Err(Reason::NotAFile);
        }
        Ok(Self::new(path, &metadata))
    }

    /// Opens the file if it has not changed since it was found.
    pub(crate) fn open(&self) -> Result<Opened, Reason> {
        let mut options = File::options();
        options.read(true);
        #[cfg(unix)]
        {
            use std::os::unix::fs::OpenOptionsExt;
            options.custom_flags(libc::O_NONBLOCK);
        }
        let file = options.open(&self.path)?;
        let state = self.state;
        let mut opened = Opened { file, state };
        opened.unchanged()?;
        opened.check_content()?;
        Ok(opened)
    }
}

impl Opened {
    /// Length of the file in bytes.
    pub(crate) fn length(&self) -> u64 {
        self.state.length
    }

    /// Refuses a Git LFS pointer.
    fn check_content(&mut self) -> Result<(), Reason> {
        let mut begin = Vec::with_capacity(LFS_POINTER.len());
        let begins = self.by_ref().take(LFS_POINTER.len() as u64);
        { begins }.read_to_end(&mut begin)?;
        if begin == LFS_POINTER {
            return Err(Reason::LfsPointer);
        }
        self.file.rewind()?;
        Ok(())
    }

    /// Returns an error if the file has changed since it was found.
    pub(crate) fn unchanged(&self) -> Result<(), Reason> {
        if State::of(&self.file.metadata()?) == self.state {
            Ok(())
        } else {
            Err(Reason::Changed)
        }
    }
}

impl Read for Opened {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.file.read(buffer)
    }
}

impl Seek for Opened {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}
