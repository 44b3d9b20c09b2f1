//! `Query`: which triangles intersect, which edges cross triangles, and which elements are
//! candidates; hits are rows of numbers.

use crate::answers::{Any, class};
use crate::columns::Columns;
use crate::error::Result;
use crate::options::Threads;
use crate::queries::{Each, Hit, Kind, Want, Wanted, query_class};
use pliant::{CrossingEdge, EdgeEdge, Pair, Scalar, VertexTriangle};
use pyo3::prelude::*;

/// Kind of question: triangles that intersect, edges that cross triangles, or elements near each
/// other within a margin.
#[derive(Clone, Copy)]
pub(crate) enum Pairs {
    Intersections,
    CrossingEdges,
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
            Self::CrossingEdges => wanted.of(world.crossing_edges(of)),
            Self::VertexTriangleCandidates(radius) => {
                wanted.of(world.vertex_triangle_candidates(of, radius))
            }
            Self::EdgeEdgeCandidates(radius) => wanted.of(world.edge_edge_candidates(of, radius)),
        }
    }

    fn said(self) -> String {
        match self {
            Self::Intersections => String::new(),
            Self::CrossingEdges => ", edges that cross triangles".to_owned(),
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
            fn columns<'h, 'py>(of: Columns<'h, 'py, Self>) -> PyResult<Columns<'h, 'py, Self>> {
                of.row(|&hit| <[u32; 4]>::from(hit))
            }

            fn many(columns: Vec<Py<PyAny>>, py: Python<'_>) -> PyResult<Any<'_>> {
                let rows = columns.into_iter().next();
                Ok(rows.into_pyobject(py)?)
            }

            fn one(self, py: Python<'_>) -> PyResult<Any<'_>> {
                let [body_a, a, body_b, b] = self.into();
                class!(py, $class).call1((body_a, a, body_b, b))
            }
        }
    };
}

rows!(Pair, "Pair");
rows!(CrossingEdge, "CrossingEdge");
rows!(VertexTriangle, "VertexTriangle");
rows!(EdgeEdge, "EdgeEdge");

query_class! {
    /// A question to a world, answered by all(), first() or visit().
    ///
    /// World.intersections, crossing_edges and the two methods for candidates make it. Ask for
    /// all() hits, the first(), or a visit(...). Each call asks anew, about the shapes that the
    /// bodies have then.
    ///
    /// Whatever is asked, a call raises pliant.Error and leaves the world usable:
    ///
    /// - NoSuchBody if the selection names a body that is not there
    /// - SameBody if Selection.between names one body twice
    /// - BadMargin if the radius of candidates is negative, infinite or NaN
    /// - TooManyHits if a list would be longer than at_most
    /// - Busy if the world is answering another call, also one made by a visitor
    ///
    /// An exception that a signal handler raises in the main thread ends the query early:
    /// KeyboardInterrupt after Ctrl-C. The next query then refits the boxes of all bodies.
    Query of Pairs;

    /// All hits, a new array (k, 4) uint32, sorted.
    ///
    /// A row is body, triangle, body, triangle. Of crossing edges it is body, edge, body, triangle.
    /// Of candidates it is body, vertex, body, triangle, or body, edge, body, edge. Options,
    /// history and number of threads do not change it.
    ///
    /// at_most refuses a longer list with pliant.Error: TooManyHits, before it fills the memory.
    /// sort=False leaves the list in job order, which is equal for any number of threads. It is for
    /// who sums over millions, in whatever order.
    ///
    /// Cost: the broad phase, O(bodies + overlaps) where bodies move a little. Where boxes overlap,
    /// what grows with the region where bodies are close. Sorting is O(k).
    all;

    /// Some hit, a Pair, CrossingEdge, VertexTriangle or EdgeEdge, or None if there is none.
    ///
    /// Much cheaper than all() where there are many. Options and history may change which one it
    /// is, never whether there is one.
    first;

    /// Calls visit(rows) with some hits at a time, (k, 4) uint32, until it returns true.
    ///
    /// Returns whether it did. Every hit comes once, and no list of all is made. The order and the
    /// sizes are deterministic. visit may not ask this world; its exceptions pass through.
    visit_some;

    /// Does early what the query would do first, and asks nothing.
    ///
    /// Finds the bodies that may meet, and refits the upper levels of their trees. Refits all
    /// levels in a body that meets itself. Never needed for right answers; for timing, or in spare
    /// time.
    prepare;

    /// Calls visit(hit) for every hit once, until it returns true. Returns whether it did.
    ///
    /// hit is a Pair, CrossingEdge, VertexTriangle or EdgeEdge. The order is deterministic, not
    /// sorted. visit may not ask this world; its exceptions pass through. visit_some is faster
    /// where there are many.
    fn visit(&self, visit: &Any<'_>) -> Result<bool> {
        self.0.ask(visit.py(), Each(visit.as_unbound()))
    }

    /// Asks about many shapes of bodies, frame by frame, in one call.
    ///
    ///     found = world.intersections().of_frames({cloth: positions}, threads="all")
    ///     found.counts                # (frames,) hits of each
    ///     found.frame(7)              # hits of frame 7, as all() returns them
    ///
    /// frames is a dict of positions (frames, n, 3) by bodies, or pairs of a body and its
    /// positions. Other bodies stay as they are, and so does the world itself. Each thread asks a
    /// copy of the world, whose trees are kept from frame to frame. An answer depends on its frame
    /// alone. answer says how much is wanted of each frame:
    ///
    /// - "rows": all hits, sorted, frame by frame: a FrameHits
    /// - "first": of each frame that has hits the first of these: a FrameHits; it costs as "rows"
    /// - "counts": numbers of hits, (frames,) int64
    /// - "any": whether there is one, (frames,) bool; the cheapest
    ///
    /// Raises pliant.Error, about the first frame that is refused, which is its attribute frame:
    /// the kinds of all() and World.set_positions. BadOption for threads where the world has more
    /// than one of its own. Nothing is returned of the other frames then.
    ///
    /// Cost: a copy of the world with its trees for each thread; then for each frame as
    /// set_positions and all().
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
