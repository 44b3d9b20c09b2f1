//! `ContactQuery`: which triangles intersect, and how, with numbers in arrays side by side.
//!
//! It also asks about triangles that share a vertex, whose hits are of the same form.

use crate::answers::{Any, class};
use crate::arrays::expected;
use crate::columns::Columns;
use crate::error::Result;
use crate::options::Threads;
use crate::queries::{Hit, Kind, Want, Wanted, query_class};
use pliant::{AdjacentContact, Contact, ContactKind, Scalar};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// Kinds in the order of their numbers in Python.
const KINDS: [ContactKind; 3] = [
    ContactKind::Touching,
    ContactKind::Overlapping,
    ContactKind::Crossing,
];

/// Values of `only`, for messages.
const WANTED: &str = "a pliant.ContactKind: give only=ContactKind.CROSSING, OVERLAPPING or \
                      TOUCHING, or None for all";

/// Kind of contact that alone is asked for.
#[derive(Clone, Copy)]
pub(crate) struct Only(ContactKind);

impl<'py> FromPyObject<'_, 'py> for Only {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let number = object.extract::<usize>();
        let number = number.map_err(|error| expected(object, error, WANTED))?;
        let kind = KINDS.get(number).copied().map(Self);
        kind.ok_or_else(|| PyValueError::new_err(format!("{number} is not {WANTED}")))
    }
}

/// Question which triangles intersect, or meet beyond a vertex that they share, perhaps of one kind
/// alone.
#[derive(Clone, Copy)]
pub(crate) struct Contacts {
    pub(crate) adjacent: bool,
    pub(crate) only: Option<Only>,
}

impl Kind for Contacts {
    fn ask<'w, W: Want>(
        self,
        world: &'w mut pliant::World<impl Scalar>,
        of: pliant::Selection,
        wanted: Wanted<'w, W>,
    ) -> Result<W::Answer> {
        if self.adjacent {
            let query = world.adjacent_intersections(of);
            return wanted.of(match self.only {
                Some(Only(kind)) => query.only(kind),
                None => query,
            });
        }
        let query = world.contacts(of);
        wanted.of(match self.only {
            Some(Only(kind)) => query.only(kind),
            None => query,
        })
    }

    fn said(self) -> String {
        let only = self.only.map(|Only(kind)| format!(", only {kind:?}"));
        let adjacent = if self.adjacent { ", adjacent" } else { "" };
        format!("{adjacent}{}", only.unwrap_or_default())
    }
}

impl Hit for Contact {
    fn columns<'h, 'py>(of: Columns<'h, 'py, Self>) -> PyResult<Columns<'h, 'py, Self>> {
        of.row(|hit| <[u32; 4]>::from(hit.pair))?
            .number(|hit| hit.kind as u8)
    }

    fn many(columns: Vec<Py<PyAny>>, py: Python<'_>) -> PyResult<Any<'_>> {
        class!(py, "Contacts").call1(PyTuple::new(py, columns)?)
    }

    fn one(self, py: Python<'_>) -> PyResult<Any<'_>> {
        let kind = class!(py, "ContactKind").call1((self.kind as u8,))?;
        class!(py, "Contact").call1((self.pair.one(py)?, kind))
    }
}

/// As contacts: the pair, and how it meets beyond what it shares.
impl Hit for AdjacentContact {
    fn columns<'h, 'py>(of: Columns<'h, 'py, Self>) -> PyResult<Columns<'h, 'py, Self>> {
        of.row(|hit| <[u32; 4]>::from(hit.pair))?
            .number(|hit| hit.kind as u8)
    }

    fn many(columns: Vec<Py<PyAny>>, py: Python<'_>) -> PyResult<Any<'_>> {
        Contact::many(columns, py)
    }

    fn one(self, py: Python<'_>) -> PyResult<Any<'_>> {
        let Self { pair, kind } = self;
        Contact { pair, kind }.one(py)
    }
}

query_class! {
    /// A question which triangles intersect and how, answered by all() or first().
    ///
    /// World.contacts makes it, and World.adjacent_intersections. Ask for all(), the first(), or
    /// visit_some(...). Each call asks anew, about the shapes that the bodies have then. A call
    /// raises the errors and exceptions of Query.
    ContactQuery of Contacts;

    /// All contacts, a Contacts of arrays, sorted by their numbers.
    ///
    /// Options, history and number of threads do not change it. at_most refuses a longer list with
    /// pliant.Error: TooManyHits, before it fills the memory. sort=False leaves job order, which is
    /// equal for any number of threads.
    ///
    /// Cost: that of Query.all. Pairs whose kind rounded signs leave open take their exact signs
    /// once more.
    all;

    /// Some contact, a Contact, or None if there is none.
    ///
    /// Much cheaper than all() where there are many. Options and history may change which one it
    /// is, never whether there is one.
    first;

    /// Calls visit(contacts) with a Contacts of some at a time, until it returns true.
    ///
    /// Returns whether it did. Every contact comes once, and no list of all is made. The order and
    /// the sizes are deterministic. visit may not ask this world; its exceptions pass through.
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
