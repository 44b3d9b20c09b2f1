//! `Edit` of Python: changes of a body's mesh, made all at once or not at all.
//!
//! Their results, `Edited`, `Piece` and `Fused`, are named tuples of arrays.

use crate::answers::{Any, Column, class};
use crate::arrays::{self, CopiedCoordinates, CopiedFaces, Number, Triangle};
use crate::error::{Refused, Result, alone};
use crate::state::{State, of_body};
use pliant::{BodyId, Edited, Error, ErrorKind, Fused, Piece};
use pliant_check::{AnyWorld, double, single};
use pyo3::prelude::*;
use std::sync::Mutex;

/// Name and meaning of an array of triangle numbers, for messages.
const TRIANGLES: [&str; 2] = ["triangles", "which triangles they are"];

/// Edit of a world of either precision.
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

/// Adds a step to an edit, which no other call has meanwhile.
macro_rules! step {
    ($this:ident, $edit:ident => $step:expr) => {
        $this.with(|edit| Ok(with_edit!(edit, $edit => $step)))
    };
    // A step that takes positions, in the type of the world.
    ($this:ident, $edit:ident, $rows:ident of $positions:expr => $step:expr) => {
        $this.with(|edit| {
            let body = edit.body();
            let positions = $positions;
            Ok(match edit {
                AnyEdit::F32($edit) => {
                    let $rows = single(positions).map_err(|refused| of_body(body, refused))?;
                    $step
                }
                AnyEdit::F64($edit) => {
                    let mut widened = Vec::new();
                    let $rows = double(positions, &mut widened);
                    $step
                }
            })
        })
    };
}

impl AnyEdit {
    /// Begins an edit without steps, of a body of a world.
    pub(crate) fn of(state: &State, body: BodyId) -> Result<Self, Error> {
        Ok(match &state.world {
            AnyWorld::F32(world) => Self::F32(world.edit(body)?),
            AnyWorld::F64(world) => Self::F64(world.edit(body)?),
        })
    }

    /// Makes the changes in the world.
    pub(crate) fn apply(&self, state: &mut State) -> Result<Edited> {
        Ok(match (&mut state.world, self) {
            (AnyWorld::F32(world), Self::F32(edit)) => world.apply(edit)?,
            (AnyWorld::F64(world), Self::F64(edit)) => world.apply(edit)?,
            _ => {
                let (body, kind) = (Some(self.body()), ErrorKind::OutdatedEdit);
                return Err(Error { body, kind }.into());
            }
        })
    }

    fn body(&self) -> BodyId {
        with_edit!(self, edit => edit.body())
    }
}

/// Changes of one body's mesh, which World.apply makes all at once or not at all.
///
/// World.edit begins one without steps. Each step goes on from the mesh that the steps before it
/// leave. Steps are checked by World.apply; a step itself raises only for its arrays, with
/// pliant.Error: BadArray, Precision or VertexOutOfRange.
///
/// Numbers stay. A triangle or vertex that goes leaves its number empty. What comes is numbered
/// behind all others, so its numbers are known at once. A step may use an empty number again by
/// naming it.
///
/// A vertex that loses its last triangle goes at the end of the edit; one that never had any stays.
/// A vertex that is merged into another is empty at once, and a later step may place it again. An
/// edit is of the world that began it, and no copy of that world takes it.
///
///     edit = world.edit(body)
///     new = edit.split_vertex(0, [1])     # tears triangle 1 off vertex 0
///     edited = world.apply(edit)          # edited.new_vertices == [new]
///
/// Cost: O(1) a step, and the copy of its arrays.
#[pyclass(frozen, module = "pliant")]
pub(crate) struct Edit(Mutex<AnyEdit>);

impl Edit {
    pub(crate) fn new(edit: AnyEdit) -> Self {
        Self(Mutex::new(edit))
    }

    pub(crate) fn with<T>(&self, work: impl FnOnce(&mut AnyEdit) -> Result<T>) -> Result<T> {
        work(&mut *alone(&self.0)?)
    }

    /// Returns a function that says of a refusal which body it is about.
    fn of_body(&self) -> Result<impl Fn(Refused) -> Refused> {
        let body = self.with(|edit| Ok(edit.body()))?;
        Ok(move |refused: Refused| refused.of_body(Some(body)))
    }
}

#[pymethods]
impl Edit {
    /// Number of the body whose mesh it changes.
    fn body(&self) -> Result<u32> {
        self.with(|edit| Ok(edit.body().0))
    }

    /// Adds vertices at positions (k, 3); returns their numbers, (k,) uint32.
    ///
    /// Positions are float32 or float64, as World.add takes them. The vertices have group 0.
    ///
    /// Raises pliant.Error: BadArray, Precision.
    fn add_vertices(&self, positions: &Any<'_>) -> Result<Column<u32>> {
        let about = self.of_body()?;
        let copied = CopiedCoordinates::of(positions).map_err(about)?;
        let added = step!(self, edit, rows of copied.get()? => edit.add_vertices(rows))?;
        Ok(Column(added.collect()))
    }

    /// Uses an empty vertex number again, at a position (3,) of float32 or float64.
    ///
    /// Raises pliant.Error: BadArray, Precision. World.apply raises VertexInUse if it is not empty.
    fn place_vertex(&self, vertex: Number, position: &Any<'_>) -> Result<()> {
        let about = self.of_body()?;
        let copied = arrays::position(position).map_err(about)?;
        step!(self, edit, rows of copied.get()? => {
            if let Some(&position) = rows.first() {
                edit.place_vertex(vertex.0, position);
            }
        })
    }

    /// Adds a vertex in the place of another, for the given triangles; returns its number.
    ///
    /// triangles is (k,) of any integer type. They have the new vertex as a corner instead of the
    /// other. The new vertex has the group of the other.
    ///
    /// Raises pliant.Error: BadArray. World.apply raises NotACorner if a triangle does not have the
    /// vertex.
    fn split_vertex(&self, vertex: Number, triangles: &Any<'_>) -> Result<u32> {
        let triangles = arrays::numbers(triangles, TRIANGLES)?;
        step!(self, edit => edit.split_vertex(vertex.0, &triangles))
    }

    /// Replaces the vertex gone by the vertex kept in all triangles. kept stays where it is.
    fn merge_vertices(&self, kept: Number, gone: Number) -> Result<()> {
        step!(self, edit => edit.merge_vertices(kept.0, gone.0))
    }

    /// Adds triangles, faces (k, 3) of any integer type; returns their numbers, (k,) uint32.
    ///
    /// Corners are vertices that are there, or that an earlier step added.
    ///
    /// Raises pliant.Error: BadArray, VertexOutOfRange.
    fn add_triangles(&self, faces: &Any<'_>) -> Result<Column<u32>> {
        let vertices = step!(self, edit => edit.vertex_count())?;
        let about = self.of_body()?;
        let faces = CopiedFaces::of(faces, vertices).map_err(about)?;
        let faces = faces.get()?;
        let added = step!(self, edit => edit.add_triangles(faces))?;
        Ok(Column(added.collect()))
    }

    /// Gives a triangle other corners, three vertex numbers; an empty number is used again.
    fn set_triangle(&self, triangle: Number, corners: Triangle) -> Result<()> {
        step!(self, edit => edit.set_triangle(triangle.0, corners.0))
    }

    /// Removes triangles, (k,) of any integer type. Their numbers become empty.
    ///
    /// Raises pliant.Error: BadArray.
    fn remove_triangles(&self, triangles: &Any<'_>) -> Result<()> {
        let triangles = arrays::numbers(triangles, TRIANGLES)?;
        step!(self, edit => edit.remove_triangles(&triangles))
    }
}

/// Makes an `Edited` of Python.
pub(crate) fn edited(py: Python<'_>, edited: Edited) -> PyResult<Any<'_>> {
    class!(py, "Edited").call1((
        Column(edited.new_triangles),
        Column(edited.changed_triangles),
        Column(edited.removed_triangles),
        Column(edited.new_vertices),
        Column(edited.removed_vertices),
    ))
}

/// Makes a `Piece` of Python.
pub(crate) fn piece(py: Python<'_>, piece: Piece) -> PyResult<Any<'_>> {
    let numbers = (Column(piece.triangles), Column(piece.vertices));
    class!(py, "Piece").call1((piece.body.0, numbers.0, numbers.1))
}

/// Makes a `Fused` of Python.
pub(crate) fn fused(py: Python<'_>, fused: Fused) -> PyResult<Any<'_>> {
    class!(py, "Fused").call1((Column(fused.triangles), Column(fused.vertices)))
}
