//! Close pairs: elements, or triangles, that are at most a distance apart, decided exactly.
//!
//! Close elements are candidates (`candidates`) of half the distance as a margin, whose own
//! distance is then decided. Single precision decides eight at a time between two proven bounds
//! (`kernels::closest`). Double precision decides the few whose bounds the distance lies between,
//! and integers (`pliant_exact::distance`) the rest. Distances are of the present shape. Where a
//! body has a motion, its boxes hold the way too, and only more candidates are looked at.

mod closest;
mod elements;
mod hit;
mod measured;
mod triangles;

pub(crate) use closest::closest_of;
pub(super) use closest::primitives;
pub(crate) use elements::{Close, ElementCandidates};
pub(super) use elements::{corners_at, length};
pub(crate) use hit::count;
pub use hit::{CloseEdgeEdge, CloseTriangles, CloseVertexTriangle, ClosestFeatures};
pub(crate) use measured::{ElementPair, Measurable, direction, measure_all, weights};
pub(crate) use triangles::{NearTriangles, NearestPair, close, closest_of_triangles, corners_of};
