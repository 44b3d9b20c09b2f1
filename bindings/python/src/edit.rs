//! `Edit` as Python sees it: changes of a body's mesh, made all at once or not at all; and what they come to, as named tuples of arrays.

use crate::arrays::{self, CopiedCoordinates, CopiedFaces};
use crate::error::{Refused, alone};
use crate::state::{State, of_body};
use numpy::{IntoPyArray, PyArray1};
use pliant::{BodyId, Edited, Error, ErrorKind, Fused, Piece, Scalar};
use pliant_check::{AnyWorld, double, single};
use pliant_io::Positions;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyList, PyType};
use std::ops::Range;
use std::sync::Mutex;

/// What numbers of triangles are called.
const TRIANGLES: [&str; 2] = ["triangles", "which triangles they are"];

/// An edit of a world of either precision.
pub(crate) enum AnyEdit {
    F32(pliant::Edit<f32>),
    F64(pliant::Edit<f64>),
}

macro_rules! with_edit {
    ($edit:expr, $name:ident => $work:expr) => {
        match $edit {
            AnyEdit::F32($name) => $work,
            AnyEdit::F64($name) => $work,
        }
    };
}

impl AnyEdit {
    /// Of a body of a world, without steps.
    pub(crate) fn of(state: &State, body: BodyId) -> Result<Self, Error> {
        Ok(match &state.world {
            AnyWorld::F32(world) => Self::F32(world.edit(body)?),
            AnyWorld::F64(world) => Self::F64(world.edit(body)?),
        })
    }

    /// Makes the changes in the world.
    pub(crate) fn apply(&self, state: &mut State) -> Result<Edited, Refused> {
        Ok(match (&mut state.world, self) {
            (AnyWorld::F32(world), Self::F32(edit)) => world.apply(edit)?,
            (AnyWorld::F64(world), Self::F64(edit)) => world.apply(edit)?,
            _ => {
                let body = with_edit!(self, edit => edit.body());
                let kind = ErrorKind::OutdatedEdit;
                let body = Some(body);
                return Err(Error { body, kind }.into());
            }
        })
    }

    fn body(&self) -> BodyId {
        with_edit!(self, edit => edit.body())
    }

    /// Gives positions to a step that takes them in the type of the world.
    fn with_positions(
        &mut self,
        positions: Positions<'_>,
        step: impl Steps,
    ) -> Result<Range<u32>, Refused> {
        let body = self.body();
        match self {
            Self::F32(edit) => {
                let rows = single(positions).map_err(|not_taken| of_body(body, not_taken))?;
                Ok(step.take(edit, rows))
            }
            Self::F64(edit) => {
                let mut widened = Vec::new();
                Ok(step.take(edit, double(positions, &mut widened)))
            }
        }
    }
}

/// A step that takes positions.
trait Steps {
    fn take<S: Scalar>(self, edit: &mut pliant::Edit<S>, rows: &[[S; 3]]) -> Range<u32>;
}

/// Adds all as vertices.
struct AddVertices;

impl Steps for AddVertices {
    fn take<S: Scalar>(self, edit: &mut pliant::Edit<S>, rows: &[[S; 3]]) -> Range<u32> {
        edit.add_vertices(rows)
    }
}

/// Uses an empty number again, for a vertex at the first.
struct PlaceVertex(u32);

impl Steps for PlaceVertex {
    fn take<S: Scalar>(self, edit: &mut pliant::Edit<S>, rows: &[[S; 3]]) -> Range<u32> {
        if let Some(&position) = rows.first() {
            edit.place_vertex(self.0, position);
        }
        self.0..self.0
    }
}

/// Changes of one body's mesh, to be made all at once by World.apply, or not at all. World.edit gives one that has no steps yet.
///
/// Each step goes on from the mesh that the steps before it leave. Numbers stay: a triangle or a vertex that goes leaves its number empty,
/// and what comes is numbered behind all others, so that its numbers are known at once. An empty number is used again where a step names it.
/// A vertex that loses its last triangle by the edit goes at its end; one that never had any stays. One that is merged into another is
/// empty at once, and may be placed again by a later step. An edit is of the world that began it: no other makes its changes, not even a
/// copy.
///
///     edit = world.edit(body)
///     new = edit.split_vertex(0, [1])     # triangle 1 is torn off at vertex 0
///     world.apply(edit)
#[pyclass(frozen, module = "pliant")]
pub(crate) struct Edit {
    edit: Mutex<AnyEdit>,
}

impl Edit {
    pub(crate) fn new(edit: AnyEdit) -> Self {
        Self {
            edit: Mutex::new(edit),
        }
    }

    pub(crate) fn with<T>(
        &self,
        work: impl FnOnce(&mut AnyEdit) -> Result<T, Refused>,
    ) -> Result<T, Refused> {
        work(&mut *alone(&self.edit)?)
    }
}

#[pymethods]
impl Edit {
    /// The body whose mesh it is.
    fn body(&self) -> Result<u32, Refused> {
        self.with(|edit| Ok(edit.body().0))
    }

    /// Adds vertices, positions (n, 3) as World.add takes them. Returns their numbers, (n,) uint32.
    fn add_vertices<'py>(
        &self,
        py: Python<'py>,
        positions: &Bound<'py, PyAny>,
    ) -> Result<Bound<'py, PyArray1<u32>>, Refused> {
        let body = self.with(|edit| Ok(edit.body()))?;
        let copied = CopiedCoordinates::of(positions).map_err(|it| it.of_body(Some(body)))?;
        let numbers = self.with(|edit| edit.with_positions(copied.get()?, AddVertices))?;
        Ok(numbers.collect::<Vec<u32>>().into_pyarray(py))
    }

    /// Uses an empty number of a vertex again, for one at a position, (3,).
    fn place_vertex(&self, vertex: u32, position: &Bound<'_, PyAny>) -> Result<(), Refused> {
        let body = self.with(|edit| Ok(edit.body()))?;
        let one = PyList::new(position.py(), [position])?;
        let copied = CopiedCoordinates::of(one.as_any()).map_err(|it| it.of_body(Some(body)))?;
        self.with(|edit| edit.with_positions(copied.get()?, PlaceVertex(vertex)))
            .map(drop)
    }

    /// Adds a vertex in the place where another is, which these triangles, (k,), have for a corner from now on instead of the other.
    /// Returns its number. It has the group of the other.
    fn split_vertex(&self, vertex: u32, triangles: &Bound<'_, PyAny>) -> Result<u32, Refused> {
        let triangles = arrays::numbers(triangles, TRIANGLES)?;
        self.with(|edit| Ok(with_edit!(edit, edit => edit.split_vertex(vertex, &triangles))))
    }

    /// All triangles that have the vertex gone have kept instead from now on, which stays where it is; gone goes.
    fn merge_vertices(&self, kept: u32, gone: u32) -> Result<(), Refused> {
        self.with(|edit| {
            with_edit!(edit, edit => edit.merge_vertices(kept, gone));
            Ok(())
        })
    }

    /// Adds triangles, faces (m, 3) as World.add takes them, of vertices that are there or were added before. Returns their numbers,
    /// (m,) uint32.
    fn add_triangles<'py>(
        &self,
        py: Python<'py>,
        faces: &Bound<'py, PyAny>,
    ) -> Result<Bound<'py, PyArray1<u32>>, Refused> {
        let vertices = self.with(|edit| Ok(with_edit!(edit, edit => edit.vertex_count())))?;
        let body = self.with(|edit| Ok(edit.body()))?;
        let faces = CopiedFaces::of(faces, vertices).map_err(|it| it.of_body(Some(body)))?;
        let faces = faces.get()?;
        let numbers = self.with(|edit| Ok(with_edit!(edit, edit => edit.add_triangles(faces))))?;
        Ok(numbers.collect::<Vec<u32>>().into_pyarray(py))
    }

    /// Gives a triangle other corners, (3,), or uses an empty number again.
    fn set_triangle(&self, triangle: u32, corners: [u32; 3]) -> Result<(), Refused> {
        self.with(|edit| {
            with_edit!(edit, edit => edit.set_triangle(triangle, corners));
            Ok(())
        })
    }

    /// Takes triangles, (k,), out.
    fn remove_triangles(&self, triangles: &Bound<'_, PyAny>) -> Result<(), Refused> {
        let triangles = arrays::numbers(triangles, TRIANGLES)?;
        self.with(|edit| {
            with_edit!(edit, edit => edit.remove_triangles(&triangles));
            Ok(())
        })
    }
}

/// Named tuples of arrays.
fn class(py: Python<'_>, place: usize) -> PyResult<&Bound<'_, PyType>> {
    const NAMES: [&str; 3] = ["Edited", "Piece", "Fused"];
    static CLASSES: [PyOnceLock<Py<PyType>>; 3] = [const { PyOnceLock::new() }; 3];
    CLASSES[place].import(py, "pliant._types", NAMES[place])
}

/// An Edited.
pub(crate) fn edited(py: Python<'_>, edited: Edited) -> PyResult<Bound<'_, PyAny>> {
    class(py, 0)?.call1((
        edited.new_triangles.into_pyarray(py),
        edited.changed_triangles.into_pyarray(py),
        edited.removed_triangles.into_pyarray(py),
        edited.new_vertices.into_pyarray(py),
        edited.removed_vertices.into_pyarray(py),
    ))
}

/// A Piece.
pub(crate) fn piece(py: Python<'_>, piece: Piece) -> PyResult<Bound<'_, PyAny>> {
    let (triangles, vertices) = (piece.triangles, piece.vertices);
    let arrays = (triangles.into_pyarray(py), vertices.into_pyarray(py));
    class(py, 1)?.call1((piece.body.0, arrays.0, arrays.1))
}

/// A Fused.
pub(crate) fn fused(py: Python<'_>, fused: Fused) -> PyResult<Bound<'_, PyAny>> {
    let (triangles, vertices) = (fused.triangles, fused.vertices);
    class(py, 2)?.call1((triangles.into_pyarray(py), vertices.into_pyarray(py)))
}
