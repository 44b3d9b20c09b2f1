//! Detection of files that change while they are read.
//!
//! A file may still be written, or be replaced before its turn. So a file's identity, length and
//! modification time are recorded when it is found ([`Found`]). They are compared when it is opened
//! and after every frame. A change in place, of equal length and within one tick of the file
//! system's clock, goes unseen; NPZ files also have checksums. Opening never waits: a pipe that has
//! replaced a file is refused like any other change.

use std::fmt;
use std::fs::{File, Metadata};
use std::io::{self, Cursor, Read, Seek, SeekFrom};
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
    content: Content,
}

/// Where the bytes of a file are.
#[derive(Debug, Clone)]
enum Content {
    Disk(State),
    Memory(Bytes),
}

/// An open file, unchanged as far as the last [`unchanged`](Self::unchanged) could tell.
#[derive(Debug)]
pub(crate) enum Opened {
    Disk { file: File, state: State },
    Memory(Cursor<Bytes>),
}

/// Bytes of a file in memory, which cannot change; clones share them.
#[derive(Clone, PartialEq, Eq)]
pub(crate) struct Bytes(Arc<Vec<u8>>);

impl From<Vec<u8>> for Bytes {
    fn from(bytes: Vec<u8>) -> Self {
        Self(Arc::new(bytes))
    }
}

impl AsRef<[u8]> for Bytes {
    fn as_ref(&self) -> &[u8] {
        &self.0
    }
}

impl fmt::Debug for Bytes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} bytes", self.0.len())
    }
}

/// Properties of a file that reveal a change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct State {
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
    /// Records the state of a regular file on disk.
    pub(crate) fn on_disk(path: PathBuf) -> Result<Self, Reason> {
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
        Ok(Self {
            path: path.into(),
            content: Content::Disk(State::of(&metadata)),
        })
    }

    pub(crate) fn in_memory(bytes: Bytes, path: PathBuf) -> Self {
        Self {
            path: path.into(),
            content: Content::Memory(bytes),
        }
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Shared path: the many bodies of one file need only one copy.
    pub(crate) fn shared_path(&self) -> Arc<Path> {
        self.path.clone()
    }

    /// Opens the file if it has not changed since it was found.
    pub(crate) fn open(&self) -> Result<Opened, Reason> {
        let mut opened = match &self.content {
            Content::Memory(bytes) => Opened::Memory(Cursor::new(bytes.clone())),
            &Content::Disk(state) => {
                let mut options = File::options();
                options.read(true);
                #[cfg(unix)]
                {
                    use std::os::unix::fs::OpenOptionsExt;
                    options.custom_flags(libc::O_NONBLOCK);
                }
                let file = options.open(&self.path)?;
                Opened::Disk { file, state }
            }
        };
        opened.unchanged()?;
        opened.check_content()?;
        Ok(opened)
    }
}

impl Opened {
    /// Length of the file in bytes.
    pub(crate) fn length(&self) -> u64 {
        match self {
            Self::Disk { state, .. } => state.length,
            Self::Memory(bytes) => bytes.get_ref().as_ref().len() as u64,
        }
    }

    /// Refuses a Git LFS pointer.
    fn check_content(&mut self) -> Result<(), Reason> {
        let mut begin = Vec::with_capacity(LFS_POINTER.len());
        let begins = self.by_ref().take(LFS_POINTER.len() as u64);
        { begins }.read_to_end(&mut begin)?;
        if begin == LFS_POINTER {
            return Err(Reason::LfsPointer);
        }
        self.rewind()?;
        Ok(())
    }

    /// Returns an error if the file has changed since it was found.
    pub(crate) fn unchanged(&self) -> Result<(), Reason> {
        match self {
            Self::Disk { file, state } if State::of(&file.metadata()?) != *state => {
                Err(Reason::Changed)
            }
            _ => Ok(()),
        }
    }
}

impl Read for Opened {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        match self {
            Self::Disk { file, .. } => file.read(buffer),
            Self::Memory(bytes) => bytes.read(buffer),
        }
    }
}

impl Seek for Opened {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        match self {
            Self::Disk { file, .. } => file.seek(to),
            Self::Memory(bytes) => bytes.seek(to),
        }
    }
}
