//! The error type of the crate: one line that names the file, the place in it, and the fault.
//!
//! A message says what to do only where the file itself must be changed, or named otherwise. The
//! options of callers have other names in a program than in Python. So a message states the limit
//! but names no option; whoever shows it chooses the advice by its [`Reason`].
//!
//! A reader does not know the name of its file: it returns a `Fault`, of which the body makes an
//! [`Error`]. Vertices, faces and frames are numbered from 0, as in pliant's results; an index
//! quoted from a file is written as in the file.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use crate::shown::{shown, shown_within};
use crate::size::Size;

/// Why a body could not be read or written. Its message is one line, whatever names it quotes.
#[derive(Debug)]
pub struct Error {
    file: PathBuf,
    place: Place,
    reason: Reason,
}

/// The place in a file to which an error refers.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Place {
    /// The file as a whole.
    File,
    /// A line of a text file, or of a text header, counted from 1.
    Line(u64),
    /// An element of a binary PLY file (`vertex`, `face`, ...), counted from 0.
    Element(String, u64),
    /// An array of an NPZ file.
    Array(&'static str),
    /// A frame of a file that holds many, counted from 0 within the file.
    Frame(u64),
    /// A byte of a binary file, counted from 0.
    Byte(u64),
    /// A part of a glTF file (`accessor`, `node`, ...), counted from 0.
    Part(&'static str, usize),
}

/// The fault that an error reports.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[allow(missing_docs)] // the messages say it, and nothing is gained by saying it twice
pub enum Reason {
    #[error("no such file")]
    NotFound,
    #[error("no file matches this pattern")]
    NoMatch,
    #[error("not a valid pattern ({0}), and no file has this name")]
    Pattern(&'static str),
    #[error("is a directory; name a file, or a pattern such as 'frame_*.obj'")]
    Directory,
    #[error("is not a regular file; copy it to one, for it may be read more than once")]
    NotAFile,
    #[error("this kind of file cannot be read; {instead}")]
    UnknownFormat { instead: &'static str },
    #[error(
        "is a Git LFS pointer, not the file that it stands for; fetch that with `git lfs pull`"
    )]
    LfsPointer,
    #[error("cannot be read: {0}")]
    Io(#[from] io::Error),
    #[error("{}", sentence(.0))]
    Malformed(String),
    #[error("ends too early: {}", sentence(.0))]
    Truncated(String),
    #[error("{}", sentence(.0))]
    Unsupported(String),
    #[error("the data of `{array}` does not match its checksum; the file is damaged")]
    Checksum { array: &'static str },
    #[error("face {face} has {corners} corners; a face needs at least 3")]
    FewCorners { face: u64, corners: usize },
    #[error(
        "face {face} visits {different} vertices {corners} times in all, \
         which no face of a surface does"
    )]
    RepeatedCorners {
        face: u64,
        corners: usize,
        different: usize,
    },
    #[error(
        "face {face} uses vertex {index}, but {}", numbering(*first, *last)
    )]
    VertexIndex {
        face: u64,
        index: i64,
        first: i64,
        last: i64,
    },
    #[error(
        "{axis} of vertex {vertex} is {value:e}; coordinates must be finite and \
         at most 3.4028235e38 in magnitude"
    )]
    Coordinate { vertex: u64, axis: char, value: f64 },
    #[error("holds no vertices")]
    NoVertices,
    #[error("holds no faces, so there is no surface to check")]
    NoFaces,
    #[error("holds no frames")]
    NoFrames,
    #[error("holds more than 4294967295 {what}, the most that are supported")]
    TooMany { what: &'static str },
    #[error(
        "a frame needs at least {} of memory, {} are allowed", Size(*needed), Size(*limit)
    )]
    TooLarge { needed: u64, limit: u64 },
    #[error(
        "a frame needs at least {} of memory while its seams are found, {} are allowed",
        Size(*needed),
        Size(*limit)
    )]
    SeamsTooLarge { needed: u64, limit: u64 },
    #[error("holds {count} bodies: {names}; name one: '{}'", shown(example))]
    ManyBodies {
        count: usize,
        names: String,
        example: String,
    },
    #[error("has no body \"{}\"; it has: {names}", shown(name))]
    NoBody { name: String, names: String },
    #[error("has no clip \"{}\"; it has: {names}", shown(name))]
    NoClip { name: String, names: String },
    #[error(
        "{} frames a second cannot be evaluated; a rate must be finite and above 0", plain(*fps)
    )]
    BadRate { fps: f64 },
    #[error(
        "its clip lasts {} s, more than {most} frames at {} a second", plain(*seconds), plain(*fps)
    )]
    ClipTooLong { seconds: f64, most: u32, fps: f64 },
    #[error("has {frames} frames; the mesh beside positions must have one")]
    MeshMoves { frames: usize },
    #[error("exists already")]
    Exists,
    #[error("this format holds one frame a file, but {frames} are to be written")]
    HoldsOneFrame { frames: usize },
    #[error("cannot be written: {0}")]
    Write(io::Error),
    #[error("a polygon has more than {most} corners, the most that are read")]
    ManyCorners { most: usize },
    #[error("the system has no memory left for it")]
    OutOfMemory,
    #[error(
        "face {face} has other corners than in {}; the frames of a body need the same faces",
        shown(than)
    )]
    FacesDiffer { face: u64, than: PathBuf },
    #[error(
        "has {faces} faces, {} has {expected}; the frames of a body need the same faces",
        shown(than)
    )]
    FaceCount {
        faces: u64,
        expected: u64,
        than: PathBuf,
    },
    #[error(
        "has {vertices} vertices, {} has {expected}; the frames of a body need the same number",
        shown(than)
    )]
    VertexCount {
        vertices: u64,
        expected: u64,
        than: PathBuf,
    },
    #[error(
        "holds 64-bit coordinates, but the body began with 32-bit ones in {}; \
         convert the frames to one type",
        shown(than)
    )]
    Precision { than: PathBuf },
    #[error("too many boundary edges are too close to each other to be joined at this tolerance")]
    SeamsTooDense,
    #[error(
        "a tolerance of {} is not possible; it must be 0, or from 1e-15 to 0.1", plain(*tolerance)
    )]
    BadTolerance { tolerance: f64 },
    #[error("changed while it was being read; wait until it is written, or copy it first")]
    Changed,
    #[error("an earlier frame could not be read, so no later one is read")]
    AfterError,
}

/// A reader's sentence in at most 1000 characters; it may quote the file.
fn sentence(text: &str) -> String {
    shown_within(text, 1000)
}

/// A name in at most 40 characters, for lists and for places.
pub(crate) fn listed_name(name: &str) -> String {
    shown_within(name, 40)
}

/// A list of names for a message: the first ten, each shortened, and the number of the others.
pub(crate) fn listed<N: AsRef<str>>(names: impl Iterator<Item = N> + Clone) -> String {
    let count = names.clone().count();
    if count == 0 {
        return "none".to_owned();
    }
    let short = names.take(10).map(|name| listed_name(name.as_ref()));
    let mut list = short.collect::<Vec<_>>().join(", ");
    if count > 10 {
        list = format!("{list} and {} more", count - 10);
    }
    list
}

/// The range of valid vertex numbers, as the end of a message.
///
/// Where the number of vertices is not known yet, `last` is the largest that a vertex can have.
/// A number as people write it: 30, 59.94, 1e300.
fn plain(number: f64) -> String {
    match number.abs() {
        0.0 | 1e-4..1e9 => number.to_string(),
        _ => format!("{number:e}"),
    }
}

fn numbering(first: i64, last: i64) -> String {
    if last < first {
        "there are no vertices yet".to_owned()
    } else if last >= i64::from(u32::MAX) - 1 {
        format!("vertices are numbered from {first} to {last} at most")
    } else {
        format!("the vertices are numbered {first} to {last} here")
    }
}

impl Error {
    pub(crate) fn new(file: impl Into<PathBuf>, fault: impl Into<Fault>) -> Self {
        let Fault {
            file: other,
            place,
            reason,
        } = fault.into();
        Self {
            file: other.unwrap_or_else(|| file.into()),
            place,
            reason,
        }
    }

    /// Path of the file, or the argument where no file was found for it.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// Place in the file.
    pub fn place(&self) -> &Place {
        &self.place
    }

    /// The fault.
    pub fn reason(&self) -> &Reason {
        &self.reason
    }

    /// Takes the fault out, for callers that say in their own words where it is.
    pub fn into_reason(self) -> Reason {
        self.reason
    }
}

impl std::error::Error for Error {}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            file,
            place,
            reason,
        } = self;
        write!(f, "{}{place}: {reason}", shown(file))
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::File => Ok(()),
            Place::Line(number) => write!(f, ", line {number}"),
            Place::Element(name, number) => write!(f, ", {} {number}", listed_name(name)),
            Place::Array(name) => write!(f, ", array `{name}`"),
            Place::Frame(number) => write!(f, ", frame {number}"),
            Place::Byte(number) => write!(f, ", byte {number}"),
            Place::Part(name, number) => write!(f, ", {name} {number}"),
        }
    }
}

/// An error without the name of its file: the error type of readers.
#[derive(Debug)]
pub(crate) struct Fault {
    /// The file, where it is not the one being read but one that this one needs.
    pub(crate) file: Option<PathBuf>,
    pub(crate) place: Place,
    pub(crate) reason: Reason,
}

impl Fault {
    /// Sets the place, unless one is set.
    pub(crate) fn or_at(mut self, place: Place) -> Self {
        if self.place == Place::File {
            self.place = place;
        }
        self
    }

    /// Sets the file, unless one is set: for a file other than the one being read.
    pub(crate) fn or_in(mut self, file: &Path) -> Self {
        self.file.get_or_insert_with(|| file.to_owned());
        self
    }
}

impl Reason {
    /// Whether the only fault is that faces or number of vertices differ from the first frame.
    pub(crate) fn is_of_another_mesh(&self) -> bool {
        matches!(
            self,
            Self::FacesDiffer { .. } | Self::FaceCount { .. } | Self::VertexCount { .. }
        )
    }

    pub(crate) fn at(self, place: Place) -> Fault {
        Fault {
            file: None,
            place,
            reason: self,
        }
    }
}

impl<R: Into<Reason>> From<R> for Fault {
    fn from(reason: R) -> Self {
        reason.into().at(Place::File)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_message_is_one_line_whatever_the_names_hold() {
        let than = PathBuf::from("first\nframe.ply");
        let error = Error::new(
            "bad\r\nname.ply",
            Reason::FacesDiffer { face: 3, than }.at(Place::Line(7)),
        );
        let message = error.to_string();
        assert_eq!(message.lines().count(), 1);
        assert_eq!(
            message,
            concat!(
                r"bad\r\nname.ply, line 7: face 3 has other corners than in first\nframe.ply; ",
                "the frames of a body need the same faces"
            )
        );
    }

    #[test]
    fn a_place_once_named_stays() {
        let fault = Reason::NoFaces.at(Place::Line(2)).or_at(Place::Frame(1));
        assert_eq!(fault.place, Place::Line(2));
        assert_eq!(
            Fault::from(Reason::NoFaces).or_at(Place::Frame(1)).place,
            Place::Frame(1)
        );
    }
}
