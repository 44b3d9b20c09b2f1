//! Which ending is which reader: the one place to add a format.
//!
//! A format is one file. Where a file of it is one frame, the file holds a function `read(input,
//! frame)` like `obj::read`; where a file is a sequence, a type that implements [`FrameSource`]
//! like `npz::Npz`. Either way it fills a [`Frame`], which checks what it is given and hands out
//! the proof that the frame is complete.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use crate::error::{Fault, Reason};
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

    /// Reads the next one into `frame`; not called after the last, nor after an error.
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

    /// How many frames the file at `path` has, with as little reading as the format allows.
    pub(crate) fn frame_count(self, path: &Path) -> Result<usize, Fault> {
        match self {
            Self::Obj | Self::Ply => Ok(1),
            Self::Npz => Ok(npz::Npz::open(path)?.frame_count()),
        }
    }

    pub(crate) fn open(self, path: &Path) -> Result<Box<dyn FrameSource>, Fault> {
        let one_frame = |read| -> Result<Box<dyn FrameSource>, Fault> {
            let input = BufReader::with_capacity(1 << 16, File::open(path)?);
            Ok(Box::new(OneFrame { input, read }))
        };
        match self {
            Self::Obj => one_frame(|input, frame| obj::read(input, frame)),
            Self::Ply => one_frame(|input, frame| ply::read(input, frame)),
            Self::Npz => Ok(Box::new(npz::Npz::open(path)?)),
        }
    }
}

/// A file that is one frame.
struct OneFrame {
    input: BufReader<File>,
    read: fn(&mut BufReader<File>, &mut Frame) -> Result<Complete, Fault>,
}

impl FrameSource for OneFrame {
    fn frame_count(&self) -> usize {
        1
    }

    fn read(&mut self, frame: &mut Frame) -> Result<Complete, Fault> {
        (self.read)(&mut self.input, frame)
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
}
