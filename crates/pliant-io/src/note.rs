//! What a reader did, or left undone, that the owner of the file would want to know. No error: the body is read.

use std::fmt;

use crate::shown::shown_within;

/// About a body, or about the file that it is of. Its message is one line and names no file.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Note {
    /// Vertices were joined to others near them, as [`weld_tolerance`](crate::OpenOptions::weld_tolerance) asked for.
    NearSeams {
        /// How many.
        count: usize,
        /// The largest distance of a vertex from the one it was joined to, in diagonals of the body's box.
        farthest: f64,
    },
    /// Vertices were welded whose joints hold them nearly alike, not to the bit.
    SeamsByWeights {
        /// How many.
        count: usize,
    },
    /// The animation of a glTF file moves what is not evaluated, or what is no part of any body.
    StillTargets {
        /// How many channels do.
        count: usize,
        /// What the first of them moves: a place in the JSON, as `KHR_animation_pointer` writes it.
        first: String,
    },
    /// Polygons are far from flat, so that the surface depends on how they are cut into triangles.
    BentPolygons {
        /// How many.
        count: usize,
        /// The first, counted from 0.
        first: usize,
    },
    /// Faces have two corners, and are read as the segments that they are.
    Segments {
        /// How many.
        count: usize,
        /// The first, counted from 0.
        first: usize,
    },
    /// A text ends behind a triangle, without what should end it.
    NoEnd {
        /// What that is, or stands in its place.
        end: &'static str,
    },
    /// A glTF file has no scene: all its nodes are shown.
    NoScene,
    /// An array of an NPZ or NPY file is not what it is mostly, and was read all the same.
    Array {
        /// What it holds: `vertices` or `faces`.
        holds: &'static str,
        /// What it is, as the end of a sentence that begins with it.
        is: String,
    },
    /// Polygons cross themselves, or have two corners in one place: as triangles they are fans, which meet what the polygon does not.
    CrossedPolygons {
        /// How many.
        count: usize,
        /// The first, counted from 0.
        first: usize,
    },
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NearSeams { count, farthest } => write!(
                f,
                "{count} vertices were joined to others near them, at most {farthest:.1e} of the body's size away"
            ),
            Self::SeamsByWeights { count } => write!(
                f,
                "{count} vertices were welded to others at their place, though the weights of their joints differ in the fifth place or behind it"
            ),
            Self::StillTargets { count, first } => write!(
                f,
                "{count} channels of its animation move what stands still here (the first: {})",
                shown_within(first, 100)
            ),
            Self::BentPolygons { count, first } => write!(
                f,
                "{count} polygons are far from flat (the first is face {first}); as which triangles these are meant, the file does not say"
            ),
            Self::Segments { count, first } => write!(
                f,
                "{count} faces have two corners (the first is face {first}) and are read as segments"
            ),
            Self::NoEnd { end } => write!(f, "ends {end}; what stands before it is read"),
            Self::NoScene => write!(f, "has no scene; all its nodes are read"),
            Self::Array { holds, is } => {
                write!(f, "the array of {holds} {}", shown_within(is, 100))
            }
            Self::CrossedPolygons { count, first } => write!(
                f,
                "{count} polygons cross themselves (the first is face {first}) and are made into fans; mend them or triangulate the mesh"
            ),
        }
    }
}
