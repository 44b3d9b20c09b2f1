//! `ContactQuery`: which triangles intersect, and how, with numbers in arrays side by side.

use crate::answers::{Any, Column, Rows, class};
use crate::error::Result;
use crate::queries::{Hit, Kind, Want, Wanted, query_class};
use pliant::{Contact, ContactKind, Scalar};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// The numbers that Python has for them.
const KINDS: [ContactKind; 3] = [
    ContactKind::Touching,
    ContactKind::Overlapping,
    ContactKind::Crossing,
];

/// The one kind that is asked for.
#[derive(Clone, Copy)]
pub(crate) struct Only(ContactKind);

impl<'py> FromPyObject<'_, 'py> for Only {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let number: usize = object.extract()?;
        let kind = KINDS.get(number).copied().map(Self);
        kind.ok_or_else(|| PyValueError::new_err(format!("{number} is no pliant.ContactKind")))
    }
}

/// Triangles that intersect, perhaps only those of one kind.
#[derive(Clone, Copy)]
pub(crate) struct Contacts {
    pub(crate) only: Option<Only>,
}

impl Kind for Contacts {
    fn ask<'w, W: Want>(
        self,
        world: &'w mut pliant::World<impl Scalar>,
        of: pliant::Selection,
        wanted: Wanted<'w, W>,
    ) -> Result<W::Answer> {
        let query = world.contacts(of);
        wanted.of(match self.only {
            Some(Only(kind)) => query.only(kind),
            None => query,
        })
    }

    fn said(self) -> String {
        let only = self.only.map(|Only(kind)| format!(", only {kind:?}"));
        only.unwrap_or_default()
    }
}

impl Hit for Contact {
    type Columns = (Vec<[u32; 4]>, Vec<u8>);

    fn columns(hits: &[Self]) -> Self::Columns {
        let row = |hit: &Self| (<[u32; 4]>::from(hit.pair), hit.kind as u8);
        hits.iter().map(row).collect()
    }

    fn many((pairs, kinds): Self::Columns, py: Python<'_>) -> PyResult<Any<'_>> {
        class!(py, "Contacts").call1((Rows(pairs), Column(kinds)))
    }

    fn one(self, py: Python<'_>) -> PyResult<Any<'_>> {
        let kind = class!(py, "ContactKind").call1((self.kind as u8,))?;
        class!(py, "Contact").call1((self.pair.one(py)?, kind))
    }
}

query_class! {
    /// A question which triangles intersect and how, that waits to be told how much is wanted: all(), the first(), or visit_some(...). Each call
    /// asks anew, about the shapes that the bodies have then. A call raises pliant.Error as those of Query do.
    ContactQuery of Contacts;

    /// All contacts, sorted, as a Contacts of arrays; the same for every option, history and number of threads.
    ///
    /// at_most refuses more than this with pliant.Error, kind "TooManyHits", instead of making arrays that may fill the memory.
    all;

    /// Some contact, or None if there is none: much cheaper than all where there are many. Which one may depend on options and history;
    /// whether there is one never does.
    first;

    /// Calls visit(contacts) with some contacts at a time, a Contacts, until it returns True (or anything true). Returns whether it did.
    /// Each comes once; no list of all is made. The order, and how many come at a time, is deterministic; visit may not ask this world.
    visit_some;

    /// Does early what the query would do first, and asks nothing; see Query.prepare.
    prepare;
}
