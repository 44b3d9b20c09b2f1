//! `Changes` of Python: rows of a list that began, persist and ended since the last list.

use crate::answers::{Any, Column, Rows, class};
use crate::arrays::{self, numbers};
use crate::error::{Result, alone_with, refused};
use crate::selection::Body;
use pliant::{BodyId, Changed, Edited, Fused, Listed, Piece, Thing};
use pyo3::prelude::*;
use std::sync::Mutex;

/// Rows of four numbers, by the kinds of their two things.
macro_rules! rows {
    ($($row:ident: $a:ident, $b:ident;)*) => {
        $(
            #[derive(Clone, Copy)]
            struct $row([u32; 4]);

            impl From<[u32; 4]> for $row {
                fn from(row: [u32; 4]) -> Self {
                    Self(row)
                }
            }

            impl Listed for $row {
                const THINGS: [Thing; 2] = [Thing::$a, Thing::$b];

                fn things(&self) -> [(BodyId, u32); 2] {
                    let [body_a, a, body_b, b] = self.0;
                    [(BodyId(body_a), a), (BodyId(body_b), b)]
                }
            }
        )*
    };
}

rows! {
    TriangleRow: Triangle, Triangle;
    VertexTriangleRow: Vertex, Triangle;
    EdgeRow: Edge, Edge;
    EdgeTriangleRow: Edge, Triangle;
}

/// Changes of rows of one kind.
enum AnyChanges {
    Triangles(pliant::Changes<TriangleRow>),
    VertexTriangle(pliant::Changes<VertexTriangleRow>),
    EdgeEdge(pliant::Changes<EdgeRow>),
    EdgeTriangle(pliant::Changes<EdgeTriangleRow>),
}

macro_rules! with_changes {
    ($changes:expr, $name:ident => $work:expr) => {
        match $changes {
            AnyChanges::Triangles($name) => $work,
            AnyChanges::VertexTriangle($name) => $work,
            AnyChanges::EdgeEdge($name) => $work,
            AnyChanges::EdgeTriangle($name) => $work,
        }
    };
}

/// Memory of the last list of hits: what began, persists and ended is told of the next.
///
///     changes = pliant.Changes()
///     for positions in frames:
///         world.set_positions(cloth, positions)
///         pairs = world.intersections().all()
///         changed = changes.update(pairs)
///         print(len(changed.began), "began,", len(changed.ended), "ended")
///
/// It compares lists of one question, whose rows are of one kind: "triangles" (the default),
/// "vertex-triangle", "edge-edge", or "edge-triangle" for crossing edges. Each hit has a number,
/// which it keeps while it persists and which is never used again. A list is a set: any order will
/// do, and the sorted one that queries give is quickest.
///
/// Triangles and vertices keep their numbers when a mesh is edited, except where a number is used
/// again. Tell it of each edit between two lists: edited, split, fused, and edges_edited for edges.
///
/// Raises pliant.Error: BadOption for another kind.
#[pyclass(frozen, module = "pliant")]
pub(crate) struct Changes {
    state: Mutex<AnyChanges>,
}

#[pymethods]
impl Changes {
    #[new]
    #[pyo3(signature = (kind="triangles"))]
    fn new(kind: &str) -> Result<Self> {
        let state = match kind {
            "triangles" => AnyChanges::Triangles(pliant::Changes::new()),
            "vertex-triangle" => AnyChanges::VertexTriangle(pliant::Changes::new()),
            "edge-edge" => AnyChanges::EdgeEdge(pliant::Changes::new()),
            "edge-triangle" => AnyChanges::EdgeTriangle(pliant::Changes::new()),
            other => {
                return Err(refused!(BadOption:
                    "kind is {other:?}; it can be one of \"triangles\", \"vertex-triangle\", \
                     \"edge-edge\", \"edge-triangle\""));
            }
        };
        Ok(Self {
            state: Mutex::new(state),
        })
    }

    /// Compares a list with the last one, and remembers it; returns a Changed.
    ///
    /// Takes rows (k, 4) uint32 as queries give them: pairs of intersections and candidates,
    /// crossing edges, the pairs of contacts, close pairs and impacts. A row that is there twice is
    /// one hit.
    ///
    /// Raises pliant.Error: BadArray for another type or shape.
    ///
    /// Cost: O(k) for sorted rows, some nanoseconds each.
    fn update<'py>(&self, py: Python<'py>, rows: &Any<'py>) -> Result<Any<'py>> {
        let rows = arrays::rows_of(rows, "rows", "queries give")?;
        let told = alone_with(py, &self.state, move |changes| {
            Ok(with_changes!(changes, changes => told(changes.update(&listed(rows)))))
        })?;
        let Told {
            numbers,
            began,
            ended,
            ended_numbers,
        } = told;
        let (numbers, began) = (Column(numbers), Column(began));
        let changed = (numbers, began, Rows(ended), Column(ended_numbers));
        Ok(class!(py, "Changed").call1(changed)?)
    }

    /// Notes an edit between two lists: takes the Edited that World.apply or weld gave.
    ///
    /// Numbers that were removed or used again are other things: hits with them end. Edges are not
    /// in an Edited: see edges_edited.
    fn edited(&self, py: Python<'_>, body: Body, edited: &Any<'_>) -> Result<()> {
        let list = |name| field(edited, name);
        let edited = Edited {
            new_triangles: list("new_triangles")?,
            changed_triangles: Vec::new(),
            removed_triangles: list("removed_triangles")?,
            new_vertices: list("new_vertices")?,
            removed_vertices: list("removed_vertices")?,
        };
        alone_with(py, &self.state, |changes| {
            with_changes!(changes, changes => changes.edited(body.0, &edited));
            Ok(())
        })
    }

    /// Notes that World.split made pieces of a body: takes the list of Piece that it gave.
    fn split(&self, py: Python<'_>, body: Body, pieces: &Any<'_>) -> Result<()> {
        let mut all = Vec::new();
        for piece in pieces.try_iter()? {
            let piece = piece?;
            let Body(of) = piece.getattr("body")?.extract()?;
            all.push(Piece {
                body: of,
                triangles: field(&piece, "triangles")?,
                vertices: field(&piece, "vertices")?,
            });
        }
        alone_with(py, &self.state, |changes| {
            with_changes!(changes, changes => changes.split(body.0, &all));
            Ok(())
        })
    }

    /// Notes that World.fuse put body gone into kept: takes the Fused that it gave.
    fn fused(&self, py: Python<'_>, kept: Body, gone: Body, fused: &Any<'_>) -> Result<()> {
        let fused = Fused {
            triangles: field(fused, "triangles")?,
            vertices: field(fused, "vertices")?,
        };
        alone_with(py, &self.state, |changes| {
            with_changes!(changes, changes => changes.fused(kept.0, gone.0, &fused));
            Ok(())
        })
    }

    /// Notes an edit between two lists: takes World.edges of the body before and after it.
    ///
    /// An edge is the same if its number has the same two ends. Hits with others end.
    fn edges_edited(
        &self,
        py: Python<'_>,
        body: Body,
        before: &Any<'_>,
        after: &Any<'_>,
    ) -> Result<()> {
        let ends = |given: &Any<'_>, name: &str| -> Result<Vec<[u32; 2]>> {
            arrays::rows_of(given, name, "World.edges gives")
        };
        let (before, after) = (ends(before, "before")?, ends(after, "after")?);
        let follow = |thing: Thing, of: BodyId, number: u32| {
            let place = number as usize;
            let is_same = thing != Thing::Edge
                || of != body.0
                || before
                    .get(place)
                    .is_some_and(|ends| after.get(place) == Some(ends));
            is_same.then_some((of, number))
        };
        alone_with(py, &self.state, |changes| {
            with_changes!(changes, changes => changes.follow(follow));
            Ok(())
        })
    }
}

/// Changes in vectors of their own.
struct Told {
    numbers: Vec<u64>,
    began: Vec<u64>,
    ended: Vec<[u32; 4]>,
    ended_numbers: Vec<u64>,
}

fn told(changed: Changed<'_>) -> Told {
    let row = |[(body_a, a), (body_b, b)]: [(BodyId, u32); 2]| [body_a.0, a, body_b.0, b];
    let ended = changed.ended.iter();
    Told {
        numbers: changed.numbers.to_vec(),
        began: changed.began.iter().map(|&place| place as u64).collect(),
        ended: ended.clone().map(|ended| row(ended.things)).collect(),
        ended_numbers: ended.map(|ended| ended.number).collect(),
    }
}

fn listed<R: From<[u32; 4]>>(rows: Vec<[u32; 4]>) -> Vec<R> {
    rows.into_iter().map(R::from).collect()
}

/// A list of numbers of a named tuple.
fn field(of: &Any<'_>, name: &str) -> Result<Vec<u32>> {
    numbers(&of.getattr(name)?, [name, "which of them these are"])
}
