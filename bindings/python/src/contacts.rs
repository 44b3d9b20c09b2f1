//! `ContactQuery` as Python sees it: which triangles intersect, and how, with numbers in arrays side by side.

use crate::arrays;
use crate::error::Refused;
use crate::query::{All, First, Prepare, Selection, SomeAtATime, Want, go_on, no_list, stopped};
use crate::signals::interruptible;
use crate::world::World;
use numpy::IntoPyArray;
use pliant::{Contact, ContactKind};
use pliant_check::with_world;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyType;

/// The numbers that Python has for them.
const KINDS: [ContactKind; 3] = [
    ContactKind::Touching,
    ContactKind::Overlapping,
    ContactKind::Crossing,
];

/// The one kind that is asked for.
pub(crate) struct Only(ContactKind);

impl<'py> FromPyObject<'_, 'py> for Only {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let number: usize = object.extract()?;
        let kind = KINDS.get(number).copied().map(Self);
        kind.ok_or_else(|| PyValueError::new_err(format!("{number} is no pliant.ContactKind")))
    }
}

/// The enumeration, and the named tuples of many and of one.
fn class(py: Python<'_>, place: usize) -> PyResult<&Bound<'_, PyType>> {
    const NAMES: [&str; 4] = ["ContactKind", "Contacts", "Contact", "Pair"];
    static CLASSES: [PyOnceLock<Py<PyType>>; 4] = [const { PyOnceLock::new() }; 4];
    CLASSES[place].import(py, "pliant._types", NAMES[place])
}

/// A Contact.
fn one(py: Python<'_>, contact: Contact) -> PyResult<Bound<'_, PyAny>> {
    let [body_a, a, body_b, b] = contact.pair.into();
    let pair = class(py, 3)?.call1((body_a, a, body_b, b))?;
    let kind = class(py, 0)?.call1((contact.kind as u8,))?;
    class(py, 2)?.call1((pair, kind))
}

/// A Contacts.
fn columns<'py>(py: Python<'py>, contacts: &[Contact]) -> PyResult<Bound<'py, PyAny>> {
    let pairs: Vec<[u32; 4]> = contacts.iter().map(|contact| contact.pair.into()).collect();
    let kinds: Vec<u8> = contacts.iter().map(|contact| contact.kind as u8).collect();
    class(py, 1)?.call1((arrays::rows_of(py, pairs)?, kinds.into_pyarray(py)))
}

/// A question which triangles intersect and how, that waits to be told how much is wanted: all(), the first(), or visit_some(...). Each call
/// asks anew, about the shapes that the bodies have then. A call raises pliant.Error as those of Query do.
#[pyclass(frozen, module = "pliant")]
pub(crate) struct ContactQuery {
    world: Py<World>,
    of: Selection,
    only: Option<ContactKind>,
}

impl ContactQuery {
    pub(crate) fn new(world: Py<World>, of: Selection, only: Option<Only>) -> Self {
        let only = only.map(|Only(kind)| kind);
        Self { world, of, only }
    }

    /// Asks the world, without the interpreter lock, for what is wanted.
    fn ask<T: Send>(
        &self,
        py: Python<'_>,
        want: impl Want<Contact, T> + Send,
    ) -> Result<T, Refused> {
        let (of, only) = (self.of.0, self.only);
        self.world.get().with(py, |state| {
            interruptible(|question| {
                with_world!(&mut state.world, world => {
                    let query = world.contacts(of);
                    let query = match only {
                        Some(kind) => query.only(kind),
                        None => query,
                    };
                    want.of(query.interrupt_if(question))
                })
            })
        })
    }
}

#[pymethods]
impl ContactQuery {
    fn __iter__(slf: &Bound<'_, Self>) -> PyResult<()> {
        Err(no_list(slf)?)
    }

    fn __len__(slf: &Bound<'_, Self>) -> PyResult<usize> {
        Err(no_list(slf)?)
    }

    /// All contacts, sorted, as a Contacts of arrays; the same for every option, history and number of threads.
    ///
    /// at_most refuses more than this with pliant.Error, kind "TooManyHits", instead of making arrays that may fill the memory.
    #[pyo3(signature = (*, at_most=None))]
    fn all<'py>(
        &self,
        py: Python<'py>,
        at_most: Option<usize>,
    ) -> Result<Bound<'py, PyAny>, Refused> {
        let contacts = self.ask(py, All(at_most.unwrap_or(usize::MAX)))?;
        Ok(columns(py, &contacts)?)
    }

    /// Some contact, or None if there is none: much cheaper than all where there are many. Which one may depend on options and history;
    /// whether there is one never does.
    fn first<'py>(&self, py: Python<'py>) -> Result<Option<Bound<'py, PyAny>>, Refused> {
        let contact = self.ask(py, First)?;
        Ok(contact.map(|contact| one(py, contact)).transpose()?)
    }

    /// Calls visit(contacts) with some contacts at a time, a Contacts, until it returns True (or anything true). Returns whether it did.
    /// Each comes once; no list of all is made. The order, and how many come at a time, is deterministic; visit may not ask this world.
    fn visit_some(&self, py: Python<'_>, visit: &Bound<'_, PyAny>) -> Result<bool, Refused> {
        let visit = visit.as_unbound();
        let visited = self.ask(
            py,
            SomeAtATime(|contacts: Vec<Contact>| {
                go_on(Python::attach(|py| {
                    visit
                        .bind(py)
                        .call1((columns(py, &contacts)?,))?
                        .is_truthy()
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
        let of = self.of.__repr__();
        match self.only {
            Some(kind) => format!("<pliant.ContactQuery of {of}, only {kind:?}>"),
            None => format!("<pliant.ContactQuery of {of}>"),
        }
    }
}
