//! Copies of arrays, to which nobody else can write: what is checked is what is kept.
//!
//! An array of a caller's may be written to while it is read: by another thread of Python's, which runs while a call computes, or
//! by numpy, which lets go of the interpreter lock over large arrays. A number that is looked at twice, once to check it and once
//! to take it, may be another by then; and Rust may not be lent memory that changes at all. So numpy copies the numbers, each is
//! read once, and Rust is lent the copy. Which of the numbers that were there meanwhile it holds is not known, nor promised.

use crate::error::{Result, refused};
use numpy::{Element, PyArray2, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods, dtype};
use pyo3::prelude::*;
use pyo3::types::PySlice;

/// Rows of three numbers in an array that was never handed out.
pub(crate) struct Copied<'py, T: Element>(PyReadonlyArray2<'py, T>);

impl<T: Element> Copied<'_, T> {
    /// As Rust has them.
    pub(crate) fn rows(&self) -> Result<&[[T; 3]]> {
        let numbers = self.0.as_slice().map_err(PyErr::from)?;
        let (rows, _) = numbers.as_chunks();
        Ok(rows)
    }
}

/// Room for a copy, kept from call to call: as much as the largest so far.
pub(crate) struct Room<T>(Option<Py<PyArray2<T>>>);

impl<T> Default for Room<T> {
    fn default() -> Self {
        Self(None)
    }
}

impl<T: Element> Room<T> {
    /// How many bytes it is.
    pub(crate) fn held(&self, py: Python<'_>) -> usize {
        let room = self.0.as_ref();
        room.map_or(0, |room| room.bind(py).len() * size_of::<T>())
    }

    /// Copies an (n, 3) array here, over the copy before. What is of another type is converted: the caller knows that this
    /// changes no number.
    pub(crate) fn copy<'py, U: Element>(
        &mut self,
        given: &Bound<'py, PyArray2<U>>,
    ) -> Result<Copied<'py, T>> {
        let (py, rows) = (given.py(), given.shape()[0]);
        let room = match self.0.take().map(|room| room.into_bound(py)) {
            Some(room) if room.shape()[0] >= rows => room,
            // Before there is more, there is none.
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

/// An array (n, 3), not yet written; numpy raises if there is no memory for it.
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
