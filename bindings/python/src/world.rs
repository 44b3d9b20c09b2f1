//! `World` as Python sees it: the Rust library's, method by method.

use crate::answers::{Any, Column, Owned, Rows, counted, named};
use crate::arrays::{self, Coordinates, CopiedCoordinates, CopiedMesh};
use crate::edit::{self, AnyEdit, Edit};
use crate::error::{Refused, Result};
use crate::options::Keywords;
use crate::pickled::{self, Written};
use crate::queries::Hit;
use crate::queries::close::{Close, CloseQuery};
use crate::queries::contacts::{ContactQuery, Contacts, Only};
use crate::queries::impacts::{ImpactQuery, Impacts};
use crate::queries::pairs::{Pairs, Query};
use crate::selection::{Body, Selection};
use crate::signals::interruptible;
use crate::state::{Corners, Shared, State};
use pliant::{BodyId, Impact, InContact, NodeBox};
use pliant_check::with_world;
use pliant_io::{Positions, Precision};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

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
    state: Shared,
    keywords: Keywords,
}

/// What most methods do: work with the world, of either precision, without the interpreter lock.
macro_rules! ask {
    ($this:ident, $py:ident, $world:ident => $work:expr) => {
        $this.state.with($py, |state| {
            with_world!(&mut state.world, $world => Ok($work))
        })
    };
}

/// The same of what takes long, and ends early if a signal handler raises something.
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

/// An object of Python's, or why there is none.
type Answer<'py> = Result<Any<'py>>;

/// The same, or nothing.
type Maybe<'py> = Result<Option<Any<'py>>>;

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

    /// The same bodies under the same numbers, in their shapes of now, with filters, ignored pairs, loose boxes and options. Boxes are
    /// made anew; what is done to the one world is nothing to the other.
    fn __copy__(&self, py: Python<'_>) -> Result<Self> {
        let state = Shared::new(self.state.with(py, |state| Ok(state.another()))?);
        let keywords = self.keywords.clone();
        Ok(Self { state, keywords })
    }

    /// As copy: a world holds nothing that it could share.
    fn __deepcopy__(&self, py: Python<'_>, _memo: &Any<'_>) -> Result<Self> {
        self.__copy__(py)
    }

    /// For pickle, which then needs nothing of copyreg: what makes a world with these options, and what it is to become.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let (py, this) = (slf.py(), slf.get());
        let options = this.keywords.clone().into_pyobject(py)?;
        let partial = py.import("functools")?.getattr("partial")?;
        let make = partial.call((slf.get_type(),), Some(&options))?;
        let written = this.state.with(py, |state| pickled::Copied::of(state))?;
        (make, PyTuple::empty(py), written).into_pyobject(py)
    }

    /// What pickle wrote down becomes of a world that never had a body. Bodies keep their numbers, and those that were used are not
    /// used again. Trees are built on the shapes of then.
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

    /// The options of this world, as the keyword arguments that make another like it.
    fn options(&self) -> Keywords {
        self.keywords.clone()
    }

    /// The type of all positions, float32 or float64; None as long as there was no body.
    #[getter]
    fn dtype<'py>(&self, py: Python<'py>) -> Maybe<'py> {
        let precision = self.state.with(py, |state| Ok(state.precision()))?;
        Ok(precision.map(|precision| dtype_of(py, precision)))
    }

    /// Adds a body: faces (m, 3) of any integer type, and positions (n, 3) of float32 or float64; or one mesh object that has
    /// .faces (or .triangles, as in Open3D) and .vertices. Returns its number, which this world will not use again.
    ///
    /// Builds its tree on these positions, which need not be special; a rest pose is best. Corners may repeat: a degenerate
    /// triangle is the segment or point that it is. Nothing is welded.
    #[pyo3(signature = (faces, positions=None))]
    fn add(&self, py: Python<'_>, faces: &Any<'_>, positions: Option<&Any<'_>>) -> Result<u32> {
        let mesh = mesh_of(faces, positions, None)?;
        let (faces, positions) = mesh.get()?;
        self.state.with(py, |state| {
            let added = state.add(faces, positions);
            Ok(added.map_err(|refused| refused.of_body(None))?.0)
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
        faces: &Any<'_>,
        positions: Option<&Any<'_>>,
    ) -> Result<()> {
        let mesh = mesh_of(faces, positions, Some(body.0))?;
        let (faces, positions) = mesh.get()?;
        let state = &self.state;
        state.with(py, |state| state.set_mesh(body.0, faces, positions))
    }

    /// Begins an edit of a body's mesh: changes that apply makes all at once, or not at all.
    fn edit(&self, py: Python<'_>, body: Body) -> Result<Edit> {
        self.state
            .with(py, |state| Ok(AnyEdit::of(state, body.0)?))
            .map(Edit::new)
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
    fn apply<'py>(&self, py: Python<'py>, edit: &Edit) -> Answer<'py> {
        let edited = edit.with(|edit| self.state.with(py, |state| edit.apply(state)))?;
        Ok(edit::edited(py, edited)?)
    }

    /// For each number whether it is that of a triangle, (m,) bool: False where an edit has left it empty.
    fn live_triangles(&self, py: Python<'_>, body: Body) -> Result<Column<bool>> {
        ask!(self, py, world => Column(world.live_triangles(body.0)?))
    }

    /// For each number whether it is that of a vertex, (n,) bool: False where an edit has left it empty.
    fn live_vertices(&self, py: Python<'_>, body: Body) -> Result<Column<bool>> {
        ask!(self, py, world => Column(world.live_vertices(body.0)?))
    }

    /// Counts the meshes of a body, and the orders that its trees bring them into: whoever keeps what vertex_order, edges or triangles says
    /// asks for them again when this is another.
    fn mesh_revision(&self, py: Python<'_>, body: Body) -> Result<u64> {
        ask!(self, py, world => world.mesh_revision(body.0)?)
    }

    /// For each triangle of a body its component, (m,) uint32: two are in one if they share a vertex, or hang together through others that
    /// do. Numbered from 0 in the order of their first triangles; an empty number has 0xFFFFFFFF.
    fn components(&self, py: Python<'_>, body: Body) -> Result<Column<u32>> {
        ask!(self, py, world => Column(world.components(body.0)?))
    }

    /// Makes a body of each component, but of the largest, which stays what it is with all its numbers: that with the most triangles, of
    /// several the first. Returns a list of Piece in the order of their first triangles; it is empty if all hangs together.
    ///
    /// What they have from the body: filter, loose box, vertex groups, and whom it ignores; if it ignores itself, the pieces ignore each
    /// other and it. A motion of the body ends. Vertices that no triangle uses stay with it.
    fn split<'py>(&self, py: Python<'py>, body: Body) -> Result<Vec<Any<'py>>> {
        let pieces = ask!(self, py, world => world.split(body.0)?)?.into_iter();
        let pieces = pieces.map(|piece| edit::piece(py, piece));
        Ok(pieces.collect::<PyResult<_>>()?)
    }

    /// Puts the triangles and vertices of body b behind those of a, and removes b. Returns a Fused: which numbers they have now.
    ///
    /// Body a keeps its numbers, its filter and whom it ignores; vertices keep their groups. The loose box is then one around both if both
    /// had one, else there is none. Motions of either end. Nothing is welded: see weld.
    fn fuse<'py>(&self, py: Python<'py>, a: Body, b: Body) -> Answer<'py> {
        let fused = ask!(self, py, world => world.fuse(a.0, b.0)?)?;
        Ok(edit::fused(py, fused)?)
    }

    /// Makes boundary edges one where they coincide: where the ends of one are, one by one, at most a tolerance from those of another,
    /// decided exactly. Of vertices that become one the lowest stays where it is, the others go. A boundary edge is one that exactly one triangle has. Returns
    /// an Edited.
    ///
    /// Vertices that coincide are not welded where no edges do, and never two corners of one triangle.
    fn weld<'py>(&self, py: Python<'py>, body: Body, tolerance: f64) -> Answer<'py> {
        let edited = search!(self, py, world => world.weld(body.0, tolerance))?;
        Ok(edit::edited(py, edited)?)
    }

    /// Removes a body. Its number will not be used again.
    fn remove(&self, py: Python<'_>, body: Body) -> Result<()> {
        ask!(self, py, world => world.remove(body.0)?)
    }

    /// The bodies of this world, in the order in which they were added.
    fn bodies(&self, py: Python<'_>) -> Result<Vec<u32>> {
        ask!(self, py, world => world.bodies().map(|body| body.0).collect())
    }

    /// Gives a body a new shape: one position for each of its vertices, (n, 3), in the order in which it was added.
    ///
    /// The positions are copied once, whatever their layout, into memory that the world keeps for it; float32 is widened in a float64
    /// world on the way. The copy is checked, and taken over only if all are good.
    fn set_positions(&self, py: Python<'_>, body: Body, positions: &Any<'_>) -> Result<()> {
        self.with_shape(py, body, positions, State::set_positions)
    }

    /// Like set_positions, but write(positions) fills an array (n, 3) of the world's type, which comes filled with NaN: every
    /// vertex must be written, or the shape is refused. Until write returns the world is in use. Where speed matters, reuse an array of your own and set_positions:
    /// unlike in Rust, this form costs copies more.
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

    /// Begins a motion: says where the vertices of a body will be at the end of the step, (n, 3). On the way they move on straight lines,
    /// from the shape that the body has now. Queries for candidates look at the whole way; intersections are of the shape of now, as
    /// ever. A body without a motion stands still.
    ///
    /// The positions are checked as those of set_positions are. A motion takes the place of the one before, and ends with finish_motion,
    /// advance_motion, the next new shape or mesh.
    fn set_motion(&self, py: Python<'_>, body: Body, end: &Any<'_>) -> Result<()> {
        self.with_shape(py, body, end, State::set_motion)
    }

    /// Ends all motions: every body that has one gets the shape at its end, without a copy. The others stand still.
    fn finish_motion(&self, py: Python<'_>) -> Result<()> {
        ask!(self, py, world => world.finish_motion())
    }

    /// Ends all motions on the way: every body that has one gets the shape in which it is at time t, from 0 (where it is) to 1 (the end).
    /// Each coordinate is x0 + t (x1 - x0), computed in float64, each operation rounded, kept between x0 and x1, and rounded to the
    /// world's type; at 1 it is x1.
    fn advance_motion(&self, py: Python<'_>, t: f64) -> Result<()> {
        ask!(self, py, world => world.advance_motion(t)?)
    }

    /// The shape that a body will have at the end of its motion, a new array (n, 3) of the world's type; None if it has none.
    fn end_positions(&self, py: Python<'_>, body: Body) -> Result<Option<Owned>> {
        ask!(self, py, world => world.end_positions(body.0)?.map(Owned::from))
    }

    /// Gives every vertex of a body a group, (n,) of integers from 0 to 2^32 - 1: candidates are left out if all their vertices are of one
    /// group, in whichever bodies they are. Those of group 0, as all are at first, meet all. For vertices that are pinned, or glued
    /// together. They stay with the body until it is given another mesh.
    fn set_vertex_groups(&self, py: Python<'_>, body: Body, groups: &Any<'_>) -> Result<()> {
        let groups = arrays::numbers(groups, ["groups", "one for each vertex"]);
        let groups = groups.map_err(|refused| refused.of_body(Some(body.0)))?;
        ask!(self, py, world => world.set_vertex_groups(body.0, &groups)?)
    }

    /// The group of every vertex of a body: a new array (n,) uint32.
    fn vertex_groups(&self, py: Python<'_>, body: Body) -> Result<Column<u32>> {
        ask!(self, py, world => Column(world.vertex_groups(body.0)?))
    }

    /// The edges of a body: a new array (k, 2) uint32, two vertices each, the smaller first. Every edge once, whatever triangles share it.
    /// The number of an edge is its row here.
    ///
    /// They are sorted when they are first asked for, here or by a query for edges. From then on an edge keeps its number while there is a
    /// triangle that has it, however the mesh is edited: a number whose edge is gone is empty, 0xFFFFFFFF twice, until an edge that comes
    /// takes it, the lowest first.
    fn edges(&self, py: Python<'_>, body: Body) -> Result<Rows<u32, 2>> {
        ask!(self, py, world => Rows(world.edges(body.0)?.to_vec()))
    }

    /// How much more the tree of a body does than a fresh one would, estimated from what queries for triangles did in the shape of now:
    /// pairs of nodes that were looked at, for one that a fresh tree would look at. 1.0 before a query says anything, or where little was looked
    /// at. With mending=True trees that have decayed mend themselves.
    fn tree_quality(&self, py: Python<'_>, body: Body) -> Result<f64> {
        ask!(self, py, world => world.tree_quality(body.0)?)
    }

    /// Builds the tree of a body anew, on the shape it has now. Worth it when a shape has become very different from the one
    /// it was built on; never needed for right answers.
    fn rebuild(&self, py: Python<'_>, body: Body) -> Result<()> {
        ask!(self, py, world => world.rebuild(body.0)?)
    }

    /// Says which bodies a body meets in queries of the whole world. Two bodies meet if the membership of each has a bit in
    /// common with the mask of the other. At first both are all ones, 0xFFFFFFFF. A query that names its bodies does not look at
    /// them.
    fn set_filter(&self, py: Python<'_>, body: Body, membership: u32, mask: u32) -> Result<()> {
        ask!(self, py, world => world.set_filter(body.0, membership, mask)?)
    }

    /// The membership and the mask of a body.
    fn filter(&self, py: Python<'_>, body: Body) -> Result<(u32, u32)> {
        ask!(self, py, world => world.filter(body.0)?)
    }

    /// From now on two bodies do not meet in queries of the whole world, or a body with itself if it is named twice. A query that
    /// names its bodies does not look at this.
    fn ignore(&self, py: Python<'_>, a: Body, b: Body) -> Result<()> {
        ask!(self, py, world => world.ignore(a.0, b.0)?)
    }

    /// Takes ignore back.
    fn unignore(&self, py: Python<'_>, a: Body, b: Body) -> Result<()> {
        ask!(self, py, world => world.unignore(a.0, b.0)?)
    }

    /// The pairs of bodies that ignore keeps apart, each once, the lower number first; sorted.
    fn ignored(&self, py: Python<'_>) -> Result<Vec<(u32, u32)>> {
        ask!(self, py, world => world.ignored().into_iter().map(|[a, b]| (a.0, b.0)).collect())
    }

    /// Gives a body a box, its lower and upper corner, that holds it in every pose to come; None takes it away. Corners are
    /// rounded to the world's type. Until the box is taken away, a position outside it is refused.
    fn set_loose_box(
        &self,
        py: Python<'_>,
        body: Body,
        corners: Option<(Any<'_>, Any<'_>)>,
    ) -> Result<()> {
        let corners = match corners {
            Some((lo, hi)) => Some((arrays::point(&lo)?, arrays::point(&hi)?)),
            None => None,
        };
        let state = &self.state;
        state.with(py, |state| Ok(state.set_loose_box(body.0, corners)?))
    }

    /// The lower and the upper corner of the box that set_loose_box gave to a body; None if it has none.
    fn loose_box(&self, py: Python<'_>, body: Body) -> Result<Option<Corners>> {
        self.state.with(py, |state| Ok(state.loose_box(body.0)?))
    }

    /// How many triangles a body has.
    fn triangle_count(&self, py: Python<'_>, body: Body) -> Result<usize> {
        ask!(self, py, world => world.triangle_count(body.0)?)
    }

    /// How many vertices a body has: the length that its positions must have.
    fn vertex_count(&self, py: Python<'_>, body: Body) -> Result<usize> {
        ask!(self, py, world => world.vertex_count(body.0)?)
    }

    /// The tree of a body in numbers.
    fn tree_shape<'py>(&self, py: Python<'py>, body: Body) -> Answer<'py> {
        let shape = ask!(self, py, world => world.tree_shape(body.0)?)?;
        Ok(named!(py, "TreeShape" of shape: depth, nodes, leaves)?)
    }

    /// For each triangle of a body, the part it is in when its tree is cut at a level, the root being level 0: (m,) uint32.
    fn tree_cut(&self, py: Python<'_>, body: Body, level: u32) -> Result<Column<u32>> {
        ask!(self, py, world => Column(world.tree_cut(body.0, level)?))
    }

    /// The faces of a body as they were added: (m, 3) uint32.
    fn triangles(&self, py: Python<'_>, body: Body) -> Result<Rows<u32, 3>> {
        ask!(self, py, world => Rows(world.triangles(body.0)?.to_vec()))
    }

    /// The shape that a body has now, the positions that it was given last: a new array (n, 3) of the world's type.
    fn positions(&self, py: Python<'_>, body: Body) -> Result<Owned> {
        ask!(self, py, world => Owned::from(world.positions(body.0)?))
    }

    /// The boxes of a level of a body's tree, the root being level 0, and which of them are valid, that is, held by the tree for the
    /// shape that the body has now: TreeBoxes(lower, upper, valid), (k, 3), (k, 3) and (k,), one row a part of tree_cut. Makes no
    /// box, and reads none.
    fn tree_boxes<'py>(&self, py: Python<'py>, body: Body, level: u32) -> Answer<'py> {
        let (lower, upper, valid) = ask!(self, py, world => {
            let boxes = world.tree_boxes(body.0, level)?.into_iter();
            let row = |node: NodeBox<_>| (node.lower, node.upper, node.valid);
            let (lower, upper, valid): (Vec<_>, Vec<_>, Vec<_>) = boxes.map(row).collect();
            (Owned::from(lower), Owned::from(upper), Column(valid))
        })?;
        Ok(named!(py, "TreeBoxes": lower = lower, upper = upper, valid = valid)?)
    }

    /// The order in which queries read the vertices of a body, as they were numbered when it was added: (n,) uint32. A body whose
    /// vertices come in this order, and whose faces name the new numbers, is faster.
    fn vertex_order(&self, py: Python<'_>, body: Body) -> Result<Column<u32>> {
        ask!(self, py, world => Column(world.vertex_order(body.0)?.to_vec()))
    }

    /// Asks which triangles intersect, of different bodies or of one: pairs of them, as closed sets. Touching counts. The Selection
    /// says who is asked about; the Query that comes back, how much is wanted: all(), first(), visit(...) or prepare().
    ///
    /// Within a body, triangles that share a vertex of the mesh are left out: they always touch. Surfaces only: a body wholly inside
    /// another meets none of its triangles.
    #[pyo3(signature = (of=Selection::WORLD))]
    fn intersections(&self, of: Selection) -> Query {
        Query::new(&self.state, of, Pairs::Intersections)
    }

    /// Asks which triangles intersect, as intersections does, and how: whether they cross, overlap in one plane, or only touch. only, a
    /// ContactKind, leaves out what is not of one kind: where surfaces lie on each other, along a cut or in a stack, it finds what goes
    /// through.
    #[pyo3(signature = (of=Selection::WORLD, *, only=None))]
    fn contacts(&self, of: Selection, only: Option<Only>) -> ContactQuery {
        ContactQuery::new(&self.state, of, Contacts { only })
    }

    /// Asks which vertices are near which triangles, now or on the way to the end of a motion: rows of body, vertex, body, triangle.
    ///
    /// The box of an element is the hull of its corners, at both ends of the motion where there is one. A vertex and a triangle are a
    /// candidate if on every axis the gap of their boxes is at most twice radius, in real arithmetic on the numbers given, and the vertex
    /// is no corner of the triangle. So with half the distance at which things are to be found nothing is missed that comes as near as
    /// that. Of two bodies it is the vertices of either and the triangles of the other. Filters keep bodies apart as in intersections,
    /// and set_vertex_groups keeps apart parts of them.
    fn vertex_triangle_candidates(&self, of: Selection, radius: f64) -> Query {
        Query::new(&self.state, of, Pairs::VertexTriangleCandidates(radius))
    }

    /// Asks which edges are near which edges, as vertex_triangle_candidates asks it of vertices and triangles: rows of body, edge, body,
    /// edge, the smaller (body, edge) first, or the body that the selection names first. Edges have the numbers that edges(body) gives
    /// them; two that have an end in common are none.
    fn edge_edge_candidates(&self, of: Selection, radius: f64) -> Query {
        Query::new(&self.state, of, Pairs::EdgeEdgeCandidates(radius))
    }

    /// Asks which vertices are close to which triangles, in the shape of now: those at most distance apart, with their closest points.
    ///
    /// Whether a pair is that close is decided exactly, in real arithmetic on the numbers given. Which pairs are looked at is said at
    /// vertex_triangle_candidates: no corner of a triangle is close to it, vertex groups and filters count. A motion is not looked at.
    fn close_vertex_triangle_pairs(&self, of: Selection, distance: f64) -> CloseQuery {
        CloseQuery::new(&self.state, of, Close::VertexTriangle(distance))
    }

    /// Asks which edges are close to which edges, as close_vertex_triangle_pairs asks it of vertices and triangles. Two that have an end in
    /// common are not looked at.
    fn close_edge_edge_pairs(&self, of: Selection, distance: f64) -> CloseQuery {
        CloseQuery::new(&self.state, of, Close::EdgeEdge(distance))
    }

    /// Asks which triangles are close to each other, in the shape of now: those at most distance apart, with their closest points; those
    /// that intersect are, at distance 0. Within a body, those that share a vertex of the mesh are left out.
    fn close_triangle_pairs(&self, of: Selection, distance: f64) -> CloseQuery {
        CloseQuery::new(&self.state, of, Close::Triangles(distance))
    }

    /// How far the surfaces of two bodies are apart: their closest triangles, a ClosePair; None if they are further apart than cut_off.
    /// The distance is 0 exactly if any of their triangles intersect; a body wholly inside another is as far from it as its surface is.
    #[pyo3(signature = (a, b, cut_off=f64::INFINITY))]
    fn distance<'py>(&self, py: Python<'py>, a: Body, b: Body, cut_off: f64) -> Maybe<'py> {
        let found = search!(self, py, world => world.distance(a.0, b.0, cut_off))?;
        Ok(found.map(|pair| pair.one(py)).transpose()?)
    }

    /// How far a body is from all others that may meet it, as filters say: the distance to the nearest of them, which the ClosePair names;
    /// None if no other is within cut_off.
    #[pyo3(signature = (body, cut_off=f64::INFINITY))]
    fn nearest_body<'py>(&self, py: Python<'py>, body: Body, cut_off: f64) -> Maybe<'py> {
        let found = search!(self, py, world => world.nearest_body(body.0, cut_off))?;
        Ok(found.map(|pair| pair.one(py)).transpose()?)
    }

    /// Asks which vertices and triangles meet on the way to the end of a motion, and when first; edge_edge_impacts is the other half.
    ///
    /// Vertices move on straight lines, from where they are at time 0 to where set_motion said at time 1; a body without a motion stands
    /// still. Whether a pair meets, as closed sets, is decided exactly. They are apart from time 0 to low, both included, and meet after
    /// that and not after high, which are at most width apart; both are 0 if they meet at the start. Which pairs are looked at is said at
    /// vertex_triangle_candidates.
    #[pyo3(signature = (of, width=1e-6))]
    fn vertex_triangle_impacts(&self, of: Selection, width: f64) -> ImpactQuery {
        ImpactQuery::new(&self.state, of, Impacts::VertexTriangle(width))
    }

    /// Asks which edges meet on the way to the end of a motion, and when first, as vertex_triangle_impacts asks it of vertices and
    /// triangles. Two that have an end in common are not looked at.
    #[pyo3(signature = (of, width=1e-6))]
    fn edge_edge_impacts(&self, of: Selection, width: f64) -> ImpactQuery {
        ImpactQuery::new(&self.state, of, Impacts::EdgeEdge(width))
    }

    /// The first contact on the way to the end of a motion, an Impact, of all vertex_triangle_impacts and edge_edge_impacts: that with the
    /// least exact time; None if nothing meets. Much faster than all.
    #[pyo3(signature = (of, width=1e-6))]
    fn first_impact<'py>(&self, py: Python<'py>, of: Selection, width: f64) -> Maybe<'py> {
        let found = search!(self, py, world => world.first_impact(of.0, width))?;
        let impact = found.map(|impact| match impact {
            Impact::VertexTriangle(impact) => impact.one(py),
            Impact::EdgeEdge(impact) => impact.one(py),
        });
        Ok(impact.transpose()?)
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
    fn free_step<'py>(&self, py: Python<'py>, of: Selection, min_distance: f64) -> Answer<'py> {
        let step = search!(self, py, world => world.free_step(of.0, min_distance))?;
        let pair = step.begins_in_contact.map(|pair| match pair {
            InContact::Triangles(pair) => pair.one(py),
            InContact::VertexTriangle(pair) => pair.one(py),
            InContact::EdgeEdge(pair) => pair.one(py),
        });
        let pair = pair.transpose()?;
        Ok(named!(py, "FreeStep": t = step.t, begins_in_contact = pair, moves = step.moves)?)
    }

    /// How far everything may go on its way to the end of a motion and stay further apart than min_distance: a time from 0 to 1 to call
    /// advance_motion with. It is proven that on straight ways to the shape that this makes, rounded as it is, no vertex meets a triangle
    /// and no edge another, nor comes as near as min_distance. 1 if that is so of the whole motion. 1 also if nothing moves, and less
    /// without a word if the start intersects: free_step says so.
    ///
    /// It is at least 0.9 of the largest such time where rounding leaves room for that. What touches at the start already does not count;
    /// what is within min_distance at the start is kept from contact alone.
    #[pyo3(signature = (of, min_distance=0.0))]
    fn collision_free_step(&self, py: Python<'_>, of: Selection, min_distance: f64) -> Result<f64> {
        search!(self, py, world => world.collision_free_step(of.0, min_distance))
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
    ) -> Result<Bound<'py, PyDict>> {
        let clearances = search!(self, py, world => world.clearance(of.0, cut_off))?;
        let of_bodies = PyDict::new(py);
        for (body, clearance) in clearances {
            of_bodies.set_item(body.0, Column(clearance))?;
        }
        Ok(of_bodies)
    }

    /// What the last query did, with what Query.prepare did before it.
    fn statistics<'py>(&self, py: Python<'py>) -> Answer<'py> {
        let statistics = ask!(self, py, world => *world.statistics())?;
        Ok(named!(py, "Statistics" of statistics:
            body_pairs, boxes_bottom_up, boxes_top_down, triangle_boxes, node_pairs,
            candidate_pairs, scalar_decisions, exact_decisions, pairs)?)
    }

    /// How many bytes of memory this world holds: bodies, trees, boxes, and the lists that queries keep for the next ones, with all
    /// that they have room for; and the room into which set_positions copies. Arrays that were handed out are not counted.
    fn memory_usage(&self, py: Python<'_>) -> Result<usize> {
        let room = self.state.alone()?.room(py);
        ask!(self, py, world => world.memory_usage() + room)
    }

    /// Checks every invariant of every tree, and raises pliant.Error if one does not hold. For tests and bug reports; no
    /// sequence of calls should ever make it fail.
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
