//! The registry of kinds: what is kept for each from query to query, and what its hits are.

use crate::close_pairs::{CloseEdgeEdge, CloseTriangles, CloseVertexTriangle};
use crate::collide::{Ask, Asked, AskedImpacts};
use crate::contacts::Contact;
use crate::held::Held;
use crate::hits::{EdgeEdge, Pair, VertexTriangle};
use crate::impacts::{EdgeEdgeImpact, VertexTriangleImpact};
use crate::kernels::Coordinate;
use crate::queries::{
    Close, Contacts, EdgeEdgeCandidates, Intersections, NearTriangles, VertexTriangleCandidates,
};

/// Lists kinds: a name, what is kept, and the hits that are asked for.
macro_rules! kinds {
    ($($name:ident: $kept:ty => $($hit:ty),+;)*) => {
        /// What is kept for each kind of query.
        pub(crate) struct Kinds<S: Coordinate> {
            $(pub(super) $name: $kept,)*
        }

        impl<S: Coordinate> Default for Kinds<S> {
            fn default() -> Self {
                Self {
                    $($name: Default::default(),)*
                }
            }
        }

        impl<S: Coordinate> Held for Kinds<S> {
            fn held(&self) -> usize {
                0 $(+ self.$name.held())*
            }
        }

        /// Answers queries of every kind.
        pub(crate) trait AskAll: $($(Ask<$hit> +)+)* Send + Sync {}

        impl<T: $($(Ask<$hit> +)+)* Send + Sync> AskAll for T {}
    };
}

kinds! {
    intersections: Asked<Intersections<S>> => Pair;
    contacts: Asked<Contacts<S>> => Contact;
    vertex_triangle: Asked<VertexTriangleCandidates<S>> => VertexTriangle;
    edge_edge: Asked<EdgeEdgeCandidates<S>> => EdgeEdge;
    close_vertex_triangle: Asked<Close<VertexTriangleCandidates<S>>> => CloseVertexTriangle;
    close_edge_edge: Asked<Close<EdgeEdgeCandidates<S>>> => CloseEdgeEdge;
    close_triangles: Asked<NearTriangles<S>> => CloseTriangles;
    impacts: AskedImpacts<S> => VertexTriangleImpact, EdgeEdgeImpact;
}
