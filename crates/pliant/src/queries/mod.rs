//! Kinds of queries: one room a kind.
//!
//! The update, the traversal, the sorting and what users call are the same for every kind. A kind says what is different: what its boxes
//! are made of and which set of them it uses, what two leaves do to each other, its rule for neighbours in the mesh, and what a hit is.
//! `intersections`, `contacts`, `candidates`, `close` and `impacts` are kinds; the `hit`s of each are
//! what callers get.

mod candidates;
mod close;
mod contacts;
mod door;
mod impacts;
mod intersections;
mod near;

/// Hits of every kind, as callers get them: the crate exports what is here.
pub(crate) mod hits {
    pub use super::candidates::{EdgeEdge, VertexTriangle};
    pub use super::close::{CloseEdgeEdge, CloseTriangles, CloseVertexTriangle, ClosestFeatures};
    pub use super::contacts::{Contact, ContactKind};
    pub use super::impacts::{EdgeEdgeImpact, Impact, VertexTriangleImpact};
    pub use super::intersections::Pair;
}

pub(crate) use candidates::{Candidates, EdgeEdgeCandidates, Margin, VertexTriangleCandidates};
pub(crate) use close::{
    Close, Measurable, NearTriangles, NearestPair, close, closest_of_triangles, corners_of,
    measure_all,
};
pub(crate) use contacts::Contacts;
pub(crate) use door::{
    Batch, BodyBoxes, BoxSetNumber, CallerIds, Candidate, Found, FoundBy, Kind, LeafTest, LeafWork,
    Needs, OF_GROWN_SHAPES, OF_MOTIONS, OF_SHAPES, Reach, Shown, shows_hits,
};
pub(crate) use hits::*;
pub(crate) use impacts::{Earliest, First, Impacts, LIMIT};
pub(crate) use intersections::Intersections;
pub(crate) use near::{Groups, NearBoxes, NearElements, Removed, Which};
