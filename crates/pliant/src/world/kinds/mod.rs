//! Registry of kinds, and a folder for each kind as users ask for it.
//!
//! Here a kind is made from a request (`Ask`). It has its method of `World`, its options of
//! `Query`, and its slow `reference`. The registry says what a world keeps for each kind. Tests ask
//! for everything that it lists, so a kind that exists is tested.

/// Lists every kind of query, for the macro whose name it is given: `every_kind! { name }`.
///
/// A line has a name and the buffers that a world of scalars `S` keeps for the kind. For each of
/// its hits it has the method of [`World`](crate::World) that asks for them. The method takes a
/// selection, and for some kinds a length: a margin or a distance.
#[doc(hidden)]
#[macro_export]
macro_rules! every_kind {
    ($then:ident) => {
        $then! {
            intersections: $crate::collide::Asked<$crate::queries::Intersections<S>>
                => $crate::queries::Pair: intersections(of);
            contacts: $crate::collide::Asked<$crate::queries::Contacts<S>>
                => $crate::queries::Contact: contacts(of);
            adjacent: $crate::collide::AskedAdjacent
                => $crate::queries::AdjacentContact: adjacent_intersections(of);
            crossing_edges: $crate::collide::AskedCrossing<S>
                => $crate::queries::CrossingEdge: crossing_edges(of);
            vertex_triangle: $crate::collide::Asked<$crate::queries::VertexTriangleCandidates<S>>
                => $crate::queries::VertexTriangle: vertex_triangle_candidates(of, length);
            edge_edge: $crate::collide::Asked<$crate::queries::EdgeEdgeCandidates<S>>
                => $crate::queries::EdgeEdge: edge_edge_candidates(of, length);
            close_vertex_triangle: $crate::collide::Asked<
                $crate::queries::Close<$crate::queries::VertexTriangleCandidates<S>>,
            > => $crate::queries::CloseVertexTriangle: close_vertex_triangle_pairs(of, length);
            close_edge_edge: $crate::collide::Asked<
                $crate::queries::Close<$crate::queries::EdgeEdgeCandidates<S>>,
            > => $crate::queries::CloseEdgeEdge: close_edge_edge_pairs(of, length);
            close_triangles: $crate::collide::Asked<$crate::queries::NearTriangles<S>>
                => $crate::queries::CloseTriangles: close_triangle_pairs(of, length);
            impacts: $crate::collide::AskedImpacts<S>
                => $crate::queries::VertexTriangleImpact: vertex_triangle_impacts(of),
                $crate::queries::EdgeEdgeImpact: edge_edge_impacts(of);
        }
    };
}

#[macro_use]
mod ask;

// Modules in the order in which documentation shows their sections of `World`.
mod intersections;

mod contacts;

mod adjacent;

mod crossing_edges;

mod candidates;

mod close;

mod close_triangles;

mod impacts;

/// References of all kinds, for the crate's `reference`.
pub(crate) mod reference {
    pub use super::adjacent::reference::*;
    pub use super::candidates::reference::*;
    pub use super::close::reference::*;
    pub use super::close_triangles::reference::*;
    pub use super::contacts::reference::*;
    pub use super::crossing_edges::reference::*;
    pub use super::impacts::reference::*;
    pub use super::intersections::reference::*;
}
