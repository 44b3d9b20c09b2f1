//! The error type of the crate.

use std::fmt;

use crate::limits;

/// Reason why a scene could not be made.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum SceneError {
    /// No scene has this name.
    UnknownName {
        /// The name that was asked for.
        asked: String,
    },
    /// The surface of this scene cannot have this number of triangles.
    ImpossibleSize {
        /// The scene.
        scene: &'static str,
        /// The number of triangles that was asked for.
        asked: usize,
        /// The nearest possible number below, if there is one.
        below: Option<usize>,
        /// The nearest possible number above, if there is one.
        above: Option<usize>,
    },
    /// [`Scene::gather`](crate::Scene::gather) was asked for no body, or for more than
    /// [`Scene::MAX_BODIES`](crate::Scene::MAX_BODIES).
    ImpossibleBodyCount {
        /// The number of bodies that was asked for.
        asked: usize,
    },
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownName { asked } => {
                write!(
                    f,
                    "no scene of this kind is called `{asked}`; scenes whose meshes stay are {}; \
                     scenes whose meshes change are {}",
                    limits::NAMES.join(", "),
                    limits::CHANGING_NAMES.join(", ")
                )
            }
            Self::ImpossibleSize {
                scene,
                asked,
                below,
                above,
            } => {
                write!(
                    f,
                    "a body of scene `{scene}` cannot have {asked} triangles; "
                )?;
                match (below, above) {
                    (Some(below), Some(above)) => {
                        write!(f, "the nearest possible numbers are {below} and {above}")
                    }
                    (Some(largest), None) => write!(f, "the largest possible number is {largest}"),
                    (None, Some(smallest)) => {
                        write!(f, "the smallest possible number is {smallest}")
                    }
                    (None, None) => write!(f, "no number is possible"),
                }
            }
            Self::ImpossibleBodyCount { asked } => {
                write!(
                    f,
                    "scene `gather` cannot have {asked} bodies; choose from 1 to {}",
                    limits::MAX_BODIES
                )
            }
        }
    }
}

impl std::error::Error for SceneError {}
