//! What can be asked for, where messages say it.

/// The names of the scenes.
pub(crate) const NAMES: [&str; 5] = ["spheres", "crowd", "arms", "gather", "cloth"];

/// The most bodies that gather.
pub(crate) const MAX_BODIES: usize = 10_000;
