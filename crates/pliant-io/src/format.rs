//! File formats: maps file endings to readers, and is the one place to add a format.
//!
//! A format is one file of code, or a folder. Where a file of the format holds one frame, the
//! format has a function `read(input, frame)` like `obj::read`. Where it holds a sequence, a type
//! implements [`FrameSource`] like `npz::Npz`. Both fill a [`Frame`], which checks the data and
//! returns the proof that the frame is complete.

use std::io::BufReader;
use std::path::Path;

use crate::error::{Fault, Reason};
use crate::file::{Found, Opened};
use crate::frame::{Complete, Frame};
use crate::options::OpenOptions;
use crate::shown::shown;
use crate::source::FrameSource;
use crate::{gltf, npz, obj, ply, stl};

/// Advice for a file of an unknown format, as the end of a message.
const READABLE: &str = "these can: one frame per file (.obj, .ply, .stl); \
    a sequence per file (.npz, .glb, .gltf, .vrm); \
    positions beside a mesh ('mesh.obj+positions.pc2', .mdd, .npy)";
/// Advice for a format of another program, as the end of a message.
const EXPORT: &str = "export glTF (.glb) with its animation; \
    or a mesh and its point cache (.obj and .pc2 or .mdd); or one file per frame";
/// Advice for a USD file, as the end of a message.
const USD: &str = "the Python package reads it (pip install 'pliant[usd]'); \
    or export glTF (.glb) with its animation; \
    or a mesh and its point cache (.obj and .pc2 or .mdd); or one file per frame";

/// The format of a file.

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Format {
    Obj,
    Ply,
    Stl,
    Npz,
    Gltf,
    Pc2,
    Mdd,
    Npy,
    /// Frames that the calling program evaluates; no file ending maps to it.
    Evaluated,
}

impl Format {
    /// Returns the format of a file by its ending, in either case of letters.
    pub(crate) fn of(path: &Path) -> Result<Self, Reason> {
        let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
        match ending.to_str() {
            Some("obj") => Ok(Self::Obj),
            Some("ply") => Ok(Self::Ply),
            Some("stl") => Ok(Self::Stl),
            Some("npz") => Ok(Self::Npz),
            Some("gltf" | "glb" | "vrm") => Ok(Self::Gltf),
            Some("pc2") => Ok(Self::Pc2),
            Some("mdd") => Ok(Self::Mdd),
            Some("npy") => Ok(Self::Npy),
            Some("usd" | "usda" | "usdc" | "usdz") => Err(Reason::UnknownFormat { instead: USD }),
            Some(
                "fbx" | "abc" | "blend" | "ma" | "mb" | "max" | "dae" | "3ds" | "c4d" | "hip"
                | "step" | "stp" | "iges" | "igs",
            ) => Err(Reason::UnknownFormat { instead: EXPORT }),
            _ => Err(Reason::UnknownFormat { instead: READABLE }),
        }
    }

    /// Whether a file may hold several bodies.
    pub(crate) fn holds_bodies(self) -> bool {
        self == Self::Gltf
    }

    /// Whether a file may name groups of its triangles.
    pub(crate) fn holds_groups(self) -> bool {
        matches!(self, Self::Obj | Self::Stl)
    }

    /// Whether a file holds positions alone.
    pub(crate) fn is_cache(self) -> bool {
        matches!(self, Self::Pc2 | Self::Mdd | Self::Npy)
    }

    /// Number of frames of `file`, found with as little reading as the format allows.
    pub(crate) fn frame_count(self, file: &Found, options: &OpenOptions) -> Result<usize, Fault> {
        match self {
            Self::Obj | Self::Ply | Self::Stl => Ok(1),
            Self::Npz | Self::Gltf | Self::Pc2 | Self::Mdd | Self::Npy | Self::Evaluated => {
                Ok(self.open(file, options)?.frame_count())
            }
        }
    }

    /// Opens a file of this format; its frames are then read in order.
    pub(crate) fn open(
        self,
        file: &Found,
        options: &OpenOptions,
    ) -> Result<Box<dyn FrameSource>, Fault> {
        let one_frame = |read| -> Result<Box<dyn FrameSource>, Fault> {
            let input = BufReader::with_capacity(1 << 16, file.open()?);
            Ok(Box::new(OneFrame { input, read }))
        };
        match self {
            Self::Obj => one_frame(|input, frame| obj::read(input, frame)),
            Self::Ply => one_frame(|input, frame| ply::read(input, frame)),
            Self::Stl => one_frame(|input, frame| {
                let length = input.get_ref().length();
                stl::read(input, length, frame)
            }),
            Self::Npz => Ok(Box::new(npz::Npz::open(file, options.max_memory)?)),
            Self::Gltf => Ok(Box::new(gltf::open_one(file, options)?)),
            Self::Pc2 | Self::Mdd | Self::Npy => Err(without_faces(file.path()).into()),
            // Never called: evaluated frames rewind without being opened again.
            Self::Evaluated => Err(Reason::UnknownFormat { instead: READABLE }.into()),
        }
    }
}

/// The error for a file of positions that is named without a mesh.
fn without_faces(path: &Path) -> Reason {
    let name = shown(path.file_name().unwrap_or_default());
    Reason::Unsupported(format!(
        "holds positions but no faces; name the mesh that they move too: 'mesh.obj+{name}'"
    ))
}

/// The source of a file that holds one frame.
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
        // Before the reader's own error: a change while reading is the likelier cause of it.
        self.input.get_ref().unchanged()?;
        read
    }

    fn skip(&mut self, _: usize) -> Result<(), Fault> {
        Ok(()) // never needed: at least one frame must be left after skipping
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_decide_in_either_case() {
        assert_eq!(Format::of(Path::new("a/b.OBJ")).ok(), Some(Format::Obj));
        assert_eq!(Format::of(Path::new("b.obj.Ply")).ok(), Some(Format::Ply));
        for gltf in ["a.glb", "a.gltf", "a.VRM"] {
            assert_eq!(Format::of(Path::new(gltf)).ok(), Some(Format::Gltf));
        }
        for unknown in ["a.npt", "a.fbx", "a", ".obj", "obj", "a.obj."] {
            assert!(Format::of(Path::new(unknown)).is_err(), "{unknown}");
        }
    }

    #[test]
    fn a_file_that_changes_under_its_reader_is_refused() {
        const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3\n\
            property float x\nproperty float y\nproperty float z\n\
            element face 1\nproperty list uchar int vertex_index\nend_header\n\
            0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in [("a.obj", OBJ), ("a.ply", PLY)] {
            let path = folder.path().join(name);
            // One triangle more, half of the file, nothing at all, and no change.
            for (change, refused) in [
                (text.to_owned() + "\n3 0 1 2\n", true),
                (text[..text.len() / 2].to_owned(), true),
                (String::new(), true),
                (text.to_owned(), false),
            ] {
                std::fs::write(&path, text).unwrap();
                let found = Found::on_disk(path.clone()).unwrap();
                let mut source = Format::of(&path)
                    .unwrap()
                    .open(&found, &OpenOptions::default())
                    .unwrap();
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
