//! `ImpactQuery`: which elements meet on their way, and when first, with numbers in arrays side by
//! side.

use crate::answers::{Any, Column, Rows, class};
use crate::error::Result;
use crate::queries::{Hit, Kind, Want, Wanted, query_class};
use pliant::{EdgeEdgeImpact, Scalar, VertexTriangleImpact};
use pyo3::prelude::*;

/// Elements that meet, and how wide the intervals of times may be.
#[derive(Clone, Copy)]
pub(crate) enum Impacts {
    VertexTriangle(f64),
    EdgeEdge(f64),
}

impl Kind for Impacts {
    fn ask<'w, W: Want>(
        self,
        world: &'w mut pliant::World<impl Scalar>,
        of: pliant::Selection,
        wanted: Wanted<'w, W>,
    ) -> Result<W::Answer> {
        match self {
            Self::VertexTriangle(width) => {
                wanted.of(world.vertex_triangle_impacts(of).width(width))
            }
            Self::EdgeEdge(width) => wanted.of(world.edge_edge_impacts(of).width(width)),
        }
    }

    fn said(self) -> String {
        match self {
            Self::VertexTriangle(width) => format!(", vertices and triangles, width {width}"),
            Self::EdgeEdge(width) => format!(", edges and edges, width {width}"),
        }
    }
}

macro_rules! impacts {
    ($hit:ident) => {
        impl Hit for $hit {
            type Columns = (Vec<[u32; 4]>, Vec<f64>, Vec<f64>);

            fn columns(hits: &[Self]) -> Self::Columns {
                let row = |hit: &Self| (<[u32; 4]>::from(hit.pair), hit.low, hit.high);
                hits.iter().map(row).collect()
            }

            fn many(columns: Self::Columns, py: Python<'_>) -> PyResult<Any<'_>> {
                let (pairs, low, high) = columns;
                class!(py, "Impacts").call1((Rows(pairs), Column(low), Column(high)))
            }

            fn one(self, py: Python<'_>) -> PyResult<Any<'_>> {
                class!(py, "Impact").call1((self.pair.one(py)?, self.low, self.high))
            }
        }
    };
}

impacts!(VertexTriangleImpact);
impacts!(EdgeEdgeImpact);

query_class! {
    /// A question which elements meet on their way, that waits to be told how much is wanted: all(), the first(), or visit_some(...). Each call
    /// asks anew, about the shapes and the motions that the bodies have then.
    ///
    /// A call raises pliant.Error as those of Query do; with kind "BadWidth" if the width is negative, infinite or NaN.
    ImpactQuery of Impacts;

    /// All impacts, sorted, as an Impacts of arrays; the same for every option, history and number of threads.
    ///
    /// at_most refuses more than this with pliant.Error, kind "TooManyHits", instead of making arrays that may fill the memory.
    all;

    /// The impact with the least exact time, an Impact; of several, the first in order. None if nothing meets. Much faster than all.
    first;

    /// Calls visit(impacts) with some impacts at a time, an Impacts, until it returns True (or anything true). Returns whether it did.
    /// Each comes once; no list of all is made. The order, and how many come at a time, is deterministic; visit may not ask this world.
    visit_some;

    /// Does early what the query would do first, and asks nothing; see Query.prepare.
    prepare;
}
