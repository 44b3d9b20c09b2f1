//! State of a world as pickle writes it, and a world restored from it.
//!
//! Written are bodies by number, with shape, motion, filter, environment, vertex groups, rest
//! shape, labels, thickness and loose box, and the ignored pairs. Options are arguments of the
//! constructor that pickle calls. Trees are not written but built anew on the present shapes, which
//! changes no answer. Numbers of edges are written once somebody has asked for them, so they stay;
//! older pickles lack them. A state that is read is checked, for it is restored by the calls that a
//! caller would make.

use crate::answers::{Any, Owned, Rows};
use crate::arrays::{CopiedCoordinates, CopiedMesh};
use crate::error::{Refused, Result, caught, refused};
use crate::state::{Corners, State};
use numpy::{PyArray2, PyArrayMethods};
use pliant::{BodyId, Error, Labels};
use pliant_check::with_world;
use pliant_io::Precision;
use pyo3::prelude::*;

/// Labels of the faces, and pairs of neighbours.
type WrittenLabels = (Vec<u32>, Option<Vec<[u32; 2]>>);

/// A body, copied from a world without the interpreter lock.
#[derive(IntoPyObject)]
struct CopiedBody {
    body: u32,
    faces: Rows<u32, 3>,
    positions: Owned,
    end: Option<Owned>,
    groups: Vec<u32>,
    rest: Option<Owned>,
    labels: Option<WrittenLabels>,
    thickness: Vec<f64>,
    edges: Option<Rows<u32, 2>>,
    filter: (u32, u32),
    environment: u32,
    loose_box: Option<Corners>,
}

/// State of a world, without its options; it becomes a dictionary.
#[derive(IntoPyObject)]
pub(crate) struct Copied {
    dtype: Option<&'static str>,
    next: Option<u32>,
    bodies: Vec<CopiedBody>,
    ignored: Vec<(u32, u32)>,
}

/// State of a world, as pickle gives it back.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Written<'py> {
    dtype: Option<String>,
    next: Option<u32>,
    bodies: Vec<WrittenBody<'py>>,
    ignored: Vec<(u32, u32)>,
}

#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct WrittenBody<'py> {
    body: u32,
    faces: Bound<'py, PyAny>,
    positions: Bound<'py, PyAny>,
    end: Option<Any<'py>>,
    groups: Vec<u32>,
    #[pyo3(default)]
    rest: Option<Any<'py>>,
    #[pyo3(default)]
    labels: Option<WrittenLabels>,
    #[pyo3(default)]
    thickness: Vec<f64>,
    #[pyo3(default)]
    edges: Option<Bound<'py, PyArray2<u32>>>,
    filter: (u32, u32),
    #[pyo3(default)]
    environment: u32,
    loose_box: Option<Corners>,
}

impl Copied {
    pub(crate) fn of(state: &State) -> Result<Self> {
        let dtype = state.precision().map(|precision| match precision {
            Precision::F32 => "float32",
            Precision::F64 => "float64",
        });
        with_world!(&state.world, world => {
            let bodies = world.bodies().map(|id| {
                // Mostly all are 0, and then not written.
                let mut groups = world.vertex_groups(id)?;
                if groups.iter().all(|&group| group == 0) {
                    groups.clear();
                }
                let mut thickness = world.thickness(id)?;
                if thickness.iter().all(|&thickness| thickness == 0.0) {
                    thickness.clear();
                }
                let edges = world.numbered_edges(id)?;
                let labels = world.labels(id)?;
                Ok(CopiedBody {
                    body: id.0,
                    faces: Rows(world.triangles(id)?.to_vec()),
                    positions: Owned::from(world.positions(id)?),
                    end: world.end_positions(id)?.map(Owned::from),
                    groups,
                    rest: world.rest_positions(id)?.map(|rest| Owned::from(rest.to_vec())),
                    labels: labels.map(|it| {
                        (it.of_triangles.to_vec(), it.neighbours.map(<[_]>::to_vec))
                    }),
                    thickness,
                    edges: edges.map(|edges| Rows(edges.to_vec())),
                    filter: world.filter(id)?,
                    environment: world.environment(id)?,
                    loose_box: state.loose_box(id)?,
                })
            });
            Ok(Self {
                dtype,
                next: world.next_id(),
                bodies: bodies.collect::<Result<_, Error>>()?,
                ignored: world.ignored().into_iter().map(|[a, b]| (a.0, b.0)).collect(),
            })
        })
    }
}

impl Written<'_> {
    /// Restores a world that has had no body. If anything is refused, the world is of no use.
    pub(crate) fn restore(self, py: Python<'_>, state: &mut State) -> Result<()> {
        match self.dtype.as_deref() {
            None => {}
            Some("float32") => state.fix_precision(Precision::F32),
            Some("float64") => state.fix_precision(Precision::F64),
            Some(other) => return Err(bad(format!("{other:?} is no type of a world's"))),
        }
        for written in self.bodies {
            let mesh = CopiedMesh::of(&written.faces, &written.positions, |refused| refused)?;
            let (faces, positions) = mesh.get()?;
            let (state, number) = (&mut *state, written.body);
            let body = py.detach(|| {
                with_world!(&mut state.world, world => world.skip_ids(Some(number)));
                caught(|| state.add_with_empty(faces, positions))
            })?;
            if body.0 != number {
                let what = format!("body {number} does not come after those before it");
                return Err(bad(what));
            }
            if let Some(edges) = &written.edges {
                let numbers = edges.to_vec().map_err(PyErr::from)?;
                let (edges, _) = numbers.as_chunks();
                let numbered =
                    with_world!(&mut state.world, world => world.number_edges(body, edges)?);
                if !numbered {
                    return Err(bad(format!(
                        "the edges of body {number} are not those of its faces"
                    )));
                }
            }
            let (membership, mask) = written.filter;
            with_world!(&mut state.world, world => {
                world.set_filter(body, membership, mask)?;
                world.set_environment(body, written.environment)?;
            });
            state.set_loose_box(body, written.loose_box)?;
            if let Some(end) = &written.end {
                let end = CopiedCoordinates::of(end)?;
                state.set_motion(body, end.get()?)?;
            }
            if let Some(rest) = &written.rest {
                let rest = CopiedCoordinates::of(rest)?;
                state.set_rest_positions(body, rest.get()?)?;
            }
            if let Some((of_triangles, neighbours)) = &written.labels {
                let (of_triangles, neighbours) = (&of_triangles[..], neighbours.as_deref());
                let labels = Some(Labels {
                    of_triangles,
                    neighbours,
                });
                with_world!(&mut state.world, world => world.set_labels(body, labels)?);
            }
            if !written.thickness.is_empty() {
                let all = &written.thickness;
                with_world!(&mut state.world, world => world.set_vertex_thickness(body, all)?);
            }
            if !written.groups.is_empty() {
                let groups = &written.groups;
                with_world!(&mut state.world, world => world.set_vertex_groups(body, groups)?);
            }
        }
        with_world!(&mut state.world, world => {
            for (a, b) in self.ignored {
                world.ignore(BodyId(a), BodyId(b))?;
            }
            world.skip_ids(self.next);
        });
        Ok(())
    }
}

fn bad(what: impl std::fmt::Display) -> Refused {
    refused!(BadOption: "not a world that pickle wrote down: {what}")
}
