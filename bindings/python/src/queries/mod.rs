//! Queries that wait to be told how much is wanted: the part that all kinds share.
//!
//! A kind is a file here, with a [`Kind`] that asks a world, and a [`Hit`] for each type of hit.
//! [`query_class`] makes its class, because pyo3 has no generic classes. A new kind also needs its
//! `mod` below, its class in `lib.rs`, and the methods of `World` that ask it.

use crate::answers::{Any, Column, class};
use crate::columns::{Columns, Resources};
use crate::error::Result;
use crate::selection::Selection;
use crate::signals::interruptible;
use crate::state::{Shared, State};
use pliant::{BodyId, HitRows, Scalar};
use pliant_check::{AnyWorld, with_world};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::IntoPyDict;
use std::ops::ControlFlow;

pub(crate) mod close;
pub(crate) mod contacts;
pub(crate) mod frames;
pub(crate) mod impacts;
pub(crate) mod pairs;

/// Hit of the library, and the objects of Python that one and many become.
pub(crate) trait Hit: pliant::InRows + Send + Sync + 'static {
    /// Says which columns hits have.
    fn columns<'h, 'py>(of: Columns<'h, 'py, Self>) -> PyResult<Columns<'h, 'py, Self>>;

    /// Makes what Python sees of many hits, of their columns.
    fn many(columns: Vec<Py<PyAny>>, py: Python<'_>) -> PyResult<Any<'_>>;

    /// Makes a named tuple of one hit.
    fn one(self, py: Python<'_>) -> PyResult<Any<'_>>;
}

/// Kind of query, with its arguments besides the selection.
pub(crate) trait Kind: Copy + Send + Sync {
    /// Asks a world. The hits of a kind may be of several types.
    fn ask<'w, W: Want>(
        self,
        world: &'w mut pliant::World<impl Scalar>,
        of: pliant::Selection,
        wanted: Wanted<'w, W>,
    ) -> Result<W::Answer>;

    /// Text of `repr` behind the selection.
    fn said(self) -> String;
}

/// Copies hits into arrays, with at most `threads`.
pub(crate) fn copied<H: Hit>(
    py: Python<'_>,
    hits: &[H],
    threads: usize,
) -> PyResult<Vec<Py<PyAny>>> {
    H::columns(Columns::new(py, hits, threads))?.filled()
}

/// How much is wanted of a query, for hits of any type.
pub(crate) trait Want: Send {
    type Answer: Send;

    fn of<H: Hit>(
        self,
        query: pliant::Query<'_, H>,
        resources: Resources<'_>,
    ) -> Result<Self::Answer>;
}

/// How much is wanted, and the question that may end the search early.
pub(crate) struct Wanted<'w, W> {
    want: W,
    question: &'w (dyn Fn() -> bool + Sync),
    resources: Resources<'w>,
}

impl<'w, W: Want> Wanted<'w, W> {
    /// Answers a query with as much as is wanted.
    pub(crate) fn of<H: Hit>(self, query: pliant::Query<'w, H>) -> Result<W::Answer> {
        self.want
            .of(query.interrupt_if(self.question), self.resources)
    }
}

/// Object of Python that is made when the world is free again.
pub(crate) type Made = Box<dyn FnOnce(Python<'_>) -> PyResult<Any<'_>> + Send>;

/// All hits, up to a limit, sorted or in job order.
pub(crate) struct All {
    pub(crate) most: usize,
    pub(crate) sort: bool,
}

impl Want for All {
    type Answer = Made;

    fn of<H: Hit>(self, query: pliant::Query<'_, H>, resources: Resources<'_>) -> Result<Made> {
        let query = query.at_most(self.most);
        let hits = if self.sort {
            query.all()?
        } else {
            let list = resources.kept.list();
            query.unsorted(list)?;
            list
        };
        let columns = Python::attach(|py| copied(py, hits, resources.threads))?;
        Ok(Box::new(move |py| H::many(columns, py)))
    }
}

/// All hits, up to a limit, with rows of their first elements.
pub(crate) struct InRows(pub(crate) usize);

/// Hits that wait for the world, which knows how many rows there are.
type Rowed = Box<dyn FnOnce(&AnyWorld, Resources<'_>) -> Result<Made> + Send>;

impl Want for InRows {
    type Answer = Rowed;

    fn of<H: Hit>(self, query: pliant::Query<'_, H>, resources: Resources<'_>) -> Result<Rowed> {
        // Taken, since another thread of Python may ask before the rows are made.
        let mut hits = std::mem::take(resources.kept.list::<H>());
        query.at_most(self.0).unsorted(&mut hits)?;
        Ok(Box::new(move |world, resources| {
            let mut rows = HitRows::new();
            let starts: Vec<(u32, usize)> = with_world!(world, world => {
                rows.update(world, &hits)?;
                let start = |body: BodyId| Some((body.0, rows.start(body)?));
                world.bodies().filter_map(start).collect()
            });
            let columns = Python::attach(|py| copied(py, &hits, resources.threads))?;
            *resources.kept.list() = hits;
            Ok(Box::new(move |py| {
                let offsets = Column(rows.offsets().to_vec());
                let places = Column(rows.places().to_vec());
                let hits = H::many(columns, py)?;
                class!(py, "HitRows").call1((hits, offsets, places, starts.into_py_dict(py)?))
            }))
        }))
    }
}

/// The first hit.
pub(crate) struct First;

impl Want for First {
    type Answer = Option<Made>;

    fn of<H: Hit>(self, query: pliant::Query<'_, H>, _: Resources<'_>) -> Result<Option<Made>> {
        let hit = query.first()?;
        Ok(hit.map(|hit| -> Made { Box::new(move |py| hit.one(py)) }))
    }
}

/// The first phases of the query alone.
pub(crate) struct Prepare;

impl Want for Prepare {
    type Answer = ();

    fn of<H: Hit>(self, query: pliant::Query<'_, H>, _: Resources<'_>) -> Result<()> {
        Ok(query.prepare()?)
    }
}

/// Visitor of Python that is shown one hit after the other.
pub(crate) struct Each<'a>(pub(crate) &'a Py<PyAny>);

impl Want for Each<'_> {
    type Answer = bool;

    fn of<H: Hit>(self, query: pliant::Query<'_, H>, _: Resources<'_>) -> Result<bool> {
        stopped(query.visit(|hit| show(self.0, |py| hit.one(py)))?)
    }
}

/// Visitor of Python that is shown some hits at a time.
pub(crate) struct SomeAtATime<'a>(pub(crate) &'a Py<PyAny>);

impl Want for SomeAtATime<'_> {
    type Answer = bool;

    fn of<H: Hit>(self, query: pliant::Query<'_, H>, _: Resources<'_>) -> Result<bool> {
        stopped(query.visit_some(|hits| show(self.0, |py| H::many(copied(py, hits, 1)?, py)))?)
    }
}

/// Whether a visitor has ended a visit, or the exception that it raised.
type Stopped = ControlFlow<PyResult<()>>;

/// Calls a visitor, under the interpreter lock.
fn show(visit: &Py<PyAny>, shown: impl FnOnce(Python<'_>) -> PyResult<Any<'_>>) -> Stopped {
    let answer = Python::attach(|py| visit.bind(py).call1((shown(py)?,))?.is_truthy());
    match answer {
        Ok(false) => ControlFlow::Continue(()),
        Ok(true) => ControlFlow::Break(Ok(())),
        Err(raised) => ControlFlow::Break(Err(raised)),
    }
}

fn stopped(visited: Stopped) -> Result<bool> {
    match visited {
        ControlFlow::Continue(()) => Ok(false),
        ControlFlow::Break(stopped) => Ok(stopped.map(|()| true)?),
    }
}

/// A question of some kind to a world.
pub(crate) struct Question<K> {
    pub(crate) world: Shared,
    pub(crate) of: Selection,
    pub(crate) kind: K,
}

/// Asks a world a question for what is wanted.
pub(crate) fn answer<W: Want>(
    state: &mut State,
    question: &(dyn Fn() -> bool + Sync),
    (kind, of): (impl Kind, pliant::Selection),
    want: W,
) -> Result<W::Answer> {
    let (world, resources) = state.lend();
    let wanted = Wanted {
        want,
        question,
        resources,
    };
    with_world!(world, world => kind.ask(world, of, wanted))
}

impl<K: Kind> Question<K> {
    /// Asks the world, without the interpreter lock, for what is wanted.
    pub(crate) fn ask<W: Want>(&self, py: Python<'_>, want: W) -> Result<W::Answer> {
        let (kind, of) = (self.kind, self.of.0);
        self.world.with(py, |state| {
            interruptible(|question| answer(state, question, (kind, of), want))
        })
    }
}

/// Exception for a query that is iterated, or whose length is asked for.
pub(crate) fn no_list(question: &Any<'_>) -> PyResult<PyErr> {
    let class = question.get_type().fully_qualified_name()?;
    Ok(PyTypeError::new_err(format!(
        "a {class} is a question that was not answered yet: ask it for all(), first() or \
         visit_some(...)"
    )))
}

/// Makes the class of a kind: its documentation, and that of its methods, and methods that only
/// this kind has.
macro_rules! query_class {
    (
        $(#[$class:meta])*
        $name:ident of $kind:ident;
        $(#[$all:meta])*
        all;
        $(#[$first:meta])*
        first;
        $(#[$visit_some:meta])*
        visit_some;
        $(#[$prepare:meta])*
        prepare;
        $($more:tt)*
    ) => {
        $(#[$class])*
        #[pyclass(frozen, module = "pliant")]
        pub(crate) struct $name($crate::queries::Question<$kind>);

        impl $name {
            pub(crate) fn new(
                world: &$crate::state::Shared,
                of: $crate::selection::Selection,
                kind: $kind,
            ) -> Self {
                let world = world.clone();
                Self($crate::queries::Question { world, of, kind })
            }
        }

        #[pymethods]
        impl $name {
            fn __iter__(slf: &Bound<'_, Self>) -> PyResult<()> {
                Err($crate::queries::no_list(slf)?)
            }

            fn __len__(slf: &Bound<'_, Self>) -> PyResult<usize> {
                Err($crate::queries::no_list(slf)?)
            }

            $(#[$all])*
            #[pyo3(signature = (*, at_most=None, sort=true))]
            fn all<'py>(
                &self,
                py: Python<'py>,
                at_most: Option<usize>,
                sort: bool,
            ) -> Result<Any<'py>> {
                let most = at_most.unwrap_or(usize::MAX);
                Ok(self.0.ask(py, $crate::queries::All { most, sort })?(py)?)
            }

            /// All hits in compressed rows (CSR), a HitRows: a row for each first element.
            ///
            /// Hits are in job order, as with all(sort=False). at_most refuses a longer list.
            ///
            /// Cost: that of all(sort=False), and O(hits + rows).
            #[pyo3(signature = (*, at_most=None))]
            fn rows<'py>(&self, py: Python<'py>, at_most: Option<usize>) -> Result<Any<'py>> {
                let most = at_most.unwrap_or(usize::MAX);
                let rowed = self.0.ask(py, $crate::queries::InRows(most))?;
                let rowed = self.0.world.with(py, |state| {
                    let (world, resources) = state.lend();
                    rowed(world, resources)
                });
                Ok(rowed?(py)?)
            }

            $(#[$first])*
            fn first<'py>(&self, py: Python<'py>) -> Result<Option<Any<'py>>> {
                let hit = self.0.ask(py, $crate::queries::First)?;
                Ok(hit.map(|hit| hit(py)).transpose()?)
            }

            $(#[$visit_some])*
            fn visit_some(&self, visit: &Any<'_>) -> Result<bool> {
                let visitor = $crate::queries::SomeAtATime(visit.as_unbound());
                self.0.ask(visit.py(), visitor)
            }

            $(#[$prepare])*
            fn prepare(&self, py: Python<'_>) -> Result<()> {
                self.0.ask(py, $crate::queries::Prepare)
            }

            fn __repr__(&self) -> String {
                let (of, said) = (self.0.of.__repr__(), self.0.kind.said());
                format!(concat!("<pliant.", stringify!($name), " of {}{}>"), of, said)
            }

            $($more)*
        }
    };
}
pub(crate) use query_class;
