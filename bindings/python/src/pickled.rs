//! A world as Python's pickle writes it down, and what is read back: bodies with their numbers, in their shapes of now, with their motions,
//! filters, groups of vertices, ignored pairs and loose boxes. Options are arguments of what makes the new world.
//!
//! Trees are not written: they are built anew, on the shapes of now, which changes no answer. Numbers of edges are, where somebody has
//! asked for them: they stay. What is read is checked as if it was given to a world by calls, which it is. What was written before there
//! were numbers of edges is read, and its edges are numbered anew.

use crate::arrays::{CopiedCoordinates, CopiedFaces, rows_of};
use crate::error::{Refused, caught};
use crate::state::State;
use crate::world::Owned;
use numpy::{PyArray2, PyArrayMethods};
use pliant::{BodyId, Error};
use pliant_check::{AnyWorld, with_world};
use pliant_io::Precision;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

type Corners = ([f64; 3], [f64; 3]);

/// A body, copied from a world without the interpreter lock.
struct Body {
    id: u32,
    triangles: Vec<[u32; 3]>,
    positions: Owned,
    end: Option<Owned>,
    groups: Vec<u32>,
    edges: Option<Vec<[u32; 2]>>,
    filter: (u32, u32),
    loose: Option<Corners>,
}

/// All of a world but its options.
pub(crate) struct Copied {
    precision: Option<Precision>,
    next: Option<u32>,
    bodies: Vec<Body>,
    ignored: Vec<[BodyId; 2]>,
}

/// A world that was written down.
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
    end: Option<Bound<'py, PyAny>>,
    groups: Vec<u32>,
    #[pyo3(default)]
    edges: Option<Bound<'py, PyArray2<u32>>>,
    filter: (u32, u32),
    loose_box: Option<Corners>,
}

impl Copied {
    pub(crate) fn of(state: &State) -> Result<Self, Refused> {
        let bodies = with_world!(&state.world, world => {
            let bodies = world.bodies().map(|id| {
                Ok(Body {
                    id: id.0,
                    triangles: world.triangles(id)?.to_vec(),
                    positions: Owned::from(world.positions(id)?),
                    end: world.end_positions(id)?.map(Owned::from),
                    groups: world.vertex_groups(id)?,
                    edges: world.numbered_edges(id)?.map(<[_]>::to_vec),
                    filter: world.filter(id)?,
                    loose: loose_box(&state.world, id)?,
                })
            });
            bodies.collect::<Result<_, Error>>()?
        });
        Ok(Self {
            precision: state.precision(),
            next: with_world!(&state.world, world => world.next_id()),
            bodies,
            ignored: with_world!(&state.world, world => world.ignored()),
        })
    }

    /// As pickle takes it.
    pub(crate) fn into_dict(self, py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
        let bodies = PyList::empty(py);
        for body in self.bodies {
            let dict = PyDict::new(py);
            dict.set_item("body", body.id)?;
            dict.set_item("faces", rows_of(py, body.triangles)?)?;
            dict.set_item("positions", body.positions.into_array(py)?)?;
            let end = body.end.map(|end| end.into_array(py)).transpose()?;
            dict.set_item("end", end)?;
            // Mostly none: then it is not written at all.
            let groups = body.groups;
            let are_any = groups.iter().any(|&group| group != 0);
            dict.set_item("groups", if are_any { groups } else { Vec::new() })?;
            let edges = body.edges.map(|edges| rows_of(py, edges)).transpose()?;
            dict.set_item("edges", edges)?;
            dict.set_item("filter", body.filter)?;
            dict.set_item("loose_box", body.loose)?;
            bodies.append(dict)?;
        }
        let dtype = self.precision.map(|precision| match precision {
            Precision::F32 => "float32",
            Precision::F64 => "float64",
        });
        let ignored: Vec<_> = self.ignored.iter().map(|[a, b]| (a.0, b.0)).collect();
        let dict = PyDict::new(py);
        dict.set_item("dtype", dtype)?;
        dict.set_item("next", self.next)?;
        dict.set_item("bodies", bodies)?;
        dict.set_item("ignored", ignored)?;
        Ok(dict)
    }
}

impl Written<'_> {
    /// Makes this of a world that has had no body. If anything is refused, what it is then is of no use.
    pub(crate) fn restore(self, py: Python<'_>, state: &mut State) -> Result<(), Refused> {
        match self.dtype.as_deref() {
            None => {}
            Some("float32") => state.fix_precision(Precision::F32),
            Some("float64") => state.fix_precision(Precision::F64),
            Some(other) => return Err(bad(format!("{other:?} is no type of a world's"))),
        }
        for written in self.bodies {
            let positions = CopiedCoordinates::of(&written.positions)?;
            let positions = positions.get()?;
            let faces = CopiedFaces::of(&written.faces, positions.len())?;
            let faces = faces.get()?;
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
            with_world!(&mut state.world, world => world.set_filter(body, membership, mask)?);
            state.set_loose_box(body, written.loose_box)?;
            if let Some(end) = &written.end {
                let end = CopiedCoordinates::of(end)?;
                state.set_motion(body, end.get()?)?;
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

/// The box that holds a body in every pose, widened.
pub(crate) fn loose_box(world: &AnyWorld, body: BodyId) -> Result<Option<Corners>, Error> {
    Ok(match world {
        AnyWorld::F32(world) => {
            let wide = |corner: [f32; 3]| corner.map(f64::from);
            let corners = world.loose_box(body)?;
            corners.map(|(lo, hi)| (wide(lo), wide(hi)))
        }
        AnyWorld::F64(world) => world.loose_box(body)?,
    })
}

fn bad(what: impl std::fmt::Display) -> Refused {
    Refused::new(
        "BadOption",
        format!("not a world that pickle wrote down: {what}"),
    )
}
