//! `World` as Python sees it: the Rust library's, method by method.

use crate::arrays::{self, Coordinates, CopiedCoordinates, CopiedFaces};
use crate::close::{Close, CloseKind, CloseQuery};
use crate::contacts::{ContactQuery, Only};
use crate::edit::{self, AnyEdit, Edit};
use crate::error::{Refused, alone, alone_with, named_tuple};
use crate::impacts::{Impact, ImpactKind, ImpactQuery};
use crate::options::Keywords;
use crate::pickled::{self, Written};
use crate::query::{Kind, Query, Selection};
use crate::signals::interruptible;
use crate::state::State;
use numpy::{IntoPyArray, PyArray1, PyArray2};
use pliant::{BodyId, ErrorKind, InContact};
use pliant_check::with_world;
use pliant_io::Precision;
use pyo3::exceptions::PyOverflowError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::sync::Mutex;

/// Bodies that change their shape, and the questions which of their triangles intersect.
///
/// The first body fixes the precision, float32 or float64. Moving a body is `set_positions`; there is nothing else to call:
/// every query refits what is stale of what it touches, and none can answer for old positions. A call that is refused raises
/// `pliant.Error` and leaves the world as it was.
///
/// No option changes an answer; the defaults measured best. The paper's trees are partition="centre", leaf_size=1.
///
///   degree      the most children of a node: 2, 4 or 8
///   partition   how triangles are divided into a tree: at the "centre" of a node's box, at the "mean" of the triangles'
///               midpoints, into parts of equal size ("balanced"), or along the mesh ("connectivity")
///   leaf_size   the most triangles in a leaf
///   update      which boxes are made when: "bottom-up", "top-down" or "hybrid"
///   level       the level down to which the hybrid works bottom-up; None: half the depth of the tree
///   broad       how bodies that may meet are found: "brute", "sweep", or by their number ("auto")
///   threads     how many share the work of a query; no number changes an answer
///   mending     whether a tree that has decayed so far that a fresh one would have paid is built anew, a part of the work whenever
///               the body has a new shape
///
/// The interpreter lock is released while a call computes. Arrays are copied before: whoever writes to one while a call is given it
/// may see some of what was written in the shape, but never what was not checked. A world is in use by one call at a time; a second
/// is refused.
#[pyclass(frozen, module = "pliant")]
pub(crate) struct World {
    state: Mutex<State>,
    keywords: Keywords,
}

/// A body: its number. A number that no body can have is no body of any world.
#[derive(Clone, Copy)]
pub(crate) struct Body(pub(crate) BodyId);

impl<'py> FromPyObject<'_, 'py> for Body {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        match given.extract() {
            Ok(number) => Ok(Self(BodyId(number))),
            Err(error) if error.is_instance_of::<PyOverflowError>(given.py()) => {
                let kind = ErrorKind::NoSuchBody;
                let message = format!("body {}: {kind}", given.str()?);
                Err(Refused::new("NoSuchBody", message).into())
            }
            Err(error) => Err(error),
        }
    }
}

/// Positions on their way to numpy.
pub(crate) enum Owned {
    F32(Vec<[f32; 3]>),
    F64(Vec<[f64; 3]>),
}

impl From<Vec<[f32; 3]>> for Owned {
    fn from(rows: Vec<[f32; 3]>) -> Self {
        Self::F32(rows)
    }
}

impl From<Vec<[f64; 3]>> for Owned {
    fn from(rows: Vec<[f64; 3]>) -> Self {
        Self::F64(rows)
    }
}

impl Owned {
    pub(crate) fn into_array(self, py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
        Ok(match self {
            Self::F32(rows) => arrays::rows_of(py, rows)?.into_any(),
            Self::F64(rows) => arrays::rows_of(py, rows)?.into_any(),
        })
    }
}

impl World {
    /// Does `work` on the world, without the interpreter lock.
    pub(crate) fn with<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut State) -> Result<T, Refused> + Send,
    ) -> Result<T, Refused> {
        alone_with(py, &self.state, work)
    }
}

#[pymethods]
impl World {
    #[new]
    #[expect(clippy::too_many_arguments, reason = "they are keywords")]
    #[pyo3(signature = (*, degree=8, partition="balanced", leaf_size=8, update="hybrid", level=None, broad="auto", threads=1, mending=false))]
    fn new(
        degree: i64,
        partition: &str,
        leaf_size: i64,
        update: &str,
        level: Option<i64>,
        broad: &str,
        threads: i64,
        mending: bool,
    ) -> Result<Self, Refused> {
        let keywords = Keywords {
            degree,
            partition: partition.to_owned(),
            leaf_size,
            update: update.to_owned(),
            level,
            broad: broad.to_owned(),
            threads,
            mending,
        };
        let state = State::new(keywords.to_options()?);
        Ok(Self {
            state: Mutex::new(state),
            keywords,
        })
    }

    /// The same bodies under the same numbers, in their shapes of now, with filters, ignored pairs, loose boxes and options. Boxes are
    /// made anew; what is done to the one world is nothing to the other.
    fn __copy__(&self, py: Python<'_>) -> Result<Self, Refused> {
        let state = self.with(py, |state| Ok(state.another()))?;
        Ok(Self {
            state: Mutex::new(state),
            keywords: self.keywords.clone(),
        })
    }

    /// As copy: a world holds nothing that it could share.
    fn __deepcopy__(&self, py: Python<'_>, _memo: &Bound<'_, PyAny>) -> Result<Self, Refused> {
        self.__copy__(py)
    }

    /// For pickle, which then needs nothing of copyreg: what makes a world with these options, and what it is to become.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let py = slf.py();
        let this = slf.get();
        let options = this.keywords.to_dict(py)?;
        let partial = py.import("functools")?.getattr("partial")?;
        let make = partial.call((slf.get_type(),), Some(&options))?;
        let state = this.with(py, |state| pickled::Copied::of(state))?;
        PyTuple::new(
            py,
            [
                make,
                PyTuple::empty(py).into_any(),
                state.into_dict(py)?.into_any(),
            ],
        )
    }

    /// What pickle wrote down becomes of a world that never had a body. Bodies keep their numbers, and those that were used are not
    /// used again. Trees are built on the shapes of then.
    fn __setstate__(&self, py: Python<'_>, written: Written<'_>) -> Result<(), Refused> {
        let mut restored = State::new(self.keywords.to_options()?);
        written.restore(py, &mut restored)?;
        self.with(py, |state| {
            if state.precision().is_some() {
                let message = "this world has had bodies; what pickle wrote down becomes a new one";
                return Err(Refused::new("BadOption", message));
            }
            *state = restored;
            Ok(())
        })
    }

    /// The options of this world, as the keyword arguments that make another like it.
    fn options<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.keywords.to_dict(py)
    }

    /// The type of all positions, float32 or float64; None as long as there was no body.
    #[getter]
    fn dtype<'py>(
        &self,
        py: Python<'py>,
    ) -> Result<Option<Bound<'py, numpy::PyArrayDescr>>, Refused> {
        let precision = self.with(py, |state| Ok(state.precision()))?;
        Ok(precision.map(|precision| match precision {
            Precision::F32 => numpy::dtype::<f32>(py),
            Precision::F64 => numpy::dtype::<f64>(py),
        }))
    }

    /// Adds a body: faces (m, 3) of any integer type, and positions (n, 3) of float32 or float64; or one mesh object that has
    /// .faces (or .triangles, as in Open3D) and .vertices. Returns its number, which this world will not use again.
    ///
    /// Builds its tree on these positions, which need not be special; a rest pose is best. Corners may repeat: a degenerate
    /// triangle is the segment or point that it is. Nothing is welded.
    #[pyo3(signature = (faces, positions=None))]
    fn add(
        &self,
        py: Python<'_>,
        faces: &Bound<'_, PyAny>,
        positions: Option<&Bound<'_, PyAny>>,
    ) -> Result<u32, Refused> {
        let [faces, positions] = match positions {
            Some(positions) => [faces.clone(), positions.clone()],
            None => arrays::parts_of_mesh(faces)?,
        };
        let of_new = |refused: Refused| refused.of_body(None);
        let positions = CopiedCoordinates::of(&positions).map_err(of_new)?;
        let positions = positions.get()?;
        let faces = CopiedFaces::of(&faces, positions.len()).map_err(of_new)?;
        let faces = faces.get()?;
        self.with(py, |state| {
            Ok(state.add(faces, positions).map_err(of_new)?.0)
        })
    }

    /// Gives a body another mesh and its shape, of any size: faces (m, 3) and positions (n, 3), or one mesh object, as add takes them.
    /// Number, filter, ignored pairs and loose box stay; triangles and vertices are numbered as these are, and none is empty.
    ///
    /// What is equal by number stays, what differs is edited, which costs as apply does. Where more than an eighth of the triangles differ,
    /// or vertices are fewer than before, all is made anew, which costs as much as add: edges have other numbers then. A mesh that is not
    /// that which the body has ends a motion, and takes the vertices their groups.
    #[pyo3(signature = (body, faces, positions=None))]
    fn set_mesh(
        &self,
        py: Python<'_>,
        body: Body,
        faces: &Bound<'_, PyAny>,
        positions: Option<&Bound<'_, PyAny>>,
    ) -> Result<(), Refused> {
        let body = body.0;
        let of_body = |refused: Refused| refused.of_body(Some(body));
        let [faces, positions] = match positions {
            Some(positions) => [faces.clone(), positions.clone()],
            None => arrays::parts_of_mesh(faces)?,
        };
        let positions = CopiedCoordinates::of(&positions).map_err(of_body)?;
        let positions = positions.get()?;
        let faces = CopiedFaces::of(&faces, positions.len()).map_err(of_body)?;
        let faces = faces.get()?;
        self.with(py, |state| state.set_mesh(body, faces, positions))
    }

    /// Begins an edit of a body's mesh: changes that apply makes all at once, or not at all.
    fn edit(&self, py: Python<'_>, body: Body) -> Result<Edit, Refused> {
        let edit = self.with(py, |state| Ok(AnyEdit::of(state, body.0)?))?;
        Ok(Edit::new(edit))
    }

    /// Makes the changes of an edit, and says by number what has changed, as an Edited of arrays. Triangles and vertices that it does not
    /// name keep their numbers, edges their numbers if they stay.
    ///
    /// A number that is left empty is 0xFFFFFFFF three times in triangles, and nothing in any answer. Positions keep one row for every
    /// number; rows of empty vertices are not looked at when they are set, and NaN when they are asked for. Filter, ignored pairs and loose
    /// box stay; a new vertex has group 0, or that of the vertex that it was split from; a motion ends if anything changes.
    ///
    /// Costs by what the edit names and the triangles at the vertices of that, whatever the size of the mesh; but O(m) for the first edit
    /// of a body, and when a sixteenth of the triangles were changed since, for the tree is then built anew.
    fn apply<'py>(&self, py: Python<'py>, edit: &Edit) -> Result<Bound<'py, PyAny>, Refused> {
        let edited = edit.with(|edit| self.with(py, |state| edit.apply(state)))?;
        Ok(edit::edited(py, edited)?)
    }

    /// For each number whether it is that of a triangle, (m,) bool: False where an edit has left it empty.
    fn live_triangles<'py>(
        &self,
        py: Python<'py>,
        body: Body,
    ) -> Result<Bound<'py, PyArray1<bool>>, Refused> {
        let live = self.with(
            py,
            |state| with_world!(&state.world, world => Ok(world.live_triangles(body.0)?)),
        )?;
        Ok(live.into_pyarray(py))
    }

    /// For each number whether it is that of a vertex, (n,) bool: False where an edit has left it empty.
    fn live_vertices<'py>(
        &self,
        py: Python<'py>,
        body: Body,
    ) -> Result<Bound<'py, PyArray1<bool>>, Refused> {
        let live = self.with(
            py,
            |state| with_world!(&state.world, world => Ok(world.live_vertices(body.0)?)),
        )?;
        Ok(live.into_pyarray(py))
    }

    /// Counts the meshes of a body, and the orders that its trees bring them into: whoever keeps what vertex_order, edges or triangles says
    /// asks for them again when this is another.
    fn mesh_revision(&self, py: Python<'_>, body: Body) -> Result<u64, Refused> {
        self.with(
            py,
            |state| with_world!(&state.world, world => Ok(world.mesh_revision(body.0)?)),
        )
    }

    /// For each triangle of a body its component, (m,) uint32: two are in one if they share a vertex, or hang together through others that
    /// do. Numbered from 0 in the order of their first triangles; an empty number has 0xFFFFFFFF.
    fn components<'py>(
        &self,
        py: Python<'py>,
        body: Body,
    ) -> Result<Bound<'py, PyArray1<u32>>, Refused> {
        let components = self.with(
            py,
            |state| with_world!(&state.world, world => Ok(world.components(body.0)?)),
        )?;
        Ok(components.into_pyarray(py))
    }

    /// Makes a body of each component, but of the largest, which stays what it is with all its numbers: that with the most triangles, of
    /// several the first. Returns a list of Piece in the order of their first triangles; it is empty if all hangs together.
    ///
    /// What they have from the body: filter, loose box, vertex groups, and whom it ignores; if it ignores itself, the pieces ignore each
    /// other and it. A motion of the body ends. Vertices that no triangle uses stay with it.
    fn split<'py>(&self, py: Python<'py>, body: Body) -> Result<Vec<Bound<'py, PyAny>>, Refused> {
        let pieces = self.with(
            py,
            |state| with_world!(&mut state.world, world => Ok(world.split(body.0)?)),
        )?;
        let pieces = pieces.into_iter().map(|piece| edit::piece(py, piece));
        Ok(pieces.collect::<PyResult<_>>()?)
    }

    /// Puts the triangles and vertices of body b behind those of a, and removes b. Returns a Fused: which numbers they have now.
    ///
    /// Body a keeps its numbers, its filter and whom it ignores; vertices keep their groups. The loose box is then one around both if both
    /// had one, else there is none. Motions of either end. Nothing is welded: see weld.
    fn fuse<'py>(&self, py: Python<'py>, a: Body, b: Body) -> Result<Bound<'py, PyAny>, Refused> {
        let fused = self.with(
            py,
            |state| with_world!(&mut state.world, world => Ok(world.fuse(a.0, b.0)?)),
        )?;
        Ok(edit::fused(py, fused)?)
    }

    /// Makes boundary edges one where they coincide: where the ends of one are, one by one, at most a tolerance from those of another,
    /// decided exactly. Of vertices that become one the lowest stays where it is, the others go. A boundary edge is one that exactly one triangle has. Returns
    /// an Edited.
    ///
    /// Vertices that coincide are not welded where no edges do, and never two corners of one triangle.
    fn weld<'py>(
        &self,
        py: Python<'py>,
        body: Body,
        tolerance: f64,
    ) -> Result<Bound<'py, PyAny>, Refused> {
        let edited = self.with(py, |state| {
            interruptible(|question| {
                with_world!(&mut state.world, world => {
                    world.interruptible(question).weld(body.0, tolerance)
                })
            })
        })?;
        Ok(edit::edited(py, edited)?)
    }

    /// Removes a body. Its number will not be used again.
    fn remove(&self, py: Python<'_>, body: Body) -> Result<(), Refused> {
        self.with(
            py,
            |state| with_world!(&mut state.world, world => Ok(world.remove(body.0)?)),
        )
    }

    /// The bodies of this world, in the order in which they were added.
    fn bodies(&self, py: Python<'_>) -> Result<Vec<u32>, Refused> {
        self.with(py, |state| {
            Ok(with_world!(&state.world, world => world.bodies().map(|body| body.0).collect()))
        })
    }

    /// Gives a body a new shape: one position for each of its vertices, (n, 3), in the order in which it was added.
    ///
    /// The positions are copied once, whatever their layout, into memory that the world keeps for it; float32 is widened in a float64
    /// world on the way. The copy is checked, and taken over only if all are good.
    fn set_positions(
        &self,
        py: Python<'_>,
        body: Body,
        positions: &Bound<'_, PyAny>,
    ) -> Result<(), Refused> {
        let body = body.0;
        let positions =
            Coordinates::read(positions).map_err(|refused| refused.of_body(Some(body)))?;
        let mut state = alone(&self.state)?;
        let copied = state.copy(body, &positions)?;
        let (state, copied) = (&mut *state, copied.get()?);
        py.detach(|| state.set_positions(body, copied))
    }

    /// Like set_positions, but write(positions) fills an array (n, 3) of the world's type, which comes filled with NaN: every
    /// vertex must be written, or the shape is refused. Until write returns the world is in use. Where speed matters, reuse an array of your own and set_positions:
    /// unlike in Rust, this form costs copies more.
    fn write_positions(
        &self,
        py: Python<'_>,
        body: Body,
        write: &Bound<'_, PyAny>,
    ) -> Result<(), Refused> {
        let body = body.0;
        // Until it is written, so that what is written is for the body that was asked about.
        let mut state = alone(&self.state)?;
        let vertices = with_world!(&state.world, world => world.vertex_count(body))?;
        let dtype = match state.world.precision() {
            Precision::F32 => numpy::dtype::<f32>(py),
            Precision::F64 => numpy::dtype::<f64>(py),
        };
        let array = py
            .import("numpy")?
            .call_method1("full", ((vertices, 3), f64::NAN, dtype))?;
        write.call1((&array,))?;
        // Whoever wrote may have kept the array, and write again.
        let written = CopiedCoordinates::of(&array)?;
        let (state, written) = (&mut *state, written.get()?);
        py.detach(|| state.write_positions(body, written))
    }

    /// Begins a motion: says where the vertices of a body will be at the end of the step, (n, 3). On the way they move on straight lines,
    /// from the shape that the body has now. Queries for candidates look at the whole way; intersections are of the shape of now, as
    /// ever. A body without a motion stands still.
    ///
    /// The positions are checked as those of set_positions are. A motion takes the place of the one before, and ends with finish_motion,
    /// advance_motion, the next new shape or mesh.
    fn set_motion(
        &self,
        py: Python<'_>,
        body: Body,
        end: &Bound<'_, PyAny>,
    ) -> Result<(), Refused> {
        let body = body.0;
        let end = Coordinates::read(end).map_err(|refused| refused.of_body(Some(body)))?;
        let mut state = alone(&self.state)?;
        let copied = state.copy(body, &end)?;
        let (state, copied) = (&mut *state, copied.get()?);
        py.detach(|| state.set_motion(body, copied))
    }

    /// Ends all motions: every body that has one gets the shape at its end, without a copy. The others stand still.
    fn finish_motion(&self, py: Python<'_>) -> Result<(), Refused> {
        self.with(py, |state| {
            with_world!(&mut state.world, world => world.finish_motion());
            Ok(())
        })
    }

    /// Ends all motions on the way: every body that has one gets the shape in which it is at time t, from 0 (where it is) to 1 (the end).
    /// Each coordinate is x0 + t (x1 - x0), computed in float64, each operation rounded, kept between x0 and x1, and rounded to the
    /// world's type; at 1 it is x1.
    fn advance_motion(&self, py: Python<'_>, t: f64) -> Result<(), Refused> {
        self.with(
            py,
            |state| with_world!(&mut state.world, world => Ok(world.advance_motion(t)?)),
        )
    }

    /// The shape that a body will have at the end of its motion, a new array (n, 3) of the world's type; None if it has none.
    fn end_positions<'py>(
        &self,
        py: Python<'py>,
        body: Body,
    ) -> Result<Option<Bound<'py, PyAny>>, Refused> {
        let end = self.with(py, |state| {
            Ok(with_world!(&state.world, world => world.end_positions(body.0)?.map(Owned::from)))
        })?;
        Ok(end.map(|end| end.into_array(py)).transpose()?)
    }

    /// Gives every vertex of a body a group, (n,) of integers from 0 to 2^32 - 1: candidates are left out if all their vertices are of one
    /// group, in whichever bodies they are. Those of group 0, as all are at first, meet all. For vertices that are pinned, or glued
    /// together. They stay with the body until it is given another mesh.
    fn set_vertex_groups(
        &self,
        py: Python<'_>,
        body: Body,
        groups: &Bound<'_, PyAny>,
    ) -> Result<(), Refused> {
        let groups = arrays::numbers(groups, ["groups", "one for each vertex"])
            .map_err(|refused| refused.of_body(Some(body.0)))?;
        self.with(
            py,
            |state| with_world!(&mut state.world, world => Ok(world.set_vertex_groups(body.0, &groups)?)),
        )
    }

    /// The group of every vertex of a body: a new array (n,) uint32.
    fn vertex_groups<'py>(
        &self,
        py: Python<'py>,
        body: Body,
    ) -> Result<Bound<'py, PyArray1<u32>>, Refused> {
        let groups = self.with(
            py,
            |state| with_world!(&state.world, world => Ok(world.vertex_groups(body.0)?)),
        )?;
        Ok(groups.into_pyarray(py))
    }

    /// The edges of a body: a new array (k, 2) uint32, two vertices each, the smaller first. Every edge once, whatever triangles share it.
    /// The number of an edge is its row here.
    ///
    /// They are sorted when they are first asked for, here or by a query for edges. From then on an edge keeps its number while there is a
    /// triangle that has it, however the mesh is edited: a number whose edge is gone is empty, 0xFFFFFFFF twice, until an edge that comes
    /// takes it, the lowest first.
    fn edges<'py>(
        &self,
        py: Python<'py>,
        body: Body,
    ) -> Result<Bound<'py, PyArray2<u32>>, Refused> {
        let edges = self.with(py, |state| {
            Ok(with_world!(&state.world, world => world.edges(body.0))?.to_vec())
        })?;
        Ok(arrays::rows_of(py, edges)?)
    }

    /// How much more the tree of a body does than a fresh one would, estimated from what queries for triangles did in the shape of now:
    /// pairs of nodes that were looked at, for one that a fresh tree would look at. 1.0 before a query says anything, or where little was looked
    /// at. With mending=True trees that have decayed mend themselves.
    fn tree_quality(&self, py: Python<'_>, body: Body) -> Result<f64, Refused> {
        self.with(
            py,
            |state| with_world!(&state.world, world => Ok(world.tree_quality(body.0)?)),
        )
    }

    /// Builds the tree of a body anew, on the shape it has now. Worth it when a shape has become very different from the one
    /// it was built on; never needed for right answers.
    fn rebuild(&self, py: Python<'_>, body: Body) -> Result<(), Refused> {
        self.with(
            py,
            |state| with_world!(&mut state.world, world => Ok(world.rebuild(body.0)?)),
        )
    }

    /// Says which bodies a body meets in queries of the whole world. Two bodies meet if the membership of each has a bit in
    /// common with the mask of the other. At first both are all ones, 0xFFFFFFFF. A query that names its bodies does not look at
    /// them.
    fn set_filter(
        &self,
        py: Python<'_>,
        body: Body,
        membership: u32,
        mask: u32,
    ) -> Result<(), Refused> {
        self.with(py, |state| {
            with_world!(&mut state.world, world => Ok(world.set_filter(body.0, membership, mask)?))
        })
    }

    /// The membership and the mask of a body.
    fn filter(&self, py: Python<'_>, body: Body) -> Result<(u32, u32), Refused> {
        self.with(
            py,
            |state| with_world!(&state.world, world => Ok(world.filter(body.0)?)),
        )
    }

    /// From now on two bodies do not meet in queries of the whole world, or a body with itself if it is named twice. A query that
    /// names its bodies does not look at this.
    fn ignore(&self, py: Python<'_>, a: Body, b: Body) -> Result<(), Refused> {
        self.with(
            py,
            |state| with_world!(&mut state.world, world => Ok(world.ignore(a.0, b.0)?)),
        )
    }

    /// Takes ignore back.
    fn unignore(&self, py: Python<'_>, a: Body, b: Body) -> Result<(), Refused> {
        self.with(
            py,
            |state| with_world!(&mut state.world, world => Ok(world.unignore(a.0, b.0)?)),
        )
    }

    /// The pairs of bodies that ignore keeps apart, each once, the lower number first; sorted.
    fn ignored(&self, py: Python<'_>) -> Result<Vec<(u32, u32)>, Refused> {
        self.with(py, |state| {
            let ignored = with_world!(&state.world, world => world.ignored());
            Ok(ignored.into_iter().map(|[a, b]| (a.0, b.0)).collect())
        })
    }

    /// Gives a body a box, its lower and upper corner, that holds it in every pose to come; None takes it away. Corners are
    /// rounded to the world's type. Until the box is taken away, a position outside it is refused.
    fn set_loose_box(
        &self,
        py: Python<'_>,
        body: Body,
        corners: Option<(Bound<'_, PyAny>, Bound<'_, PyAny>)>,
    ) -> Result<(), Refused> {
        let corners = match corners {
            Some((lo, hi)) => Some((arrays::point(&lo)?, arrays::point(&hi)?)),
            None => None,
        };
        self.with(py, |state| Ok(state.set_loose_box(body.0, corners)?))
    }

    /// The lower and the upper corner of the box that set_loose_box gave to a body; None if it has none.
    fn loose_box(
        &self,
        py: Python<'_>,
        body: Body,
    ) -> Result<Option<([f64; 3], [f64; 3])>, Refused> {
        self.with(py, |state| Ok(pickled::loose_box(&state.world, body.0)?))
    }

    /// How many triangles a body has.
    fn triangle_count(&self, py: Python<'_>, body: Body) -> Result<usize, Refused> {
        self.with(py, |state| {
            Ok(with_world!(&state.world, world => world.triangle_count(body.0))?)
        })
    }

    /// How many vertices a body has: the length that its positions must have.
    fn vertex_count(&self, py: Python<'_>, body: Body) -> Result<usize, Refused> {
        self.with(py, |state| {
            Ok(with_world!(&state.world, world => world.vertex_count(body.0))?)
        })
    }

    /// The tree of a body in numbers.
    fn tree_shape<'py>(&self, py: Python<'py>, body: Body) -> Result<Bound<'py, PyAny>, Refused> {
        let shape = self.with(py, |state| {
            Ok(with_world!(&state.world, world => world.tree_shape(body.0))?)
        })?;
        let fields = [
            ("depth", shape.depth as usize),
            ("nodes", shape.nodes),
            ("leaves", shape.leaves),
        ];
        Ok(named_tuple(py, "TreeShape", fields)?)
    }

    /// For each triangle of a body, the part it is in when its tree is cut at a level, the root being level 0: (m,) uint32.
    fn tree_cut<'py>(
        &self,
        py: Python<'py>,
        body: Body,
        level: u32,
    ) -> Result<Bound<'py, PyArray1<u32>>, Refused> {
        let parts = self.with(py, |state| {
            Ok(with_world!(&state.world, world => world.tree_cut(body.0, level))?)
        })?;
        Ok(parts.into_pyarray(py))
    }

    /// The faces of a body as they were added: (m, 3) uint32.
    fn triangles<'py>(
        &self,
        py: Python<'py>,
        body: Body,
    ) -> Result<Bound<'py, PyArray2<u32>>, Refused> {
        let triangles = self.with(py, |state| {
            Ok(with_world!(&state.world, world => world.triangles(body.0))?.to_vec())
        })?;
        Ok(arrays::rows_of(py, triangles)?)
    }

    /// The shape that a body has now, the positions that it was given last: a new array (n, 3) of the world's type.
    fn positions<'py>(&self, py: Python<'py>, body: Body) -> Result<Bound<'py, PyAny>, Refused> {
        let positions = self.with(py, |state| {
            Ok(with_world!(&state.world, world => Owned::from(world.positions(body.0)?)))
        })?;
        Ok(positions.into_array(py)?)
    }

    /// The boxes of a level of a body's tree, the root being level 0, and which of them are valid, that is, held by the tree for the
    /// shape that the body has now: TreeBoxes(lower, upper, valid), (k, 3), (k, 3) and (k,), one row a part of tree_cut. Makes no
    /// box, and reads none.
    fn tree_boxes<'py>(
        &self,
        py: Python<'py>,
        body: Body,
        level: u32,
    ) -> Result<Bound<'py, PyAny>, Refused> {
        let (lower, upper, valid) = self.with(py, |state| {
            Ok(with_world!(&state.world, world => {
                let boxes = world.tree_boxes(body.0, level)?;
                let lower: Vec<_> = boxes.iter().map(|node| node.lower).collect();
                let upper: Vec<_> = boxes.iter().map(|node| node.upper).collect();
                let valid: Vec<_> = boxes.iter().map(|node| node.valid).collect();
                (Owned::from(lower), Owned::from(upper), valid)
            }))
        })?;
        let fields = [
            ("lower", lower.into_array(py)?),
            ("upper", upper.into_array(py)?),
            ("valid", valid.into_pyarray(py).into_any()),
        ];
        Ok(named_tuple(py, "TreeBoxes", fields)?)
    }

    /// The order in which queries read the vertices of a body, as they were numbered when it was added: (n,) uint32. A body whose
    /// vertices come in this order, and whose faces name the new numbers, is faster.
    fn vertex_order<'py>(
        &self,
        py: Python<'py>,
        body: Body,
    ) -> Result<Bound<'py, PyArray1<u32>>, Refused> {
        let order = self.with(py, |state| {
            Ok(with_world!(&state.world, world => world.vertex_order(body.0))?.to_vec())
        })?;
        Ok(order.into_pyarray(py))
    }

    /// Asks which triangles intersect, of different bodies or of one: pairs of them, as closed sets. Touching counts. The Selection
    /// says who is asked about; the Query that comes back, how much is wanted: all(), first(), visit(...) or prepare().
    ///
    /// Within a body, triangles that share a vertex of the mesh are left out: they always touch. Surfaces only: a body wholly inside
    /// another meets none of its triangles.
    #[pyo3(signature = (of=Selection::WORLD))]
    fn intersections(slf: Py<Self>, of: Selection) -> Query {
        Query::new(slf, Kind::Intersections, of)
    }

    /// Asks which triangles intersect, as intersections does, and how: whether they cross, overlap in one plane, or only touch. only, a
    /// ContactKind, leaves out what is not of one kind: where surfaces lie on each other, along a cut or in a stack, it finds what goes
    /// through.
    #[pyo3(signature = (of=Selection::WORLD, *, only=None))]
    fn contacts(slf: Py<Self>, of: Selection, only: Option<Only>) -> ContactQuery {
        ContactQuery::new(slf, of, only)
    }

    /// Asks which vertices are near which triangles, now or on the way to the end of a motion: rows of body, vertex, body, triangle.
    ///
    /// The box of an element is the hull of its corners, at both ends of the motion where there is one. A vertex and a triangle are a
    /// candidate if on every axis the gap of their boxes is at most twice radius, in real arithmetic on the numbers given, and the vertex
    /// is no corner of the triangle. So with half the distance at which things are to be found nothing is missed that comes as near as
    /// that. Of two bodies it is the vertices of either and the triangles of the other. Filters keep bodies apart as in intersections,
    /// and set_vertex_groups keeps apart parts of them.
    #[pyo3(signature = (of, radius))]
    fn vertex_triangle_candidates(slf: Py<Self>, of: Selection, radius: f64) -> Query {
        Query::new(slf, Kind::VertexTriangleCandidates(radius), of)
    }

    /// Asks which edges are near which edges, as vertex_triangle_candidates asks it of vertices and triangles: rows of body, edge, body,
    /// edge, the smaller (body, edge) first, or the body that the selection names first. Edges have the numbers that edges(body) gives
    /// them; two that have an end in common are none.
    #[pyo3(signature = (of, radius))]
    fn edge_edge_candidates(slf: Py<Self>, of: Selection, radius: f64) -> Query {
        Query::new(slf, Kind::EdgeEdgeCandidates(radius), of)
    }

    /// Asks which vertices are close to which triangles, in the shape of now: those at most distance apart, with their closest points.
    ///
    /// Whether a pair is that close is decided exactly, in real arithmetic on the numbers given. Which pairs are looked at is said at
    /// vertex_triangle_candidates: no corner of a triangle is close to it, vertex groups and filters count. A motion is not looked at.
    #[pyo3(signature = (of, distance))]
    fn close_vertex_triangle_pairs(slf: Py<Self>, of: Selection, distance: f64) -> CloseQuery {
        CloseQuery::new(slf, CloseKind::VertexTriangle, of, distance)
    }

    /// Asks which edges are close to which edges, as close_vertex_triangle_pairs asks it of vertices and triangles. Two that have an end in
    /// common are not looked at.
    #[pyo3(signature = (of, distance))]
    fn close_edge_edge_pairs(slf: Py<Self>, of: Selection, distance: f64) -> CloseQuery {
        CloseQuery::new(slf, CloseKind::EdgeEdge, of, distance)
    }

    /// Asks which triangles are close to each other, in the shape of now: those at most distance apart, with their closest points; those
    /// that intersect are, at distance 0. Within a body, those that share a vertex of the mesh are left out.
    #[pyo3(signature = (of, distance))]
    fn close_triangle_pairs(slf: Py<Self>, of: Selection, distance: f64) -> CloseQuery {
        CloseQuery::new(slf, CloseKind::Triangles, of, distance)
    }

    /// How far the surfaces of two bodies are apart: their closest triangles, a ClosePair; None if they are further apart than cut_off.
    /// The distance is 0 exactly if any of their triangles intersect; a body wholly inside another is as far from it as its surface is.
    #[pyo3(signature = (a, b, cut_off=f64::INFINITY))]
    fn distance<'py>(
        &self,
        py: Python<'py>,
        a: Body,
        b: Body,
        cut_off: f64,
    ) -> Result<Option<Bound<'py, PyAny>>, Refused> {
        let found = self.with(py, |state| {
            interruptible(|question| {
                with_world!(&mut state.world, world => {
                    world.interruptible(question).distance(a.0, b.0, cut_off)
                })
            })
        })?;
        Ok(found.map(|it| Close::of_triangles(py, it)).transpose()?)
    }

    /// How far a body is from all others that may meet it, as filters say: the distance to the nearest of them, which the ClosePair names;
    /// None if no other is within cut_off.
    #[pyo3(signature = (body, cut_off=f64::INFINITY))]
    fn nearest_body<'py>(
        &self,
        py: Python<'py>,
        body: Body,
        cut_off: f64,
    ) -> Result<Option<Bound<'py, PyAny>>, Refused> {
        let found = self.with(py, |state| {
            interruptible(|question| {
                with_world!(&mut state.world, world => {
                    world.interruptible(question).nearest_body(body.0, cut_off)
                })
            })
        })?;
        Ok(found.map(|it| Close::of_triangles(py, it)).transpose()?)
    }

    /// Asks which vertices and triangles meet on the way to the end of a motion, and when first; edge_edge_impacts is the other half.
    ///
    /// Vertices move on straight lines, from where they are at time 0 to where set_motion said at time 1; a body without a motion stands
    /// still. Whether a pair meets, as closed sets, is decided exactly. They are apart from time 0 to low, both included, and meet after
    /// that and not after high, which are at most width apart; both are 0 if they meet at the start. Which pairs are looked at is said at
    /// vertex_triangle_candidates.
    #[pyo3(signature = (of, width=1e-6))]
    fn vertex_triangle_impacts(slf: Py<Self>, of: Selection, width: f64) -> ImpactQuery {
        ImpactQuery::new(slf, ImpactKind::VertexTriangle, of, width)
    }

    /// Asks which edges meet on the way to the end of a motion, and when first, as vertex_triangle_impacts asks it of vertices and
    /// triangles. Two that have an end in common are not looked at.
    #[pyo3(signature = (of, width=1e-6))]
    fn edge_edge_impacts(slf: Py<Self>, of: Selection, width: f64) -> ImpactQuery {
        ImpactQuery::new(slf, ImpactKind::EdgeEdge, of, width)
    }

    /// The first contact on the way to the end of a motion, an Impact, of all vertex_triangle_impacts and edge_edge_impacts: that with the
    /// least exact time; None if nothing meets. Much faster than all.
    #[pyo3(signature = (of, width=1e-6))]
    fn first_impact<'py>(
        &self,
        py: Python<'py>,
        of: Selection,
        width: f64,
    ) -> Result<Option<Bound<'py, PyAny>>, Refused> {
        let found = self.with(py, |state| {
            interruptible(|question| {
                with_world!(&mut state.world, world => {
                    world.interruptible(question).first_impact(of.0, width)
                })
            })
        })?;
        Ok(found.map(|it| Impact::of(py, it)).transpose()?)
    }

    /// How far everything may go on its way to the end of a motion and stay further apart than min_distance, and what that number alone
    /// does not say: a FreeStep(t, begins_in_contact, moves).
    ///
    /// t is the time of collision_free_step, to call advance_motion with. It promises nothing for what is in contact at the start.
    /// begins_in_contact is the first such pair, in the shape of now: a Pair of triangles that intersect, as intersections looks at them,
    /// unless all six vertices are of one group; else a VertexTriangle or an EdgeEdge that are at most min_distance apart, as impacts look
    /// at them; None if everything begins apart. Surfaces that are through each other meet on every way out, so t may be small for no
    /// other reason; elements that touch may go through each other, and those nearer than min_distance may come nearer. A mesh with edges
    /// shorter than min_distance is always that near to itself. Triangles that share a vertex and are through each other beyond it are
    /// not found.
    ///
    /// moves is False if no body that is asked about has a motion; then t is 1.
    #[pyo3(signature = (of, min_distance=0.0))]
    fn free_step<'py>(
        &self,
        py: Python<'py>,
        of: Selection,
        min_distance: f64,
    ) -> Result<Bound<'py, PyAny>, Refused> {
        let step = self.with(py, |state| {
            interruptible(|question| {
                with_world!(&mut state.world, world => {
                    world.interruptible(question).free_step(of.0, min_distance)
                })
            })
        })?;
        let pair = step.begins_in_contact.map(|pair| match pair {
            InContact::Triangles(pair) => ("Pair", <[u32; 4]>::from(pair)),
            InContact::VertexTriangle(pair) => ("VertexTriangle", pair.into()),
            InContact::EdgeEdge(pair) => ("EdgeEdge", pair.into()),
        });
        let classes = py.import("pliant._types")?;
        let pair = pair.map(|(class, [body_a, a, body_b, b])| {
            classes.getattr(class)?.call1((body_a, a, body_b, b))
        });
        let step = (step.t, pair.transpose()?, step.moves);
        Ok(classes.getattr("FreeStep")?.call1(step)?)
    }

    /// How far everything may go on its way to the end of a motion and stay further apart than min_distance: a time from 0 to 1 to call
    /// advance_motion with. It is proven that on straight ways to the shape that this makes, rounded as it is, no vertex meets a triangle
    /// and no edge another, nor comes as near as min_distance. 1 if that is so of the whole motion. 1 also if nothing moves, and less
    /// without a word if the start intersects: free_step says so.
    ///
    /// It is at least 0.9 of the largest such time where rounding leaves room for that. What touches at the start already does not count;
    /// what is within min_distance at the start is kept from contact alone.
    #[pyo3(signature = (of, min_distance=0.0))]
    fn collision_free_step(
        &self,
        py: Python<'_>,
        of: Selection,
        min_distance: f64,
    ) -> Result<f64, Refused> {
        self.with(py, |state| {
            interruptible(|question| {
                with_world!(&mut state.world, world => {
                    world.interruptible(question).collision_free_step(of.0, min_distance)
                })
            })
        })
    }

    /// How far each vertex may move before anything can touch: a dictionary of bodies, with an array (n,) float64 each, at most half of
    /// cut_off. It is half the least distance of the vertices and triangles, and edges and edges, that the vertex is a corner of, as
    /// close_vertex_triangle_pairs looks at them; rounded down by at most 1e-6 of itself and 1e-323. If every vertex moves less than that, in
    /// whatever direction, none of these touch.
    #[pyo3(signature = (of, cut_off))]
    fn clearance<'py>(
        &self,
        py: Python<'py>,
        of: Selection,
        cut_off: f64,
    ) -> Result<Bound<'py, PyDict>, Refused> {
        let clearances = self.with(py, |state| {
            interruptible(|question| {
                with_world!(&mut state.world, world => {
                    world.interruptible(question).clearance(of.0, cut_off)
                })
            })
        })?;
        let of_bodies = PyDict::new(py);
        for (body, clearance) in clearances {
            of_bodies.set_item(body.0, clearance.into_pyarray(py))?;
        }
        Ok(of_bodies)
    }

    /// What the last query did, with what Query.prepare did before it.
    fn statistics<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>, Refused> {
        let statistics = self.with(py, |state| {
            Ok(with_world!(&state.world, world => *world.statistics()))
        })?;
        let fields = [
            ("body_pairs", statistics.body_pairs),
            ("boxes_bottom_up", statistics.boxes_bottom_up),
            ("boxes_top_down", statistics.boxes_top_down),
            ("triangle_boxes", statistics.triangle_boxes),
            ("node_pairs", statistics.node_pairs),
            ("candidate_pairs", statistics.candidate_pairs),
            ("scalar_decisions", statistics.scalar_decisions),
            ("exact_decisions", statistics.exact_decisions),
            ("pairs", statistics.pairs),
        ];
        Ok(named_tuple(py, "Statistics", fields)?)
    }

    /// How many bytes of memory this world holds: bodies, trees, boxes, and the lists that queries keep for the next ones, with all
    /// that they have room for; and the room into which set_positions copies. Arrays that were handed out are not counted.
    fn memory_usage(&self, py: Python<'_>) -> Result<usize, Refused> {
        let room = alone(&self.state)?.room(py);
        self.with(py, |state| {
            Ok(with_world!(&state.world, world => world.memory_usage()) + room)
        })
    }

    /// Checks every invariant of every tree, and raises pliant.Error if one does not hold. For tests and bug reports; no
    /// sequence of calls should ever make it fail.
    fn validate(&self, py: Python<'_>) -> Result<(), Refused> {
        self.with(py, |state| {
            let holds = with_world!(&state.world, world => world.validate());
            holds.map_err(|what| Refused::new("Broken", what))
        })
    }

    fn __repr__(&self, py: Python<'_>) -> Result<String, Refused> {
        self.with(py, |state| {
            let bodies = with_world!(&state.world, world => world.bodies().len());
            let bodies = format!("{bodies} {}", if bodies == 1 { "body" } else { "bodies" });
            Ok(match state.precision() {
                None => "<pliant.World, no body yet>".to_owned(),
                Some(Precision::F32) => format!("<pliant.World of float32, {bodies}>"),
                Some(Precision::F64) => format!("<pliant.World of float64, {bodies}>"),
            })
        })
    }
}
