//! Which ending is which reader: the one place to add a format.
//!
//! A format is one file. Where a file of it is one frame, the file holds a function `read(input,
//! frame)` like `obj::read`; where a file is a sequence, a type that implements [`FrameSource`]
//! like `npz::Npz`. Either way it fills a [`Frame`], which checks what it is given and hands out
//! the proof that the frame is complete.

use std::io::BufReader;
use std::path::Path;

use crate::error::{Fault, Reason};
use crate::file::{Found, Opened};
use crate::frame::{Complete, Frame};
use crate::{npz, obj, ply};

/// For messages.
const READABLE: &str = "a frame a file: .obj, .ply; a sequence a file: .npz";

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Format {
    Obj,
    Ply,
    Npz,
}

/// The frames of one file, in order.
pub(crate) trait FrameSource: Send {
    /// How many there are.
    fn frame_count(&self) -> usize;

    /// Reads the next one into `frame`, from a file that did not change meanwhile; not called after the last, nor after an
    /// error.
    fn read(&mut self, frame: &mut Frame) -> Result<Complete, Fault>;
}

impl Format {
    /// By the ending of the name, in either case.
    pub(crate) fn of(path: &Path) -> Result<Self, Reason> {
        let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
        match ending.to_str() {
            Some("obj") => Ok(Self::Obj),
            Some("ply") => Ok(Self::Ply),
            Some("npz") => Ok(Self::Npz),
            _ => Err(Reason::UnknownFormat { readable: READABLE }),
        }
    }

    /// How many frames `file` has, with as little reading as the format allows.
    pub(crate) fn frame_count(self, file: &Found) -> Result<usize, Fault> {
        match self {
            Self::Obj | Self::Ply => Ok(1),
            Self::Npz => Ok(npz::Npz::open(file)?.frame_count()),
        }
    }

    pub(crate) fn open(self, file: &Found) -> Result<Box<dyn FrameSource>, Fault> {
        let one_frame = |read| -> Result<Box<dyn FrameSource>, Fault> {
            let input = BufReader::with_capacity(1 << 16, file.open()?);
            Ok(Box::new(OneFrame { input, read }))
        };
        match self {
            Self::Obj => one_frame(|input, frame| obj::read(input, frame)),
            Self::Ply => one_frame(|input, frame| ply::read(input, frame)),
            Self::Npz => Ok(Box::new(npz::Npz::open(file)?)),
        }
    }
}

/// A file that is one frame.
struct OneFrame {
    input: BufReader<Opened>,
    read: fn(&mut BufReader<Opened>, &mut Frame) -> Result<Complete, Fault>,
}

impl FrameSource for OneFrame {
    fn frame_count(&self) -> usize {
        1
    }

    fn read(&mut self, frame: &mut Frame) -> Result<Complete, Fault> {
        let read = (self.read)(&mut self.input, frame);
        // First: what looks wrong may be half of a change.
        self.input.get_ref().unchanged()?;
        read
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_decide_in_either_case() {
        assert_eq!(Format::of(Path::new("a/b.OBJ")).ok(), Some(Format::Obj));
        assert_eq!(Format::of(Path::new("b.obj.Ply")).ok(), Some(Format::Ply));
        for unknown in ["a.npy", "a.stl", "a", ".obj", "obj", "a.obj."] {
            assert!(Format::of(Path::new(unknown)).is_err(), "{unknown}");
        }
    }

    #[test]
    fn a_file_that_changes_under_its_reader_is_refused() {
        const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
            property float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n\
            0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in [("a.obj", OBJ), ("a.ply", PLY)] {
            let path = folder.path().join(name);
            // Whole triangles more, half of it, nothing at all, and what it was.
            for (change, refused) in [
                (text.to_owned() + "\n3 0 1 2\n", true),
                (text[..text.len() / 2].to_owned(), true),
                (String::new(), true),
                (text.to_owned(), false),
            ] {
                std::fs::write(&path, text).unwrap();
                let found = Found::new(path.clone(), &path.metadata().unwrap());
                let mut source = Format::of(&path).unwrap().open(&found).unwrap();
                if refused {
                    std::fs::write(&path, change).unwrap();
                }
                let read = source.read(&mut Frame::new(1 << 20, true));
                assert_eq!(read.is_err(), refused);
                if let Err(fault) = read {
                    assert!(matches!(fault.reason, Reason::Changed), "{fault:?}");
                }
            }
        }
    }
}
