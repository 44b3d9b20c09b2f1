//! `Changes` of Python: rows of a list that began, persist and ended since the last list.

use crate::answers::{Any, Column, Rows, class};
use crate::arrays::{self, numbers};
use crate::error::{Result, alone_with, refused};
use crate::selection::Body;
use pliant::{BodyId, Changed, Edited, Fused, Piece, RowChanges, Thing};
use pyo3::prelude::*;
use std::sync::Mutex;

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
    state: Mutex<RowChanges>,
}

#[pymethods]
impl Changes {
    #[new]
    #[pyo3(signature = (kind="triangles"))]
    fn new(kind: &str) -> Result<Self> {
        let kinds = match kind {
            "triangles" => [Thing::Triangle; 2],
            "vertex-triangle" => [Thing::Vertex, Thing::Triangle],
            "edge-edge" => [Thing::Edge; 2],
            "edge-triangle" => [Thing::Edge, Thing::Triangle],
            other => {
                return Err(refused!(BadOption:
                    "kind is {other:?}; it can be one of \"triangles\", \"vertex-triangle\", \
                     \"edge-edge\", \"edge-triangle\""));
            }
        };
        Ok(Self {
            state: Mutex::new(RowChanges::new(kinds)),
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
        let rows = arrays::rows_of::<4>(rows, "rows", "queries give")?;
        let things = |[body_a, a, body_b, b]: [u32; 4]| [(BodyId(body_a), a), (BodyId(body_b), b)];
        let told = alone_with(py, &self.state, move |changes| {
            Ok(told(changes.update(rows.into_iter().map(things))))
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
            changes.edited(body.0, &edited);
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
            changes.split(body.0, &all);
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
            changes.fused(kept.0, gone.0, &fused);
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
        alone_with(py, &self.state, |changes| {
            changes.edges_edited(body.0, &before, &after);
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

/// A list of numbers of a named tuple.
fn field(of: &Any<'_>, name: &str) -> Result<Vec<u32>> {
    numbers(&of.getattr(name)?, [name, "which of them these are"])
}
