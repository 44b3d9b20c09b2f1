//! Meshes: what the caller said, and how a tree orders it. Neither ever moves.

mod order;
mod topology;

pub(crate) use order::Order;
pub(crate) use topology::{Topology, share_a_vertex, validate};
