//! Meshes: what the caller said, how a tree orders it, and its edges. None of it ever moves.

mod elements;
mod order;
mod topology;

pub(crate) use elements::{Elements, TriangleRun};
pub(crate) use order::Order;
pub(crate) use topology::{Topology, share_a_vertex, validate};
