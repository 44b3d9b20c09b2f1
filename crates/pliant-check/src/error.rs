//! Errors of a check. Each message is one line.
//!
//! A message names no option as a program or Python writes it. The caller that shows the message
//! adds what to do.

use pliant_io::{shown, shown_within};
use std::path::PathBuf;
use thiserror::Error;

/// `name` in quotes, shortened to 100 characters.
pub(crate) fn quoted(name: &str) -> String {
    format!("\"{}\"", shown_within(name, 100))
}

/// Why a check could not begin or could not go on.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// A file could not be read.
    #[error(transparent)]
    Read(#[from] pliant_io::Error),
    /// No source was given.
    #[error("no path was given; each is a body")]
    NoSources,
    /// A clip was asked for, but no source has an animation.
    #[error("no body has an animation, so none can be chosen")]
    NoClip,
    /// The distance is negative or not finite.
    #[error("a distance must be a finite number, at least 0; this is {0}")]
    Distance(f64),
    /// A distance was asked for with bodies checked against themselves.
    #[error(
        "neighbouring triangles of a body always are close to each other: a distance is kept \
         between two bodies or more, and not with themselves"
    )]
    WithinItself,
    /// Crossing places and a distance were asked for together.
    #[error(
        "triangles that are close need not even touch: what crosses, and how close triangles are, \
         cannot be asked at once"
    )]
    CrossingWithin,
    /// Impacts between frames were asked for, but only one frame is checked.
    #[error(
        "one frame alone is checked: there is no other to move to, and nothing to meet on the way"
    )]
    SweptOneFrame,
    /// Impacts between frames and a distance were asked for together.
    #[error(
        "on the way from frame to frame it is known who meets, not who comes close: both cannot be \
         asked at once"
    )]
    SweptWithin,
    /// Impacts between frames and a baseline were asked for together.
    #[error(
        "a baseline has pairs of triangles, and on the way from frame to frame vertices meet \
         triangles and edges meet edges: which of them are known cannot be said"
    )]
    SweptBaseline,
    /// Two moving sources differ in the number of frames.
    #[error(
        "frame counts must be equal or 1: {} has {frames} frames, {} has {other_frames}",
        shown(longest),
        shown(other)
    )]
    FrameCounts {
        /// The source with the most frames.
        longest: String,
        /// Number of frames of `longest`.
        frames: usize,
        /// A source with neither `frames` frames nor one.
        other: String,
        /// Number of frames of `other`.
        other_frames: usize,
    },
    /// A source ended before the number of frames that it announced.
    #[error("{}: frame {frame} is missing", shown(source_name))]
    Missing {
        /// Name of the source.
        source_name: String,
        /// Number of the missing frame.
        frame: usize,
    },
    /// The library refused a mesh or its positions.
    #[error("{}, frame {frame}: {error}", shown(source_name))]
    Refused {
        /// Name of the source.
        source_name: String,
        /// Number of the frame.
        frame: usize,
        /// The library's reason.
        error: pliant::Error,
    },
    /// A split into groups was asked for, but no source can be split.
    #[error("{}: cannot be split into groups: {why}", shown(source_name))]
    NoGroups {
        /// Name of the first source that cannot be split.
        source_name: String,
        /// Reason.
        why: &'static str,
    },
    /// The list of pairs would exceed its memory limit.
    #[error(
        "frame {frame}: more than {most} pairs are found, and their list needs more memory than is \
         allowed"
    )]
    TooManyPairs {
        /// Number of the frame.
        frame: usize,
        /// Most pairs that fit the limit.
        most: usize,
    },
    /// A frame has more pairs than are counted.
    #[error("frame {frame}: more than {most} pairs are found, and the rest is not looked for")]
    Endless {
        /// Number of the frame.
        frame: usize,
        /// Most pairs that are counted.
        most: usize,
    },
    /// The list of impacts between two frames would exceed its memory limit.
    #[error(
        "from frame {frame} to {until}: more than {most} pairs of elements meet, and their list \
         needs more memory than is allowed"
    )]
    TooManyImpacts {
        /// Number of the earlier frame.
        frame: usize,
        /// Number of the later frame.
        until: usize,
        /// Most impacts that fit the limit.
        most: usize,
    },
    /// More elements meet between two frames than are counted.
    #[error(
        "from frame {frame} to {until}: more than {most} pairs of elements meet, and the rest is \
         not looked for"
    )]
    EndlessImpacts {
        /// Number of the earlier frame.
        frame: usize,
        /// Number of the later frame.
        until: usize,
        /// Most impacts that are counted.
        most: usize,
    },
    /// Too many triangles are the same point, so that each meets every other.
    #[error(
        "{}: {count} triangles are one point, ({x:e}, {y:e}, {z:e}), where each meets every other",
        shown(source_name)
    )]
    OnePoint {
        /// Name of the source.
        source_name: String,
        /// Number of such triangles.
        count: usize,
        /// First coordinate of the point.
        x: f64,
        /// Second coordinate.
        y: f64,
        /// Third coordinate.
        z: f64,
    },
    /// The caller interrupted the check.
    #[error("frame {frame}: interrupted")]
    Interrupted {
        /// Number of the frame.
        frame: usize,
    },
    /// A frame number in the settings is beyond the last frame.
    #[error("{what} is frame {frame}, but the frames of these files are 0 to {last}")]
    NoSuchFrame {
        /// Role of the frame, such as "the baseline".
        what: &'static str,
        /// Number of the frame that was asked for.
        frame: usize,
        /// Number of the last frame.
        last: usize,
    },
    /// A name in a group or in an ignored pair matches no body and no group.
    #[error("no {wanted} is called {}; {there}", quoted(name))]
    NoSuchName {
        /// Kind of thing that was looked for: "body", or "body or group".
        wanted: &'static str,
        /// The unknown name.
        name: String,
        /// List of the known names.
        there: String,
    },
    /// A group cannot have this name.
    #[error("no group can be called {}: {why}", quoted(name))]
    BadGroup {
        /// The name.
        name: String,
        /// Reason.
        why: &'static str,
    },
    /// A group has no bodies.
    #[error("no bodies are named for the group {}", quoted(name))]
    EmptyGroup {
        /// The name of the group.
        name: String,
    },
    /// The file of a baseline cannot be used.
    #[error("the baseline {}: {}", shown(file), shown_within(why, 1000))]
    BadBaseline {
        /// Path of the file.
        file: PathBuf,
        /// Reason.
        why: String,
    },
    /// A source that is split changes its mesh.
    #[error(
        "{}, frame {frame}: has another mesh than before, and what a body is split into is known \
         of its first mesh only",
        shown(source_name)
    )]
    PiecesChanged {
        /// Name of the source.
        source_name: String,
        /// Number of the frame.
        frame: usize,
    },
    /// Split into connected pieces, an argument names a group of an OBJ file.
    ///
    /// Numbers of pieces would stand where the group's name does.
    #[error(
        "{} is a group, and behind the # of a file that is split into connected pieces stand their \
         numbers",
        shown(name)
    )]
    PiecesOfGroup {
        /// Name of the file, `#`, and the name of the group.
        name: String,
    },
    /// Two arguments name the same group of an OBJ file.
    #[error(
        "{}: {} is named twice, as {} and as {}",
        shown(file),
        quoted(group),
        quoted(&names[0]),
        quoted(&names[1])
    )]
    NamedTwice {
        /// Name of the file.
        file: String,
        /// Name of the group.
        group: String,
        /// The text behind the `#` in the two arguments.
        names: [String; 2],
    },
    /// An earlier call failed, so that no frame follows.
    #[error("an earlier frame could not be checked, so the frames after it are not")]
    AfterError,
}
