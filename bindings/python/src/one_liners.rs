//! Questions that need no world to be made: two meshes, or one; and the same of the slow and obviously right reference.

use crate::answers::{Any, Rows};
use crate::arrays::{self, CopiedMesh};
use crate::error::{Refused, Result};
use crate::options::with_threads;
use crate::signals::interruptible;
use crate::state::{State, precision_of};
use pliant::{BodyId, Pair, Selection, reference};
use pliant_check::{double, with_world};
use pliant_io::Positions;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// Copies a mesh; what is refused is about its name.
fn read<'py>(positions: &Any<'py>, faces: &Any<'py>, name: &str) -> Result<CopiedMesh<'py>> {
    CopiedMesh::of(faces, positions, |refused| refused.about(name))
}

fn of_object<'py>(mesh: &Any<'py>, name: &str) -> Result<CopiedMesh<'py>> {
    let parts = arrays::parts_of_mesh(mesh).map_err(|refused| refused.about(name));
    let [faces, positions] = parts?;
    read(&positions, &faces, name)
}

/// Two meshes: two objects, or positions, faces, positions, faces.
fn two<'py>(given: &Bound<'py, PyTuple>) -> Result<[CopiedMesh<'py>; 2]> {
    match given.iter().collect::<Vec<_>>().as_slice() {
        [a, b] => Ok([of_object(a, "a")?, of_object(b, "b")?]),
        [va, fa, vb, fb] => Ok([read(va, fa, "a")?, read(vb, fb, "b")?]),
        _ => Err(wrong_number(
            "two meshes, or four arrays: vertices and faces of one, vertices and faces of the other",
        )),
    }
}

/// One mesh: an object, or positions and faces.
fn one<'py>(given: &Bound<'py, PyTuple>) -> Result<CopiedMesh<'py>> {
    match given.iter().collect::<Vec<_>>().as_slice() {
        [mesh] => of_object(mesh, "mesh"),
        [vertices, faces] => read(vertices, faces, "mesh"),
        _ => Err(wrong_number("a mesh, or two arrays: vertices and faces")),
    }
}

fn wrong_number(wanted: &str) -> Refused {
    Refused::Python(PyTypeError::new_err(format!("give {wanted}")))
}

/// Adds a mesh as a body; what is refused is about its name.
fn add(
    state: &mut State,
    (faces, positions): (&[[u32; 3]], Positions<'_>),
    name: &str,
) -> Result<BodyId> {
    let added = state.add(faces, positions);
    added.map_err(|refused| refused.about(name))
}

/// All hits, without their bodies, which are known.
fn triangles_of_all(state: &mut State, of: Selection) -> Result<Rows<u32, 2>> {
    interruptible(|question| {
        let query = with_world!(&mut state.world, world => world.intersections(of));
        let pairs = query.interrupt_if(question).all()?;
        Ok::<_, pliant::Error>(Rows(pairs.iter().map(Pair::triangles).collect()))
    })
}

/// intersection_pairs(va, fa, vb, fb, *, threads=1), or intersection_pairs(mesh_a, mesh_b, *, threads=1)
///
/// All intersecting pairs of two meshes, sorted: (k, 2) uint32, triangle of a, triangle of b. Decided as in a world; if one is
/// of float64, both are. threads: how many share the work.
#[pyfunction]
#[pyo3(signature = (*meshes, threads=1))]
pub(crate) fn intersection_pairs(
    py: Python<'_>,
    meshes: &Bound<'_, PyTuple>,
    threads: i64,
) -> Result<Rows<u32, 2>> {
    let options = with_threads(threads)?;
    let [a, b] = two(meshes)?;
    let (a, b) = (a.get()?, b.get()?);
    py.detach(|| {
        let mut state = State::new(options);
        state.fix_precision(precision_of(a.1).max(precision_of(b.1)));
        let a = add(&mut state, a, "a")?;
        let b = add(&mut state, b, "b")?;
        triangles_of_all(&mut state, Selection::Between(a, b))
    })
}

/// self_intersection_pairs(vertices, faces, *, threads=1), or self_intersection_pairs(mesh, *, threads=1)
///
/// All intersecting pairs of a mesh with itself, sorted: (k, 2) uint32, smaller triangle, larger triangle; triangles that
/// share a vertex are left out. threads: how many share the work.
#[pyfunction]
#[pyo3(signature = (*mesh, threads=1))]
pub(crate) fn self_intersection_pairs(
    py: Python<'_>,
    mesh: &Bound<'_, PyTuple>,
    threads: i64,
) -> Result<Rows<u32, 2>> {
    let options = with_threads(threads)?;
    let mesh = one(mesh)?;
    let mesh = mesh.get()?;
    py.detach(|| {
        let mut state = State::new(options);
        let body = add(&mut state, mesh, "mesh")?;
        triangles_of_all(&mut state, Selection::Within(body))
    })
}

/// intersection_pairs(va, fa, vb, fb), or intersection_pairs(mesh_a, mesh_b)
///
/// What pliant.intersection_pairs must give: every pair of triangles decided, no tree, no box, exact signs. Slow.
#[pyfunction]
#[pyo3(signature = (*meshes))]
pub(crate) fn reference_intersection_pairs(
    py: Python<'_>,
    meshes: &Bound<'_, PyTuple>,
) -> Result<Rows<u32, 2>> {
    let [a, b] = two(meshes)?;
    let ((faces_a, a), (faces_b, b)) = (a.get()?, b.get()?);
    let (wide_a, wide_b) = (&mut Vec::new(), &mut Vec::new());
    let pairs = py.detach(|| {
        let (a, b) = (double(a, wide_a), double(b, wide_b));
        reference::intersection_pairs(faces_a, a, faces_b, b)
    });
    Ok(Rows(pairs?))
}

/// self_intersection_pairs(vertices, faces), or self_intersection_pairs(mesh)
///
/// What pliant.self_intersection_pairs must give: every pair of triangles decided, no tree, no box, exact signs. Slow.
#[pyfunction]
#[pyo3(signature = (*mesh))]
pub(crate) fn reference_self_intersection_pairs(
    py: Python<'_>,
    mesh: &Bound<'_, PyTuple>,
) -> Result<Rows<u32, 2>> {
    let mesh = one(mesh)?;
    let (faces, positions) = mesh.get()?;
    let pairs =
        py.detach(|| reference::self_intersection_pairs(faces, double(positions, &mut Vec::new())));
    Ok(Rows(pairs?))
}
