//! Why a check could not begin, or could not go on. Each message is one line, and names no option as a program or Python writes
//! it: whoever shows the message adds what to do.

use thiserror::Error;

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
    /// Sources move, but not together.
    #[error(
        "frame counts must be equal or 1: {longest} has {frames} frames, {other} has {other_frames}"
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
    #[error("{source_name}: frame {frame} is missing")]
    Missing {
        /// The source.
        source_name: String,
        /// The frame.
        frame: usize,
    },
    /// The library refused what was read.
    #[error("{source_name}, frame {frame}: {error}")]
    Refused {
        /// The source.
        source_name: String,
        /// The frame.
        frame: usize,
        /// What was wrong.
        error: pliant::Error,
    },
    /// A list of pairs would take more memory than it may.
    #[error(
        "frame {frame}: more than {most} pairs intersect, and their list needs more memory than is allowed"
    )]
    TooManyPairs {
        /// The frame.
        frame: usize,
        /// So many may be listed.
        most: usize,
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
    #[error("no {wanted} is called {name:?}; {there}")]
    NoSuchName {
        /// What it could have been.
        wanted: &'static str,
        /// The name.
        name: String,
        /// Those that there are.
        there: String,
    },
    /// A group cannot have this name.
    #[error("no group can be called {name:?}: {why}")]
    BadGroup {
        /// The name.
        name: String,
        /// Why not.
        why: &'static str,
    },
    /// A group has no bodies.
    #[error("no bodies are named for the group {name:?}")]
    EmptyGroup {
        /// The name.
        name: String,
    },
    /// An earlier frame could not be checked.
    #[error("an earlier frame could not be checked, so the frames after it are not")]
    AfterError,
}
