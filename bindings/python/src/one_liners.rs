//! Questions that need no world to be made: two meshes, or one; and the same of the slow and obviously right reference.

use crate::arrays::{self, CopiedCoordinates, CopiedFaces};
use crate::error::Refused;
use crate::options::with_threads;
use crate::signals::interruptible;
use crate::state::{State, precision_of};
use numpy::PyArray2;
use pliant::{Pair, Selection, reference};
use pliant_check::{double, with_world};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// A copy of what was given for one mesh.
struct Mesh<'py> {
    positions: CopiedCoordinates<'py>,
    faces: CopiedFaces<'py>,
}

impl<'py> Mesh<'py> {
    fn read(
        positions: &Bound<'py, PyAny>,
        faces: &Bound<'py, PyAny>,
        name: &str,
    ) -> Result<Self, Refused> {
        let positions = CopiedCoordinates::of(positions).map_err(|refused| refused.about(name))?;
        let vertices = positions.get()?.len();
        let faces = CopiedFaces::of(faces, vertices).map_err(|refused| refused.about(name))?;
        Ok(Self { positions, faces })
    }

    fn of_object(mesh: &Bound<'py, PyAny>, name: &str) -> Result<Self, Refused> {
        let [faces, positions] =
            arrays::parts_of_mesh(mesh).map_err(|refused| refused.about(name))?;
        Self::read(&positions, &faces, name)
    }

    /// Two meshes: two objects, or positions, faces, positions, faces.
    fn two(given: &Bound<'py, PyTuple>) -> Result<[Self; 2], Refused> {
        let items: Vec<_> = given.iter().collect();
        match items.as_slice() {
            [a, b] => Ok([Self::of_object(a, "a")?, Self::of_object(b, "b")?]),
            [va, fa, vb, fb] => Ok([Self::read(va, fa, "a")?, Self::read(vb, fb, "b")?]),
            _ => Err(wrong_number(
                "two meshes, or four arrays: vertices and faces of one, vertices and faces of the other",
            )),
        }
    }

    /// One mesh: an object, or positions and faces.
    fn one(given: &Bound<'py, PyTuple>) -> Result<Self, Refused> {
        let items: Vec<_> = given.iter().collect();
        match items.as_slice() {
            [mesh] => Self::of_object(mesh, "mesh"),
            [vertices, faces] => Self::read(vertices, faces, "mesh"),
            _ => Err(wrong_number("a mesh, or two arrays: vertices and faces")),
        }
    }
}

fn wrong_number(wanted: &str) -> Refused {
    Refused::Python(PyTypeError::new_err(format!("give {wanted}")))
}

/// All hits, without their bodies, which are known.
fn triangles_of_all(state: &mut State, of: Selection) -> Result<Vec<[u32; 2]>, Refused> {
    interruptible(|question| {
        let query = with_world!(&mut state.world, world => world.intersections(of));
        let pairs = query.interrupt_if(question).all()?;
        Ok::<_, pliant::Error>(pairs.iter().map(Pair::triangles).collect())
    })
}

/// intersection_pairs(va, fa, vb, fb, *, threads=1), or intersection_pairs(mesh_a, mesh_b, *, threads=1)
///
/// All intersecting pairs of two meshes, sorted: (k, 2) uint32, triangle of a, triangle of b. Decided as in a world; if one is
/// of float64, both are. threads: how many share the work.
#[pyfunction]
#[pyo3(signature = (*meshes, threads=1))]
pub(crate) fn intersection_pairs<'py>(
    py: Python<'py>,
    meshes: &Bound<'py, PyTuple>,
    threads: i64,
) -> Result<Bound<'py, PyArray2<u32>>, Refused> {
    let options = with_threads(threads)?;
    let [a, b] = Mesh::two(meshes)?;
    let positions = [a.positions.get()?, b.positions.get()?];
    let faces = [a.faces.get()?, b.faces.get()?];
    let pairs = py.detach(|| {
        let mut state = State::new(options);
        let [a, b] = positions.map(precision_of);
        state.fix_precision(a.max(b));
        let a = state
            .add(faces[0], positions[0])
            .map_err(|refused| refused.about("a"))?;
        let b = state
            .add(faces[1], positions[1])
            .map_err(|refused| refused.about("b"))?;
        triangles_of_all(&mut state, Selection::Between(a, b))
    })?;
    Ok(arrays::rows_of(py, pairs)?)
}

/// self_intersection_pairs(vertices, faces, *, threads=1), or self_intersection_pairs(mesh, *, threads=1)
///
/// All intersecting pairs of a mesh with itself, sorted: (k, 2) uint32, smaller triangle, larger triangle; triangles that
/// share a vertex are left out. threads: how many share the work.
#[pyfunction]
#[pyo3(signature = (*mesh, threads=1))]
pub(crate) fn self_intersection_pairs<'py>(
    py: Python<'py>,
    mesh: &Bound<'py, PyTuple>,
    threads: i64,
) -> Result<Bound<'py, PyArray2<u32>>, Refused> {
    let options = with_threads(threads)?;
    let mesh = Mesh::one(mesh)?;
    let (positions, faces) = (mesh.positions.get()?, mesh.faces.get()?);
    let pairs = py.detach(|| {
        let mut state = State::new(options);
        let body = state
            .add(faces, positions)
            .map_err(|refused| refused.about("mesh"))?;
        triangles_of_all(&mut state, Selection::Within(body))
    })?;
    Ok(arrays::rows_of(py, pairs)?)
}

/// intersection_pairs(va, fa, vb, fb), or intersection_pairs(mesh_a, mesh_b)
///
/// What pliant.intersection_pairs must give: every pair of triangles decided, no tree, no box, exact signs. Slow.
#[pyfunction]
#[pyo3(signature = (*meshes))]
pub(crate) fn reference_intersection_pairs<'py>(
    py: Python<'py>,
    meshes: &Bound<'py, PyTuple>,
) -> Result<Bound<'py, PyArray2<u32>>, Refused> {
    let [a, b] = Mesh::two(meshes)?;
    let positions = [a.positions.get()?, b.positions.get()?];
    let faces = [a.faces.get()?, b.faces.get()?];
    let pairs = py.detach(|| {
        let mut wide = [Vec::new(), Vec::new()];
        let [wide_a, wide_b] = &mut wide;
        reference::intersection_pairs(
            faces[0],
            double(positions[0], wide_a),
            faces[1],
            double(positions[1], wide_b),
        )
    });
    Ok(arrays::rows_of(py, pairs.map_err(Refused::from)?)?)
}

/// self_intersection_pairs(vertices, faces), or self_intersection_pairs(mesh)
///
/// What pliant.self_intersection_pairs must give: every pair of triangles decided, no tree, no box, exact signs. Slow.
#[pyfunction]
#[pyo3(signature = (*mesh))]
pub(crate) fn reference_self_intersection_pairs<'py>(
    py: Python<'py>,
    mesh: &Bound<'py, PyTuple>,
) -> Result<Bound<'py, PyArray2<u32>>, Refused> {
    let mesh = Mesh::one(mesh)?;
    let (positions, faces) = (mesh.positions.get()?, mesh.faces.get()?);
    let pairs =
        py.detach(|| reference::self_intersection_pairs(faces, double(positions, &mut Vec::new())));
    Ok(arrays::rows_of(py, pairs.map_err(Refused::from)?)?)
}
