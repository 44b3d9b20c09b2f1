//! Names and limits that messages quote.

/// Names of the scenes.
pub(crate) const NAMES: [&str; 5] = ["spheres", "crowd", "arms", "gather", "cloth"];

/// Most bodies of the scene `gather`.
pub(crate) const MAX_BODIES: usize = 10_000;
