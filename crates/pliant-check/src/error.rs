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

/// `number` and the noun for that many.
fn counted(number: usize, one: &str, many: &str) -> String {
    format!("{number} {}", if number == 1 { one } else { many })
}

/// A source and a frame, as messages begin; the frame alone, if no source is to blame.
fn place(source_name: &str, frame: usize) -> String {
    match source_name {
        "" => format!("frame {frame}"),
        name => format!("{}, frame {frame}", shown(name)),
    }
}

/// Why a check could not begin or could not go on.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// A file could not be read.
    #[error(transparent)]
    Read(#[from] pliant_io::Error),
    /// No source was given.
    #[error("no file was given to check; give at least one")]
    NoSources,
    /// A clip was asked for, but no source has an animation.
    #[error("an animation was asked for by name, but none of the files has one")]
    NoClip,
    /// The distance is negative or not finite.
    #[error(
        "pairs within {0:?} of each other cannot be searched for: a distance must be finite and at \
         least 0"
    )]
    Distance(f64),
    /// A distance was asked for with bodies checked against themselves, without a rest shape.
    #[error(
        "pairs within a distance are searched for between different bodies only, unless there is \
         a rest shape, or labels of all bodies: neighbouring triangles of one body are always that \
         close"
    )]
    WithinItself,
    /// The labels of a source cannot be used.
    #[error("the labels {}: {}", shown(file), shown_within(why, 1000))]
    BadLabels {
        /// Path of the file.
        file: PathBuf,
        /// Reason.
        why: String,
    },
    /// A source whose mesh changes has no labels any more.
    #[error(
        "{}: the mesh is another than in the first frame, and the labels say nothing about it",
        place(source_name, *frame)
    )]
    LabelsChanged {
        /// Name of the source.
        source_name: String,
        /// Number of the frame.
        frame: usize,
    },
    /// Labels and crossing places, or impacts, were asked for together.
    #[error(
        "labels leave out pairs of triangles, which {} cannot do without",
        if *swept { "what meets on the way from frame to frame" } else { "places that cross" }
    )]
    LabelsWith {
        /// Whether impacts were asked for, not crossing places.
        swept: bool,
    },
    /// A rest shape was given without a distance.
    #[error("a rest shape says which triangles are always close, and no distance was asked for")]
    RestAlone,
    /// The file of a rest shape cannot be used.
    #[error("the rest shape {}: {}", shown(file), shown_within(why, 1000))]
    BadRest {
        /// Path of the file.
        file: PathBuf,
        /// Reason.
        why: String,
    },
    /// A source whose mesh changes has no rest shape any more.
    #[error(
        "{}: the mesh is another than in the rest shape, which says nothing about it",
        place(source_name, *frame)
    )]
    RestChanged {
        /// Name of the source.
        source_name: String,
        /// Number of the frame.
        frame: usize,
    },
    /// Crossing places and a distance were asked for together.
    #[error(
        "places that cross and pairs within a distance cannot be asked for in one check: triangles \
         that are only close do not cross"
    )]
    CrossingWithin,
    /// Impacts between frames were asked for, but fewer than two frames are checked.
    #[error(
        "what meets on the way from frame to frame needs at least two frames, and {} to be checked",
        if *count == 1 { "only one is" } else { "none is" }
    )]
    SweptOneFrame {
        /// Number of frames to be checked: 0 or 1.
        count: usize,
    },
    /// Impacts between frames and a distance were asked for together.
    #[error(
        "what meets on the way from frame to frame and what is within a distance cannot be asked \
         for in one check: on the way, only contacts are found"
    )]
    SweptWithin,
    /// Impacts between frames and a baseline were asked for together.
    #[error(
        "a baseline cannot be used for what meets on the way from frame to frame: it lists pairs \
         of triangles, and on the way vertices meet triangles and edges meet edges"
    )]
    SweptBaseline,
    /// Two moving sources differ in the number of frames.
    #[error(
        "{} has {frames} frames and {} has {other_frames}; a body must have as many frames as the \
         longest, or 1 if it stands still",
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
    #[error(
        "{}: ends before frame {frame}, though it announces {}",
        shown(source_name),
        counted(*frames, "frame", "frames")
    )]
    Missing {
        /// Name of the source.
        source_name: String,
        /// Number of the missing frame.
        frame: usize,
        /// Number of frames that the source announced.
        frames: usize,
    },
    /// The library refused a mesh or its positions.
    #[error("{}: {error}", place(source_name, *frame))]
    Refused {
        /// Name of the source; empty if the library blames no body.
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
        "frame {frame}: has more than {most} pairs, the most that a list holds in the memory that \
         is allowed"
    )]
    TooManyPairs {
        /// Number of the frame.
        frame: usize,
        /// Most pairs that fit the limit.
        most: usize,
    },
    /// A frame has more pairs than are counted.
    #[error("frame {frame}: has more than {most} pairs, the most that are counted")]
    Endless {
        /// Number of the frame.
        frame: usize,
        /// Most pairs that are counted.
        most: usize,
    },
    /// The list of impacts between two frames would exceed its memory limit.
    #[error(
        "from frame {frame} to frame {until}: more than {most} pairs of elements meet, the most \
         that a list holds in the memory that is allowed"
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
        "from frame {frame} to frame {until}: more than {most} pairs of elements meet, the most \
         that are counted"
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
        "{}: {count} triangles have no size and lie at one point, ({x:?}, {y:?}, {z:?}); each \
         would be a pair with every other",
        place(source_name, *frame)
    )]
    OnePoint {
        /// Name of the source.
        source_name: String,
        /// Number of the frame.
        frame: usize,
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
    #[error("frame {frame}: stopped on request; the same call can be made again")]
    Interrupted {
        /// Number of the frame.
        frame: usize,
    },
    /// A frame number in the settings is beyond the last frame.
    #[error(
        "{what} is frame {frame}, but these files have {}",
        match last {
            0 => "one frame, 0".to_owned(),
            last => format!("frames 0 to {last}"),
        }
    )]
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
    #[error("the group {} cannot be made: {why}", quoted(name))]
    BadGroup {
        /// The name.
        name: String,
        /// Reason.
        why: &'static str,
    },
    /// A group has no bodies.
    #[error("the group {} has no bodies", quoted(name))]
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
        "{}: the mesh is another than in the first frame, and which triangles form which body is \
         known for the first frame's mesh only",
        place(source_name, *frame)
    )]
    PiecesChanged {
        /// Name of the source.
        source_name: String,
        /// Number of the frame.
        frame: usize,
        /// Whether arguments name groups of the source, as `scan.obj#arm` does.
        by_name: bool,
    },
    /// Split into connected pieces, an argument names a group of an OBJ file.
    ///
    /// The number of a piece would stand where the group's name does.
    #[error(
        "{} names a group, and a file of which groups are named is not split into connected pieces",
        shown(name)
    )]
    PiecesOfGroup {
        /// Name of the file, `#`, and the name of the group.
        name: String,
    },
    /// Two arguments name the same group of an OBJ file.
    #[error(
        "the group {} of {} is named by two arguments, {} and {}",
        quoted(group),
        shown(file),
        quoted(&format!("{file}#{}", names[0])),
        quoted(&format!("{file}#{}", names[1]))
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
    #[error("the check ended at frame {frame}, and nothing follows: {error}")]
    AfterError {
        /// Number of the frame at which the check ended.
        frame: usize,
        /// Message of the error with which it ended.
        error: String,
    },
}
