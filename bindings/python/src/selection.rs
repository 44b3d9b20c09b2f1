//! `Selection` of Python, and bodies by their numbers.

use crate::answers::Any;
use crate::error::{after_calling, refused};
use pliant::{BodyId, ErrorKind};
use pyo3::exceptions::{PyOverflowError, PyTypeError};
use pyo3::prelude::*;

/// Number of a body, as a caller gives it. A number that no body can have is no body of any world.
#[derive(Clone, Copy)]
pub(crate) struct Body(pub(crate) BodyId);

impl<'py> FromPyObject<'_, 'py> for Body {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        match given.extract() {
            Ok(number) => Ok(Self(BodyId(number))),
            Err(error) if error.is_instance_of::<PyOverflowError>(given.py()) => {
                let kind = ErrorKind::NoSuchBody;
                let refused = refused!(NoSuchBody: "body {}: {kind}", given.str()?);
                Err(refused.advising(after_calling(&kind)).into())
            }
            Err(error) => Err(error),
        }
    }
}

/// Which bodies a query asks about: a value that every kind of query takes.
///
/// - Selection.WORLD: every two bodies that may meet, as World.set_filter and ignore say; no body
///   with itself
/// - Selection.EVERYTHING: as WORLD, and each body with itself. It is what a step of a simulator
///   asks. A body whose own membership and mask share no bit is left out with itself, and so is one
///   ignored with itself
/// - Selection.between(a, b): two different bodies, whatever filters say
/// - Selection.within(a): one body with itself, whatever filters say
///
/// Selections can be compared, hashed, copied and pickled.
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
            "who is asked about is a pliant.Selection: Selection.EVERYTHING, Selection.WORLD, \
             Selection.between(a, b) or Selection.within(a); not {given}"
        )))
    }
}

#[pymethods]
impl Selection {
    #[classattr]
    pub(crate) const WORLD: Self = Self(pliant::Selection::World);
    #[classattr]
    pub(crate) const EVERYTHING: Self = Self(pliant::Selection::Everything);

    /// Two different bodies, whatever filters say. Body a is the first of every hit.
    ///
    /// But a vertex comes before a triangle, whichever body it is of.
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

    /// Returns what pickle and copy need: the name of a constant, or a function and its arguments.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Any<'py>> {
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
