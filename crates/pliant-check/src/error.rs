//! Why a check could not begin, or could not go on. Each message is one line, and names no option as a program or Python writes
//! it: whoever shows the message adds what to do.

use pliant_io::{shown, shown_within};
use std::path::PathBuf;
use thiserror::Error;

/// A name in quotes.
pub(crate) fn quoted(name: &str) -> String {
    format!("\"{}\"", shown_within(name, 100))
}

/// Why frames could not be checked.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// A file could not be read.
    #[error(transparent)]
    Read(#[from] pliant_io::Error),
    /// There is nothing to check.
    #[error("no path was given; each is a body")]
    NoSources,
    /// A clip was asked for, but no source has one.
    #[error("no body has an animation, so none can be chosen")]
    NoClip,
    /// A distance that is none.
    #[error("a distance must be a finite number, at least 0; this is {0}")]
    Distance(f64),
    /// Bodies are asked how close they are to themselves.
    #[error(
        "neighbouring triangles of a body always are close to each other: a distance is kept between two bodies or more, and not with themselves"
    )]
    WithinItself,
    /// It is asked what crosses, and how close triangles are.
    #[error(
        "triangles that are close need not even touch: what crosses, and how close triangles are, cannot be asked at once"
    )]
    CrossingWithin,
    /// It is asked what meets between frames, and only one is checked.
    #[error(
        "one frame alone is checked: there is no other to move to, and nothing to meet on the way"
    )]
    SweptOneFrame,
    /// It is asked what meets between frames, and how close triangles are.
    #[error(
        "on the way from frame to frame it is known who meets, not who comes close: both cannot be asked at once"
    )]
    SweptWithin,
    /// It is asked what meets between frames, and pairs are to be left out.
    #[error(
        "a baseline has pairs of triangles, and on the way from frame to frame vertices meet triangles and edges meet edges: which of them are known cannot be said"
    )]
    SweptBaseline,
    /// Sources move, but not together.
    #[error(
        "frame counts must be equal or 1: {} has {frames} frames, {} has {other_frames}",
        shown(longest),
        shown(other)
    )]
    FrameCounts {
        /// The source with the most frames.
        longest: String,
        /// How many it has.
        frames: usize,
        /// One that has neither as many nor one.
        other: String,
        /// How many that has.
        other_frames: usize,
    },
    /// A source ended before the frame that it said it has.
    #[error("{}: frame {frame} is missing", shown(source_name))]
    Missing {
        /// The source.
        source_name: String,
        /// The frame.
        frame: usize,
    },
    /// The library refused what was read.
    #[error("{}, frame {frame}: {error}", shown(source_name))]
    Refused {
        /// The source.
        source_name: String,
        /// The frame.
        frame: usize,
        /// What was wrong.
        error: pliant::Error,
    },
    /// Sources are to be split into groups, and none can be.
    #[error("{}: cannot be split into groups: {why}", shown(source_name))]
    NoGroups {
        /// The first that cannot be.
        source_name: String,
        /// Why.
        why: &'static str,
    },
    /// A list of pairs would take more memory than it may.
    #[error(
        "frame {frame}: more than {most} pairs are found, and their list needs more memory than is allowed"
    )]
    TooManyPairs {
        /// The frame.
        frame: usize,
        /// So many may be listed.
        most: usize,
    },
    /// There are more pairs than anybody would wait for, or look at.
    #[error("frame {frame}: more than {most} pairs are found, and the rest is not looked for")]
    Endless {
        /// The frame.
        frame: usize,
        /// So many are counted.
        most: usize,
    },
    /// A list of what meets between two frames would take more memory than it may.
    #[error(
        "from frame {frame} to {until}: more than {most} pairs of elements meet, and their list needs more memory than is allowed"
    )]
    TooManyImpacts {
        /// The frame.
        frame: usize,
        /// The next.
        until: usize,
        /// So many may be listed.
        most: usize,
    },
    /// More meets between two frames than anybody would wait for, or look at.
    #[error(
        "from frame {frame} to {until}: more than {most} pairs of elements meet, and the rest is not looked for"
    )]
    EndlessImpacts {
        /// The frame.
        frame: usize,
        /// The next.
        until: usize,
        /// So many are counted.
        most: usize,
    },
    /// Very many triangles are points, and at one place: each of them meets every other.
    #[error(
        "{}: {count} triangles are one point, ({x:e}, {y:e}, {z:e}), where each meets every other",
        shown(source_name)
    )]
    OnePoint {
        /// The source.
        source_name: String,
        /// How many there are.
        count: usize,
        /// Where.
        x: f64,
        /// Where.
        y: f64,
        /// Where.
        z: f64,
    },
    /// The caller did not want to wait any longer.
    #[error("frame {frame}: interrupted")]
    Interrupted {
        /// The frame.
        frame: usize,
    },
    /// There is no such frame.
    #[error("{what} is frame {frame}, but the frames of these files are 0 to {last}")]
    NoSuchFrame {
        /// What was to be that frame.
        what: &'static str,
        /// The frame.
        frame: usize,
        /// The last that there is.
        last: usize,
    },
    /// A name in a group or in a pair to be ignored is nobody's.
    #[error("no {wanted} is called {}; {there}", quoted(name))]
    NoSuchName {
        /// What it could have been.
        wanted: &'static str,
        /// The name.
        name: String,
        /// Those that there are.
        there: String,
    },
    /// A group cannot have this name.
    #[error("no group can be called {}: {why}", quoted(name))]
    BadGroup {
        /// The name.
        name: String,
        /// Why not.
        why: &'static str,
    },
    /// A group has no bodies.
    #[error("no bodies are named for the group {}", quoted(name))]
    EmptyGroup {
        /// The name.
        name: String,
    },
    /// The pairs of an earlier check cannot be left out.
    #[error("the baseline {}: {}", shown(file), shown_within(why, 1000))]
    BadBaseline {
        /// Where they were to be read from.
        file: PathBuf,
        /// Why not.
        why: String,
    },
    /// Sources are split into pieces, and the mesh of one changes.
    #[error(
        "{}, frame {frame}: has another mesh than before, and what a body is split into is known of its first mesh only",
        shown(source_name)
    )]
    PiecesChanged {
        /// The source.
        source_name: String,
        /// The frame.
        frame: usize,
    },
    /// A group of an OBJ file is to be split into connected pieces, whose numbers would stand where its name does.
    #[error(
        "{} is a group, and behind the # of a file that is split into connected pieces stand their numbers",
        shown(name)
    )]
    PiecesOfGroup {
        /// The name of the group, behind that of its file.
        name: String,
    },
    /// A group of an OBJ file is named by two arguments.
    #[error(
        "{}: {} is named twice, as {} and as {}",
        shown(file),
        quoted(group),
        quoted(&names[0]),
        quoted(&names[1])
    )]
    NamedTwice {
        /// The file.
        file: String,
        /// The group.
        group: String,
        /// What stands behind the # in the two arguments.
        names: [String; 2],
    },
    /// An earlier frame could not be checked.
    #[error("an earlier frame could not be checked, so the frames after it are not")]
    AfterError,
}
