//! What is asked of a world: what intersects, what is near, how far apart things are.

use super::handle::World;
use super::query::Query;
use super::scalar::Scalar;
use crate::close_pairs::CloseEdgeEdge;
use crate::close_pairs::CloseTriangles;
use crate::close_pairs::CloseVertexTriangle;
use crate::contacts::Contact;
use crate::error::Error;
use crate::hits::EdgeEdge;
use crate::hits::Pair;
use crate::hits::VertexTriangle;
use crate::ids::BodyId;
use crate::selection::Selection;
use crate::statistics::Statistics;

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
        Query::new(&mut *self.verbs, of)
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
        Query::new(&mut *self.verbs, of)
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
        Query::<VertexTriangle>::new(&mut *self.verbs, of).within(radius)
    }

    /// Asks which edges are near which edges, as [`vertex_triangle_candidates`](Self::vertex_triangle_candidates) asks it of vertices and
    /// triangles. Edges have the numbers that [`edges`](Self::edges) gives them; two that have an end in common are no candidate.
    #[doc(alias = "detect_edge_edge_candidates")]
    pub fn edge_edge_candidates(&mut self, of: Selection, radius: f64) -> Query<'_, EdgeEdge> {
        Query::<EdgeEdge>::new(&mut *self.verbs, of).within(radius)
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
        Query::<CloseVertexTriangle>::new(&mut *self.verbs, of).within(distance)
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
        Query::<CloseEdgeEdge>::new(&mut *self.verbs, of).within(distance)
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
        Query::<CloseTriangles>::new(&mut *self.verbs, of).within(distance)
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
        self.verbs.distance([a, b], cut_off, None)
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
        self.verbs.nearest_body(body, cut_off, None)
    }

    /// What the last query did, with what [`Query::prepare`] did before it.
    pub fn statistics(&self) -> &Statistics {
        &self.state().common.statistics
    }
}
