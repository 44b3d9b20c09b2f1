//! `ImpactQuery`: which elements meet on their way, and when first, with numbers in arrays side by
//! side.

use crate::answers::{Any, class};
use crate::columns::Columns;
use crate::error::Result;
use crate::queries::{Hit, Kind, Want, Wanted, query_class};
use pliant::{EdgeEdgeImpact, Scalar, VertexTriangleImpact};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// Kind of elements that meet, and the widest interval of times.
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
            fn columns<'h, 'py>(of: Columns<'h, 'py, Self>) -> PyResult<Columns<'h, 'py, Self>> {
                of.row(|hit| <[u32; 4]>::from(hit.pair))?
                    .number(|hit| hit.low)?
                    .number(|hit| hit.high)
            }

            fn many(columns: Vec<Py<PyAny>>, py: Python<'_>) -> PyResult<Any<'_>> {
                class!(py, "Impacts").call1(PyTuple::new(py, columns)?)
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
    /// A question which elements meet during the motion, answered by all() or first().
    ///
    /// World.vertex_triangle_impacts and edge_edge_impacts make it. Ask for all(), the first(), or
    /// visit_some(...). Each call asks anew, about the shapes and the motions that the bodies have
    /// then.
    ///
    /// A call raises the errors and exceptions of Query, and pliant.Error: BadWidth if the width is
    /// negative, infinite or NaN.
    ImpactQuery of Impacts;

    /// All impacts, an Impacts of arrays, sorted by their numbers.
    ///
    /// Options, history and number of threads do not change it. at_most refuses a longer list with
    /// pliant.Error: TooManyHits, before it fills the memory. sort=False leaves job order, which is
    /// equal for any number of threads.
    ///
    /// Memory is for what meets: pairs that are looked at on the way are not listed.
    all;

    /// The impact with the least exact time, an Impact, or None if nothing meets.
    ///
    /// Of several at one time it is the first by number. Much faster than all().
    first;

    /// Calls visit(impacts) with an Impacts of some at a time, until it returns true.
    ///
    /// Returns whether it did. Every impact comes once, and no list of all is made. The order and
    /// the sizes are deterministic. visit may not ask this world; its exceptions pass through.
    visit_some;

    /// Does early what the query would do first, and asks nothing: see Query.prepare.
    prepare;
}
