//! `Selection` and `Query` as Python sees them: who is asked about, and how much is wanted.

use crate::arrays;
use crate::error::Refused;
use crate::signals::interruptible;
use crate::world::{Body, World};
use numpy::PyArray2;
use pliant::{Error, Pair};
use pliant_check::with_world;
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
#[pyclass(frozen, eq, hash, from_py_object, module = "pliant")]
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Selection(pub(crate) pliant::Selection);

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

    fn __repr__(&self) -> String {
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

/// A question that was put to a world, and waits to be told how much is wanted: all() hits, the first(), or a visit(...) to one after
/// the other. Each call asks anew, about the shapes that the bodies have then.
///
/// A call raises pliant.Error if the selection names a body that is not there, or one body as two. What a signal handler raises
/// meanwhile in the main thread, KeyboardInterrupt after Ctrl-C, ends it early; the world stays usable, and makes the boxes of all
/// bodies anew in the next query.
#[pyclass(frozen, module = "pliant")]
pub(crate) struct Query {
    world: Py<World>,
    of: Selection,
}

impl Query {
    pub(crate) fn new(world: Py<World>, of: Selection) -> Self {
        Self { world, of }
    }

    /// Asks the world, without the interpreter lock, for what is wanted.
    fn ask<T: Send>(
        &self,
        py: Python<'_>,
        want: impl FnOnce(pliant::Query<'_, Pair>) -> Result<T, Error> + Send,
    ) -> Result<T, Refused> {
        let of = self.of.0;
        self.world.get().with(py, |state| {
            interruptible(|question| {
                let query = with_world!(&mut state.world, world => world.intersections(of));
                want(query.interrupt_if(question))
            })
        })
    }
}

#[pymethods]
#[expect(
    clippy::redundant_closure_for_method_calls,
    reason = "the method itself takes a query of one lifetime, the closure one of any"
)]
impl Query {
    /// All hits, sorted: (k, 4) uint32, body, triangle, body, triangle; the same for every option, history and number of threads.
    ///
    /// at_most refuses a list of more hits than this with pliant.Error, kind "TooManyHits", instead of making one that may fill the
    /// memory.
    #[pyo3(signature = (*, at_most=None))]
    fn all<'py>(
        &self,
        py: Python<'py>,
        at_most: Option<usize>,
    ) -> Result<Bound<'py, PyArray2<u32>>, Refused> {
        let rows = self.ask(py, |query| {
            let pairs = query.at_most(at_most.unwrap_or(usize::MAX)).all()?;
            Ok(pairs.iter().map(|&pair| pair.into()).collect())
        })?;
        Ok(arrays::rows_of::<_, 4>(py, rows)?)
    }

    /// Some hit, a Pair, or None if there is none: much cheaper than all where there are many. Which one may depend on options and
    /// history; whether there is one never does.
    fn first<'py>(&self, py: Python<'py>) -> Result<Option<Bound<'py, PyAny>>, Refused> {
        let pair = self.ask(py, |query| query.first())?;
        Ok(pair.map(|pair| pair_of_python(py, pair)).transpose()?)
    }

    /// Calls visit(pair) for every hit once, until it returns True (or anything true). Returns whether it did. The order is
    /// deterministic, not sorted; visit may not ask this world.
    fn visit(&self, py: Python<'_>, visit: &Bound<'_, PyAny>) -> Result<bool, Refused> {
        let visit = visit.as_unbound();
        let show = |pair| {
            Python::attach(|py| {
                let pair = pair_of_python(py, pair)?;
                visit.bind(py).call1((pair,))?.is_truthy()
            })
        };
        let visited = self.ask(py, |query| {
            query.visit(|pair| match show(pair) {
                Ok(false) => ControlFlow::Continue(()),
                Ok(true) => ControlFlow::Break(Ok(())),
                Err(raised) => ControlFlow::Break(Err(raised)),
            })
        })?;
        match visited {
            ControlFlow::Continue(()) => Ok(false),
            ControlFlow::Break(stopped) => Ok(stopped.map(|()| true)?),
        }
    }

    /// Does early what the query would do first, and asks nothing: finds the bodies that may meet and refits the upper levels of their
    /// trees; all of it in a body that meets itself. Never needed for right answers; it is for whoever wants to time it, or has time
    /// to spare.
    fn prepare(&self, py: Python<'_>) -> Result<(), Refused> {
        self.ask(py, |query| query.prepare())
    }

    fn __repr__(&self) -> String {
        format!("<pliant.Query of {}>", self.of.__repr__())
    }
}

/// Visitors are shown many, so the class is looked up once.
fn pair_of_python(py: Python<'_>, pair: Pair) -> PyResult<Bound<'_, PyAny>> {
    static CLASS: PyOnceLock<Py<PyType>> = PyOnceLock::new();
    let class = CLASS.import(py, "pliant._types", "Pair")?;
    class.call1((
        pair.body_a.0,
        pair.triangle_a,
        pair.body_b.0,
        pair.triangle_b,
    ))
}
