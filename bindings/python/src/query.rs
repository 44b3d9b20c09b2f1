//! `Selection` and `Query` as Python sees them: who is asked about, what, and how much is wanted.

use crate::arrays;
use crate::error::Refused;
use crate::signals::interruptible;
use crate::world::{Body, World};
use numpy::PyArray2;
use pliant::Error;
use pliant_check::with_world;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyType;
use std::ops::ControlFlow;

/// Who meets whom in a query: a value, made with
///
///   Selection.WORLD           every two bodies that may meet, as set_filter and ignore say; no body with itself
///   Selection.EVERYTHING      the same, and each body with itself: what a step of a simulator asks. A body meets itself unless its
///                             own membership and mask have no bit in common, or it is ignored with itself
///   Selection.between(a, b)   two different bodies, whatever filters say; the first is the first of every hit
///   Selection.within(a)       one body with itself, whatever filters say
#[pyclass(frozen, eq, hash, module = "pliant")]
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Selection(pub(crate) pliant::Selection);

impl<'py> FromPyObject<'_, 'py> for Selection {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(selection) = given.cast::<Self>() {
            return Ok(*selection.get());
        }
        let given = given.repr()?;
        Err(PyTypeError::new_err(format!(
            "who is asked about is a pliant.Selection: Selection.EVERYTHING, Selection.WORLD, Selection.between(a, b) or \
             Selection.within(a); not {given}"
        )))
    }
}

#[pymethods]
impl Selection {
    #[classattr]
    pub(crate) const WORLD: Self = Self(pliant::Selection::World);
    #[classattr]
    const EVERYTHING: Self = Self(pliant::Selection::Everything);

    /// Two different bodies, whatever filters say. The first is the first of every hit.
    #[staticmethod]
    fn between(a: Body, b: Body) -> Self {
        Self(pliant::Selection::Between(a.0, b.0))
    }

    /// One body with itself, whatever filters say.
    #[staticmethod]
    fn within(body: Body) -> Self {
        Self(pliant::Selection::Within(body.0))
    }

    pub(crate) fn __repr__(&self) -> String {
        match self.0 {
            pliant::Selection::World => "Selection.WORLD".to_owned(),
            pliant::Selection::Everything => "Selection.EVERYTHING".to_owned(),
            pliant::Selection::Between(a, b) => format!("Selection.between({}, {})", a.0, b.0),
            pliant::Selection::Within(body) => format!("Selection.within({})", body.0),
        }
    }

    /// For `pickle` and `copy`: the name of a constant, or a function and its arguments.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let (py, class) = (slf.py(), slf.get_type());
        let constant = |name: &str| {
            let getattr = py.import("builtins")?.getattr("getattr")?;
            (getattr, (&class, name)).into_pyobject(py)
        };
        let reduced = match slf.get().0 {
            pliant::Selection::World => constant("WORLD")?,
            pliant::Selection::Everything => constant("EVERYTHING")?,
            pliant::Selection::Between(a, b) => {
                (class.getattr("between")?, (a.0, b.0)).into_pyobject(py)?
            }
            pliant::Selection::Within(body) => {
                (class.getattr("within")?, (body.0,)).into_pyobject(py)?
            }
        };
        Ok(reduced.into_any())
    }
}

/// What is asked.
#[derive(Clone, Copy)]
pub(crate) enum Kind {
    Intersections,
    /// Within a margin round each.
    VertexTriangleCandidates(f64),
    EdgeEdgeCandidates(f64),
}

impl Kind {
    /// The class of its hits.
    fn class(self, py: Python<'_>) -> PyResult<&Bound<'_, PyType>> {
        // Visitors are shown many, so each is looked up once.
        static CLASSES: [PyOnceLock<Py<PyType>>; 3] = [const { PyOnceLock::new() }; 3];
        let (place, name) = match self {
            Self::Intersections => (0, "Pair"),
            Self::VertexTriangleCandidates(_) => (1, "VertexTriangle"),
            Self::EdgeEdgeCandidates(_) => (2, "EdgeEdge"),
        };
        CLASSES[place].import(py, "pliant._types", name)
    }

    fn hit(self, py: Python<'_>, row: Row) -> PyResult<Bound<'_, PyAny>> {
        let [body_a, a, body_b, b] = row;
        self.class(py)?.call1((body_a, a, body_b, b))
    }
}

/// A hit of any kind.
type Row = [u32; 4];

/// How much is wanted of a query, whatever its kind, where hits are shown as `R`.
pub(crate) trait Want<R, T> {
    fn of<H: Copy + Into<R>>(self, query: pliant::Query<'_, H>) -> Result<T, Error>;
}

pub(crate) struct All(pub(crate) usize);

impl<R> Want<R, Vec<R>> for All {
    fn of<H: Copy + Into<R>>(self, query: pliant::Query<'_, H>) -> Result<Vec<R>, Error> {
        let hits = query.at_most(self.0).all()?;
        Ok(hits.iter().map(|&hit| hit.into()).collect())
    }
}

/// All, as an array of rows, which is made and filled under the interpreter lock.
struct AllRows(usize);

impl Want<Row, PyResult<Py<PyArray2<u32>>>> for AllRows {
    fn of<H: Copy + Into<Row>>(
        self,
        query: pliant::Query<'_, H>,
    ) -> Result<PyResult<Py<PyArray2<u32>>>, Error> {
        let hits = query.at_most(self.0).all()?;
        let rows = hits.iter().map(|&hit| hit.into());
        Ok(Python::attach(|py| {
            arrays::copy_of_rows(py, rows).map(Bound::unbind)
        }))
    }
}

pub(crate) struct First;

impl<R> Want<R, Option<R>> for First {
    fn of<H: Copy + Into<R>>(self, query: pliant::Query<'_, H>) -> Result<Option<R>, Error> {
        Ok(query.first()?.map(Into::into))
    }
}

/// Shows some hits at a time to a function.
pub(crate) struct SomeAtATime<F>(pub(crate) F);

pub(crate) type Stopped = ControlFlow<PyResult<()>>;

impl<R, F: FnMut(Vec<R>) -> Stopped> Want<R, Stopped> for SomeAtATime<F> {
    fn of<H: Copy + Into<R>>(mut self, query: pliant::Query<'_, H>) -> Result<Stopped, Error> {
        query.visit_some(|hits| self.0(hits.iter().map(|&hit| hit.into()).collect()))
    }
}

/// Shows one row after the other to a function.
struct Each<F>(F);

impl<F: FnMut(Row) -> Stopped> Want<Row, Stopped> for Each<F> {
    fn of<H: Copy + Into<Row>>(mut self, query: pliant::Query<'_, H>) -> Result<Stopped, Error> {
        query.visit(|hit| self.0(hit.into()))
    }
}

pub(crate) struct Prepare;

impl<R> Want<R, ()> for Prepare {
    fn of<H: Copy + Into<R>>(self, query: pliant::Query<'_, H>) -> Result<(), Error> {
        query.prepare()
    }
}

/// A question that was put to a world, and waits to be told how much is wanted: all() hits, the first(), or a visit(...) to one after
/// the other. Each call asks anew, about the shapes that the bodies have then.
///
/// A call raises pliant.Error if the selection names a body that is not there, or one body as two. What a signal handler raises
/// meanwhile in the main thread, KeyboardInterrupt after Ctrl-C, ends it early; the world stays usable, and makes the boxes of all
/// bodies anew in the next query.
#[pyclass(frozen, module = "pliant")]
pub(crate) struct Query {
    world: Py<World>,
    kind: Kind,
    of: Selection,
}

impl Query {
    pub(crate) fn new(world: Py<World>, kind: Kind, of: Selection) -> Self {
        Self { world, kind, of }
    }

    /// Asks the world, without the interpreter lock, for what is wanted.
    fn ask<T: Send>(&self, py: Python<'_>, want: impl Want<Row, T> + Send) -> Result<T, Refused> {
        let (kind, of) = (self.kind, self.of.0);
        self.world.get().with(py, |state| {
            interruptible(|question| {
                with_world!(&mut state.world, world => match kind {
                    Kind::Intersections => {
                        want.of(world.intersections(of).interrupt_if(question))
                    }
                    Kind::VertexTriangleCandidates(radius) => {
                        let query = world.vertex_triangle_candidates(of, radius);
                        want.of(query.interrupt_if(question))
                    }
                    Kind::EdgeEdgeCandidates(radius) => {
                        let query = world.edge_edge_candidates(of, radius);
                        want.of(query.interrupt_if(question))
                    }
                })
            })
        })
    }
}

/// Why nobody goes through a question, or counts it.
pub(crate) fn no_list(question: &Bound<'_, PyAny>) -> PyResult<PyErr> {
    let class = question.get_type().fully_qualified_name()?;
    Ok(PyTypeError::new_err(format!(
        "a {class} is a question that was not answered yet: ask it for all(), first() or visit_some(...)"
    )))
}

/// Whether a visitor stopped, or what it raised.
pub(crate) fn stopped(visited: Stopped) -> PyResult<bool> {
    match visited {
        ControlFlow::Continue(()) => Ok(false),
        ControlFlow::Break(stopped) => stopped.map(|()| true),
    }
}

/// What a visitor's answer means.
pub(crate) fn go_on(answer: PyResult<bool>) -> Stopped {
    match answer {
        Ok(false) => ControlFlow::Continue(()),
        Ok(true) => ControlFlow::Break(Ok(())),
        Err(raised) => ControlFlow::Break(Err(raised)),
    }
}

#[pymethods]
impl Query {
    fn __iter__(slf: &Bound<'_, Self>) -> PyResult<()> {
        Err(no_list(slf)?)
    }

    fn __len__(slf: &Bound<'_, Self>) -> PyResult<usize> {
        Err(no_list(slf)?)
    }

    /// All hits, sorted: (k, 4) uint32; the same for every option, history and number of threads. A row is body, triangle, body, triangle;
    /// of candidates body, vertex, body, triangle, or body, edge, body, edge.
    ///
    /// at_most refuses a list of more hits than this with pliant.Error, kind "TooManyHits", instead of making one that may fill the
    /// memory.
    #[pyo3(signature = (*, at_most=None))]
    fn all<'py>(
        &self,
        py: Python<'py>,
        at_most: Option<usize>,
    ) -> Result<Bound<'py, PyArray2<u32>>, Refused> {
        let rows = self.ask(py, AllRows(at_most.unwrap_or(usize::MAX)))??;
        Ok(rows.into_bound(py))
    }

    /// Some hit, a Pair, VertexTriangle or EdgeEdge, or None if there is none: much cheaper than all where there are many. Which one may
    /// depend on options and history; whether there is one never does.
    fn first<'py>(&self, py: Python<'py>) -> Result<Option<Bound<'py, PyAny>>, Refused> {
        let row = self.ask(py, First)?;
        Ok(row.map(|row| self.kind.hit(py, row)).transpose()?)
    }

    /// Calls visit(hit) for every hit once, until it returns True (or anything true). Returns whether it did. The order is
    /// deterministic, not sorted; visit may not ask this world.
    fn visit(&self, py: Python<'_>, visit: &Bound<'_, PyAny>) -> Result<bool, Refused> {
        let (visit, kind) = (visit.as_unbound(), self.kind);
        let visited = self.ask(
            py,
            Each(|row| {
                go_on(Python::attach(|py| {
                    let hit = kind.hit(py, row)?;
                    visit.bind(py).call1((hit,))?.is_truthy()
                }))
            }),
        )?;
        Ok(stopped(visited)?)
    }

    /// Calls visit(rows) with some hits at a time, (k, 4) uint32 as of all(), until it returns True (or anything true). Returns whether it
    /// did. Every hit comes once; no list of all is made. The order, and how many come at a time, is deterministic.
    fn visit_some(&self, py: Python<'_>, visit: &Bound<'_, PyAny>) -> Result<bool, Refused> {
        let visit = visit.as_unbound();
        let visited = self.ask(
            py,
            SomeAtATime(|rows| {
                go_on(Python::attach(|py| {
                    let rows = arrays::rows_of::<_, 4>(py, rows)?;
                    visit.bind(py).call1((rows,))?.is_truthy()
                }))
            }),
        )?;
        Ok(stopped(visited)?)
    }

    /// Does early what the query would do first, and asks nothing: finds the bodies that may meet and refits the upper levels of their
    /// trees; all of it in a body that meets itself. Never needed for right answers; it is for whoever wants to time it, or has time
    /// to spare.
    fn prepare(&self, py: Python<'_>) -> Result<(), Refused> {
        self.ask(py, Prepare)
    }

    fn __repr__(&self) -> String {
        let of = self.of.__repr__();
        match self.kind {
            Kind::Intersections => format!("<pliant.Query of {of}>"),
            Kind::VertexTriangleCandidates(radius) => {
                format!("<pliant.Query of {of}, vertices and triangles, margin {radius}>")
            }
            Kind::EdgeEdgeCandidates(radius) => {
                format!("<pliant.Query of {of}, edges and edges, margin {radius}>")
            }
        }
    }
}
