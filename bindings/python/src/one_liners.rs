//! Intersections of two meshes, or of one with itself, in one call; and of `pliant.reference`.

use crate::answers::{Any, Rows};
use crate::arrays::{self, CopiedMesh};
use crate::error::{Refused, Result};
use crate::options::{Threads, with_threads};
use crate::signals::interruptible;
use crate::state::{State, precision_of};
use pliant::{BodyId, Pair, Selection, reference};
use pliant_check::{double, with_world};
use pliant_io::Positions;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// Copies a mesh; a refusal is about its name.
fn read<'py>(positions: &Any<'py>, faces: &Any<'py>, name: &str) -> Result<CopiedMesh<'py>> {
    CopiedMesh::of(faces, positions, |refused| refused.about(name))
}

/// Copies the arrays of a mesh object; a refusal is about its name.
fn of_object<'py>(mesh: &Any<'py>, name: &str) -> Result<CopiedMesh<'py>> {
    let parts = arrays::parts_of_mesh(mesh).map_err(|refused| refused.about(name));
    let [faces, positions] = parts?;
    read(&positions, &faces, name)
}

/// Copies two meshes: two objects, or positions, faces, positions, faces.
fn two<'py>(given: &Bound<'py, PyTuple>) -> Result<[CopiedMesh<'py>; 2]> {
    match given.iter().collect::<Vec<_>>().as_slice() {
        [a, b] => Ok([of_object(a, "a")?, of_object(b, "b")?]),
        [va, fa, vb, fb] => Ok([read(va, fa, "a")?, read(vb, fb, "b")?]),
        _ => Err(wrong_number(
            "two meshes, or four arrays: vertices and faces of one, vertices and faces of the \
             other",
        )),
    }
}

/// Copies one mesh: an object, or positions and faces.
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

/// Adds a mesh as a body; a refusal is about its name.
fn add(
    state: &mut State,
    (faces, positions): (&[[u32; 3]], Positions<'_>),
    name: &str,
) -> Result<BodyId> {
    let added = state.add(faces, positions);
    added.map_err(|refused| refused.about(name))
}

/// All hits without their bodies, which are known.
fn triangles_of_all(state: &mut State, of: Selection) -> Result<Rows<u32, 2>> {
    interruptible(|question| {
        let query = with_world!(&mut state.world, world => world.intersections(of));
        let pairs = query.interrupt_if(question).all()?;
        Ok::<_, pliant::Error>(Rows(pairs.iter().map(Pair::triangles).collect()))
    })
}

/// Intersecting triangles of two meshes, (k, 2) uint32, sorted: triangle of a, triangle of b.
///
///     intersection_pairs(vertices_a, faces_a, vertices_b, faces_b, *, threads=1)
///     intersection_pairs(mesh_a, mesh_b, *, threads=1)
///
/// Vertices are (n, 3) float32 or float64, faces (m, 3) of any integer type. A mesh object has
/// .vertices and .faces or .triangles. If one mesh is of float64, both are decided in it. Decided
/// exactly, as World.intersections does. threads is how many share the work, at most, or "all" for
/// one a core. It changes no answer.
///
/// Raises pliant.Error: the kinds of World.add, and BadOption for threads. TypeError for another
/// number of arguments.
///
/// Cost: building both trees, O(m log m); ask again and again with a World.
#[pyfunction]
#[pyo3(signature = (*meshes, threads=Threads::Count(1)), text_signature = "(*meshes, threads=1)")]
pub(crate) fn intersection_pairs(
    py: Python<'_>,
    meshes: &Bound<'_, PyTuple>,
    threads: Threads,
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

/// Self-intersections of a mesh, (k, 2) uint32, sorted: smaller triangle, larger triangle.
///
///     self_intersection_pairs(vertices, faces, *, threads=1)
///     self_intersection_pairs(mesh, *, threads=1)
///
/// Triangles that share a vertex are left out. Nothing is welded: weld seams first, or their sides
/// are reported. Arguments, errors and cost are as for pliant.intersection_pairs.
#[pyfunction]
#[pyo3(signature = (*mesh, threads=Threads::Count(1)), text_signature = "(*mesh, threads=1)")]
pub(crate) fn self_intersection_pairs(
    py: Python<'_>,
    mesh: &Bound<'_, PyTuple>,
    threads: Threads,
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

/// Intersecting triangles of two meshes by brute force, (k, 2) uint32, sorted.
///
///     intersection_pairs(vertices_a, faces_a, vertices_b, faces_b)
///     intersection_pairs(mesh_a, mesh_b)
///
/// pliant.intersection_pairs must give the same. No tree, no box, exact signs.
///
/// Raises pliant.Error: the kinds of World.add. Cost: O(m_a m_b).
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

/// Self-intersections of a mesh by brute force, (k, 2) uint32, sorted.
///
///     self_intersection_pairs(vertices, faces)
///     self_intersection_pairs(mesh)
///
/// pliant.self_intersection_pairs must give the same. No tree, no box, exact signs.
///
/// Raises pliant.Error: the kinds of World.add. Cost: O(m^2).
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
