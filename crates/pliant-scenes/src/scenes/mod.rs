//! The five scenes, one a file: how many bodies, what they look like, where they go.

pub(crate) mod arms;
pub(crate) mod cloth;
pub(crate) mod crowd;
pub(crate) mod gather;
pub(crate) mod spheres;
