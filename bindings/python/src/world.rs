//! `World` of Python: the world of the Rust library, method by method.

use crate::answers::{Any, Column, Owned, Rows, counted, named};
use crate::arrays::{self, BoxCorners, Coordinates, CopiedCoordinates, CopiedMesh, Number};
use crate::edit::{self, AnyEdit, Edit};
use crate::error::{Refused, Result};
use crate::inside::{self, OfWorld};
use crate::options::{Keywords, Threads};
use crate::pickled::{self, Written};
use crate::queries::Hit;
use crate::queries::close::{Close, CloseQuery};
use crate::queries::contacts::{ContactQuery, Contacts, Only};
use crate::queries::frames::{Frames, each_frame};
use crate::queries::impacts::{ImpactQuery, Impacts};
use crate::queries::pairs::{Pairs, Query};
use crate::selection::{Body, Selection};
use crate::signals::interruptible;
use crate::state::{Corners, Shared, State};
use numpy::PyArray2;
use pliant::{BodyId, Impact, InContact, Labels, NodeBox};
use pliant_check::with_world;
use pliant_io::{Positions, Precision};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::borrow::Cow;

/// Deforming triangle meshes, and exact answers about what of them meets or is near.
///
///     world = pliant.World(threads=4)
///     cloth = world.add(faces, positions)
///     world.set_positions(cloth, moved)
///     hits = world.intersections(pliant.Selection.EVERYTHING).all()
///
/// A query refits the boxes that it reads. There is no refit to call, and no answer is for old
/// positions.
///
/// The first body fixes the precision, float32 or float64: see dtype. Lengths are in the unit of
/// the positions. Bodies, triangles, vertices and edges are numbers, counted from 0. Surfaces only:
/// a body wholly inside another meets none of its triangles, and contained finds it.
///
/// A refused call raises pliant.Error and leaves the world as it was. Names behind "Raises
/// pliant.Error:" are values of its attribute kind. Every call may also raise the kind Busy, for a
/// world answers one call at a time. In costs, m and n are the numbers of triangles and vertices of
/// a body.
///
/// - bodies: add, remove, bodies, set_positions, write_positions, positions, triangles, edges,
///   set_edges, triangle_count, vertex_count
/// - what meets or is near: intersections, contacts, adjacent_intersections, crossing_edges,
///   vertex_triangle_candidates, edge_edge_candidates
/// - distances: close_vertex_triangle_pairs, close_edge_edge_pairs, close_triangle_pairs, distance,
///   nearest_body, clearance
/// - closed bodies: watertight, points_inside, inside, contained, depth
/// - points: points_inside, closest_points, signed_closest_points
/// - many shapes in one call: Query.of_frames, inside
/// - motion: set_motion, end_positions, vertex_triangle_impacts, edge_edge_impacts, first_impact,
///   free_step, collision_free_step, advance_motion, finish_motion
/// - change of a mesh: set_mesh, edit, apply, live_triangles, live_vertices, mesh_revision,
///   components, split, fuse, weld
/// - who may meet: set_filter, filter, set_environment, environment, ignore, unignore, ignored,
///   set_vertex_groups, vertex_groups, set_rest_positions, rest_positions, set_labels, labels,
///   set_thickness, set_vertex_thickness, thickness
/// - speed: options, rebuild, tree_quality, set_loose_box, loose_box, vertex_order, statistics,
///   memory_usage
/// - the tree itself: tree_shape, tree_cut, tree_boxes, validate
///
/// Options are keywords. None changes an answer, and the defaults measured best. The paper's trees
/// are partition="centre", leaf_size=1.
///
/// - degree: the most children of a node, 2, 4 or 8
/// - partition: how triangles are divided into a tree. "balanced" makes parts of equal size,
///   "connectivity" connected pieces of the mesh. "centre" cuts the box of a node at its centre,
///   "mean" at the mean of the midpoints of its triangles
/// - leaf_size: the most triangles in a leaf
/// - update: which boxes are refitted when. "bottom-up" refits all ahead, "top-down" each one when
///   it is reached, "hybrid" the upper levels ahead
/// - level: the level down to which "hybrid" refits ahead, the root being 0. None is half the depth
///   of the tree, and all levels where a body meets itself
/// - broad: how pairs of bodies are found. "brute" compares all boxes, "sweep" is sweep and prune,
///   "tree" a tree of bodies. "auto" is "brute" up to 100 bodies, then "tree"
/// - threads: how many threads share the work of a query, at most, or "all" for one a core. Work
///   that is small takes fewer. Where other programs use the cores, fewer may be quicker
/// - mending: whether a tree that has decayed is built anew, a part of the work at each new shape:
///   see tree_quality
///
/// An option without such a value raises pliant.Error: BadOption.
///
/// The interpreter lock is released while a call computes. Arrays are copied and checked before:
/// another thread that writes to one may change the shape taken, never make it unchecked.
/// copy.copy, copy.deepcopy and pickle make a world that answers the same.
#[pyclass(frozen, module = "pliant")]
pub(crate) struct World {
    pub(crate) state: Shared,
    keywords: Keywords,
}

/// Works with the world, of either precision, without the interpreter lock: most methods.
macro_rules! ask {
    ($this:ident, $py:ident, $world:ident => $work:expr) => {
        $this.state.with($py, |state| {
            with_world!(&mut state.world, $world => Ok($work))
        })
    };
}

/// Works with the world as `ask!` does, and ends early if a signal handler raises: long work.
macro_rules! search {
    ($this:ident, $py:ident, $world:ident => $work:expr) => {
        $this.state.with($py, |state| {
            interruptible(|question| with_world!(&mut state.world, world => {
                let $world = world.interruptible(question);
                $work
            }))
        })
    };
}

/// Searches as `search!` does, with points in the type of the world.
macro_rules! search_at {
    ($this:ident, $py:ident, $given:ident, ($world:ident, $points:ident) => $work:expr) => {{
        let copied = arrays::points($given)?;
        let given = copied.get()?;
        search!($this, $py, $world => {
            let mut widened = Vec::new();
            let $points = OfWorld::take(given, &mut widened)?;
            Ok::<_, Refused>($work?)
        })
    }};
}

/// An object of Python, or the refusal.
type Answer<'py> = Result<Any<'py>>;

/// An object of Python or `None`, or the refusal.
type Maybe<'py> = Result<Option<Any<'py>>>;

#[pymethods]
impl World {
    #[new]
    #[expect(clippy::too_many_arguments, reason = "they are keywords")]
    #[pyo3(
        signature = (
            *, degree=8, partition="balanced", leaf_size=8, update="hybrid", level=None,
            broad="auto", threads=Threads::Count(1), mending=false
        ),
        text_signature = "(*, degree=8, partition='balanced', leaf_size=8, update='hybrid', \
            level=None, broad='auto', threads=1, mending=False)"
    )]
    fn new(
        degree: i64,
        partition: &str,
        leaf_size: i64,
        update: &str,
        level: Option<i64>,
        broad: &str,
        threads: Threads,
        mending: bool,
    ) -> Result<Self> {
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
        let state = Shared::new(State::new(keywords.to_options()?));
        Ok(Self { state, keywords })
    }

    /// Returns a copy with the same bodies, under the same numbers and in their present shapes.
    ///
    /// Filters, ignored pairs, loose boxes and options are copied. Boxes are made anew. The two
    /// worlds share nothing.
    fn __copy__(&self, py: Python<'_>) -> Result<Self> {
        let state = Shared::new(self.state.with(py, |state| Ok(state.another()))?);
        let keywords = self.keywords.clone();
        Ok(Self { state, keywords })
    }

    /// Returns a copy, as copy.copy does: a world holds nothing that could be shared.
    fn __deepcopy__(&self, py: Python<'_>, _memo: &Any<'_>) -> Result<Self> {
        self.__copy__(py)
    }

    /// Returns a constructor with these options, and the state for __setstate__: for pickle.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let (py, this) = (slf.py(), slf.get());
        let options = this.keywords.clone().into_pyobject(py)?;
        let partial = py.import("functools")?.getattr("partial")?;
        let make = partial.call((slf.get_type(),), Some(&options))?;
        let written = this.state.with(py, |state| pickled::Copied::of(state))?;
        (make, PyTuple::empty(py), written).into_pyobject(py)
    }

    /// Restores the state that pickle wrote, into a world that never had a body.
    ///
    /// Bodies keep their numbers, and numbers that were used are not used again. Trees are built on
    /// the shapes that were written.
    ///
    /// Raises pliant.Error: BadOption if the world has had bodies, or the state is not one that
    /// pickle wrote.
    fn __setstate__(&self, py: Python<'_>, written: Written<'_>) -> Result<()> {
        let mut restored = State::new(self.keywords.to_options()?);
        written.restore(py, &mut restored)?;
        self.state.with(py, |state| {
            if state.precision().is_some() {
                let message = "this world has had bodies; what pickle wrote down becomes a new one";
                return Err(Refused::new("BadOption", message));
            }
            *state = restored;
            Ok(())
        })
    }

    /// Options of this world, a dict of the keyword arguments that make another like it.
    fn options(&self) -> Keywords {
        self.keywords.clone()
    }

    /// Dtype of all positions, numpy.float32 or numpy.float64; None before the first body.
    #[getter]
    fn dtype<'py>(&self, py: Python<'py>) -> Maybe<'py> {
        let precision = self.state.with(py, |state| Ok(state.precision()))?;
        Ok(precision.map(|precision| dtype_of(py, precision)))
    }

    /// Adds a body, and returns its number, an int that this world will not use again.
    ///
    /// - faces: (m, 3) of any integer type, the corners of each triangle, counted from 0
    /// - positions: (n, 3) float32 or float64; float32 is widened in a float64 world
    ///
    /// - edges: (k, 2) of any integer type, edges that are of no triangle: rods, cables, nets
    /// - points: (k,) of any integer type, vertices that collide as points
    ///
    /// An edge is the triangle of its ends in which the second is twice, and a point that of one
    /// vertex. They are numbered behind the triangles, edges first, and every question answers for
    /// them as for triangles. Where there are no triangles, faces are None. A vertex that nothing
    /// names collides with nothing.
    ///
    /// One mesh object takes the place of both: .faces (or .triangles, as in Open3D) and .vertices
    /// are read. The tree is built on these positions; a rest pose is best. A degenerate triangle
    /// is the segment or point that it is. Vertices without triangles are allowed. Nothing is
    /// welded.
    ///
    /// Raises pliant.Error: BadArray, Precision, NoTriangles, VertexOutOfRange, BadPosition,
    /// NeedsSubnormals, TooLarge above 2^28 triangles or 2^32 - 1 vertices, TooManyBodies.
    ///
    /// Cost: O(m log m) with partition="balanced", else O(m) for each level of the tree.
    #[pyo3(signature = (faces, positions=None, *, edges=None, points=None))]
    fn add<'py>(
        &self,
        py: Python<'py>,
        faces: Option<&Any<'py>>,
        positions: Option<&Any<'py>>,
        edges: Option<&Any<'py>>,
        points: Option<&Any<'py>>,
    ) -> Result<u32> {
        let none = PyArray2::<u32>::zeros(py, [0, 3], false);
        let mesh = mesh_of(faces.unwrap_or(none.as_any()), positions, None)?;
        let (faces, positions) = mesh.get()?;
        let others = arrays::edges_and_points([edges, points], positions.len())?;
        let all: Cow<[[u32; 3]]> = if others.is_empty() {
            faces.into()
        } else {
            [faces, &others].concat().into()
        };
        self.state.with(py, |state| {
            let added = state.add(&all, positions);
            Ok(added.map_err(|refused| refused.of_body(None))?.0)
        })
    }

    /// Gives a body another mesh and shape, of any size.
    ///
    /// Faces (m, 3) and positions (n, 3), or one mesh object, as add takes them. The body keeps its
    /// number, filter, ignored pairs and loose box. Triangles and vertices are numbered as given,
    /// and none is empty. If the mesh differs from the present one, a motion ends and vertex groups
    /// are 0 again.
    ///
    /// Rows equal by number stay, others are edited, as apply does. If more than an eighth of the
    /// triangles differ, or there are fewer vertices than before, all is made anew. Edges then have
    /// other numbers.
    ///
    /// Raises pliant.Error: NoSuchBody, OutsideLooseBox, and the kinds of add. The body then keeps
    /// mesh and shape.
    ///
    /// Cost: O(m + n) to compare, and the cost of apply for what differs; if all is made anew, that
    /// of add.
    #[pyo3(signature = (body, faces, positions=None))]
    fn set_mesh(
        &self,
        py: Python<'_>,
        body: Body,
        faces: &Any<'_>,
        positions: Option<&Any<'_>>,
    ) -> Result<()> {
        let mesh = mesh_of(faces, positions, Some(body.0))?;
        let (faces, positions) = mesh.get()?;
        let state = &self.state;
        state.with(py, |state| state.set_mesh(body.0, faces, positions))
    }

    /// Numbers the edges of a body as given, (k, 2) of any integer type, two vertices a row.
    ///
    /// They must be the edges of the mesh, each once, with their ends in either order. From then on
    /// answers name edges by the row here, as a solver that has its own edges does. edges(body) has
    /// the smaller end of each first, and so have weights and times along edges.
    ///
    /// Raises pliant.Error: NoSuchBody, BadArray, MissingEdge, NotAnEdge. EditedMesh once an edit
    /// has changed the mesh.
    ///
    /// Cost: O(k log k).
    fn set_edges(&self, py: Python<'_>, body: Body, edges: &Any<'_>) -> Result<()> {
        let edges = arrays::edges_of(edges)?;
        Ok(ask!(self, py, world => world.set_edges(body.0, &edges))??)
    }

    /// Begins an edit of a body's mesh: an Edit without steps, which apply makes all at once.
    ///
    /// Raises pliant.Error: NoSuchBody.
    fn edit(&self, py: Python<'_>, body: Body) -> Result<Edit> {
        self.state
            .with(py, |state| Ok(AnyEdit::of(state, body.0)?))
            .map(Edit::new)
    }

    /// Makes the changes of an edit, all or none; returns an Edited, the changes by number.
    ///
    /// Triangles and vertices that the edit does not name keep their numbers. Edges keep theirs
    /// while they stay. A triangle number left empty is 0xFFFFFFFF three times in triangles, and in
    /// no answer. Positions keep a row for every number. Rows of empty vertices are not looked at
    /// when set, and NaN when asked for.
    ///
    /// Filter, ignored pairs and loose box stay. A split vertex has the group of the vertex it was
    /// split from, any other new one group 0. A motion ends if anything changes.
    ///
    /// Raises pliant.Error: OutdatedEdit if the mesh was changed since the edit began, or another
    /// world began it. NoTriangles if none would be left. NoSuchTriangle, EmptyTriangle,
    /// NoSuchVertex, EmptyVertex, VertexOutOfRange, VertexInUse, NotACorner for steps. BadPosition,
    /// OutsideLooseBox and NeedsSubnormals for new positions.
    ///
    /// Cost: proportional to the edit and the triangles around it, whatever the size of the mesh.
    /// The first edit of a body costs O(m). So does the one that makes m / 16 changed triangles:
    /// the tree is then built anew.
    fn apply<'py>(&self, py: Python<'py>, edit: &Edit) -> Answer<'py> {
        let edited = edit.with(|edit| self.state.with(py, |state| edit.apply(state)))?;
        Ok(edit::edited(py, edited)?)
    }

    /// Whether each triangle number of a body is in use, (m,) bool; False if left empty.
    ///
    /// Raises pliant.Error: NoSuchBody. Cost: O(m).
    fn live_triangles(&self, py: Python<'_>, body: Body) -> Result<Column<bool>> {
        ask!(self, py, world => Column(world.live_triangles(body.0)?))
    }

    /// Whether each vertex number of a body is in use, (n,) bool; False if left empty.
    ///
    /// Raises pliant.Error: NoSuchBody. Cost: O(n).
    fn live_vertices(&self, py: Python<'_>, body: Body) -> Result<Column<bool>> {
        ask!(self, py, world => Column(world.live_vertices(body.0)?))
    }

    /// Counter of a body's meshes and tree orders, an int that changes when either does.
    ///
    /// Whoever keeps the arrays of triangles, edges or vertex_order asks for them again when it has
    /// changed.
    ///
    /// Raises pliant.Error: NoSuchBody. Cost: O(1).
    fn mesh_revision(&self, py: Python<'_>, body: Body) -> Result<u64> {
        ask!(self, py, world => world.mesh_revision(body.0)?)
    }

    /// Connected component of each triangle of a body, (m,) uint32.
    ///
    /// Triangles that share a vertex are in one component. Components are numbered from 0 by their
    /// first triangles. An empty triangle number has 0xFFFFFFFF.
    ///
    /// Raises pliant.Error: NoSuchBody. Cost: O(m + n).
    fn components(&self, py: Python<'_>, body: Body) -> Result<Column<u32>> {
        ask!(self, py, world => Column(world.components(body.0)?))
    }

    /// Makes each connected component of a body but the largest a body of its own.
    ///
    /// Returns a list of Piece, ordered by first triangle; empty, with nothing changed, if the mesh
    /// is connected. The component with the most triangles, of several the first, stays with all
    /// its numbers. Vertices without triangles stay with it.
    ///
    /// Pieces inherit filter, loose box, vertex groups and ignored pairs. If the body ignores
    /// itself, the pieces ignore each other and it. A motion of the body ends.
    ///
    /// Raises pliant.Error: NoSuchBody, TooManyBodies. Cost: O(m + n), and building the trees of
    /// the pieces.
    fn split<'py>(&self, py: Python<'py>, body: Body) -> Result<Vec<Any<'py>>> {
        let pieces = ask!(self, py, world => world.split(body.0)?)?.into_iter();
        let pieces = pieces.map(|piece| edit::piece(py, piece));
        Ok(pieces.collect::<PyResult<_>>()?)
    }

    /// Appends the triangles and vertices of body b to body a, and removes b.
    ///
    /// Returns a Fused: the new number of each triangle and vertex of b. Body a keeps its numbers,
    /// filter and ignored pairs; vertices keep their groups. If both have a loose box, the new one
    /// holds both; else there is none. Motions of both end. Nothing is welded: see weld.
    ///
    /// Raises pliant.Error: NoSuchBody, SameBody if a is b, TooLarge.
    ///
    /// Cost: building a tree for the triangles of b; for both, if b has more than a sixteenth as
    /// many as a.
    fn fuse<'py>(&self, py: Python<'py>, a: Body, b: Body) -> Answer<'py> {
        let fused = ask!(self, py, world => world.fuse(a.0, b.0)?)?;
        Ok(edit::fused(py, fused)?)
    }

    /// Joins boundary edges of a body that coincide within a tolerance; returns an Edited.
    ///
    /// A boundary edge belongs to exactly one triangle. Two coincide if their ends, one by one, are
    /// at most tolerance apart, in the unit of the positions, decided exactly. Of joined vertices
    /// the lowest number stays where it is, and the others go. Vertices alone are not welded, and
    /// never two corners of one triangle.
    ///
    /// Raises pliant.Error: NoSuchBody, BadDistance if tolerance is negative, infinite or NaN.
    /// Cost: O(m log m).
    fn weld<'py>(&self, py: Python<'py>, body: Body, tolerance: f64) -> Answer<'py> {
        let edited = search!(self, py, world => world.weld(body.0, tolerance))
            .map_err(|refused| refused.distance_is("tolerance"))?;
        Ok(edit::edited(py, edited)?)
    }

    /// Removes a body. Its number will not be used again.
    ///
    /// Raises pliant.Error: NoSuchBody.
    fn remove(&self, py: Python<'_>, body: Body) -> Result<()> {
        ask!(self, py, world => world.remove(body.0)?)
    }

    /// Numbers of all bodies, a list of int in the order in which they were added.
    fn bodies(&self, py: Python<'_>) -> Result<Vec<u32>> {
        ask!(self, py, world => world.bodies().map(|body| body.0).collect())
    }

    /// Gives a body a new shape: positions (n, 3), a row for each vertex.
    ///
    /// Float32 is widened in a float64 world. The array is copied once, whatever its layout, into
    /// memory that the world keeps. The copy is checked, and taken only if every coordinate is
    /// good. A motion of the body ends.
    ///
    /// Raises pliant.Error: NoSuchBody, BadArray, Precision for float64 in a float32 world,
    /// WrongLength. BadPosition for a coordinate that is NaN, infinite or above 3.4e38 in
    /// magnitude. OutsideLooseBox, and NeedsSubnormals in a thread that flushes subnormal numbers.
    ///
    /// Cost: O(n).
    fn set_positions(&self, py: Python<'_>, body: Body, positions: &Any<'_>) -> Result<()> {
        self.with_shape(py, body, positions, State::set_positions)
    }

    /// Gives several bodies new shapes at once: all of them, or none if one is refused.
    ///
    /// Takes a dict of positions (n, 3) by bodies, or pairs of a body and its positions, each as
    /// set_positions takes them. All threads of the world share the work.
    ///
    /// Raises pliant.Error: NoSuchBody, SameBody for a body that comes twice, and the other kinds
    /// of set_positions, of the first shape that is refused.
    ///
    /// Cost: O(n) in all vertices.
    fn set_positions_of(&self, py: Python<'_>, shapes: &Any<'_>) -> Result<()> {
        let items = match shapes.getattr_opt("items")? {
            Some(items) => items.call0()?,
            None => shapes.clone(),
        };
        let mut given = Vec::new();
        for item in items.try_iter()? {
            let (Body(body), positions): (Body, Any<'_>) = item?.extract()?;
            let read = Coordinates::read(&positions);
            given.push((body, read.map_err(|refused| refused.of_body(Some(body)))?));
        }
        let mut state = self.state.alone()?;
        let mut copies = Vec::with_capacity(given.len());
        for (body, given) in given {
            let copied = CopiedCoordinates::anew(given);
            copies.push((body, copied.map_err(|refused| refused.of_body(Some(body)))?));
        }
        let mut shapes = Vec::with_capacity(copies.len());
        for (body, copied) in &copies {
            shapes.push((*body, copied.get()?));
        }
        let state = &mut *state;
        py.detach(|| state.set_positions_of(&shapes))
    }

    /// Gives a body a new shape that write(positions) fills into an array.
    ///
    /// The array is (n, 3) of the world's dtype, filled with NaN: every row must be written. The
    /// world is in use until write returns. Prefer set_positions with an array of your own where
    /// speed matters: this form copies more.
    ///
    /// Raises pliant.Error: NoSuchBody, NotWritten for a row left NaN, and the other kinds of
    /// set_positions. The exceptions of write pass through. Cost: O(n).
    fn write_positions(&self, py: Python<'_>, body: Body, write: &Any<'_>) -> Result<()> {
        let body = body.0;
        // Until it is written, so that what is written is for the body that was asked about.
        let mut state = self.state.alone()?;
        let vertices = with_world!(&state.world, world => world.vertex_count(body))?;
        let dtype = dtype_of(py, state.world.precision());
        let empty = ((vertices, 3), f64::NAN, dtype);
        let array = py.import("numpy")?.call_method1("full", empty)?;
        write.call1((&array,))?;
        // Whoever wrote may have kept the array, and write again.
        let written = CopiedCoordinates::of(&array)?;
        let (state, written) = (&mut *state, written.get()?);
        py.detach(|| state.write_positions(body, written))
    }

    /// Begins a motion of a body: end (n, 3) is its shape at the end of the step.
    ///
    /// Vertices move on straight lines from the present shape at time 0 to end at time 1.
    /// Candidates and impacts look at the whole way; all other queries at the present shape. A body
    /// without a motion stands still.
    ///
    /// A motion replaces the one before. It ends with finish_motion, advance_motion, or the next
    /// shape or mesh of the body.
    ///
    /// Raises pliant.Error: NoSuchBody, BadArray, Precision, WrongLength, BadPosition,
    /// OutsideLooseBox, NeedsSubnormals, as set_positions. The body then keeps the motion that it
    /// has. Cost: O(n).
    fn set_motion(&self, py: Python<'_>, body: Body, end: &Any<'_>) -> Result<()> {
        self.with_shape(py, body, end, State::set_motion)
    }

    /// Ends all motions: bodies that have one take the shape at its end, without a copy.
    fn finish_motion(&self, py: Python<'_>) -> Result<()> {
        ask!(self, py, world => world.finish_motion())
    }

    /// Ends all motions on the way: bodies that have one take their shape at time t, 0 to 1.
    ///
    /// Each coordinate is x0 + t (x1 - x0), computed in float64, kept between x0 and x1, and
    /// rounded to the world's dtype. At t = 1 it is x1.
    ///
    /// Raises pliant.Error: BadTime if t is not from 0 to 1. Cost: O(n) for each body that moves.
    fn advance_motion(&self, py: Python<'_>, t: f64) -> Result<()> {
        ask!(self, py, world => world.advance_motion(t)?)
    }

    /// Shape at the end of a body's motion, a new array (n, 3) of the world's dtype or None.
    ///
    /// Raises pliant.Error: NoSuchBody.
    fn end_positions(&self, py: Python<'_>, body: Body) -> Result<Option<Owned>> {
        ask!(self, py, world => world.end_positions(body.0)?.map(Owned::from))
    }

    /// Gives every vertex of a body a group, (n,) of integers from 0 to 2^32 - 1.
    ///
    /// Two elements whose vertices are all of one group are no candidates, close pairs or impacts,
    /// in whichever bodies they are. Group 0, which all have at first, meets everything. For
    /// vertices that are pinned, or glued together. Groups stay until the body is given another
    /// mesh.
    ///
    /// Raises pliant.Error: NoSuchBody, BadArray, WrongLength. Cost: O(n).
    fn set_vertex_groups(&self, py: Python<'_>, body: Body, groups: &Any<'_>) -> Result<()> {
        let groups = arrays::numbers(groups, ["groups", "one for each vertex"]);
        let groups = groups.map_err(|refused| refused.of_body(Some(body.0)))?;
        ask!(self, py, world => world.set_vertex_groups(body.0, &groups)?)
    }

    /// Gives a body a rest shape, positions (n, 3), or takes it away with None.
    ///
    /// In a cloth all neighbours are close. With a rest shape, close pairs of one body are left out
    /// that are at most the distance apart in it, too. Pairs of two bodies and other questions do
    /// not look at it. It stays until the body is given another mesh. A vertex that is split from
    /// another rests in that one's place; another new vertex rests where it was put.
    ///
    /// Raises pliant.Error: NoSuchBody, BadArray, Precision, WrongLength, BadPosition,
    /// NeedsSubnormals. Cost: O(n).
    fn set_rest_positions(
        &self,
        py: Python<'_>,
        body: Body,
        positions: Option<&Any<'_>>,
    ) -> Result<()> {
        match positions {
            Some(positions) => self.with_shape(py, body, positions, State::set_rest_positions),
            None => ask!(self, py, world => world.set_rest_positions(body.0, None)?),
        }
    }

    /// Positions of a body in its rest shape, a new array (n, 3), or None if it has none.
    ///
    /// Raises pliant.Error: NoSuchBody.
    fn rest_positions(&self, py: Python<'_>, body: Body) -> Result<Option<Owned>> {
        ask!(self, py, world => {
            world.rest_positions(body.0)?.map(|rest| Owned::from(rest.to_vec()))
        })
    }

    /// Labels the faces of a body, (m,) integers: equal or neighbouring ones do not meet.
    ///
    /// They are for the parts of a character. Pairs of triangles of the body with such labels are
    /// left out of intersections, contacts, adjacent contacts and close pairs. Labels are
    /// neighbours if a vertex has triangles of both, or, if neighbours is given, as its rows (k, 2)
    /// say. A vertex or an edge has the labels of all its triangles. A pair of elements is left out
    /// if each label of one is equal or next to each of the other. A face labelled 2^32 - 1 is left
    /// out of nothing. None takes all labels away. Other questions look past labels: crossing
    /// edges, candidates, impacts, free steps, clearance.
    ///
    /// Labels stay until the body is given another mesh. A face that an edit adds has none.
    ///
    /// Raises pliant.Error: NoSuchBody, BadArray, WrongLength. Cost: O(n + m log m), and as much
    /// again for the next question after edits.
    #[pyo3(signature = (body, labels, neighbours=None))]
    fn set_labels(
        &self,
        py: Python<'_>,
        body: Body,
        labels: Option<&Any<'_>>,
        neighbours: Option<&Any<'_>>,
    ) -> Result<()> {
        let about = |refused: Refused| refused.of_body(Some(body.0));
        let of_faces = |given| arrays::numbers(given, ["labels", "one for each face"]);
        let labels = labels.map(of_faces).transpose().map_err(about)?;
        let pairs = neighbours
            .map(arrays::neighbours_of)
            .transpose()
            .map_err(about)?;
        let labels = labels.as_deref().map(|of_triangles| Labels {
            of_triangles,
            neighbours: pairs.as_deref(),
        });
        ask!(self, py, world => world.set_labels(body.0, labels)?)
    }

    /// Labels of a body's faces (m,), and neighbours (k, 2) or None; None without labels.
    ///
    /// Both are new arrays, uint32.
    ///
    /// Raises pliant.Error: NoSuchBody.
    fn labels(
        &self,
        py: Python<'_>,
        body: Body,
    ) -> Result<Option<(Column<u32>, Option<Rows<u32, 2>>)>> {
        ask!(self, py, world => world.labels(body.0)?.map(|labels| {
            let neighbours = labels.neighbours.map(|pairs| Rows(pairs.to_vec()));
            (Column(labels.of_triangles.to_vec()), neighbours)
        }))
    }

    /// Makes a body thick: every vertex is a ball of this radius, a float of at least 0.
    ///
    /// An element is as thick as the thickest of its vertices. Two elements of thickness s and t
    /// are close if they are at most distance + s + t apart. Candidates have boxes at most
    /// 2 radius + s + t apart. Steps free of contact keep min_distance + s + t, and clearance is
    /// what is left of distances. Measured distances stay what they are. Intersections and impacts
    /// are of bodies without thickness. A thick cloth needs set_rest_positions: its neighbours are
    /// close.
    ///
    /// It stays with the body. A vertex that is split from another is as thick as that. Other new
    /// vertices, and all of another mesh, are as thick as the thickest.
    ///
    /// Raises pliant.Error: NoSuchBody, BadThickness. Cost: O(n).
    fn set_thickness(&self, py: Python<'_>, body: Body, thickness: f64) -> Result<()> {
        ask!(self, py, world => world.set_thickness(body.0, thickness)?)
    }

    /// Gives every vertex of a body a thickness of its own, (n,) floats: see set_thickness.
    ///
    /// Raises pliant.Error: NoSuchBody, BadArray, WrongLength, BadThickness. Cost: O(n).
    fn set_vertex_thickness(&self, py: Python<'_>, body: Body, thickness: &Any<'_>) -> Result<()> {
        let all = arrays::floats(thickness, ["thickness", "one for each vertex"]);
        let all = all.map_err(|refused| refused.of_body(Some(body.0)))?;
        ask!(self, py, world => world.set_vertex_thickness(body.0, &all)?)
    }

    /// Thickness of every vertex of a body, a new array (n,) float64.
    ///
    /// Raises pliant.Error: NoSuchBody. Cost: O(n).
    fn thickness(&self, py: Python<'_>, body: Body) -> Result<Column<f64>> {
        ask!(self, py, world => Column(world.thickness(body.0)?))
    }

    /// Group of every vertex of a body, a new array (n,) uint32.
    ///
    /// Raises pliant.Error: NoSuchBody.
    fn vertex_groups(&self, py: Python<'_>, body: Body) -> Result<Column<u32>> {
        ask!(self, py, world => Column(world.vertex_groups(body.0)?))
    }

    /// Edges of a body, a new array (k, 2) uint32: two vertices each, the smaller first.
    ///
    /// Every edge is there once, whatever triangles share it. Its number is its row here.
    ///
    /// Edges are sorted when first asked for, here or by a query for edges. From then on an edge
    /// keeps its number while a triangle has it. An edit leaves the number of an edge that goes
    /// empty, 0xFFFFFFFF twice. New edges take the lowest empty numbers first.
    ///
    /// Raises pliant.Error: NoSuchBody. Cost: O(m) the first time and after rebuild, then the copy.
    fn edges(&self, py: Python<'_>, body: Body) -> Result<Rows<u32, 2>> {
        ask!(self, py, world => Rows(world.edges(body.0)?.to_vec()))
    }

    /// Decay of a body's tree, a float: work of recent queries over that of a fresh tree.
    ///
    /// It is estimated from pairs of nodes that queries for triangles looked at in the present
    /// shape. 1.0 before any query, or where little was looked at. World(mending=True) rebuilds
    /// trees as soon as it pays, part of the work at each new shape; not with
    /// partition="connectivity".
    ///
    /// Raises pliant.Error: NoSuchBody. Cost: O(1).
    fn tree_quality(&self, py: Python<'_>, body: Body) -> Result<f64> {
        ask!(self, py, world => world.tree_quality(body.0)?)
    }

    /// Builds the tree of a body anew on its present shape. Never needed for right answers.
    ///
    /// Worth it when the shape has become very different from the one the tree was built on: see
    /// tree_quality.
    ///
    /// Raises pliant.Error: NoSuchBody. Cost: that of add.
    fn rebuild(&self, py: Python<'_>, body: Body) -> Result<()> {
        ask!(self, py, world => world.rebuild(body.0)?)
    }

    /// Sets the collision filter of a body, two 32-bit masks: what it is and what it meets.
    ///
    /// Two bodies meet if the membership of each has a bit in common with the mask of the other. At
    /// first both are 0xFFFFFFFF. Selection.WORLD and EVERYTHING heed filters; between and within
    /// do not.
    ///
    /// Raises pliant.Error: NoSuchBody. OverflowError for a number outside 0 to 2^32 - 1.
    fn set_filter(
        &self,
        py: Python<'_>,
        body: Body,
        membership: Number,
        mask: Number,
    ) -> Result<()> {
        ask!(self, py, world => world.set_filter(body.0, membership.0, mask.0)?)
    }

    /// Collision filter of a body, a tuple (membership, mask): see set_filter.
    ///
    /// Raises pliant.Error: NoSuchBody.
    fn filter(&self, py: Python<'_>, body: Body) -> Result<(u32, u32)> {
        ask!(self, py, world => world.filter(body.0)?)
    }

    /// Puts a body into an environment, a number from 0 to 2^32 - 1; at first all are in 0.
    ///
    /// Bodies of different environments do not meet, whatever masks say. So thousands of small
    /// worlds fit into one, each in the same place, at the cost of far apart. Selection.WORLD and
    /// EVERYTHING heed environments; between and within do not.
    ///
    /// Raises pliant.Error: NoSuchBody. OverflowError for a number outside 0 to 2^32 - 1.
    fn set_environment(&self, py: Python<'_>, body: Body, environment: Number) -> Result<()> {
        ask!(self, py, world => world.set_environment(body.0, environment.0)?)
    }

    /// Environment of a body: see set_environment.
    ///
    /// Raises pliant.Error: NoSuchBody.
    fn environment(&self, py: Python<'_>, body: Body) -> Result<u32> {
        ask!(self, py, world => world.environment(body.0)?)
    }

    /// Keeps two bodies apart in queries of the whole world, or one body from itself.
    ///
    /// A body that is named twice does not meet itself. Selection.between and within do not heed
    /// it. unignore takes it back.
    ///
    /// Raises pliant.Error: NoSuchBody.
    fn ignore(&self, py: Python<'_>, a: Body, b: Body) -> Result<()> {
        ask!(self, py, world => world.ignore(a.0, b.0)?)
    }

    /// Lets two bodies meet again that ignore keeps apart.
    ///
    /// Raises pliant.Error: NoSuchBody.
    fn unignore(&self, py: Python<'_>, a: Body, b: Body) -> Result<()> {
        ask!(self, py, world => world.unignore(a.0, b.0)?)
    }

    /// Pairs of bodies that ignore keeps apart, a sorted list of (lower, higher) numbers.
    fn ignored(&self, py: Python<'_>) -> Result<Vec<(u32, u32)>> {
        ask!(self, py, world => world.ignored().into_iter().map(|[a, b]| (a.0, b.0)).collect())
    }

    /// Gives a body a fixed box that holds it in every pose to come; None takes it away.
    ///
    /// corners is (lower, upper), three numbers each, rounded to the world's dtype. The broad phase
    /// works with this box. It looks at the exact one only where loose boxes overlap. Worth it for
    /// many bodies that move on their spot. While it is there, a position outside it is refused.
    ///
    /// Raises pliant.Error: NoSuchBody, OutsideLooseBox if the body is not inside now. BadLooseBox
    /// for corners that are not finite or above 3.4e38 in magnitude, or a lower one above the
    /// upper.
    fn set_loose_box(&self, py: Python<'_>, body: Body, corners: Option<BoxCorners>) -> Result<()> {
        let corners = corners.map(|BoxCorners(corners)| corners);
        let state = &self.state;
        state.with(py, |state| Ok(state.set_loose_box(body.0, corners)?))
    }

    /// Loose box of a body, (lower, upper) corners as lists of three floats, or None.
    ///
    /// Raises pliant.Error: NoSuchBody.
    fn loose_box(&self, py: Python<'_>, body: Body) -> Result<Option<Corners>> {
        self.state.with(py, |state| Ok(state.loose_box(body.0)?))
    }

    /// Number of triangles of a body, numbers left empty by an edit included.
    ///
    /// Raises pliant.Error: NoSuchBody. Cost: O(1).
    fn triangle_count(&self, py: Python<'_>, body: Body) -> Result<usize> {
        ask!(self, py, world => world.triangle_count(body.0)?)
    }

    /// Number of vertices of a body, empty ones included; the rows of its positions.
    ///
    /// Raises pliant.Error: NoSuchBody. Cost: O(1).
    fn vertex_count(&self, py: Python<'_>, body: Body) -> Result<usize> {
        ask!(self, py, world => world.vertex_count(body.0)?)
    }

    /// Size of a body's tree, a TreeShape: depth, nodes, leaves.
    ///
    /// Raises pliant.Error: NoSuchBody.
    fn tree_shape<'py>(&self, py: Python<'py>, body: Body) -> Answer<'py> {
        let shape = ask!(self, py, world => world.tree_shape(body.0)?)?;
        Ok(named!(py, "TreeShape" of shape: depth, nodes, leaves)?)
    }

    /// Part of each triangle when a body's tree is cut at a level, (m,) uint32.
    ///
    /// The part is the node of that level, or the leaf above it. Parts are numbered from 0 in tree
    /// order. Level 0 is the root, and all levels from TreeShape.depth on are the leaves. Triangles
    /// that an edit added are in trees of their own, with parts behind the others. An empty number
    /// has 0xFFFFFFFF.
    ///
    /// Raises pliant.Error: NoSuchBody. Cost: O(m).
    fn tree_cut(&self, py: Python<'_>, body: Body, level: Number) -> Result<Column<u32>> {
        ask!(self, py, world => Column(world.tree_cut(body.0, level.0)?))
    }

    /// Faces of a body as added and edited, a new array (m, 3) uint32.
    ///
    /// A number that an edit left empty is 0xFFFFFFFF three times.
    ///
    /// Raises pliant.Error: NoSuchBody.
    fn triangles(&self, py: Python<'_>, body: Body) -> Result<Rows<u32, 3>> {
        ask!(self, py, world => Rows(world.triangles(body.0)?.to_vec()))
    }

    /// Present shape of a body, a new array (n, 3) of the world's dtype.
    ///
    /// Rows of vertices that an edit left empty are NaN.
    ///
    /// Raises pliant.Error: NoSuchBody.
    fn positions(&self, py: Python<'_>, body: Body) -> Result<Owned> {
        ask!(self, py, world => Owned::from(world.positions(body.0)?))
    }

    /// Boxes of a level of a body's tree, a TreeBoxes: lower, upper, valid.
    ///
    /// lower and upper are (k, 3), of the world's dtype, valid is (k,) bool. A row is a part of
    /// tree_cut, the root being level 0. valid says whether the tree holds the box for the present
    /// shape, or it is stale. Makes no box, and reads none.
    ///
    /// Raises pliant.Error: NoSuchBody. Cost: O(m).
    fn tree_boxes<'py>(&self, py: Python<'py>, body: Body, level: Number) -> Answer<'py> {
        let (lower, upper, valid) = ask!(self, py, world => {
            let boxes = world.tree_boxes(body.0, level.0)?.into_iter();
            let row = |node: NodeBox<_>| (node.lower, node.upper, node.valid);
            let (lower, upper, valid): (Vec<_>, Vec<_>, Vec<_>) = boxes.map(row).collect();
            (Owned::from(lower), Owned::from(upper), Column(valid))
        })?;
        Ok(named!(py, "TreeBoxes": lower = lower, upper = upper, valid = valid)?)
    }

    /// Order in which queries read the vertices of a body, (n,) uint32.
    ///
    /// Queries are faster on a mesh whose vertices come in this order. To renumber, give
    /// positions[order], and faces with the new numbers.
    ///
    /// Raises pliant.Error: NoSuchBody.
    fn vertex_order(&self, py: Python<'_>, body: Body) -> Result<Column<u32>> {
        ask!(self, py, world => Column(world.vertex_order(body.0)?.to_vec()))
    }

    /// Asks which triangles intersect: a Query, all() of which is (k, 4) uint32, sorted.
    ///
    /// A row is body, triangle, body, triangle. Triangles are closed sets: touching counts, and so
    /// does coplanar overlap. A degenerate triangle is the segment or point that it is. The
    /// decision is that of exact arithmetic on the coordinates given.
    ///
    /// Within a body, triangles that share a vertex are left out. Surfaces only: a body wholly
    /// inside another meets none of its triangles. The default selection leaves out each body with
    /// itself: see Selection.EVERYTHING.
    ///
    /// Nothing is computed until the query is asked, which raises pliant.Error: NoSuchBody,
    /// SameBody, TooManyHits, Busy. Cost: see Query.all.
    #[pyo3(signature = (of=Selection::WORLD))]
    fn intersections(&self, of: Selection) -> Query {
        Query::new(&self.state, of, Pairs::Intersections)
    }

    /// Asks which triangles intersect, and how: a ContactQuery, all() of which is a Contacts.
    ///
    /// Triangles are found as by intersections. Each pair is crossing, overlapping in one plane, or
    /// only touching, decided exactly: see ContactKind. only leaves out all other kinds. Where
    /// surfaces lie on each other, along a cut or in a stack, ContactKind.CROSSING finds what goes
    /// through.
    ///
    ///     query = world.contacts(Selection.WORLD, only=ContactKind.CROSSING)
    ///     pairs, kind = query.all()           # (k, 4) uint32, (k,) uint8
    ///
    /// Nothing is computed until the query is asked, which raises pliant.Error: NoSuchBody,
    /// SameBody, TooManyHits, Busy. A value of only that is no ContactKind raises ValueError here.
    ///
    /// Cost: that of intersections. Pairs whose kind rounded signs leave open take their exact
    /// signs once more.
    #[pyo3(signature = (of=Selection::WORLD, *, only=None))]
    fn contacts(&self, of: Selection, only: Option<Only>) -> ContactQuery {
        let adjacent = false;
        ContactQuery::new(&self.state, of, Contacts { adjacent, only })
    }

    /// Asks which triangles that share a vertex meet beyond it, and how: a ContactQuery.
    ///
    /// intersections leaves out all pairs of a body that have a vertex in common. This asks about
    /// these pairs alone: whether one triangle goes through the other somewhere else, lies folded
    /// onto it, or is there twice. The two together say whether a body meets itself.
    ///
    /// CROSSING: one vertex in common, and after every small enough move of the vertices they still
    /// meet beyond it. OVERLAPPING: in one plane with an area in common, or all three vertices in
    /// common. TOUCHING: anything else. A degenerate triangle is the segment or point that it is.
    ///
    ///     pairs, kind = world.adjacent_intersections().all()     # (k, 4) uint32, (k,) uint8
    ///
    /// Each body meets itself alone, so the answer is empty for Selection.WORLD and between.
    ///
    /// Nothing is computed until the query is asked, which raises pliant.Error: NoSuchBody,
    /// SameBody, TooManyHits, Busy. A value of only that is no ContactKind raises ValueError here.
    ///
    /// Cost: O(m), half of a query for intersections within a folded body, as much as one within a
    /// flat body. Where d triangles at a vertex are folded, O(d^2) pairs are decided.
    #[pyo3(signature = (of=Selection::EVERYTHING, *, only=None))]
    fn adjacent_intersections(&self, of: Selection, only: Option<Only>) -> ContactQuery {
        let adjacent = true;
        ContactQuery::new(&self.state, of, Contacts { adjacent, only })
    }

    /// Asks which edges cross which triangles: a Query of rows (k, 4) uint32.
    ///
    /// A row is body, edge, body, triangle; World.edges numbers edges. An edge crosses a triangle
    /// if the open edge meets the open triangle, and not in its plane. That is decided exactly, and
    /// stays after every small enough move. Within a body the edge's triangles may share a vertex
    /// with the other. Where surfaces go through each other, curves of intersection pass from one
    /// crossing edge to the next.
    ///
    ///     rows = world.crossing_edges().all()
    ///     distinct = len(np.unique(rows[:, :2], axis=0))      # edges that cross anything
    ///
    /// Nothing is computed until the query is asked, which raises pliant.Error: NoSuchBody,
    /// SameBody, TooManyHits, Busy.
    ///
    /// Cost: that of intersections and, within bodies, of adjacent_intersections, and some hundred
    /// nanoseconds for each of their hits.
    #[pyo3(signature = (of=Selection::EVERYTHING))]
    fn crossing_edges(&self, of: Selection) -> Query {
        Query::new(&self.state, of, Pairs::CrossingEdges)
    }

    /// Asks which vertices are near which triangles: a Query of rows (k, 4) uint32.
    ///
    /// all() is sorted; a row is body, vertex, body, triangle. For solvers that then measure, or
    /// find when they touch; edge_edge_candidates is the other half. With a motion, the whole way
    /// to its end counts.
    ///
    /// The box of an element is the hull of its corners, at both ends of a motion. A vertex and a
    /// triangle are a candidate if on every axis the gap of their boxes is at most 2 radius,
    /// decided exactly. So radius = distance / 2 misses nothing that comes within distance. Corners
    /// of the triangle itself are left out, and vertices without triangles.
    ///
    /// Of two bodies, vertices of either and triangles of the other are looked at. Filters and
    /// set_vertex_groups keep elements apart.
    ///
    /// Nothing is computed until the query is asked, which raises pliant.Error: NoSuchBody,
    /// SameBody, TooManyHits, Busy. BadMargin if radius is negative, infinite or NaN. Cost: see
    /// Query.all.
    fn vertex_triangle_candidates(&self, of: Selection, radius: f64) -> Query {
        Query::new(&self.state, of, Pairs::VertexTriangleCandidates(radius))
    }

    /// Asks which edges are near which edges: a Query of rows (k, 4) uint32.
    ///
    /// all() is sorted; a row is body, edge, body, edge. The smaller (body, edge) comes first, or
    /// the body that the selection names first. Edges are numbered by rows of edges(body). Edges
    /// with an end in common are left out. All else is as for vertex_triangle_candidates, radius
    /// included.
    ///
    /// Nothing is computed until the query is asked, which raises pliant.Error: NoSuchBody,
    /// SameBody, TooManyHits, Busy. BadMargin if radius is negative, infinite or NaN. Cost: see
    /// Query.all.
    fn edge_edge_candidates(&self, of: Selection, radius: f64) -> Query {
        Query::new(&self.state, of, Pairs::EdgeEdgeCandidates(radius))
    }

    /// Asks which vertices and triangles are at most distance apart: a CloseQuery.
    ///
    /// Its all() is a ClosePairs: distances, directions and closest points. It is what penalty,
    /// barrier and position-based solvers push apart; close_edge_edge_pairs is the other half.
    ///
    /// Whether a pair is that close is decided exactly, in the present shape. A motion is not
    /// looked at. The query looks at the pairs of vertex_triangle_candidates: corners of the
    /// triangle itself are left out, filters and vertex groups count.
    ///
    /// Nothing is computed until the query is asked, which raises pliant.Error: NoSuchBody,
    /// SameBody, TooManyHits, Busy. BadDistance if distance is negative, infinite or NaN. Cost: see
    /// CloseQuery.all.
    fn close_vertex_triangle_pairs(&self, of: Selection, distance: f64) -> CloseQuery {
        CloseQuery::new(&self.state, of, Close::VertexTriangle(distance))
    }

    /// Asks which edges are at most distance apart: a CloseQuery.
    ///
    /// Its all() is a ClosePairs. Edges are numbered by rows of edges(body). Edges with an end in
    /// common are left out. All else is as for close_vertex_triangle_pairs.
    ///
    /// Nothing is computed until the query is asked, which raises pliant.Error: NoSuchBody,
    /// SameBody, TooManyHits, Busy. BadDistance if distance is negative, infinite or NaN. Cost: see
    /// CloseQuery.all.
    fn close_edge_edge_pairs(&self, of: Selection, distance: f64) -> CloseQuery {
        CloseQuery::new(&self.state, of, Close::EdgeEdge(distance))
    }

    /// Asks which triangles are at most distance apart: a CloseQuery.
    ///
    /// Its all() is a ClosePairs. For bodies that should keep a distance from each other. Triangles
    /// that intersect are close, at distance 0. Within a body, triangles that share a vertex are
    /// left out. Decided exactly, in the present shape.
    ///
    /// Nothing is computed until the query is asked, which raises pliant.Error: NoSuchBody,
    /// SameBody, TooManyHits, Busy. BadDistance if distance is negative, infinite or NaN. Cost: see
    /// CloseQuery.all.
    fn close_triangle_pairs(&self, of: Selection, distance: f64) -> CloseQuery {
        CloseQuery::new(&self.state, of, Close::Triangles(distance))
    }

    /// Distance of the surfaces of two bodies, a ClosePair of their closest triangles.
    ///
    /// None if they are further apart than cut_off, which may be infinite. The distance is 0
    /// exactly if any of their triangles intersect. A body wholly inside another is as far from it
    /// as its surface is. Filters and motions are not looked at.
    ///
    /// Raises pliant.Error: NoSuchBody, SameBody if a is b, BadDistance if cut_off is negative or
    /// NaN.
    ///
    /// Cost: refits of intersections, and the triangles whose boxes are nearer than the bodies are.
    /// The closest triangles of the last time are measured first.
    #[pyo3(signature = (a, b, cut_off=f64::INFINITY))]
    fn distance<'py>(&self, py: Python<'py>, a: Body, b: Body, cut_off: f64) -> Maybe<'py> {
        let found = search!(self, py, world => world.distance(a.0, b.0, cut_off))
            .map_err(|refused| refused.distance_is("cut_off"))?;
        Ok(found.map(|pair| pair.one(py)).transpose()?)
    }

    /// Distance of a body to the nearest other that it may meet, a ClosePair.
    ///
    /// Its pair names the other body. Filters say whom it may meet. None if no other is within
    /// cut_off, which may be infinite.
    ///
    /// Raises pliant.Error: NoSuchBody, BadDistance if cut_off is negative or NaN.
    ///
    /// Cost: that of distance, for the bodies whose boxes are nearer than the nearest is.
    #[pyo3(signature = (body, cut_off=f64::INFINITY))]
    fn nearest_body<'py>(&self, py: Python<'py>, body: Body, cut_off: f64) -> Maybe<'py> {
        let found = search!(self, py, world => world.nearest_body(body.0, cut_off))
            .map_err(|refused| refused.distance_is("cut_off"))?;
        Ok(found.map(|pair| pair.one(py)).transpose()?)
    }

    /// Asks which vertices and triangles meet during the motion, and when: an ImpactQuery.
    ///
    /// Its all() is an Impacts: pairs, low and high. Continuous collision detection;
    /// edge_edge_impacts is the other half. Vertices move on straight lines, from the present shape
    /// at time 0 to that of set_motion at time 1. A body without a motion stands still.
    ///
    /// Whether a pair meets, as closed sets, is decided exactly. It is apart from time 0 to low,
    /// both included, and meets after low and by high. high - low is at most width. Both are 0 if
    /// it meets at the start. The query looks at the pairs of vertex_triangle_candidates: corners
    /// of the triangle itself are left out, filters and vertex groups count.
    ///
    /// Nothing is computed until the query is asked, which raises pliant.Error: NoSuchBody,
    /// SameBody, TooManyHits, Busy. BadWidth if width is negative, infinite or NaN. Cost: see
    /// ImpactQuery.all; first() is much faster.
    #[pyo3(signature = (of, width=1e-6))]
    fn vertex_triangle_impacts(&self, of: Selection, width: f64) -> ImpactQuery {
        ImpactQuery::new(&self.state, of, Impacts::VertexTriangle(width))
    }

    /// Asks which edges meet during the motion, and when: an ImpactQuery.
    ///
    /// Its all() is an Impacts. Edges are numbered by rows of edges(body). Edges with an end in
    /// common are left out. All else is as for vertex_triangle_impacts, width included.
    ///
    /// Nothing is computed until the query is asked, which raises pliant.Error: NoSuchBody,
    /// SameBody, TooManyHits, Busy. BadWidth if width is negative, infinite or NaN.
    #[pyo3(signature = (of, width=1e-6))]
    fn edge_edge_impacts(&self, of: Selection, width: f64) -> ImpactQuery {
        ImpactQuery::new(&self.state, of, Impacts::EdgeEdge(width))
    }

    /// First contact of the motion, an Impact of either kind, or None if nothing meets.
    ///
    /// It has the least exact time of all vertex_triangle_impacts and edge_edge_impacts. Much
    /// faster than either list. high - low is at most width.
    ///
    /// Raises pliant.Error: NoSuchBody, SameBody, BadWidth if width is negative, infinite or NaN.
    #[pyo3(signature = (of, width=1e-6))]
    fn first_impact<'py>(&self, py: Python<'py>, of: Selection, width: f64) -> Maybe<'py> {
        let found = search!(self, py, world => world.first_impact(of.0, width))?;
        let impact = found.map(|impact| match impact {
            Impact::VertexTriangle(impact) => impact.one(py),
            Impact::EdgeEdge(impact) => impact.one(py),
        });
        Ok(impact.transpose()?)
    }

    /// How far everything may go without collision: FreeStep(t, begins_in_contact, moves).
    ///
    /// t, from 0 to 1, is the time of collision_free_step, to call advance_motion with. Up to t,
    /// everything stays further apart than min_distance, in the unit of the positions. It promises
    /// nothing for pairs in contact at the start:
    ///
    /// - surfaces that are through each other meet on every way out, so t may be small for no other
    ///   reason
    /// - elements that touch may go through each other, and nearer ones than min_distance may come
    ///   nearer
    ///
    /// begins_in_contact is the first such pair in the present shape, or None. It is a Pair if
    /// triangles intersect, unless one group has all six vertices. Else it is a VertexTriangle or
    /// an EdgeEdge at most min_distance apart. A mesh with edges shorter than min_distance is
    /// always that near to itself. Triangles that share a vertex and are through each other beyond
    /// it are not found.
    ///
    /// moves is False if no selected body has a motion; t is then 1.
    ///
    /// Raises pliant.Error: NoSuchBody, SameBody, BadDistance if min_distance is negative, infinite
    /// or NaN.
    ///
    /// Cost: collision_free_step, both queries for close pairs within min_distance, and the first
    /// intersection.
    #[pyo3(signature = (of, min_distance=0.0))]
    fn free_step<'py>(&self, py: Python<'py>, of: Selection, min_distance: f64) -> Answer<'py> {
        let step = search!(self, py, world => world.free_step(of.0, min_distance))
            .map_err(|refused| refused.distance_is("min_distance"))?;
        let pair = step.begins_in_contact.map(|pair| match pair {
            InContact::Triangles(pair) => pair.one(py),
            InContact::VertexTriangle(pair) => pair.one(py),
            InContact::EdgeEdge(pair) => pair.one(py),
        });
        let pair = pair.transpose()?;
        Ok(named!(py, "FreeStep": t = step.t, begins_in_contact = pair, moves = step.moves)?)
    }

    /// Time t from 0 to 1 up to which everything stays further apart than min_distance.
    ///
    /// For advance_motion. On straight ways to the shape that this makes, rounded as it is, no
    /// vertex meets a triangle and no edge another. That is proven. 1 means the whole motion, and
    /// also that nothing moves.
    ///
    /// t is at least 0.9 of the largest such time where rounding leaves room. Pairs that touch at
    /// the start do not count. Pairs within min_distance at the start are kept from contact alone.
    /// A start that intersects is not told: see free_step.
    ///
    /// Raises pliant.Error: NoSuchBody, SameBody, BadDistance if min_distance is negative, infinite
    /// or NaN.
    #[pyo3(signature = (of, min_distance=0.0))]
    fn collision_free_step(&self, py: Python<'_>, of: Selection, min_distance: f64) -> Result<f64> {
        search!(self, py, world => world.collision_free_step(of.0, min_distance))
            .map_err(|refused| refused.distance_is("min_distance"))
    }

    /// How far each vertex may move before anything can touch: dict of body to (n,) float64.
    ///
    /// It is half the least distance of the elements that the vertex is a corner of, at most
    /// cut_off / 2. Elements are the pairs of close_vertex_triangle_pairs and
    /// close_edge_edge_pairs. It is rounded down, by at most 1e-6 of itself and 1e-323. If every
    /// vertex moves less than that, in whatever direction, none of these pairs touches.
    ///
    /// Raises pliant.Error: NoSuchBody, SameBody, BadDistance if cut_off is negative, infinite or
    /// NaN.
    ///
    /// Cost: both queries for close pairs within cut_off.
    #[pyo3(signature = (of, cut_off))]
    fn clearance<'py>(
        &self,
        py: Python<'py>,
        of: Selection,
        cut_off: f64,
    ) -> Result<Bound<'py, PyDict>> {
        let clearances = search!(self, py, world => world.clearance(of.0, cut_off))
            .map_err(|refused| refused.distance_is("cut_off"))?;
        let of_bodies = PyDict::new(py);
        for (body, clearance) in clearances {
            of_bodies.set_item(body.0, Column(clearance))?;
        }
        Ok(of_bodies)
    }

    /// Edges at which a body is not a closed surface, a Watertight: open, turned, doubled.
    ///
    /// A closed body has an inside. Closed is said of the mesh, not of its shape: a body stays
    /// closed however it moves. Seams are open until they are welded: see weld.
    ///
    /// Raises pliant.Error: NoSuchBody. Cost: O(m log m) the first time after the mesh has changed.
    fn watertight<'py>(&self, py: Python<'py>, body: Body) -> Answer<'py> {
        let found = ask!(self, py, world => world.watertight(body.0)?)?;
        Ok(inside::watertight(py, found)?)
    }

    /// Whether points are inside a closed body, outside, or on its surface: a Located.
    ///
    /// points are (k, 3) float32 or float64; float32 is widened in a float64 world. Decided
    /// exactly, for the points and the shape as given: no point is undecided, however near to the
    /// surface. Right for bodies that cross themselves. Filters and motions are not looked at.
    ///
    /// A surface winds round a point some whole number of times. That is 1 inside a body whose
    /// triangles are turned outward. It is 2 where the body overlaps itself, and -1 where it is
    /// turned inside out. rule says which numbers are inside:
    ///
    /// - "nonzero": all but 0
    /// - "positive": those above 0
    /// - "parity": where a ray crosses the surface an odd number of times, whichever way triangles
    ///   are turned; not what the body covers twice
    ///
    ///     found = world.points_inside(points, body)
    ///     inside = points[found.is_inside]            # found.sides: 1 inside, 0 on, -1 outside
    ///
    /// Raises pliant.Error: NoSuchBody, BadArray, Precision for float64 in a float32 world.
    /// NotClosed for a body that has no inside, as watertight says: is_closed, or for "parity"
    /// is_even. BadPoint for a coordinate that is NaN, infinite or above 3.4e38 in magnitude.
    /// BadOption for another rule.
    ///
    /// Cost: refitting the body, in whole if points are many. For each point the nodes and
    /// triangles on the way straight to the nearest side of the body's box.
    #[pyo3(signature = (points, body, rule="nonzero"))]
    fn points_inside<'py>(
        &self,
        py: Python<'py>,
        points: &Any<'py>,
        body: Body,
        rule: &str,
    ) -> Answer<'py> {
        let rule = inside::rule(rule)?;
        let found = search_at!(self, py, points, (world, points) => {
            world.points_inside(points, body.0, rule)
        })?;
        Ok(inside::located(py, &found, &[found.len()])?)
    }

    /// Whether each vertex of body a is inside body b, a closed one: a Located of (n,) arrays.
    ///
    /// As points_inside says it of their positions, with the same rules. Empty vertex numbers are
    /// outside. With frames, shapes of bodies as Query.of_frames takes them, arrays are (frames, n)
    /// and threads share the frames.
    ///
    /// Raises pliant.Error: NoSuchBody, SameBody if a is b, NotClosed if b has no inside, BadOption
    /// for another rule. With frames also as Query.of_frames.
    #[pyo3(signature = (a, b, rule="nonzero", *, frames=None, threads=Threads::Count(1)),
        text_signature = "($self, a, b, rule=\"nonzero\", *, frames=None, threads=1)")]
    fn inside<'py>(
        &self,
        py: Python<'py>,
        a: Body,
        b: Body,
        rule: &str,
        frames: Option<&Any<'py>>,
        threads: Threads,
    ) -> Answer<'py> {
        let rule = inside::rule(rule)?;
        let Some(frames) = frames else {
            let found = search!(self, py, world => world.inside(a.0, b.0, rule))?;
            return Ok(inside::located(py, &found, &[found.len()])?);
        };
        let frames = Frames::of(&self.state, frames, threads)?;
        let found = each_frame(py, &self.state, &frames, |state, question| {
            with_world!(&mut state.world, world => {
                Ok(world.interruptible(question).inside(a.0, b.0, rule)?)
            })
        })?;
        let vertices = self.state.with(py, |state| {
            Ok(with_world!(&state.world, world => world.vertex_count(a.0))?)
        })?;
        let shape = [frames.count(), vertices];
        Ok(inside::located(py, &found.concat(), &shape)?)
    }

    /// Components of bodies that lie inside other bodies: a Containment.
    ///
    /// These meet no triangle, so that intersections does not find them. A component, as components
    /// numbers them, lies inside a closed body if three things hold:
    ///
    /// - none of its triangles crosses or overlaps one of the body's
    /// - every vertex of it is inside the body or on it
    /// - one vertex is inside
    ///
    /// Inside is said by the rule "nonzero": see points_inside. Selection.WORLD and EVERYTHING heed
    /// filters; between(a, b) looks for either in the other. A body is never inside itself. Bodies
    /// that are not closed are listed, as nothing is said of their inside.
    ///
    /// Raises pliant.Error: NoSuchBody, SameBody.
    ///
    /// Cost: for bodies whose boxes overlap a ray for each component. Where it begins inside, a
    /// query for the contacts of both.
    #[pyo3(signature = (of=Selection::WORLD))]
    fn contained<'py>(&self, py: Python<'py>, of: Selection) -> Answer<'py> {
        let found = search!(self, py, world => world.contained(of.0))?;
        Ok(inside::containment(py, &found)?)
    }

    /// Closest point of a body, or of all bodies, for each of some points: a ClosestPoints.
    ///
    /// points are (k, 3) float32 or float64; float32 is widened in a float64 world. body=None asks
    /// of all bodies. Points further than cut_off from it, which may be infinite, have found False;
    /// this is decided exactly. Distances are at least 0, and bodies need not be closed. Filters
    /// and motions are not looked at.
    ///
    /// Raises pliant.Error: NoSuchBody, BadArray, Precision for float64 in a float32 world.
    /// BadPoint for a coordinate that is NaN, infinite or above 3.4e38 in magnitude. BadDistance if
    /// cut_off is negative or NaN.
    ///
    /// Cost: refitting the body, in whole if points are many. For each point the nodes and
    /// triangles that are about as near as the nearest one.
    #[pyo3(signature = (points, body=None, cut_off=f64::INFINITY))]
    fn closest_points<'py>(
        &self,
        py: Python<'py>,
        points: &Any<'py>,
        body: Option<Body>,
        cut_off: f64,
    ) -> Answer<'py> {
        let of = body.map(|body| body.0);
        let found = search_at!(self, py, points, (world, points) => {
            world.closest_points(points, of, cut_off)
        });
        let found = found.map_err(|refused| refused.distance_is("cut_off"))?;
        Ok(inside::closest(py, &found)?)
    }

    /// Closest point of a closed body for each of some points, with signed distances.
    ///
    /// Returns a ClosestPoints, as closest_points does, but distances are negative for points
    /// inside. The sign is that of points_inside with the rule "nonzero", which is exact. No
    /// normals are asked.
    ///
    /// Raises pliant.Error: NotClosed if the body has no inside, and the kinds of closest_points:
    /// NoSuchBody, BadArray, Precision, BadPoint, BadDistance.
    #[pyo3(signature = (points, body, cut_off=f64::INFINITY))]
    fn signed_closest_points<'py>(
        &self,
        py: Python<'py>,
        points: &Any<'py>,
        body: Body,
        cut_off: f64,
    ) -> Answer<'py> {
        let found = search_at!(self, py, points, (world, points) => {
            world.signed_closest_points(points, body.0, cut_off)
        });
        let found = found.map_err(|refused| refused.distance_is("cut_off"))?;
        Ok(inside::closest(py, &found)?)
    }

    /// How deep body a reaches into body b, a closed one, in their present shapes: a Depth.
    ///
    /// It has the depth of every vertex of a, and a bracket for the deepest point of its surface.
    /// Inside is said by the rule "nonzero": see points_inside. Body a need not be closed. Filters
    /// and motions are not looked at.
    ///
    /// Raises pliant.Error: NoSuchBody, SameBody if a is b, NotClosed if b has no inside.
    ///
    /// Cost: where all vertices are, closest points of the ones inside, and a query for the
    /// intersections of both.
    fn depth<'py>(&self, py: Python<'py>, a: Body, b: Body) -> Answer<'py> {
        let found = search!(self, py, world => world.depth(a.0, b.0))?;
        Ok(inside::depth(py, found)?)
    }

    /// Counters of the work of the last query, Query.prepare included: a Statistics.
    fn statistics<'py>(&self, py: Python<'py>) -> Answer<'py> {
        let statistics = ask!(self, py, world => *world.statistics())?;
        Ok(named!(py, "Statistics" of statistics:
            body_pairs, boxes_bottom_up, boxes_top_down, triangle_boxes, node_pairs,
            candidate_pairs, scalar_decisions, exact_decisions, pairs)?)
    }

    /// Bytes of memory that this world holds: bodies, trees, boxes, lists kept for queries.
    ///
    /// Reserved memory counts, and so do the copy that set_positions keeps and the hits that
    /// all(sort=False) keeps. Arrays that were handed out, threads and a query under way do not.
    fn memory_usage(&self, py: Python<'_>) -> Result<usize> {
        let room = self.state.alone()?.room(py);
        ask!(self, py, world => world.memory_usage() + room)
    }

    /// Checks every invariant of every tree, for tests and bug reports. Should never fail.
    ///
    /// Raises pliant.Error: Broken if an invariant does not hold. Cost: O(m) for each level of a
    /// tree.
    fn validate(&self, py: Python<'_>) -> Result<()> {
        ask!(self, py, world => world.validate().map_err(|what| Refused::new("Broken", what))?)
    }

    fn __repr__(&self, py: Python<'_>) -> Result<String> {
        self.state.with(py, |state| {
            let bodies = with_world!(&state.world, world => world.bodies().len());
            let bodies = counted(bodies, ["body", "bodies"]);
            Ok(match state.precision() {
                None => "<pliant.World, no body yet>".to_owned(),
                Some(Precision::F32) => format!("<pliant.World of float32, {bodies}>"),
                Some(Precision::F64) => format!("<pliant.World of float64, {bodies}>"),
            })
        })
    }
}

impl World {
    /// Copies a shape of a body under the interpreter lock, and gives it to `take` without.
    fn with_shape(
        &self,
        py: Python<'_>,
        Body(body): Body,
        given: &Any<'_>,
        take: fn(&mut State, BodyId, Positions<'_>) -> Result<()>,
    ) -> Result<()> {
        let given = Coordinates::read(given).map_err(|refused| refused.of_body(Some(body)))?;
        let mut state = self.state.alone()?;
        let copied = state.copy(body, &given)?;
        let (state, copied) = (&mut *state, copied.get()?);
        py.detach(|| take(state, body, copied))
    }
}

/// Copies the mesh that was given for a body, or for a new one: two arrays, or one object.
fn mesh_of<'py>(
    faces: &Any<'py>,
    positions: Option<&Any<'py>>,
    body: Option<BodyId>,
) -> Result<CopiedMesh<'py>> {
    let [faces, positions] = match positions {
        Some(positions) => [faces.clone(), positions.clone()],
        None => arrays::parts_of_mesh(faces)?,
    };
    CopiedMesh::of(&faces, &positions, |refused| refused.of_body(body))
}

/// The type that numpy has for numbers of a precision.
fn dtype_of(py: Python<'_>, precision: Precision) -> Bound<'_, PyAny> {
    let dtype = match precision {
        Precision::F32 => numpy::dtype::<f32>(py),
        Precision::F64 => numpy::dtype::<f64>(py),
    };
    dtype.into_any()
}
