//! Answers as objects of Python: vectors that become arrays, and classes of `_types.py`.

use numpy::{Element, IntoPyArray, PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use std::convert::Infallible;

/// An object of Python, of any class.
pub(crate) type Any<'py> = Bound<'py, PyAny>;

/// A vector that becomes an array (n,), without a copy.
pub(crate) struct Column<T>(pub(crate) Vec<T>);

impl<'py, T: Element> IntoPyObject<'py> for Column<T> {
    type Target = PyArray1<T>;
    type Output = Bound<'py, Self::Target>;
    type Error = Infallible;

    fn into_pyobject(self, py: Python<'py>) -> Result<Self::Output, Infallible> {
        Ok(self.0.into_pyarray(py))
    }
}

/// A vector of rows, pairs or positions, that becomes an array (k, K), without a copy.
pub(crate) struct Rows<T, const K: usize>(pub(crate) Vec<[T; K]>);

impl<'py, T: Element, const K: usize> IntoPyObject<'py> for Rows<T, K> {
    type Target = PyArray2<T>;
    type Output = Bound<'py, Self::Target>;
    type Error = PyErr;

    fn into_pyobject(self, py: Python<'py>) -> PyResult<Self::Output> {
        let shape = [self.0.len(), K];
        self.0.into_flattened().into_pyarray(py).reshape(shape)
    }
}

/// Positions of either precision, that become an array (n, 3) of their type.
#[derive(IntoPyObject)]
pub(crate) enum Owned {
    F32(Rows<f32, 3>),
    F64(Rows<f64, 3>),
}

impl From<Vec<[f32; 3]>> for Owned {
    fn from(rows: Vec<[f32; 3]>) -> Self {
        Self::F32(Rows(rows))
    }
}

impl From<Vec<[f64; 3]>> for Owned {
    fn from(rows: Vec<[f64; 3]>) -> Self {
        Self::F64(Rows(rows))
    }
}

/// A count with its noun, in the singular or the plural.
pub(crate) fn counted(count: usize, [one, many]: [&str; 2]) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

/// A class of `_types.py`, looked up once, because visitors are shown many of its objects.
macro_rules! class {
    ($py:expr, $name:literal) => {{
        use pyo3::{Py, sync::PyOnceLock, types::PyType};
        static CLASS: PyOnceLock<Py<PyType>> = PyOnceLock::new();
        CLASS.import($py, "pliant._types", $name)?
    }};
}
pub(crate) use class;

/// An object of a class of `_types.py`, from fields of `$from`, or from fields one by one.
macro_rules! named {
    ($py:expr, $class:literal of $from:ident: $($field:ident),*) => {
        named!($py, $class: $($field = $from.$field),*)
    };
    ($py:expr, $class:literal: $($field:ident = $value:expr),*) => {{
        let fields = pyo3::types::PyDict::new($py);
        $(fields.set_item(stringify!($field), $value)?;)*
        $crate::answers::class!($py, $class).call((), Some(&fields))
    }};
}
pub(crate) use named;
