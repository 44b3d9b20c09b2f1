//! The world: bodies, their shapes, and the questions that users ask.
//!
//! `World` is what users see; behind it an `engine` of some degree is the one place where the phases
//! meet. `bodies` are there, each a `body` of one `part` or several, whose `positions` are in the
//! caller's order or in the tree's. `body_pairs` says who may meet whom in a `selection`.
//!
//! `asked` answers a `query` of some kind, pair by pair (`step`) or many pairs at once (`scheduler`); an
//! `answer` is what its tasks find;
//! `witness` is the last first pair, `origin` what boxes are relative to. Close pairs are put in order
//! and measured in `close`; how far bodies are apart is found in `distance`, how far vertices may go in
//! `clearance`. What meets first, and how far everything may go, is found in `impacts`; `free_step` says
//! besides how that begins. `interruptible` has the questions with one answer that may end early.
//!
//! Meshes change by `edits`, which need an `edit_state`; `pieces` makes bodies from one and one from
//! bodies. How far a tree has decayed is counted in `decay`, and `mending` builds another
//! (`mending_state`). `debug_view` and `tree_cut` are for those who look at trees, `validate` looks at
//! every invariant.

mod answer;
mod asked;
mod bodies;
mod body;
mod body_pairs;
mod clearance;
mod close;
mod debug_view;
mod decay;
mod distance;
mod edit_state;
mod edits;
mod engine;
mod free_step;
mod impacts;
mod interruptible;
mod mending;
mod mending_state;
mod origin;
mod part;
mod pieces;
mod positions;
mod query;
mod scalar;
mod scheduler;
mod selection;
mod step;
mod tree_cut;
mod validate;
mod witness;

use crate::close_pairs::{CloseEdgeEdge, CloseTriangles, CloseVertexTriangle};
use crate::contacts::Contact;
use crate::edit::{Edit, Edited};
use crate::error::Error;
use crate::hits::{EdgeEdge, Pair, VertexTriangle};
use crate::ids::BodyId;
use crate::impacts::{EdgeEdgeImpact, Impact, VertexTriangleImpact};
use crate::kernels::Instructions;
use crate::options::Options;
use crate::statistics::Statistics;
use crate::threads::Threads;
pub(crate) use body::validate as validate_body;
pub use debug_view::{NodeBox, TreeShape};
use engine::AnyEngine;
pub use free_step::{FreeStep, InContact};
pub use interruptible::Interruptible;
pub use pieces::{Fused, Piece};
pub use query::Query;
pub use scalar::Scalar;
pub use selection::Selection;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

/// Bodies that change their shape, and the questions which of their triangles intersect, which of
/// their vertices, edges and triangles are near each other, and which meet on their way.
///
/// `S` is the type of the coordinates, `f32` or `f64`. Moving a body is [`set_positions`](Self::set_positions); there is
/// nothing else to call: every query brings up to date what it touches, and none can answer for old positions.
///
/// A call that is refused returns an [`Error`] and leaves the world as it was.
pub struct World<S: Scalar> {
    engine: Box<dyn AnyEngine<S>>,
}

/// Bodies, shapes, trees, filters, ignored pairs, loose boxes and options; ids stay, and those of removed bodies are not used again.
/// Boxes are made anew, and counters begin at zero. A pool that was lent is shared, other threads are made anew.
///
/// Cost: O(n), no tree is built.
///
/// ```
/// let mut world = pliant::World::<f32>::new();
/// let body = world.add(&[[0, 1, 2]], &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])?;
/// let before = world.clone();
/// world.set_positions(body, &[[5.0; 3], [6.0, 0.0, 0.0], [0.0, 6.0, 0.0]])?;
/// assert_eq!(before.positions(body)?[0], [0.0; 3]);
/// # Ok::<(), pliant::Error>(())
/// ```
impl<S: Scalar> Clone for World<S> {
    fn clone(&self) -> Self {
        Self {
            engine: self.engine.copy(),
        }
    }
}

/// Bodies, and the shapes that they have.
impl<S: Scalar> World<S> {
    /// An empty world with the options that measured best.
    pub fn new() -> Self {
        Self::with_options(Options::default())
    }

    /// Adds a body: triangles as corner indices into positions, shape (m, 3) and (n, 3).
    ///
    /// Builds its tree on these positions, which need not be special; a rest pose is best. Corners may repeat: a degenerate
    /// triangle is the segment or point that it is. Vertices that no triangle uses are allowed, and checked like the others.
    ///
    /// Cost: O(m log m) for the balanced partition; for the others O(m) a level of the tree.
    ///
    /// # Errors
    ///
    /// [`NoTriangles`](crate::ErrorKind::NoTriangles), [`VertexOutOfRange`](crate::ErrorKind::VertexOutOfRange),
    /// [`BadPosition`](crate::ErrorKind::BadPosition), [`NeedsSubnormals`](crate::ErrorKind::NeedsSubnormals),
    /// [`TooLarge`](crate::ErrorKind::TooLarge) above 2^28 triangles or 2^32 - 1 vertices, and
    /// [`TooManyBodies`](crate::ErrorKind::TooManyBodies) after 2^32 bodies.
    #[doc(alias = "insert")]
    pub fn add(&mut self, triangles: &[[u32; 3]], positions: &[[S; 3]]) -> Result<BodyId, Error> {
        self.engine.add(triangles, positions)
    }

    /// Gives a body a new shape: one position for each of its vertices, shape (n, 3), in the order in which it was added.
    ///
    /// The positions are checked, and taken over only if all are good; the body keeps its old shape if not. One pass that copies them;
    /// or, if a query looked at the shape before, and the body is large or there is one thread, one that checks and one that takes
    /// them straight into the order of the tree.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody), [`WrongLength`](crate::ErrorKind::WrongLength),
    /// [`BadPosition`](crate::ErrorKind::BadPosition) for the first coordinate of any vertex, used or not, that is NaN, infinite or above
    /// `f32::MAX` in magnitude, [`OutsideLooseBox`](crate::ErrorKind::OutsideLooseBox),
    /// [`NeedsSubnormals`](crate::ErrorKind::NeedsSubnormals) in a thread that flushes subnormal numbers.
    #[doc(alias = "update_vertices")]
    #[doc(alias = "refit")]
    pub fn set_positions(&mut self, body: BodyId, positions: &[[S; 3]]) -> Result<(), Error> {
        self.engine.set_positions(body, positions)
    }

    /// Like [`set_positions`](Self::set_positions), but `write` fills a buffer of the world's, shape (n, 3), in the order in
    /// which the vertices were added, so that the caller needs none of its own. The buffer comes filled with NaN: every
    /// vertex must be written. The same checked pass then takes the shape over, into the order of the tree.
    ///
    /// # Errors
    ///
    /// Those of [`set_positions`](Self::set_positions); a coordinate that is NaN, which an unwritten one is, is
    /// [`NotWritten`](crate::ErrorKind::NotWritten). If `write` panics, the body keeps its shape.
    pub fn write_positions(
        &mut self,
        body: BodyId,
        write: impl FnOnce(&mut [[S; 3]]),
    ) -> Result<(), Error> {
        let mut write = Some(write);
        self.engine.write_positions(body, &mut |lent| {
            if let Some(write) = write.take() {
                write(lent);
            }
        })
    }

    /// Removes a body. Its id will not be used again.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn remove(&mut self, body: BodyId) -> Result<(), Error> {
        self.engine.remove(body)
    }

    /// The bodies of this world, in the order in which they were added.
    pub fn bodies(&self) -> impl ExactSizeIterator<Item = BodyId> {
        self.engine.ids().iter().copied()
    }

    /// An empty world, with threads of its own if [`Options::threads`] asks for more than one.
    pub fn with_options(options: Options) -> Self {
        let threads = Threads::private(options.threads);
        Self {
            engine: S::engine(options, threads),
        }
    }

    /// An empty world whose queries are shared with the threads of a pool that the application has anyway, so that no others are
    /// made: the calling thread and as many of the pool's as make [`Options::threads`] together.
    ///
    /// Queries may be asked from any thread, those of the pool included. As with everything that waits inside of a rayon pool, such a
    /// thread may begin other work of the pool while it waits for the end of a query.
    ///
    /// ```
    /// use pliant::{Options, World};
    /// use std::num::NonZeroUsize;
    /// use std::sync::Arc;
    ///
    /// let pool = Arc::new(rayon::ThreadPoolBuilder::new().num_threads(3).build()?);
    /// let mut options = Options::default();
    /// options.threads = NonZeroUsize::new(4).expect("4 is not 0");
    /// let world = World::<f32>::with_pool(options, Arc::clone(&pool));
    /// # drop(world);
    /// # Ok::<(), rayon::ThreadPoolBuildError>(())
    /// ```
    pub fn with_pool(options: Options, pool: Arc<rayon::ThreadPool>) -> Self {
        let threads = Threads::lent(options.threads, pool);
        Self {
            engine: S::engine(options, threads),
        }
    }

    /// The options of this world.
    pub fn options(&self) -> &Options {
        self.engine.options()
    }
}

/// What intersects, what is near, how far apart things are.
impl<S: Scalar> World<S> {
    /// Asks which triangles intersect, of different bodies or of one: pairs of them, as closed sets. Touching counts. The
    /// [`Selection`] says who is asked about; the [`Query`] that comes back, how much is wanted.
    ///
    /// Within a body, triangles that share a vertex of the mesh are left out: they always touch. Surfaces only: a body wholly inside
    /// another meets none of its triangles.
    ///
    /// ```
    /// # use pliant::{Selection, World};
    /// # let mut world = World::<f32>::new();
    /// # let shirt = world.add(&[[0, 1, 2]], &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])?;
    /// # let skin = world.add(&[[0, 1, 2]], &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])?;
    /// for pair in world.intersections(Selection::Between(shirt, skin)).all()? {
    ///     println!("triangle {} of the shirt meets triangle {} of the skin", pair.triangle_a, pair.triangle_b);
    /// }
    /// if world.intersections(Selection::Everything).first()?.is_none() {
    ///     println!("nothing meets anything");
    /// }
    /// # assert_eq!(world.intersections(Selection::World).all()?.len(), 1);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    #[doc(alias = "rtcCollide")]
    #[doc(alias = "bvhcast")]
    #[doc(alias = "findCollidingTriangles")]
    #[doc(alias = "findSelfCollidingTriangles")]
    #[doc(alias = "self_intersections")]
    #[doc(alias = "does_self_intersect")]
    pub fn intersections(&mut self, of: Selection) -> Query<'_, Pair> {
        Query::new(&mut *self.engine, of)
    }

    /// Asks which triangles intersect, as [`intersections`](Self::intersections) does, and how: whether they cross, overlap in one plane, or
    /// only touch. [`Query::only`] leaves out what is not of one kind: where surfaces lie on each other, along a cut or in a stack, it finds
    /// what goes through.
    ///
    /// ```
    /// # use pliant::{ContactKind, Selection, World};
    /// let mut world = World::new();
    /// let floor = world.add(&[[0, 1, 2]], &[[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]])?;
    /// let leaf = world.add(&[[0, 1, 2]], &[[0.0, 0.0, 0.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]])?;
    /// let contacts = world.contacts(Selection::Between(floor, leaf)).all()?;
    /// assert_eq!(contacts[0].kind, ContactKind::Touching);
    /// world.set_positions(leaf, &[[0.0, 0.0, -0.1], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]])?;
    /// let crossing = world.contacts(Selection::World).only(ContactKind::Crossing);
    /// assert!(crossing.first()?.is_some());
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// Cost: a pair whose kind no rounded sign tells takes its exact signs once more.
    pub fn contacts(&mut self, of: Selection) -> Query<'_, Contact> {
        Query::new(&mut *self.engine, of)
    }

    /// Asks which vertices are near which triangles, now or on the way to the end of a motion: the search of a solver that then decides by
    /// distance, or when they touch. See [`edge_edge_candidates`](Self::edge_edge_candidates) for the other half.
    ///
    /// The box of an element is the hull of its corners, at both ends of the motion where there is one. A vertex and a triangle are a
    /// candidate if on every axis the gap of their boxes is at most twice `radius`, in real arithmetic on the numbers given, and the vertex
    /// is no corner of the triangle. So with half the distance at which things are to be found nothing is missed that comes as near as
    /// that. Degenerate triangles and those that come twice count; vertices that no triangle uses are in no candidate.
    ///
    /// Of two bodies it is the vertices of either and the triangles of the other. Filters keep bodies apart as in
    /// [`intersections`](Self::intersections), and [`set_vertex_groups`](Self::set_vertex_groups) keeps apart parts of them.
    ///
    /// ```
    /// # use pliant::{Selection, World};
    /// let mut world = World::<f64>::new();
    /// let floor = world.add(&[[0, 1, 2]], &[[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]])?;
    /// let leaf = world.add(&[[0, 1, 2]], &[[0.0, 0.0, 2.0], [1.0, 0.0, 3.0], [0.0, 1.0, 3.0]])?;
    /// // Within 0.1 of each other: 0.05 round each.
    /// assert!(world.vertex_triangle_candidates(Selection::World, 0.05).all()?.is_empty());
    /// world.set_motion(leaf, &[[0.0, 0.0, 0.05], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]])?;
    /// let near = world.vertex_triangle_candidates(Selection::World, 0.05).all()?;
    /// assert_eq!((near[0].vertex_body, near[0].vertex, near[0].triangle_body), (leaf, 0, floor));
    /// # Ok::<(), pliant::Error>(())
    /// ```
    #[doc(alias = "broad_phase")]
    #[doc(alias = "detect_face_vertex_candidates")]
    pub fn vertex_triangle_candidates(
        &mut self,
        of: Selection,
        radius: f64,
    ) -> Query<'_, VertexTriangle> {
        Query::<VertexTriangle>::new(&mut *self.engine, of).within(radius)
    }

    /// Asks which edges are near which edges, as [`vertex_triangle_candidates`](Self::vertex_triangle_candidates) asks it of vertices and
    /// triangles. Edges have the numbers that [`edges`](Self::edges) gives them; two that have an end in common are no candidate.
    #[doc(alias = "detect_edge_edge_candidates")]
    pub fn edge_edge_candidates(&mut self, of: Selection, radius: f64) -> Query<'_, EdgeEdge> {
        Query::<EdgeEdge>::new(&mut *self.engine, of).within(radius)
    }

    /// Asks which vertices are close to which triangles, in the shape of now: those at most `distance` apart, with their closest points.
    /// See [`close_edge_edge_pairs`](Self::close_edge_edge_pairs) for the other half. It is what penalty, barrier and position-based
    /// solvers push apart.
    ///
    /// Whether a pair is that close is decided exactly, in real arithmetic on the numbers given. Distance, direction and closest points are
    /// as good as [`CloseVertexTriangle`] says. Which pairs are looked at is said at
    /// [`vertex_triangle_candidates`](Self::vertex_triangle_candidates): no corner of a triangle is close to it, vertex groups and filters
    /// count. A motion is not looked at; while there is one, more candidates are.
    ///
    /// ```
    /// # use pliant::{Selection, World};
    /// let mut world = World::<f64>::new();
    /// let floor = world.add(&[[0, 1, 2]], &[[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]])?;
    /// let leaf = world.add(&[[0, 1, 2]], &[[0.0, 0.0, 0.25], [1.0, 0.0, 3.0], [0.0, 1.0, 3.0]])?;
    /// let thickness = 0.5;
    /// for close in world.close_vertex_triangle_pairs(Selection::World, thickness).all()? {
    ///     assert_eq!((close.pair.vertex_body, close.pair.vertex, close.distance), (leaf, 0, 0.25));
    ///     assert_eq!(close.direction, Some([0.0, 0.0, 1.0]));
    ///     // How far to push, shared by the vertex and the corners of the triangle.
    ///     let push = thickness - close.distance;
    ///     let weights = 1.0 + close.barycentric.iter().map(|b| b * b).sum::<f64>();
    ///     assert!(push / weights < 0.25);
    /// }
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Those of [`Query`].
    #[doc(alias = "NormalCollisions")]
    #[doc(alias = "point_triangle_distance")]
    pub fn close_vertex_triangle_pairs(
        &mut self,
        of: Selection,
        distance: f64,
    ) -> Query<'_, CloseVertexTriangle> {
        Query::<CloseVertexTriangle>::new(&mut *self.engine, of).within(distance)
    }

    /// Asks which edges are close to which edges, as [`close_vertex_triangle_pairs`](Self::close_vertex_triangle_pairs) asks it of vertices
    /// and triangles. Edges have the numbers that [`edges`](Self::edges) gives them; two that have an end in common are not looked at.
    ///
    /// # Errors
    ///
    /// Those of [`Query`].
    #[doc(alias = "edge_edge_distance")]
    pub fn close_edge_edge_pairs(
        &mut self,
        of: Selection,
        distance: f64,
    ) -> Query<'_, CloseEdgeEdge> {
        Query::<CloseEdgeEdge>::new(&mut *self.engine, of).within(distance)
    }

    /// Asks which triangles are close to each other, in the shape of now: those at most `distance` apart, with their closest points. Those
    /// that intersect are, at distance 0.
    ///
    /// Whether a pair is that close is decided exactly, in real arithmetic on the numbers given. As with
    /// [`intersections`](Self::intersections), triangles of one body that share a vertex of the mesh are left out. Those that are
    /// neighbours but for that always are close: this is for bodies that should keep a distance from each other.
    ///
    /// ```
    /// # use pliant::{Selection, World};
    /// let mut world = World::<f64>::new();
    /// let skin = world.add(&[[0, 1, 2]], &[[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]])?;
    /// let shirt = world.add(&[[0, 1, 2]], &[[0.0, 0.0, 0.002], [1.0, 0.0, 3.0], [0.0, 1.0, 3.0]])?;
    /// let close = world.close_triangle_pairs(Selection::Between(shirt, skin), 0.004).all()?;
    /// assert_eq!((close[0].distance, close[0].barycentric_a), (0.002, [1.0, 0.0, 0.0]));
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Those of [`Query`].
    #[doc(alias = "within_distance")]
    pub fn close_triangle_pairs(
        &mut self,
        of: Selection,
        distance: f64,
    ) -> Query<'_, CloseTriangles> {
        Query::<CloseTriangles>::new(&mut *self.engine, of).within(distance)
    }

    /// How far the surfaces of two bodies are apart, in the shape of now: their closest triangles, with the closest points, the first of
    /// the first body; none if they are further apart than `cut_off`, which may be infinite.
    ///
    /// The distance is 0 exactly if any of their triangles intersect, and whether it is at most the cut-off
    /// is decided exactly; it is as good as [`CloseTriangles`] says. Where several triangles are the closest, or others nearer by no more
    /// than 2^-31 of it, it is some of them. Surfaces only: a body wholly inside another is as far from it as its surface is. Filters are
    /// not looked at, and a motion is not.
    ///
    /// Cost: what a query for intersections does ahead, and the nodes and triangles whose boxes are nearer to each other than the bodies
    /// are. The triangles that were the closest the last time are measured first.
    ///
    /// ```
    /// # use pliant::World;
    /// let mut world = World::<f64>::new();
    /// let wall = world.add(&[[0, 1, 2]], &[[0.0, -9.0, -9.0], [0.0, 9.0, -9.0], [0.0, 0.0, 9.0]])?;
    /// let gripper = world.add(&[[0, 1, 2]], &[[3.0, 0.0, 0.0], [5.0, 1.0, 0.0], [5.0, 0.0, 1.0]])?;
    /// let nearest = world.distance(gripper, wall, f64::INFINITY)?.expect("nothing is further apart");
    /// assert_eq!((nearest.distance, nearest.direction), (3.0, Some([1.0, 0.0, 0.0])));
    /// assert_eq!((nearest.point_a, nearest.point_b), ([3.0, 0.0, 0.0], [0.0; 3]));
    /// assert!(world.distance(gripper, wall, 2.0)?.is_none());
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody), [`SameBody`](crate::ErrorKind::SameBody) if both are one,
    /// [`BadDistance`](crate::ErrorKind::BadDistance) if the cut-off is negative or NaN.
    #[doc(alias = "separation")]
    #[doc(alias = "closest_points")]
    pub fn distance(
        &mut self,
        a: BodyId,
        b: BodyId,
        cut_off: f64,
    ) -> Result<Option<CloseTriangles>, Error> {
        self.engine.distance([a, b], cut_off, None)
    }

    /// How far a body is from all others that may meet it, as filters say: [`distance`](Self::distance) to the nearest of them, which
    /// [`pair`](CloseTriangles::pair) names; none if no other is within `cut_off`. Of several that are equally near, it is some of them.
    ///
    /// Cost: that of the distance from those whose boxes are nearer than the nearest is.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody), and [`BadDistance`](crate::ErrorKind::BadDistance) if the cut-off is negative or NaN.
    pub fn nearest_body(
        &mut self,
        body: BodyId,
        cut_off: f64,
    ) -> Result<Option<CloseTriangles>, Error> {
        self.engine.nearest_body(body, cut_off, None)
    }

    /// How far each vertex may move before anything can touch: of the selection's bodies one number for each vertex, at most half of
    /// `cut_off`.
    ///
    /// It is half the least distance of the vertices and triangles, and edges and edges, that the vertex is a corner of and that have no
    /// vertex in common, as [`close_vertex_triangle_pairs`](Self::close_vertex_triangle_pairs) looks at them; rounded down by at most
    /// 1e-6 of itself and 1e-323, and 0 where something touches. If every vertex moves less than that, in whatever direction, none of these pairs
    /// touches, on the way or at the end. The pairs that filters or vertex groups keep apart do not count.
    ///
    /// Cost: that of both queries for close pairs within `cut_off`.
    ///
    /// ```
    /// # use pliant::{Selection, World};
    /// let mut world = World::<f64>::new();
    /// let floor = world.add(&[[0, 1, 2]], &[[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]])?;
    /// let leaf = world.add(&[[0, 1, 2]], &[[0.0, 0.0, 0.5], [1.0, 0.0, 3.0], [0.0, 1.0, 3.0]])?;
    /// let clearance = world.clearance(Selection::World, 2.0)?;
    /// assert!(clearance[&leaf][0] <= 0.25 && clearance[&leaf][0] > 0.249_999);
    /// assert!(clearance[&leaf][1] > 0.999_999);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Those of [`Query`].
    pub fn clearance(
        &mut self,
        of: Selection,
        cut_off: f64,
    ) -> Result<BTreeMap<BodyId, Vec<f64>>, Error> {
        clearance::clearance(self, of, cut_off, None)
    }

    /// This world, for a question with one answer that is to end early, with an error, when `question` says so. What
    /// [`Query::interrupt_if`] says of queries holds of these.
    ///
    /// ```
    /// # use pliant::{ErrorKind, World};
    /// use std::time::{Duration, Instant};
    ///
    /// # let mut world = World::<f32>::new();
    /// # let [robot, wall] = [0.0, 1.0].map(|z| world.add(&[[0, 1, 2]], &[[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]]).unwrap());
    /// let end = Instant::now() + Duration::from_secs(1);
    /// let is_late = || Instant::now() > end;
    /// let nearest = world.interruptible(&is_late).distance(robot, wall, 9.0)?;
    /// # assert_eq!(nearest.unwrap().distance, 1.0);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn interruptible<'w>(
        &'w mut self,
        question: &'w (dyn Fn() -> bool + Sync),
    ) -> Interruptible<'w, S> {
        Interruptible {
            world: self,
            question,
        }
    }

    /// What the last query did, with what [`Query::prepare`] did before it.
    pub fn statistics(&self) -> &Statistics {
        self.engine.statistics()
    }
}

/// Where bodies are going, what meets on the way, and how far all may go.
impl<S: Scalar> World<S> {
    /// Begins a motion: says where the vertices of a body will be at the end of the step, shape (n, 3). On the way they move on straight
    /// lines, from the shape that the body has now. Queries for candidates look at the whole way; what intersects is asked of the shape
    /// of now, as ever. A body without a motion stands still.
    ///
    /// The positions are checked as those of [`set_positions`](Self::set_positions) are. A motion takes the place of the one before, and
    /// ends with [`finish_motion`](Self::finish_motion), [`advance_motion`](Self::advance_motion), the next new shape or mesh.
    ///
    /// # Errors
    ///
    /// Those of [`set_positions`](Self::set_positions); the body keeps the motion that it has.
    #[doc(alias = "set_velocity")]
    pub fn set_motion(&mut self, body: BodyId, end: &[[S; 3]]) -> Result<(), Error> {
        self.engine.set_motion(body, end)
    }

    /// The shape that a body will have at the end of its motion; `None` if it has none.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn end_positions(&self, body: BodyId) -> Result<Option<Vec<[S; 3]>>, Error> {
        self.engine.end_positions(body)
    }

    /// Asks which vertices and triangles meet on the way to the end of a motion, and when first. See
    /// [`edge_edge_impacts`](Self::edge_edge_impacts) for the other half: surfaces that are apart first meet where a vertex meets a
    /// triangle or two edges meet.
    ///
    /// Vertices move on straight lines, in real arithmetic, from where they are at time 0 to where [`set_motion`](Self::set_motion) said at
    /// time 1; a body without a motion stands still. Whether a pair meets is decided exactly: as closed sets, degenerate triangles, motion
    /// in one plane, touching at the start and at the end included. When, is an interval ([`VertexTriangleImpact`]), as narrow as
    /// [`Query::width`] says. [`Query::first`] is that with the least exact time, and much faster than all.
    ///
    /// Which pairs are looked at is said at [`vertex_triangle_candidates`](Self::vertex_triangle_candidates): no corner of a triangle
    /// meets it, vertex groups and filters count. They are not listed on the way: memory is for what meets.
    ///
    /// ```
    /// # use pliant::{Selection, World};
    /// let mut world = World::<f64>::new();
    /// let floor = world.add(&[[0, 1, 2]], &[[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]])?;
    /// let leaf = world.add(&[[0, 1, 2]], &[[0.0, 0.0, 2.0], [1.0, 0.0, 3.0], [0.0, 1.0, 3.0]])?;
    /// // It falls by 3, and its corner touches the floor after two thirds of the step.
    /// world.set_motion(leaf, &[[0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])?;
    /// let first = world.vertex_triangle_impacts(Selection::World).first()?.expect("it falls far enough");
    /// assert_eq!((first.pair.vertex_body, first.pair.vertex), (leaf, 0));
    /// assert!(first.low < 2.0 / 3.0 && 2.0 / 3.0 <= first.high && first.high - first.low <= 1e-6);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Those of [`Query`].
    #[doc(alias = "time_of_impact")]
    #[doc(alias = "continuous_collision_detection")]
    #[doc(alias = "point_triangle_ccd")]
    pub fn vertex_triangle_impacts(&mut self, of: Selection) -> Query<'_, VertexTriangleImpact> {
        Query::new(&mut *self.engine, of)
    }

    /// Asks which edges meet on the way to the end of a motion, and when first, as
    /// [`vertex_triangle_impacts`](Self::vertex_triangle_impacts) asks it of vertices and triangles. Edges have the numbers that
    /// [`edges`](Self::edges) gives them; two that have an end in common are not looked at.
    ///
    /// # Errors
    ///
    /// Those of [`Query`].
    #[doc(alias = "edge_edge_ccd")]
    pub fn edge_edge_impacts(&mut self, of: Selection) -> Query<'_, EdgeEdgeImpact> {
        Query::new(&mut *self.engine, of)
    }

    /// The first contact on the way to the end of a motion: that with the least exact time of all
    /// [`vertex_triangle_impacts`](Self::vertex_triangle_impacts) and [`edge_edge_impacts`](Self::edge_edge_impacts); of several at one
    /// time a vertex and a triangle rather than edges, the first in order. Its interval is at most `width` wide: see [`Query::width`].
    ///
    /// # Errors
    ///
    /// Those of [`Query`].
    pub fn first_impact(&mut self, of: Selection, width: f64) -> Result<Option<Impact>, Error> {
        self.engine.first_impact(of, width, None)
    }

    /// How far everything may go on its way to the end of a motion and stay further apart than
    /// `min_distance`, a time t from 0 to 1 to call [`advance_motion`](Self::advance_motion) with;
    /// and what that number does not say. `t` is what [`collision_free_step`](Self::collision_free_step)
    /// gives, and promises what that does.
    ///
    /// It promises nothing for what is in contact at the start. Surfaces that are through each other
    /// meet on every way out, so `t` may be small for no other reason. Elements that touch may go through
    /// each other; those that are nearer than `min_distance` are kept from touching, not from coming
    /// nearer. [`begins_in_contact`](FreeStep::begins_in_contact) names the first such pair:
    ///
    /// - triangles that intersect in the shape of now, of those that
    ///   [`intersections`](Self::intersections) looks at, unless all six vertices are of one
    ///   [group](Self::set_vertex_groups);
    /// - if there are none, elements at most `min_distance` apart, of those that
    ///   [`vertex_triangle_impacts`](Self::vertex_triangle_impacts) and
    ///   [`edge_edge_impacts`](Self::edge_edge_impacts) look at; with a `min_distance` of 0, that touch.
    ///
    /// Both are decided exactly, and touching counts. So a world in which no pair is named, and which is
    /// advanced by such steps alone, never has one, unless groups of vertices let it. What is not found
    /// are triangles that share a vertex of the mesh and are through each other beyond it.
    ///
    /// A mesh with edges shorter than `min_distance` is always that near to itself: see whether it is
    /// [`InContact::Triangles`], or ask with a smaller one. Elements further apart than `min_distance` by
    /// a thousandth of it or less are in no contact, but may stop the step at 0.
    ///
    /// Without any motion there is nowhere to go, and `t` is 1: [`moves`](FreeStep::moves) is false then.
    ///
    /// ```
    /// # use pliant::{Selection, World};
    /// # let mut world = World::<f64>::new();
    /// # let floor = world.add(&[[0, 1, 2]], &[[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]])?;
    /// # let leaf = world.add(&[[0, 1, 2]], &[[0.0, 0.0, 2.0], [1.0, 0.0, 3.0], [0.0, 1.0, 3.0]])?;
    /// world.set_motion(leaf, &[[0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])?;
    /// let step = world.free_step(Selection::Everything, 0.0)?;
    /// assert!(step.moves && step.begins_in_contact.is_none());
    /// assert!(step.t > 0.6 && step.t < 2.0 / 3.0);
    /// world.advance_motion(step.t)?;
    /// assert!(world.intersections(Selection::Everything).first()?.is_none());
    /// assert!(!world.free_step(Selection::Everything, 0.0)?.moves);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// Cost: that of [`collision_free_step`](Self::collision_free_step), of both queries for close pairs
    /// within `min_distance`, and of the first intersection. [`statistics`](Self::statistics) are those
    /// of the first alone.
    ///
    /// # Errors
    ///
    /// Those of [`Query`].
    pub fn free_step(&mut self, of: Selection, min_distance: f64) -> Result<FreeStep, Error> {
        self.find_free_step(of, min_distance, None)
    }

    /// How far everything may go on its way to the end of a motion and stay further apart than `min_distance`: a time t from 0 to 1 to call
    /// [`advance_motion`](Self::advance_motion) with. It is proven that on straight ways to the shape that this makes, rounded as it is, no
    /// vertex meets a triangle and no edge another. 1 if that is so of the whole motion; then [`finish_motion`](Self::finish_motion) does
    /// the same. 1 also if nothing moves, and less without a word if the start intersects: [`free_step`](Self::free_step) says so.
    ///
    /// With a `min_distance` of 0, t is at least 0.9 of the exact time of the first contact, if up to 0.91 of it everything is apart by 9 units
    /// in the last place of the largest coordinate; else perhaps smaller, or 0. What meets at the start already does not count: it is in
    /// the lists of impacts, with time 0. So a world that begins without intersections, and is advanced by such steps alone, never has any.
    ///
    /// Above 0 it is a Euclidean distance; and 0.9 is of the time up to which everything is further apart than 1.001 times that. Elements
    /// that are not further apart than it at the start may come nearer, and are kept from contact alone.
    ///
    /// ```
    /// # use pliant::{Selection, World};
    /// # let mut world = World::<f64>::new();
    /// # let floor = world.add(&[[0, 1, 2]], &[[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]])?;
    /// # let leaf = world.add(&[[0, 1, 2]], &[[0.0, 0.0, 2.0], [1.0, 0.0, 3.0], [0.0, 1.0, 3.0]])?;
    /// # world.set_motion(leaf, &[[0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])?;
    /// let step = world.collision_free_step(Selection::Everything, 0.0)?;
    /// assert!(step > 0.6 && step < 2.0 / 3.0);
    /// world.advance_motion(step)?;
    /// assert!(world.intersections(Selection::Everything).first()?.is_none());
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Those of [`Query`].
    #[doc(alias = "compute_collision_free_stepsize")]
    pub fn collision_free_step(&mut self, of: Selection, min_distance: f64) -> Result<f64, Error> {
        self.engine.collision_free_step(of, min_distance, None)
    }

    /// Ends all motions on the way: every body that has one gets the shape in which it is at time `t`, from 0 (where it is) to 1 (the end).
    /// Each coordinate is x0 + t (x1 - x0), computed in `f64`, each operation rounded, kept between x0 and x1, and rounded to `S`; at 1 it
    /// is x1, as after [`finish_motion`](Self::finish_motion).
    ///
    /// ```
    /// # use pliant::World;
    /// let mut world = World::<f32>::new();
    /// let body = world.add(&[[0, 1, 2]], &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])?;
    /// world.set_motion(body, &[[0.0, 0.0, 4.0], [1.0, 0.0, 4.0], [0.0, 1.0, 4.0]])?;
    /// world.advance_motion(0.25)?;
    /// assert_eq!(world.positions(body)?[1], [1.0, 0.0, 1.0]);
    /// assert_eq!(world.end_positions(body)?, None);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`BadTime`](crate::ErrorKind::BadTime) if `t` is not from 0 to 1; nothing has moved.
    pub fn advance_motion(&mut self, t: f64) -> Result<(), Error> {
        self.engine.advance_motion(t)
    }

    /// Ends all motions: every body that has one gets the shape at its end, without a copy. The others stand still.
    pub fn finish_motion(&mut self) {
        self.engine.finish_motion();
    }
}

/// Who may meet whom.
impl<S: Scalar> World<S> {
    /// Says which bodies a body meets in queries of the whole world. Two bodies meet if the membership of each has a bit in
    /// common with the mask of the other. At first both are all ones. A query that names its bodies does not look at them.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    #[doc(alias = "collision_groups")]
    pub fn set_filter(&mut self, body: BodyId, membership: u32, mask: u32) -> Result<(), Error> {
        self.engine.set_filter(body, membership, mask)
    }

    /// The membership and the mask of a body, as [`set_filter`](Self::set_filter) says them.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn filter(&self, body: BodyId) -> Result<(u32, u32), Error> {
        self.engine.filter(body)
    }

    /// From now on two bodies do not meet in queries of the whole world, or a body with itself if it is named twice. A query that
    /// names its bodies does not look at this.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn ignore(&mut self, a: BodyId, b: BodyId) -> Result<(), Error> {
        self.engine.ignore(a, b)
    }

    /// Takes [`ignore`](Self::ignore) back.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn unignore(&mut self, a: BodyId, b: BodyId) -> Result<(), Error> {
        self.engine.unignore(a, b)
    }

    /// The pairs of bodies that [`ignore`](Self::ignore) keeps apart, each once, the lower id first; sorted.
    pub fn ignored(&self) -> Vec<[BodyId; 2]> {
        self.engine.ignored()
    }

    /// Gives every vertex of a body a group, shape (n,): candidates are left out if all their vertices are of one group, in whichever
    /// bodies they are. Those of group 0, as all are at first, meet all. For vertices that are pinned, or glued together.
    ///
    /// They stay with the body until [`set_mesh`](Self::set_mesh) gives it another mesh. Of the vertices that an [`Edit`] adds, those that
    /// are split from another have the group of that, the others group 0; what is given for empty vertices is not looked at.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody), [`WrongLength`](crate::ErrorKind::WrongLength).
    #[doc(alias = "can_vertices_collide")]
    pub fn set_vertex_groups(&mut self, body: BodyId, groups: &[u32]) -> Result<(), Error> {
        self.engine.set_vertex_groups(body, groups)
    }

    /// The group of every vertex of a body.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn vertex_groups(&self, body: BodyId) -> Result<Vec<u32>, Error> {
        self.engine.vertex_groups(body)
    }

    /// Gives a body a box, lower and upper corner, that holds it in every pose to come; `None` takes it away.
    ///
    /// The broad phase then works with this box, which stands still, and looks at the exact box only where loose boxes
    /// overlap. Until it is taken away, a position outside it is refused. Worth it for many bodies that move on their spot.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody), [`BadLooseBox`](crate::ErrorKind::BadLooseBox) if a corner is not finite, is
    /// above `f32::MAX` in magnitude, or the lower one is above the upper one on some axis, and
    /// [`OutsideLooseBox`](crate::ErrorKind::OutsideLooseBox) if the body is not inside now.
    pub fn set_loose_box(
        &mut self,
        body: BodyId,
        corners: Option<([S; 3], [S; 3])>,
    ) -> Result<(), Error> {
        self.engine.set_loose_box(body, corners)
    }

    /// The lower and the upper corner of the box that [`set_loose_box`](Self::set_loose_box) gave to a body; `None` if it has none.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn loose_box(&self, body: BodyId) -> Result<Option<([S; 3], [S; 3])>, Error> {
        self.engine.loose_box(body)
    }
}

/// Meshes that change.
impl<S: Scalar> World<S> {
    /// Gives a body another mesh and its shape, shapes (m, 3) and (n, 3), of any size. Id, filter, ignored pairs and loose box stay;
    /// triangles and vertices are numbered as these are, and none is empty. A mesh that is not that which the body has ends a motion, and
    /// takes the vertices their groups.
    ///
    /// What is equal by number stays, what differs is edited. So this costs a comparison of all triangles, which is as quick as
    /// [`set_positions`](Self::set_positions), and what [`apply`](Self::apply) costs for those that differ. Where they are more than an
    /// eighth, or vertices fewer than before, all is made anew, which costs as much as [`add`](Self::add): edges have other numbers then.
    ///
    /// ```
    /// use pliant::{Selection, World};
    ///
    /// let mut world = World::<f32>::new();
    /// let body = world.add(&[[0, 1, 2]], &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])?;
    /// // Cut from corner 0 to the middle of the side across.
    /// let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.5, 0.5, 0.0], [0.0, 1.0, 0.0]];
    /// world.set_mesh(body, &[[0, 1, 2], [0, 2, 3]], &positions)?;
    /// assert_eq!(world.triangle_count(body)?, 2);
    /// assert!(world.intersections(Selection::Within(body)).first()?.is_none());
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody), those of [`add`](Self::add), and
    /// [`OutsideLooseBox`](crate::ErrorKind::OutsideLooseBox); the body keeps its mesh and its shape.
    pub fn set_mesh(
        &mut self,
        body: BodyId,
        triangles: &[[u32; 3]],
        positions: &[[S; 3]],
    ) -> Result<(), Error> {
        self.engine.set_mesh(body, triangles, positions)
    }

    /// Begins an edit of a body's mesh: changes that [`apply`](Self::apply) makes all at once, or not at all. See [`Edit`].
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    #[doc(alias = "cut")]
    #[doc(alias = "tear")]
    pub fn edit(&self, body: BodyId) -> Result<Edit<S>, Error> {
        self.engine.edit(body)
    }

    /// Makes the changes of an edit, and says by number what has changed. Triangles and vertices that it does not name keep their numbers,
    /// edges their numbers if they stay: see [`edges`](Self::edges).
    ///
    /// A number that is left empty is [`u32::MAX`] three times in [`triangles`](Self::triangles), and nothing in any answer. Positions keep
    /// one row for every number; rows of empty vertices are not looked at when they are set, and NaN when they are asked for. Filter,
    /// ignored pairs and loose box stay; a new vertex has group 0, or that of the vertex that it was split from; a motion ends if anything
    /// changes.
    ///
    /// Cost: by what the edit names, and the triangles at the vertices of that, whatever the size of the mesh; but O(m) for the first edit
    /// of a body, and when a sixteenth of the triangles were changed since, for the tree is then built anew.
    ///
    /// # Errors
    ///
    /// [`OutdatedEdit`](crate::ErrorKind::OutdatedEdit) if the mesh was changed since the edit was begun, or another
    /// world began it; [`NoTriangles`](crate::ErrorKind::NoTriangles) if none would be left;
    /// [`NoSuchTriangle`](crate::ErrorKind::NoSuchTriangle), [`EmptyTriangle`](crate::ErrorKind::EmptyTriangle),
    /// [`NoSuchVertex`](crate::ErrorKind::NoSuchVertex), [`EmptyVertex`](crate::ErrorKind::EmptyVertex),
    /// [`VertexOutOfRange`](crate::ErrorKind::VertexOutOfRange), [`VertexInUse`](crate::ErrorKind::VertexInUse),
    /// [`NotACorner`](crate::ErrorKind::NotACorner), and for new positions those of [`set_positions`](Self::set_positions).
    pub fn apply(&mut self, edit: &Edit<S>) -> Result<Edited, Error> {
        self.engine.apply(edit)
    }

    /// For each number whether it is that of a triangle, shape (m,): false where an edit has left it empty.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn live_triangles(&self, body: BodyId) -> Result<Vec<bool>, Error> {
        self.engine.live_triangles(body)
    }

    /// For each number whether it is that of a vertex, shape (n,): false where an edit has left it empty.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn live_vertices(&self, body: BodyId) -> Result<Vec<bool>, Error> {
        self.engine.live_vertices(body)
    }

    /// Counts the meshes of a body, and the orders that its trees bring them into: whoever keeps what [`vertex_order`](Self::vertex_order),
    /// [`edges`](Self::edges) or [`triangles`](Self::triangles) says asks for them again when this is another.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn mesh_revision(&self, body: BodyId) -> Result<u64, Error> {
        self.engine.mesh_revision(body)
    }

    /// Builds the tree of a body anew, on the shape it has now. Id, filters and loose box stay. Worth it when a shape has
    /// become very different from the one it was built on; never needed for right answers.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn rebuild(&mut self, body: BodyId) -> Result<(), Error> {
        self.engine.rebuild(body)
    }

    /// How much more the tree of a body does than a fresh one would, estimated from what queries for triangles did in the shape of now: pairs
    /// of nodes that were looked at, for one that a fresh tree would look at. 1 before a query says anything, or where little was looked at.
    ///
    /// The first queries after the body was added tell what a fresh tree does. With [`Options::mending`] trees that have decayed are built
    /// anew, a part of the work whenever the body has a new shape (by [`set_positions`](Self::set_positions) or the end of a motion), as
    /// soon as that would have paid by now; a tree along the mesh ([`Partition::Connectivity`](crate::Partition::Connectivity)) is not, for
    /// it would be the same again.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn tree_quality(&self, body: BodyId) -> Result<f64, Error> {
        self.engine.tree_quality(body)
    }

    /// For each triangle of a body its component, shape (m,): two are in one if they share a vertex, or hang together through others that
    /// do. Components are numbered from 0 in the order of their first triangles; an empty number has [`u32::MAX`].
    ///
    /// Cost: O(m + n).
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    #[doc(alias = "connected_components")]
    pub fn components(&self, body: BodyId) -> Result<Vec<u32>, Error> {
        self.find_components(body)
    }

    /// Makes a body of each component, but of the largest, which stays what it is with all its numbers: that with the most triangles, of
    /// several the first. Returns the new bodies in the order of their first triangles; none, and nothing has changed, if all hangs together.
    ///
    /// What they have from the body: filter, loose box, vertex groups, and whom it [ignores](Self::ignore); if it ignores itself, the
    /// pieces ignore each other and it. So [`Everything`](crate::Selection::Everything) finds what it found. A motion of the body ends, as
    /// by [`apply`](Self::apply). Vertices that no triangle uses stay with it.
    ///
    /// ```
    /// use pliant::World;
    ///
    /// let mut world = World::<f32>::new();
    /// let at = |x: f32| [[x, 0.0, 0.0], [x + 1.0, 0.0, 0.0], [x, 1.0, 0.0]];
    /// let body = world.add(&[[0, 1, 2], [3, 4, 5]], &[at(0.0), at(5.0)].concat())?;
    /// let pieces = world.split(body)?;
    /// assert_eq!(pieces[0].triangles, [1]);
    /// assert_eq!(pieces[0].vertices, [3, 4, 5]);
    /// assert_eq!(world.positions(pieces[0].body)?, at(5.0));
    /// assert_eq!(world.live_triangles(body)?, [true, false]);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// Cost: O(m + n), and building the trees of the pieces.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody); [`TooManyBodies`](crate::ErrorKind::TooManyBodies), and nothing has changed.
    pub fn split(&mut self, body: BodyId) -> Result<Vec<Piece>, Error> {
        self.split_apart(body)
    }

    /// Puts the triangles and vertices of a second body behind those of a first, and removes the second. Says which numbers they have now.
    ///
    /// The first keeps its numbers, its filter and whom it [ignores](Self::ignore); vertices keep their groups. The loose box is then one
    /// around both if both had one, else there is none. Motions of either end, as by [`apply`](Self::apply). Nothing is welded: see
    /// [`weld`](Self::weld).
    ///
    /// ```
    /// use pliant::World;
    ///
    /// let mut world = World::<f32>::new();
    /// let at = |x: f32| [[x, 0.0, 0.0], [x + 1.0, 0.0, 0.0], [x, 1.0, 0.0]];
    /// let a = world.add(&[[0, 1, 2]], &at(0.0))?;
    /// let b = world.add(&[[0, 1, 2]], &at(5.0))?;
    /// let fused = world.fuse(a, b)?;
    /// assert_eq!(fused.triangles, [1]);
    /// assert_eq!(fused.vertices, [3, 4, 5]);
    /// assert_eq!(world.bodies().len(), 1);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// Cost: building a tree for what comes; for both, if the second has more than a sixteenth of the triangles of the first.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody), [`SameBody`](crate::ErrorKind::SameBody), [`TooLarge`](crate::ErrorKind::TooLarge); nothing has changed.
    #[doc(alias = "merge")]
    pub fn fuse(&mut self, a: BodyId, b: BodyId) -> Result<Fused, Error> {
        self.fuse_with(a, b)
    }

    /// Makes boundary edges one where they coincide: where the ends of one are, one by one, at most a tolerance from those of another, in
    /// the unit of the positions, decided exactly. Of vertices that become one the lowest stays where it is, the others go. A boundary edge is
    /// one that exactly one triangle has.
    ///
    /// Vertices that coincide are not welded where no edges do, and never two corners of one triangle. Says what has changed; nothing, if
    /// nothing coincides.
    ///
    /// ```
    /// use pliant::World;
    ///
    /// // Two triangles, each with vertices of its own.
    /// let mut world = World::<f32>::new();
    /// let square = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    /// let body = world.add(&[[0, 1, 2], [3, 4, 5]], &square)?;
    /// let edited = world.weld(body, 0.0)?;
    /// assert_eq!(edited.removed_vertices, [3, 4]);
    /// assert_eq!(world.triangles(body)?, [[0, 1, 2], [0, 2, 5]]);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// Cost: O(m log m), however many are within the tolerance; where not all of these may become one, as often as there are edges that they
    /// come to.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody); [`BadDistance`](crate::ErrorKind::BadDistance) if the tolerance is not a finite number that is at
    /// least 0.
    #[doc(alias = "stitch")]
    pub fn weld(&mut self, body: BodyId, tolerance: f64) -> Result<Edited, Error> {
        self.weld_unless(body, tolerance, None)
    }
}

/// What a body is, and what its tree looks like.
impl<S: Scalar> World<S> {
    /// The triangles of a body as they were added and edited, shape (m, 3): three times [`u32::MAX`] for a number that an [`Edit`] has left
    /// empty.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn triangles(&self, body: BodyId) -> Result<&[[u32; 3]], Error> {
        self.engine.triangles(body)
    }

    /// The edges of a body, shape (k, 2): two vertices each, the smaller first. Every edge once, whatever triangles share it. The number of
    /// an edge is its place here. A degenerate triangle has the edges whose two ends differ.
    ///
    /// They are sorted when they are first asked for, here or by a query for edges. From then on an edge keeps its number while there is a
    /// triangle that has it, however the mesh is edited: a number whose edge is gone is empty, two times [`u32::MAX`], until an edge that
    /// comes takes it, the lowest first; then come new numbers, in the order of the triangles that were changed.
    /// [`set_mesh`](Self::set_mesh) keeps numbers where it edits.
    ///
    /// Cost: O(m) the first time, and after [`rebuild`](Self::rebuild).
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn edges(&self, body: BodyId) -> Result<&[[u32; 2]], Error> {
        self.engine.edges(body)
    }

    /// The shape that a body has now: the positions that it was given last; NaN for vertices that an [`Edit`] has left empty.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn positions(&self, body: BodyId) -> Result<Vec<[S; 3]>, Error> {
        self.engine.positions(body)
    }

    /// How many triangles a body has: of numbers, those left empty by an [`Edit`] counted with the others.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn triangle_count(&self, body: BodyId) -> Result<usize, Error> {
        Ok(self.engine.triangles(body)?.len())
    }

    /// How many vertices a body has, counted by number like triangles: the length that its positions must have.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn vertex_count(&self, body: BodyId) -> Result<usize, Error> {
        self.engine.vertex_count(body)
    }

    /// The order in which queries read the vertices of a body, as the caller numbers them: at place i of memory is vertex
    /// `order[i]`. Shape (n,).
    ///
    /// Queries are faster on a body whose vertices come in this order already, the more so the larger it is. A simulation that
    /// can choose stores them so: vertex i of the new body is vertex `order[i]` of the old one, and triangles name the new
    /// numbers. The tree of the new body is the same, and its order is 0, 1, 2, ...
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    ///
    /// ```
    /// use pliant::World;
    ///
    /// let mut world = World::<f32>::new();
    /// let mut triangles = vec![[9, 1, 2], [2, 1, 3], [4, 8, 6]];
    /// let positions: Vec<[f32; 3]> = (0..10).map(|i| [i as f32, (i * i % 7) as f32, 0.0]).collect();
    /// let body = world.add(&triangles, &positions)?;
    ///
    /// let order = world.vertex_order(body)?.to_vec();
    /// let positions: Vec<_> = order.iter().map(|&old| positions[old as usize]).collect();
    /// let mut new_number = vec![0; order.len()];
    /// for (new, &old) in order.iter().enumerate() {
    ///     new_number[old as usize] = new as u32;
    /// }
    /// for corner in triangles.as_flattened_mut() {
    ///     *corner = new_number[*corner as usize];
    /// }
    /// let body = world.add(&triangles, &positions)?;
    /// assert!(world.vertex_order(body)?.iter().copied().eq(0..10));
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn vertex_order(&self, body: BodyId) -> Result<&[u32], Error> {
        self.engine.vertex_order(body)
    }

    /// The tree of a body in numbers.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn tree_shape(&self, body: BodyId) -> Result<TreeShape, Error> {
        self.engine.tree_shape(body)
    }

    /// For each triangle of a body, the part it is in when the tree is cut at a level: its node of that level, or its leaf, if
    /// that is above. Parts are numbered from 0 in the order of the tree, so that parts with close numbers are close in the
    /// tree. Level 0 is one part, level 1 the children of the root, [`TreeShape::depth`] and all
    /// levels below it the leaves. What an [`Edit`] adds is in trees of its own, each of which is cut at the level, in parts behind the
    /// others. A number that is left empty is in part [`u32::MAX`].
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    ///
    /// ```
    /// use pliant::World;
    ///
    /// let mut world = World::<f32>::new();
    /// let strip: Vec<[u32; 3]> = (0..64).map(|i| [i, i + 1, i + 2]).collect();
    /// let zigzag: Vec<[f32; 3]> = (0..66).map(|i| [i as f32, (i % 2) as f32, 0.0]).collect();
    /// let body = world.add(&strip, &zigzag)?;
    ///
    /// assert!(world.tree_cut(body, 0)?.iter().all(|&part| part == 0));
    /// let parts = world.tree_cut(body, 1)?;
    /// assert_eq!(parts.iter().max(), Some(&7));
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn tree_cut(&self, body: BodyId, level: u32) -> Result<Vec<u32>, Error> {
        self.engine.tree_cut(body, level)
    }

    /// The boxes of a level of a body's tree, and which of them the tree holds for the shape that the body has now: figure 2
    /// of the paper. One box a part, in the order of [`tree_cut`](Self::tree_cut): a leaf above the level stands for
    /// itself.
    ///
    /// The corners are those of the triangles; the tree's own boxes, in single precision, are the same or a rounding
    /// larger. Makes no box, and reads none.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    ///
    /// ```
    /// use pliant::World;
    ///
    /// let mut world = World::<f32>::new();
    /// let body = world.add(&[[0, 1, 2]], &[[0.0; 3], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0]])?;
    /// let root = world.tree_boxes(body, 0)?[0];
    /// assert_eq!((root.lower, root.upper, root.valid), ([0.0; 3], [2.0, 1.0, 0.0], false));
    /// world.intersections(pliant::Selection::Within(body)).prepare()?;
    /// assert!(world.tree_boxes(body, 0)?[0].valid);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn tree_boxes(&self, body: BodyId, level: u32) -> Result<Vec<NodeBox<S>>, Error> {
        self.engine.tree_boxes(body, level)
    }

    /// How many bytes of memory this world holds: bodies, trees, boxes, and the lists that queries keep for the next ones, with all
    /// that they have room for. Threads, and what a query that is under way takes besides, are not counted.
    ///
    /// ```
    /// let mut world = pliant::World::<f32>::new();
    /// let body = world.add(&[[0, 1, 2]], &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])?;
    /// let with_it = world.memory_usage();
    /// world.remove(body)?;
    /// assert!(world.memory_usage() < with_it);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn memory_usage(&self) -> usize {
        self.engine.memory_usage()
    }

    /// Checks every invariant of every tree: the structure, that each box that claims to be valid is the box of the vertices below it
    /// as they are now, and that the nodes of mesh connectivity trees are connected pieces or whole components. For tests and bug
    /// reports; no sequence of calls should ever make it fail.
    ///
    /// Cost: every triangle once a level.
    ///
    /// # Errors
    ///
    /// A sentence that names the body and what is wrong.
    pub fn validate(&self) -> Result<(), String> {
        self.engine.validate()
    }
}

/// For tests, and for who writes worlds down.
impl<S: Scalar> World<S> {
    /// Makes the kernels use other instructions, for tests that all of them give the same answers.
    #[doc(hidden)]
    pub fn use_instructions(&mut self, instructions: Instructions) {
        self.engine.use_instructions(instructions);
    }

    /// The edges of a body, if anybody has asked for them, for whoever writes a world down: their
    /// numbers stay. None if nobody has; they will be sorted.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    #[doc(hidden)]
    pub fn numbered_edges(&self, body: BodyId) -> Result<Option<&[[u32; 2]]>, Error> {
        self.engine.numbered_edges(body)
    }

    /// Numbers the edges of a body as they were when the world was written down. Returns false if
    /// these are not the edges of its mesh, or somebody has asked for them.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    #[doc(hidden)]
    pub fn number_edges(&mut self, body: BodyId, edges: &[[u32; 2]]) -> Result<bool, Error> {
        self.engine.number_edges(body, edges)
    }

    /// The id of the next body, for whoever writes a world down; none if there are no more.
    #[doc(hidden)]
    pub fn next_id(&self) -> Option<u32> {
        self.engine.next_id()
    }

    /// Uses no id below this one any more, or none at all, for whoever reads a world that was written down. Ids never go back.
    #[doc(hidden)]
    pub fn skip_ids(&mut self, next: Option<u32>) {
        self.engine.skip_ids(next);
    }
}

impl<S: Scalar> Default for World<S> {
    fn default() -> Self {
        Self::new()
    }
}

impl<S: Scalar> fmt::Debug for World<S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("World")
            .field("options", self.options())
            .field("bodies", &self.bodies().len())
            .finish_non_exhaustive()
    }
}
