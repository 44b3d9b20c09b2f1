//! Names and limits that messages quote.

/// Names of the scenes whose meshes stay.
pub(crate) const NAMES: [&str; 5] = ["spheres", "crowd", "arms", "gather", "cloth"];

/// Names of the scenes whose meshes change.
pub(crate) const CHANGING_NAMES: [&str; 5] = ["cut", "tear", "fuse", "shuffle", "remesh"];

/// Most bodies of the scene `gather`.
pub(crate) const MAX_BODIES: usize = 10_000;
