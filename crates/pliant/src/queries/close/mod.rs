//! Close pairs: candidates whose elements are at most some distance apart, exactly; and triangles that are (`triangles`).
//!
//! A candidate's boxes are as near as that on every axis; whether the elements are is decided eight at a time between two proven bounds
//! in single precision (`kernels::closest`), the few that the distance lies between in double precision, and what is left by integers
//! (`pliant_exact::distance`). They are of the shape of now; where a body has a motion, its boxes hold the way too, and only more candidates
//! are looked at.

mod closest;
mod elements;
mod hit;
mod measured;
mod triangles;

pub(super) use closest::primitives;
pub(super) use elements::corners_at;
pub(crate) use elements::{Close, ElementCandidates};
pub use hit::{CloseEdgeEdge, CloseTriangles, CloseVertexTriangle, ClosestFeatures};
pub(crate) use measured::{ElementPair, Measurable, measure_all};
pub(crate) use triangles::{NearTriangles, NearestPair, close, closest_of_triangles, corners_of};
