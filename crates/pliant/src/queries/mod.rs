//! Kinds of queries, a folder each: what a query does to two leaves, and what it finds.
//!
//! Update, traversal, sorting and the calls of users are the same for every kind. A kind defines
//! the source of its boxes, the test of two leaves, its rule for neighbours in the mesh, and its
//! hit. `door` is the trait by which the traversal sees a kind. `near` holds boxes of elements, and
//! `labels` what a body leaves out.
//!
//! | folder | kind | boxes |
//! |---|---|---|
//! | `intersections` | triangles that intersect, decided exactly | of the shape |
//! | `contacts` | intersections with their kinds | of the shape |
//! | `adjacent` | triangles that share a vertex and meet beyond it; no leaves | none |
//! | `crossing_edges` | edges that cross triangles, from pairs that intersect | none |
//! | `candidates` | vertices and triangles, or edges, within a margin | of the motion, grown |
//! | `close` | elements or triangles within a distance, measured | of motion or shape, grown |
//! | `impacts` | elements that meet during a motion, and when first | of the motion, grown |

mod adjacent;
mod candidates;
mod close;
mod contacts;
mod crossing_edges;
mod door;
mod impacts;
mod intersections;
mod labels;
mod near;

/// Hits of every kind, as callers get them. The crate exports them.
pub(crate) mod hits {
    pub use super::adjacent::AdjacentContact;
    pub use super::candidates::{EdgeEdge, VertexTriangle};
    pub use super::close::{CloseEdgeEdge, CloseTriangles, CloseVertexTriangle, ClosestFeatures};
    pub use super::contacts::{Contact, ContactKind};
    pub use super::crossing_edges::CrossingEdge;
    pub use super::impacts::{EdgeEdgeImpact, Impact, VertexTriangleImpact};
    pub use super::intersections::Pair;
}

pub(crate) use adjacent::{AdjacentSearch, AdjacentSink, StarredBody, TreeAdjacent};
pub(crate) use candidates::{Candidates, EdgeEdgeCandidates, Margin, VertexTriangleCandidates};
pub(crate) use close::{
    Close, Measurable, NearTriangles, NearestPair, close, closest_of, closest_of_triangles,
    corners_of, count, direction, measure_all, weights,
};
pub(crate) use contacts::Contacts;
pub(crate) use crossing_edges::CrossingEdges;
pub(crate) use door::{
    Batch, BodyBoxes, BoxSetNumber, CallerIds, Candidate, Found, FoundBy, Kind, LeafTest, LeafWork,
    Needs, OF_GROWN_SHAPES, OF_MOTIONS, OF_SHAPES, OwnEdges, Reach, Shown, shows_hits,
};
pub(crate) use hits::*;
pub(crate) use impacts::{Earliest, First, Impacts, LIMIT};
pub(crate) use intersections::Intersections;
pub(crate) use labels::LabelPairs;
pub(crate) use near::{
    Groups, NearBoxes, NearElements, Removed, Thickness, Thicknesses, Which, most,
};
