//! Notes: remarks about a body that was read, worth telling the owner of the file. No errors.

use std::fmt;

use crate::shown::shown_within;

/// A remark about a body, or about its file. Its message is one line and does not name the file.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Note {
    /// Vertices were joined to others near them, as
    /// [`weld_tolerance`](crate::OpenOptions::weld_tolerance) asked for.
    NearSeams {
        /// Number of vertices joined away.
        count: usize,
        /// The largest distance of a joined vertex from the one that replaces it, in diagonals of
        /// the body's bounding box.
        farthest: f64,
    },
    /// Vertices were welded whose joint weights are nearly equal, but not to the bit.
    SeamsByWeights {
        /// Number of these vertices.
        count: usize,
    },
    /// The animation of a glTF file moves something that is not evaluated, or part of no body.
    StillTargets {
        /// Number of such channels.
        count: usize,
        /// The target of the first, as a JSON pointer: the notation of `KHR_animation_pointer`.
        first: String,
    },
    /// Polygons are far from flat: the surface depends on how they are triangulated.
    BentPolygons {
        /// Number of these polygons.
        count: usize,
        /// The first of them, counted from 0.
        first: usize,
    },
    /// Faces have two corners; they are read as line segments.
    Segments {
        /// Number of these faces.
        count: usize,
        /// The first of them, counted from 0.
        first: usize,
    },
    /// A text file lacks the keyword that should end it, behind a complete triangle.
    NoEnd {
        /// The missing keyword, and any text in its place, as the rest of "ends ...".
        end: &'static str,
    },
    /// A glTF file has no scene: all its nodes are read.
    NoScene,
    /// An array of an NPZ or NPY file has an unusual shape or type, and was read all the same.
    Array {
        /// Content of the array: `vertices` or `faces`.
        holds: &'static str,
        /// The peculiarity, as the end of a sentence whose subject is the array.
        is: String,
    },
    /// Polygons cross themselves, or have two corners in one place.
    ///
    /// They are triangulated as fans, which meet things that the polygon does not.
    CrossedPolygons {
        /// Number of these polygons.
        count: usize,
        /// The first of them, counted from 0.
        first: usize,
    },
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NearSeams { count, farthest } => write!(
                f,
                "{count} vertices were merged with a vertex near them, \
                 at most {farthest:.1e} of the body's size away"
            ),
            Self::SeamsByWeights { count } => write!(
                f,
                "{count} vertices were merged with others at the same position, \
                 although their skinning weights differ slightly, by at most 1e-5 of their sum"
            ),
            Self::StillTargets { count, first } => write!(
                f,
                "{count} animation channels have no effect here: they move something that is \
                 not evaluated, or part of no body (the first: {})",
                shown_within(first, 100)
            ),
            Self::BentPolygons { count, first } => write!(
                f,
                "{count} polygons are far from flat (the first is face {first}); \
                 their triangulation is a guess; triangulate the mesh to choose it"
            ),
            Self::Segments { count, first } => write!(
                f,
                "{count} faces have two corners (the first is face {first}) \
                 and are read as segments"
            ),
            Self::NoEnd { end } => write!(f, "ends {end}; all its triangles were read"),
            Self::NoScene => write!(f, "has no scene; all its nodes are read"),
            Self::Array { holds, is } => {
                write!(f, "the array of {holds} {}", shown_within(is, 100))
            }
            Self::CrossedPolygons { count, first } => write!(
                f,
                "{count} polygons cross themselves (the first is face {first}) \
                 and were triangulated as fans, which may add intersections; \
                 mend them or triangulate the mesh"
            ),
        }
    }
}
