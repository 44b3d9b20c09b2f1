//! A file that must stay as it was found.
//!
//! Reading takes time: a program may still be writing, a copy may not be done, a frame may be replaced before its turn comes.
//! So a file is remembered as it was found ([`Found`]), and held to it when it is opened and after every frame: same file, same
//! length, same time of change. What this cannot see is a change in place, of equal length, within one tick of the file system's
//! clock; NPZ files have checksums besides.
//!
//! Opening never waits: where a pipe has taken the place of a file since, it is refused like any other change.

use std::fs::{File, Metadata};
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::SystemTime;

use crate::error::Reason;

/// How a file begins that Git LFS left in the place of another.
const LFS_POINTER: &[u8] = b"version https://git-lfs.github.com/spec/";

/// A regular file as it was found; not open.
#[derive(Debug, Clone)]
pub(crate) struct Found {
    path: Arc<Path>,
    state: State,
}

/// An open file, as it was found until [`unchanged`](Self::unchanged) says otherwise.
#[derive(Debug)]
pub(crate) struct Opened {
    file: File,
    state: State,
}

/// What tells a file from what it was.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct State {
    /// Device and number; zero where the system has none.
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
    /// `metadata` is that of `path`, and of a regular file.
    pub(crate) fn new(path: PathBuf, metadata: &Metadata) -> Self {
        let state = State::of(metadata);
        let path = path.into();
        Self { path, state }
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// For the bodies of a file, of which there may be very many.
    pub(crate) fn shared_path(&self) -> Arc<Path> {
        self.path.clone()
    }

    /// A file that was not named but is needed: found now.
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

    /// Opens the file, if it is still the one found.
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
    /// In bytes.
    pub(crate) fn length(&self) -> u64 {
        self.state.length
    }

    /// Refuses what stands for a file whose content was not fetched.
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

    /// Refuses a file that is not as it was found.
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
