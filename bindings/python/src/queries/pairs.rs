//! `Query`: which triangles intersect, and which elements are candidates; hits are rows of numbers.

use crate::answers::{Any, class, copy_of_rows};
use crate::error::Result;
use crate::queries::{Each, Hit, Kind, Want, Wanted, query_class};
use numpy::PyArray2;
use pliant::{EdgeEdge, Pair, Scalar, VertexTriangle};
use pyo3::prelude::*;

/// What is asked: triangles that intersect, or elements within a margin round each.
#[derive(Clone, Copy)]
pub(crate) enum Pairs {
    Intersections,
    VertexTriangleCandidates(f64),
    EdgeEdgeCandidates(f64),
}

impl Kind for Pairs {
    fn ask<'w, W: Want>(
        self,
        world: &'w mut pliant::World<impl Scalar>,
        of: pliant::Selection,
        wanted: Wanted<'w, W>,
    ) -> Result<W::Answer> {
        match self {
            Self::Intersections => wanted.of(world.intersections(of)),
            Self::VertexTriangleCandidates(radius) => {
                wanted.of(world.vertex_triangle_candidates(of, radius))
            }
            Self::EdgeEdgeCandidates(radius) => wanted.of(world.edge_edge_candidates(of, radius)),
        }
    }

    fn said(self) -> String {
        match self {
            Self::Intersections => String::new(),
            Self::VertexTriangleCandidates(radius) => {
                format!(", vertices and triangles, margin {radius}")
            }
            Self::EdgeEdgeCandidates(radius) => format!(", edges and edges, margin {radius}"),
        }
    }
}

macro_rules! rows {
    ($hit:ident, $class:literal) => {
        impl Hit for $hit {
            /// The array itself, which is filled under the interpreter lock.
            type Columns = PyResult<Py<PyArray2<u32>>>;

            fn columns(hits: &[Self]) -> Self::Columns {
                let rows = hits.iter().map(|&hit| hit.into());
                Python::attach(|py| Ok(copy_of_rows::<4>(py, rows)?.unbind()))
            }

            fn many(columns: Self::Columns, py: Python<'_>) -> PyResult<Any<'_>> {
                Ok(columns?.into_bound(py).into_any())
            }

            fn one(self, py: Python<'_>) -> PyResult<Any<'_>> {
                let [body_a, a, body_b, b] = self.into();
                class!(py, $class).call1((body_a, a, body_b, b))
            }
        }
    };
}

rows!(Pair, "Pair");
rows!(VertexTriangle, "VertexTriangle");
rows!(EdgeEdge, "EdgeEdge");

query_class! {
    /// A question that was put to a world, and waits to be told how much is wanted: all() hits, the first(), or a visit(...) to one after
    /// the other. Each call asks anew, about the shapes that the bodies have then.
    ///
    /// A call raises pliant.Error if the selection names a body that is not there, or one body as two. What a signal handler raises
    /// meanwhile in the main thread, KeyboardInterrupt after Ctrl-C, ends it early; the world stays usable, and makes the boxes of all
    /// bodies anew in the next query.
    Query of Pairs;

    /// All hits, sorted: (k, 4) uint32; the same for every option, history and number of threads. A row is body, triangle, body, triangle;
    /// of candidates body, vertex, body, triangle, or body, edge, body, edge.
    ///
    /// at_most refuses a list of more hits than this with pliant.Error, kind "TooManyHits", instead of making one that may fill the
    /// memory.
    all;

    /// Some hit, a Pair, VertexTriangle or EdgeEdge, or None if there is none: much cheaper than all where there are many. Which one may
    /// depend on options and history; whether there is one never does.
    first;

    /// Calls visit(rows) with some hits at a time, (k, 4) uint32 as of all(), until it returns True (or anything true). Returns whether it
    /// did. Every hit comes once; no list of all is made. The order, and how many come at a time, is deterministic.
    visit_some;

    /// Does early what the query would do first, and asks nothing: finds the bodies that may meet and refits the upper levels of their
    /// trees; all of it in a body that meets itself. Never needed for right answers; it is for whoever wants to time it, or has time
    /// to spare.
    prepare;

    /// Calls visit(hit) for every hit once, until it returns True (or anything true). Returns whether it did. The order is
    /// deterministic, not sorted; visit may not ask this world.
    fn visit(&self, visit: &Any<'_>) -> Result<bool> {
        self.0.ask(visit.py(), Each(visit.as_unbound()))
    }
}
