//! `ImpactQuery` as Python sees it: which elements meet on their way, and when first, with numbers in arrays side by side; and the same of
//! single pairs, for who has a search of their own.

use crate::arrays;
use crate::error::{Refused, caught};
use crate::query::{First, Prepare, Selection, SomeAtATime, Want, go_on, no_list, stopped};
use crate::signals::{interruptible, interruptible_after};
use crate::world::World;
use numpy::{IntoPyArray, PyArray1};
use pliant::{EdgeEdgeImpact, VertexTriangleImpact};
use pliant_check::with_world;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyType;

/// Which elements meet.
#[derive(Clone, Copy)]
pub(crate) enum ImpactKind {
    VertexTriangle,
    EdgeEdge,
}

/// An impact of either kind.
#[derive(Clone, Copy)]
pub(crate) struct Impact {
    row: [u32; 4],
    low: f64,
    high: f64,
}

impl From<VertexTriangleImpact> for Impact {
    fn from(impact: VertexTriangleImpact) -> Self {
        Self {
            row: impact.pair.into(),
            low: impact.low,
            high: impact.high,
        }
    }
}

impl From<EdgeEdgeImpact> for Impact {
    fn from(impact: EdgeEdgeImpact) -> Self {
        Self {
            row: impact.pair.into(),
            low: impact.low,
            high: impact.high,
        }
    }
}

impl Impact {
    /// An Impact of either kind.
    pub(crate) fn of(py: Python<'_>, impact: pliant::Impact) -> PyResult<Bound<'_, PyAny>> {
        match impact {
            pliant::Impact::VertexTriangle(impact) => {
                Self::from(impact).one(py, ImpactKind::VertexTriangle)
            }
            pliant::Impact::EdgeEdge(impact) => Self::from(impact).one(py, ImpactKind::EdgeEdge),
        }
    }

    fn one(self, py: Python<'_>, kind: ImpactKind) -> PyResult<Bound<'_, PyAny>> {
        let place = match kind {
            ImpactKind::VertexTriangle => 2,
            ImpactKind::EdgeEdge => 3,
        };
        let [body_a, a, body_b, b] = self.row;
        let pair = class(py, place)?.call1((body_a, a, body_b, b))?;
        class(py, 1)?.call1((pair, self.low, self.high))
    }
}

/// The named tuples of many and of one, and those of the elements.
fn class(py: Python<'_>, place: usize) -> PyResult<&Bound<'_, PyType>> {
    const NAMES: [&str; 4] = ["Impacts", "Impact", "VertexTriangle", "EdgeEdge"];
    static CLASSES: [PyOnceLock<Py<PyType>>; 4] = [const { PyOnceLock::new() }; 4];
    CLASSES[place].import(py, "pliant._types", NAMES[place])
}

/// An Impacts.
fn columns<'py>(py: Python<'py>, impacts: &[Impact]) -> PyResult<Bound<'py, PyAny>> {
    let pairs: Vec<[u32; 4]> = impacts.iter().map(|impact| impact.row).collect();
    let low: Vec<f64> = impacts.iter().map(|impact| impact.low).collect();
    let high: Vec<f64> = impacts.iter().map(|impact| impact.high).collect();
    let pairs = arrays::rows_of(py, pairs)?;
    class(py, 0)?.call1((pairs, low.into_pyarray(py), high.into_pyarray(py)))
}

/// A question which elements meet on their way, that waits to be told how much is wanted: all(), the first(), or visit_some(...). Each call
/// asks anew, about the shapes and the motions that the bodies have then.
///
/// A call raises pliant.Error as those of Query do; with kind "BadWidth" if the width is negative, infinite or NaN.
#[pyclass(frozen, module = "pliant")]
pub(crate) struct ImpactQuery {
    world: Py<World>,
    kind: ImpactKind,
    of: Selection,
    width: f64,
}

impl ImpactQuery {
    pub(crate) fn new(world: Py<World>, kind: ImpactKind, of: Selection, width: f64) -> Self {
        Self {
            world,
            kind,
            of,
            width,
        }
    }

    /// Asks the world, without the interpreter lock, for what is wanted.
    fn ask<T: Send>(
        &self,
        py: Python<'_>,
        want: impl Want<Impact, T> + Send,
    ) -> Result<T, Refused> {
        let (kind, of, width) = (self.kind, self.of.0, self.width);
        self.world.get().with(py, |state| {
            interruptible(|question| {
                with_world!(&mut state.world, world => match kind {
                    ImpactKind::VertexTriangle => {
                        let query = world.vertex_triangle_impacts(of).width(width);
                        want.of(query.interrupt_if(question))
                    }
                    ImpactKind::EdgeEdge => {
                        let query = world.edge_edge_impacts(of).width(width);
                        want.of(query.interrupt_if(question))
                    }
                })
            })
        })
    }
}

#[pymethods]
impl ImpactQuery {
    fn __iter__(slf: &Bound<'_, Self>) -> PyResult<()> {
        Err(no_list(slf)?)
    }

    fn __len__(slf: &Bound<'_, Self>) -> PyResult<usize> {
        Err(no_list(slf)?)
    }

    /// All impacts, sorted, as an Impacts of arrays; the same for every option, history and number of threads.
    ///
    /// at_most refuses more than this with pliant.Error, kind "TooManyHits", instead of making arrays that may fill the memory.
    #[pyo3(signature = (*, at_most=None))]
    fn all<'py>(
        &self,
        py: Python<'py>,
        at_most: Option<usize>,
    ) -> Result<Bound<'py, PyAny>, Refused> {
        let impacts = self.ask(py, crate::query::All(at_most.unwrap_or(usize::MAX)))?;
        Ok(columns(py, &impacts)?)
    }

    /// The impact with the least exact time, an Impact; of several, the first in order. None if nothing meets. Much faster than all.
    fn first<'py>(&self, py: Python<'py>) -> Result<Option<Bound<'py, PyAny>>, Refused> {
        let impact = self.ask(py, First)?;
        Ok(impact.map(|impact| impact.one(py, self.kind)).transpose()?)
    }

    /// Calls visit(impacts) with some impacts at a time, an Impacts, until it returns True (or anything true). Returns whether it did.
    /// Each comes once; no list of all is made. The order, and how many come at a time, is deterministic; visit may not ask this world.
    fn visit_some(&self, py: Python<'_>, visit: &Bound<'_, PyAny>) -> Result<bool, Refused> {
        let visit = visit.as_unbound();
        let visited = self.ask(
            py,
            SomeAtATime(|impacts: Vec<Impact>| {
                go_on(Python::attach(|py| {
                    visit.bind(py).call1((columns(py, &impacts)?,))?.is_truthy()
                }))
            }),
        )?;
        Ok(stopped(visited)?)
    }

    /// Does early what the query would do first, and asks nothing; see Query.prepare.
    fn prepare(&self, py: Python<'_>) -> Result<(), Refused> {
        self.ask(py, Prepare)
    }

    fn __repr__(&self) -> String {
        let elements = match self.kind {
            ImpactKind::VertexTriangle => "vertices and triangles",
            ImpactKind::EdgeEdge => "edges and edges",
        };
        let (of, width) = (self.of.__repr__(), self.width);
        format!("<pliant.ImpactQuery of {of}, {elements}, width {width}>")
    }
}

/// (hit, low, high): bool (k,), float64 (k,), float64 (k,).
type Answer<'py> = (
    Bound<'py, PyArray1<bool>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
);

/// When vertices first meet triangles that move: start and end (k, 4, 3) float64, of each pair the vertex and the three corners of the
/// triangle, at the start and at the end of the motion. Corners move on straight lines.
///
/// Returns (hit, low, high): bool (k,), float64 (k,), float64 (k,). Whether a pair meets, as closed sets, is decided exactly; they are
/// apart from time 0 to low, both included, and meet after that and not after high; both are 0 if they meet at the start, and NaN where
/// there is no hit. high - low is at most width; with 0 they are neighbouring numbers. Ctrl-C is looked for between pairs.
#[pyfunction]
#[pyo3(signature = (start, end, width=1e-6))]
pub(crate) fn vertex_triangle_impacts<'py>(
    py: Python<'py>,
    start: &Bound<'py, PyAny>,
    end: &Bound<'py, PyAny>,
    width: f64,
) -> Result<Answer<'py>, Refused> {
    answer(py, false, [start, end], width)
}

/// When edges first meet edges that move: start and end (k, 4, 3) float64, of each pair both ends of the one edge and both of the other, at
/// the start and at the end of the motion. The answer is that of vertex_triangle_impacts.
#[pyfunction]
#[pyo3(signature = (start, end, width=1e-6))]
pub(crate) fn edge_edge_impacts<'py>(
    py: Python<'py>,
    start: &Bound<'py, PyAny>,
    end: &Bound<'py, PyAny>,
    width: f64,
) -> Result<Answer<'py>, Refused> {
    answer(py, true, [start, end], width)
}

fn answer<'py>(
    py: Python<'py>,
    are_edges: bool,
    [start, end]: [&Bound<'py, PyAny>; 2],
    width: f64,
) -> Result<Answer<'py>, Refused> {
    let start = arrays::pairs_of_elements(start).map_err(|refused| refused.about("start"))?;
    let end = arrays::pairs_of_elements(end).map_err(|refused| refused.about("end"))?;
    // A single pair may take long, so that it is looked for signals before each that does.
    let ask = |question: &(dyn Fn() -> bool + Sync)| {
        pliant::pair_impacts(are_edges, &start, &end, width, Some(question))
    };
    let found = py.detach(|| caught(|| interruptible_after(1, ask)))?;
    let side = |side: usize| -> Vec<f64> {
        let cells = found.iter();
        cells
            .map(|cell| cell.map_or(f64::NAN, |cell| cell[side]))
            .collect()
    };
    let [low, high] = [side(0), side(1)].map(|side| side.into_pyarray(py));
    let hit: Vec<bool> = found.iter().map(Option::is_some).collect();
    Ok((hit.into_pyarray(py), low, high))
}
