//! numpy arrays read where they lie, and made.
//!
//! A C-contiguous, aligned (n, 3) array of float32 or float64, and an (m, 3) array of uint32, are read in place. Other integers
//! are converted to uint32 and checked on the way; other layouts and byte orders are copied once, by numpy. No value is ever
//! changed: what would have to be rounded is refused.

use crate::error::{Fact, Refused};
use numpy::{
    Element, IntoPyArray, PyArray2, PyArrayDescrMethods, PyArrayMethods, PyReadonlyArray2,
    PyUntypedArray, PyUntypedArrayMethods, dtype,
};
use pliant_io::Positions;
use pyo3::intern;
use pyo3::prelude::*;

/// Positions of a caller's.
pub(crate) enum Coordinates<'py> {
    F32(PyReadonlyArray2<'py, f32>),
    F64(PyReadonlyArray2<'py, f64>),
}

/// Triangles of a caller's.
pub(crate) enum Faces<'py> {
    AsGiven(PyReadonlyArray2<'py, u32>),
    Converted(Vec<[u32; 3]>),
}

impl<'py> Coordinates<'py> {
    /// Reads an (n, 3) array of float32 or float64, or what numpy makes one of.
    pub(crate) fn read(given: &Bound<'py, PyAny>) -> Result<Self, Refused> {
        let array = as_array(given, "positions", "n")?;
        let dtype = array.dtype();
        match (dtype.kind(), dtype.itemsize()) {
            (b'f', 4) => in_place(&array).map(Self::F32),
            (b'f', 8) => in_place(&array).map(Self::F64),
            (kind, _) => {
                let hint = if matches!(kind, b'i' | b'u') {
                    "; or were faces and positions exchanged?"
                } else {
                    ""
                };
                Err(Refused::new(
                    "BadArray",
                    format!(
                        "positions are of type {dtype}; they must be float32 or float64: use \
                         positions.astype(numpy.float64){hint}"
                    ),
                ))
            }
        }
    }

    /// As the Rust libraries have them.
    pub(crate) fn get(&self) -> Result<Positions<'_>, Refused> {
        Ok(match self {
            Self::F32(array) => Positions::F32(rows(array)?),
            Self::F64(array) => Positions::F64(rows(array)?),
        })
    }
}

impl<'py> Faces<'py> {
    /// Reads an (m, 3) array of integers, or what numpy makes one of, the corners of triangles over `vertices` vertices.
    pub(crate) fn read(given: &Bound<'py, PyAny>, vertices: usize) -> Result<Self, Refused> {
        let array = as_array(given, "faces", "m")?;
        let dtype = array.dtype();
        let converted = match (dtype.kind(), dtype.itemsize()) {
            (b'u', 4) => return in_place(&array).map(Self::AsGiven),
            (b'u', 1) => convert::<u8>(&array, vertices),
            (b'u', 2) => convert::<u16>(&array, vertices),
            (b'u', 8) => convert::<u64>(&array, vertices),
            (b'i', 1) => convert::<i8>(&array, vertices),
            (b'i', 2) => convert::<i16>(&array, vertices),
            (b'i', 4) => convert::<i32>(&array, vertices),
            (b'i', 8) => convert::<i64>(&array, vertices),
            _ => Err(Refused::new(
                "BadArray",
                format!(
                    "faces are of type {dtype}; they must be integers, the numbers of their vertices; were faces and \
                     positions exchanged?"
                ),
            )),
        };
        converted.map(Self::Converted)
    }

    /// As the Rust library has them.
    pub(crate) fn get(&self) -> Result<&[[u32; 3]], Refused> {
        match self {
            Self::AsGiven(array) => rows(array),
            Self::Converted(triangles) => Ok(triangles),
        }
    }
}

/// The faces and vertices of a mesh object: trimesh has `faces`, Open3D `triangles`, both `vertices`.
///
/// `faces` first: what trimesh calls `triangles` are coordinates.
pub(crate) fn parts_of_mesh<'py>(
    mesh: &Bound<'py, PyAny>,
) -> Result<[Bound<'py, PyAny>; 2], Refused> {
    let py = mesh.py();
    let faces = match mesh.getattr_opt(intern!(py, "faces"))? {
        None => mesh.getattr_opt(intern!(py, "triangles"))?,
        faces => faces,
    };
    match (faces, mesh.getattr_opt(intern!(py, "vertices"))?) {
        (Some(faces), Some(vertices)) => Ok([faces, vertices]),
        _ => Err(Refused::new(
            "BadArray",
            format!(
                "{} has no .faces (or .triangles) and .vertices; give a mesh that has, or the arrays themselves",
                mesh.get_type()
            ),
        )),
    }
}

/// Three numbers, rounded to 64-bit ones.
pub(crate) fn point(given: &Bound<'_, PyAny>) -> PyResult<[f64; 3]> {
    given.extract()
}

/// Rows, pairs or positions, as a new (k, K) array, which takes the vector over.
pub(crate) fn rows_of<T: Element, const K: usize>(
    py: Python<'_>,
    rows: Vec<[T; K]>,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    let count = rows.len();
    rows.into_flattened().into_pyarray(py).reshape([count, K])
}

/// An array of rows of three.
fn as_array<'py>(
    given: &Bound<'py, PyAny>,
    what: &str,
    rows: &str,
) -> Result<Bound<'py, PyUntypedArray>, Refused> {
    let array = match given.cast::<PyUntypedArray>() {
        Ok(array) => array.clone(),
        Err(_) => given
            .py()
            .import("numpy")?
            .call_method1("asarray", (given,))?
            .cast_into()
            .map_err(PyErr::from)?,
    };
    if array.ndim() == 2 && array.shape()[1] == 3 {
        return Ok(array);
    }
    let shape = array.getattr("shape")?;
    let hint = match array.shape() {
        [_, _, 3] => ": give one frame at a time",
        [3, _] => ": transposed?",
        [_, 4] if rows == "m" => ": cut each quad into two triangles",
        _ => "",
    };
    Err(Refused::new(
        "BadArray",
        format!("{what} have shape {shape}; it must be ({rows}, 3){hint}"),
    ))
}

/// The array itself where it can be read in place, else one copy.
fn in_place<'py, T: Element>(
    array: &Bound<'py, PyUntypedArray>,
) -> Result<PyReadonlyArray2<'py, T>, Refused> {
    let readable = array.is_c_contiguous() && array.is_aligned();
    let array = match array.cast::<PyArray2<T>>() {
        Ok(array) if readable => array.clone(),
        _ => {
            let py = array.py();
            py.import("numpy")?
                .call_method1("require", (array, dtype::<T>(py), ["C", "ALIGNED"]))?
                .cast_into()
                .map_err(PyErr::from)?
        }
    };
    array.try_readonly().map_err(|_| {
        Refused::new(
            "BadArray",
            "another extension module is writing to the array; call again when it has ended",
        )
    })
}

/// The rows of an array that `in_place` made.
fn rows<'a, T: Element>(array: &'a PyReadonlyArray2<'_, T>) -> Result<&'a [[T; 3]], Refused> {
    let numbers = array.as_slice().map_err(PyErr::from)?;
    let (rows, _) = numbers.as_chunks();
    Ok(rows)
}

/// Integers of another type, as 32-bit ones; the first that cannot be a vertex is refused as the library would.
fn convert<T: Element + Copy + Into<i128>>(
    array: &Bound<'_, PyUntypedArray>,
    vertices: usize,
) -> Result<Vec<[u32; 3]>, Refused> {
    let array = in_place::<T>(array)?;
    let mut triangles = Vec::with_capacity(array.len() / 3);
    for (triangle, corners) in rows(&array)?.iter().enumerate() {
        let mut converted = [0; 3];
        for (corner, &vertex) in converted.iter_mut().zip(corners) {
            *corner = u32::try_from(vertex.into()).map_err(|_| {
                let vertex: i128 = vertex.into();
                Refused::new(
                    "VertexOutOfRange",
                    format!(
                        "triangle {triangle} names vertex {vertex}, but there are {vertices} vertices (counted from 0)"
                    ),
                )
                .with("triangle", triangle)
                .with("vertex", Fact::Number(vertex))
                .with("vertices", vertices)
            })?;
        }
        triangles.push(converted);
    }
    Ok(triangles)
}
