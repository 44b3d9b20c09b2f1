//! `CloseQuery`: which elements are close, with numbers in arrays side by side.

use crate::answers::{Any, class};
use crate::columns::Columns;
use crate::error::Result;
use crate::options::Threads;
use crate::queries::{Hit, Kind, Want, Wanted, query_class};
use pliant::{CloseEdgeEdge, CloseTriangles, CloseVertexTriangle, Scalar};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use std::array;

/// Kind of elements that are close, and the most that they may be apart.
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
        let answer = match self {
            Self::VertexTriangle(most) => wanted.of(world.close_vertex_triangle_pairs(of, most)),
            Self::EdgeEdge(most) => wanted.of(world.close_edge_edge_pairs(of, most)),
            Self::Triangles(most) => wanted.of(world.close_triangle_pairs(of, most)),
        };
        answer.map_err(|refused| refused.distance_is("distance"))
    }

    fn said(self) -> String {
        match self {
            Self::VertexTriangle(most) => format!(", vertices and triangles, within {most}"),
            Self::EdgeEdge(most) => format!(", edges and edges, within {most}"),
            Self::Triangles(most) => format!(", triangles, within {most}"),
        }
    }
}

/// Joins the barycentric coordinates of two elements into one array.
fn both<const A: usize, const B: usize, const N: usize>(a: [f64; A], b: [f64; B]) -> [f64; N] {
    array::from_fn(|at| if at < A { a[at] } else { b[at - A] })
}

/// Implements `Hit` for a hit with the given number of barycentric coordinates.
macro_rules! close {
    ($hit:ident, $count:literal, $close:ident => $barycentric:expr) => {
        impl Hit for $hit {
            fn columns<'h, 'py>(of: Columns<'h, 'py, Self>) -> PyResult<Columns<'h, 'py, Self>> {
                of.row(|close| <[u32; 4]>::from(close.pair))?
                    .number(|close| close.distance)?
                    .row(|close| close.direction.unwrap_or_default())?
                    .row::<f64, $count>(|$close| $barycentric)
            }

            fn many(columns: Vec<Py<PyAny>>, py: Python<'_>) -> PyResult<Any<'_>> {
                class!(py, "ClosePairs").call1(PyTuple::new(py, columns)?)
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
    /// A question which elements are close, answered by all() or first().
    ///
    /// World.close_vertex_triangle_pairs, close_edge_edge_pairs and close_triangle_pairs make it.
    /// Ask for all(), the first(), or visit_some(...). Each call asks anew, about the shapes that
    /// the bodies have then.
    ///
    /// A call raises the errors and exceptions of Query, and pliant.Error: BadDistance if the
    /// distance is negative, infinite or NaN.
    CloseQuery of Close;

    /// All close pairs, a ClosePairs of arrays, sorted by their numbers.
    ///
    /// Options, history and number of threads do not change it. at_most refuses a longer list with
    /// pliant.Error: TooManyHits, before it fills the memory. sort=False leaves job order, which is
    /// equal for any number of threads.
    ///
    /// Cost: the region where elements are close, and O(k) for k pairs.
    all;

    /// Some close pair, a ClosePair, or None if there is none.
    ///
    /// Much cheaper than all() where there are many. Options and history may change which one it
    /// is, never whether there is one.
    first;

    /// Calls visit(close) with a ClosePairs of some at a time, until it returns true.
    ///
    /// Returns whether it did. Every pair comes once, and no list of all is made. The order and the
    /// sizes are deterministic. visit may not ask this world; its exceptions pass through.
    visit_some;

    /// Does early what the query would do first, and asks nothing: see Query.prepare.
    prepare;

    /// Asks about many shapes of bodies, frame by frame, in one call: see Query.of_frames.
    #[pyo3(signature = (frames, *, answer="rows", threads=Threads::Count(1)),
        text_signature = "($self, frames, *, answer=\"rows\", threads=1)")]
    fn of_frames<'py>(
        &self,
        py: Python<'py>,
        frames: &Any<'py>,
        answer: &str,
        threads: Threads,
    ) -> Result<Any<'py>> {
        self.0.of_frames(py, frames, answer, threads)
    }
}
