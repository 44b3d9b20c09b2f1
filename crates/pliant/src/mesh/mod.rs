//! Meshes: topology as the caller gave it, tree order, edges, edits as drafts, components, welding.

mod bits;
mod components;
mod draft;
mod edges;
mod elements;
mod order;
mod stars;
mod topology;
mod triangles_at;
mod watertight;
mod weld;

pub(crate) use bits::Bits;
pub(crate) use components::{components, find_root};
pub(crate) use draft::{Draft, Outcome};
pub(crate) use elements::{Changed, Elements, TriangleRun};
pub(crate) use order::{Moved, Order, OrderBuilder};
pub(crate) use stars::{Stars, opposite};
pub(crate) use topology::{EMPTY, Topology, share_a_vertex, validate};
pub(crate) use triangles_at::TrianglesAt;
pub use watertight::Watertight;
pub(crate) use weld::{Nearness, coinciding};
