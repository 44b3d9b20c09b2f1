//! `CloseQuery` as Python sees it: which elements are close, with numbers in arrays side by side.

use crate::arrays;
use crate::error::Refused;
use crate::query::{First, Prepare, Selection, SomeAtATime, Want, go_on, no_list, stopped};
use crate::signals::interruptible;
use crate::world::World;
use numpy::IntoPyArray;
use pliant::{CloseEdgeEdge, CloseTriangles, CloseVertexTriangle};
use pliant_check::with_world;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyTuple, PyType};

/// Which elements are close.
#[derive(Clone, Copy)]
pub(crate) enum CloseKind {
    VertexTriangle,
    EdgeEdge,
    Triangles,
}

/// A close pair of any kind.
#[derive(Clone, Copy)]
pub(crate) struct Close {
    row: [u32; 4],
    distance: f64,
    direction: Option<[f64; 3]>,
    /// Of two triangles all six, of edges the first four, of a vertex and a triangle the first three.
    barycentric: [f64; 6],
}

impl From<CloseVertexTriangle> for Close {
    fn from(close: CloseVertexTriangle) -> Self {
        let [a, b, c] = close.barycentric;
        Self {
            row: close.pair.into(),
            distance: close.distance,
            direction: close.direction,
            barycentric: [a, b, c, 0.0, 0.0, 0.0],
        }
    }
}

impl From<CloseEdgeEdge> for Close {
    fn from(close: CloseEdgeEdge) -> Self {
        let ([a, b], [c, d]) = (close.barycentric_a, close.barycentric_b);
        Self {
            row: close.pair.into(),
            distance: close.distance,
            direction: close.direction,
            barycentric: [a, b, c, d, 0.0, 0.0],
        }
    }
}

impl From<CloseTriangles> for Close {
    fn from(close: CloseTriangles) -> Self {
        let ([a, b, c], [d, e, f]) = (close.barycentric_a, close.barycentric_b);
        Self {
            row: close.pair.into(),
            distance: close.distance,
            direction: close.direction,
            barycentric: [a, b, c, d, e, f],
        }
    }
}

impl Close {
    /// A ClosePair of two triangles.
    pub(crate) fn of_triangles(
        py: Python<'_>,
        close: CloseTriangles,
    ) -> PyResult<Bound<'_, PyAny>> {
        Self::from(close).one(py, CloseKind::Triangles)
    }

    /// A ClosePair.
    fn one(self, py: Python<'_>, kind: CloseKind) -> PyResult<Bound<'_, PyAny>> {
        let (place, numbers) = match kind {
            CloseKind::VertexTriangle => (2, &self.barycentric[..3]),
            CloseKind::EdgeEdge => (3, &self.barycentric[..4]),
            CloseKind::Triangles => (4, &self.barycentric[..]),
        };
        let [body_a, a, body_b, b] = self.row;
        let pair = class(py, place)?.call1((body_a, a, body_b, b))?;
        let barycentric = PyTuple::new(py, numbers)?;
        let direction = self.direction.map(|[x, y, z]| (x, y, z));
        class(py, 1)?.call1((pair, self.distance, direction, barycentric))
    }
}

/// A question which elements are close, that waits to be told how much is wanted: all(), the first(), or visit_some(...). Each call asks
/// anew, about the shapes that the bodies have then.
///
/// A call raises pliant.Error as those of Query do; with kind "BadDistance" if the distance is negative, infinite or NaN.
#[pyclass(frozen, module = "pliant")]
pub(crate) struct CloseQuery {
    world: Py<World>,
    kind: CloseKind,
    of: Selection,
    distance: f64,
}

impl CloseQuery {
    pub(crate) fn new(world: Py<World>, kind: CloseKind, of: Selection, distance: f64) -> Self {
        Self {
            world,
            kind,
            of,
            distance,
        }
    }

    /// Asks the world, without the interpreter lock, for what is wanted.
    fn ask<T: Send>(&self, py: Python<'_>, want: impl Want<Close, T> + Send) -> Result<T, Refused> {
        let (kind, of, distance) = (self.kind, self.of.0, self.distance);
        self.world.get().with(py, |state| {
            interruptible(|question| {
                with_world!(&mut state.world, world => match kind {
                    CloseKind::VertexTriangle => {
                        let query = world.close_vertex_triangle_pairs(of, distance);
                        want.of(query.interrupt_if(question))
                    }
                    CloseKind::EdgeEdge => {
                        let query = world.close_edge_edge_pairs(of, distance);
                        want.of(query.interrupt_if(question))
                    }
                    CloseKind::Triangles => {
                        let query = world.close_triangle_pairs(of, distance);
                        want.of(query.interrupt_if(question))
                    }
                })
            })
        })
    }
}

/// What is known of many, column by column, as arrays take it over.
struct Columns {
    rows: Vec<[u32; 4]>,
    distance: Vec<f64>,
    direction: Vec<[f64; 3]>,
    barycentric: Barycentric,
}

/// As many numbers as a kind has.
enum Barycentric {
    Three(Vec<[f64; 3]>),
    Four(Vec<[f64; 4]>),
    Six(Vec<[f64; 6]>),
}

impl Columns {
    fn of(kind: CloseKind, all: impl ExactSizeIterator<Item = Close>) -> Self {
        let count = all.len();
        let mut columns = Self {
            rows: Vec::with_capacity(count),
            distance: Vec::with_capacity(count),
            direction: Vec::with_capacity(count),
            barycentric: match kind {
                CloseKind::VertexTriangle => Barycentric::Three(Vec::with_capacity(count)),
                CloseKind::EdgeEdge => Barycentric::Four(Vec::with_capacity(count)),
                CloseKind::Triangles => Barycentric::Six(Vec::with_capacity(count)),
            },
        };
        for close in all {
            columns.rows.push(close.row);
            columns.distance.push(close.distance);
            columns.direction.push(close.direction.unwrap_or_default());
            let [a, b, c, d, ..] = close.barycentric;
            match &mut columns.barycentric {
                Barycentric::Three(three) => three.push([a, b, c]),
                Barycentric::Four(four) => four.push([a, b, c, d]),
                Barycentric::Six(six) => six.push(close.barycentric),
            }
        }
        columns
    }

    /// A ClosePairs.
    fn arrays(self, py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
        let pairs = arrays::rows_of(py, self.rows)?;
        let direction = arrays::rows_of(py, self.direction)?;
        let barycentric = match self.barycentric {
            Barycentric::Three(three) => arrays::rows_of(py, three)?,
            Barycentric::Four(four) => arrays::rows_of(py, four)?,
            Barycentric::Six(six) => arrays::rows_of(py, six)?,
        };
        let distance = self.distance.into_pyarray(py);
        class(py, 0)?.call1((pairs, distance, direction, barycentric))
    }
}

/// All, in columns; at most so many.
struct AllColumns(CloseKind, usize);

impl Want<Close, Columns> for AllColumns {
    fn of<H: Copy + Into<Close>>(
        self,
        query: pliant::Query<'_, H>,
    ) -> Result<Columns, pliant::Error> {
        let Self(kind, most) = self;
        let close = query.at_most(most).all()?;
        Ok(Columns::of(kind, close.iter().map(|&close| close.into())))
    }
}

/// The named tuples of many and of one, and those of the elements.
fn class(py: Python<'_>, place: usize) -> PyResult<&Bound<'_, PyType>> {
    const NAMES: [&str; 5] = [
        "ClosePairs",
        "ClosePair",
        "VertexTriangle",
        "EdgeEdge",
        "Pair",
    ];
    static CLASSES: [PyOnceLock<Py<PyType>>; 5] = [const { PyOnceLock::new() }; 5];
    CLASSES[place].import(py, "pliant._types", NAMES[place])
}

#[pymethods]
impl CloseQuery {
    fn __iter__(slf: &Bound<'_, Self>) -> PyResult<()> {
        Err(no_list(slf)?)
    }

    fn __len__(slf: &Bound<'_, Self>) -> PyResult<usize> {
        Err(no_list(slf)?)
    }

    /// All close pairs, sorted, as a ClosePairs of arrays; the same for every option, history and number of threads.
    ///
    /// at_most refuses more than this with pliant.Error, kind "TooManyHits", instead of making arrays that may fill the memory.
    #[pyo3(signature = (*, at_most=None))]
    fn all<'py>(
        &self,
        py: Python<'py>,
        at_most: Option<usize>,
    ) -> Result<Bound<'py, PyAny>, Refused> {
        let columns = self.ask(py, AllColumns(self.kind, at_most.unwrap_or(usize::MAX)))?;
        Ok(columns.arrays(py)?)
    }

    /// Some close pair, a ClosePair, or None if there is none: much cheaper than all where there are many. Which one may depend on options
    /// and history; whether there is one never does.
    fn first<'py>(&self, py: Python<'py>) -> Result<Option<Bound<'py, PyAny>>, Refused> {
        let close = self.ask(py, First)?;
        Ok(close.map(|close| close.one(py, self.kind)).transpose()?)
    }

    /// Calls visit(close) with some close pairs at a time, a ClosePairs, until it returns True (or anything true). Returns whether it did.
    /// Each comes once; no list of all is made. The order, and how many come at a time, is deterministic; visit may not ask this world.
    fn visit_some(&self, py: Python<'_>, visit: &Bound<'_, PyAny>) -> Result<bool, Refused> {
        let (visit, kind) = (visit.as_unbound(), self.kind);
        let visited = self.ask(
            py,
            SomeAtATime(|close: Vec<Close>| {
                go_on(Python::attach(|py| {
                    let close = Columns::of(kind, close.into_iter()).arrays(py)?;
                    visit.bind(py).call1((close,))?.is_truthy()
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
            CloseKind::VertexTriangle => "vertices and triangles",
            CloseKind::EdgeEdge => "edges and edges",
            CloseKind::Triangles => "triangles",
        };
        let (of, distance) = (self.of.__repr__(), self.distance);
        format!("<pliant.CloseQuery of {of}, {elements}, within {distance}>")
    }
}
