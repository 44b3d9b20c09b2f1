//! `CloseQuery`: which elements are close, with numbers in arrays side by side.

use crate::answers::{Any, Column, Rows, class};
use crate::error::Result;
use crate::queries::{Hit, Kind, Want, Wanted, query_class};
use pliant::{CloseEdgeEdge, CloseTriangles, CloseVertexTriangle, Scalar};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use std::array;

/// Elements that are close, and how far they may be apart.
#[derive(Clone, Copy)]
pub(crate) enum Close {
    VertexTriangle(f64),
    EdgeEdge(f64),
    Triangles(f64),
}

impl Kind for Close {
    fn ask<'w, W: Want>(
        self,
        world: &'w mut pliant::World<impl Scalar>,
        of: pliant::Selection,
        wanted: Wanted<'w, W>,
    ) -> Result<W::Answer> {
        match self {
            Self::VertexTriangle(most) => wanted.of(world.close_vertex_triangle_pairs(of, most)),
            Self::EdgeEdge(most) => wanted.of(world.close_edge_edge_pairs(of, most)),
            Self::Triangles(most) => wanted.of(world.close_triangle_pairs(of, most)),
        }
    }

    fn said(self) -> String {
        match self {
            Self::VertexTriangle(most) => format!(", vertices and triangles, within {most}"),
            Self::EdgeEdge(most) => format!(", edges and edges, within {most}"),
            Self::Triangles(most) => format!(", triangles, within {most}"),
        }
    }
}

/// The numbers of one element, and of the other behind them.
fn both<const A: usize, const B: usize, const N: usize>(a: [f64; A], b: [f64; B]) -> [f64; N] {
    array::from_fn(|at| if at < A { a[at] } else { b[at - A] })
}

/// Hits with so many barycentric coordinates.
macro_rules! close {
    ($hit:ident, $count:literal, $close:ident => $barycentric:expr) => {
        impl Hit for $hit {
            type Columns = (Vec<[u32; 4]>, Vec<f64>, Vec<[f64; 3]>, Vec<[f64; $count]>);

            fn columns(hits: &[Self]) -> Self::Columns {
                let row = |$close: &Self| {
                    let direction = $close.direction.unwrap_or_default();
                    (
                        <[u32; 4]>::from($close.pair),
                        $close.distance,
                        direction,
                        $barycentric,
                    )
                };
                hits.iter().map(row).collect()
            }

            fn many(columns: Self::Columns, py: Python<'_>) -> PyResult<Any<'_>> {
                let (pairs, distance, direction, barycentric) = columns;
                let (pairs, distance) = (Rows(pairs), Column(distance));
                let (direction, barycentric) = (Rows(direction), Rows(barycentric));
                class!(py, "ClosePairs").call1((pairs, distance, direction, barycentric))
            }

            fn one(self, py: Python<'_>) -> PyResult<Any<'_>> {
                let $close = self;
                let barycentric: [f64; $count] = $barycentric;
                let barycentric = PyTuple::new(py, barycentric)?;
                let direction = self.direction.map(|[x, y, z]| (x, y, z));
                let pair = self.pair.one(py)?;
                class!(py, "ClosePair").call1((pair, self.distance, direction, barycentric))
            }
        }
    };
}

close!(CloseVertexTriangle, 3, close => close.barycentric);
close!(CloseEdgeEdge, 4, close => both(close.barycentric_a, close.barycentric_b));
close!(CloseTriangles, 6, close => both(close.barycentric_a, close.barycentric_b));

query_class! {
    /// A question which elements are close, that waits to be told how much is wanted: all(), the first(), or visit_some(...). Each call asks
    /// anew, about the shapes that the bodies have then.
    ///
    /// A call raises pliant.Error as those of Query do; with kind "BadDistance" if the distance is negative, infinite or NaN.
    CloseQuery of Close;

    /// All close pairs, sorted, as a ClosePairs of arrays; the same for every option, history and number of threads.
    ///
    /// at_most refuses more than this with pliant.Error, kind "TooManyHits", instead of making arrays that may fill the memory.
    all;

    /// Some close pair, a ClosePair, or None if there is none: much cheaper than all where there are many. Which one may depend on options
    /// and history; whether there is one never does.
    first;

    /// Calls visit(close) with some close pairs at a time, a ClosePairs, until it returns True (or anything true). Returns whether it did.
    /// Each comes once; no list of all is made. The order, and how many come at a time, is deterministic; visit may not ask this world.
    visit_some;

    /// Does early what the query would do first, and asks nothing; see Query.prepare.
    prepare;
}
