//! Private copies of arrays, to which nobody else can write: what is checked is what is kept.
//!
//! A caller's array may be written to while it is read. Another thread of Python may run while a
//! call computes, and numpy releases the interpreter lock over large arrays. A number that is read
//! twice, to check it and to take it, may then differ; and Rust may not borrow memory that changes.
//! So numpy copies each number once, and Rust borrows the copy. It holds some state of each number
//! during the copy; which one is not promised.

use crate::error::{Result, refused};
use numpy::{Element, PyArray2, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods, dtype};
use pyo3::prelude::*;
use pyo3::types::PySlice;

/// Copy of rows of three numbers, in an array that was never handed out.
pub(crate) struct Copied<'py, T: Element>(PyReadonlyArray2<'py, T>);

impl<T: Element> Copied<'_, T> {
    /// The rows as a slice.
    pub(crate) fn rows(&self) -> Result<&[[T; 3]]> {
        let numbers = self.0.as_slice().map_err(PyErr::from)?;
        let (rows, _) = numbers.as_chunks();
        Ok(rows)
    }
}

/// Buffer for copies, kept from call to call, as large as the largest copy so far.
pub(crate) struct Room<T>(Option<Py<PyArray2<T>>>);

impl<T> Default for Room<T> {
    fn default() -> Self {
        Self(None)
    }
}

impl<T: Element> Room<T> {
    /// Bytes of the buffer.
    pub(crate) fn held(&self, py: Python<'_>) -> usize {
        let room = self.0.as_ref();
        room.map_or(0, |room| room.bind(py).len() * size_of::<T>())
    }

    /// Copies an (n, 3) array here, over the copy before.
    ///
    /// Another type is converted: the caller knows that this changes no number.
    pub(crate) fn copy<'py, U: Element>(
        &mut self,
        given: &Bound<'py, PyArray2<U>>,
    ) -> Result<Copied<'py, T>> {
        let (py, rows) = (given.py(), given.shape()[0]);
        let room = match self.0.take().map(|room| room.into_bound(py)) {
            Some(room) if room.shape()[0] >= rows => room,
            // Freed first, so that both are never there at once.
            too_small => {
                drop(too_small);
                new(py, rows)?
            }
        };
        let part = if room.shape()[0] == rows {
            room.clone()
        } else {
            let part = room.get_item(PySlice::new(py, 0, rows as isize, 1))?;
            part.cast_into().map_err(PyErr::from)?
        };
        self.0 = Some(room.unbind());
        fill(given, &part)
    }
}

/// Copies an (n, 3) array into a new one.
pub(crate) fn anew<'py, T: Element>(given: &Bound<'py, PyArray2<T>>) -> Result<Copied<'py, T>> {
    fill(given, &new(given.py(), given.shape()[0])?)
}

/// Allocates an array (n, 3); numpy raises if there is no memory for it.
fn new<T: Element>(py: Python<'_>, rows: usize) -> PyResult<Bound<'_, PyArray2<T>>> {
    let array = py
        .import("numpy")?
        .call_method1("empty", ((rows, 3), dtype::<T>(py)))?;
    Ok(array.cast_into()?)
}

/// Copies an array into one of our own.
fn fill<'py, T: Element, U: Element>(
    given: &Bound<'py, PyArray2<U>>,
    own: &Bound<'py, PyArray2<T>>,
) -> Result<Copied<'py, T>> {
    let _reading = given.try_readonly().map_err(|_| {
        refused!(BadArray:
            "another extension module is writing to the array; call again when it has ended")
    })?;
    given.copy_to(own)?;
    let copied = own.try_readonly().map_err(PyErr::from)?;
    Ok(Copied(copied))
}
