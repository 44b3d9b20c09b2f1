//! Inside, outside or on: points of the caller, and vertices of bodies, against closed bodies.

use super::handle::World;
use super::scalar::Scalar;
use crate::error::{Error, ErrorKind};
use crate::ids::BodyId;
use crate::mesh::Watertight;
use crate::points::{InsideRule, Located};
use crate::threads::Question;

/// Most edges that an error names.
const NAMED: usize = 3;

/// # Questions: inside, outside, on
impl<S: Scalar> World<S> {
    /// Lists the edges at which a body is not a closed surface.
    ///
    /// A closed body has an inside. Closed is said of the mesh, not of its shape: a body stays
    /// closed however it moves. Cost: O(m log m) the first time after the mesh has changed.
    ///
    /// ```
    /// # use pliant::World;
    /// let mut world = World::<f32>::new();
    /// let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    /// let tent = world.add(&[[0, 1, 3], [1, 2, 3], [2, 0, 3]], &corners)?;
    /// assert_eq!(world.watertight(tent)?.open, [[0, 1], [0, 2], [1, 2]]);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    #[doc(alias = "is_closed")]
    #[doc(alias = "manifold")]
    pub fn watertight(&self, body: BodyId) -> Result<Watertight, Error> {
        Ok(self.state().body(body)?.mesh().watertight().clone())
    }

    /// Says of points whether they are inside a closed body, outside, or on its surface: one answer
    /// for each, shape (k,).
    ///
    /// Exact, for the points and the shape as given. No point is undecided, however near it is to
    /// the surface, on a vertex or an edge as anywhere. Right for bodies that cross themselves.
    /// Filters and motions do not count.
    ///
    /// Cost: refitting the body, in whole if points are many. For each point the nodes and
    /// triangles on the way straight to the nearest side of the body's box.
    ///
    /// ```
    /// # use pliant::World;
    /// use pliant::{InsideRule, Side};
    ///
    /// let mut world = World::<f64>::new();
    /// let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    /// let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    /// let body = world.add(&faces, &corners)?;
    /// let points = [0.25, 1e-300, 0.0, -1e-300].map(|z| [0.25, 0.25, z]);
    /// let found = world.points_inside(&points, body, InsideRule::NonZero)?;
    /// let sides: Vec<Side> = found.iter().map(|it| it.side).collect();
    /// assert_eq!(sides, [Side::Inside, Side::Inside, Side::On, Side::Outside]);
    /// assert_eq!(found[0].winding, 1);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody), [`BadPoint`](crate::ErrorKind::BadPoint).
    /// [`NotClosed`](crate::ErrorKind::NotClosed), with some edges, for a body of which
    /// [`is_closed`](Watertight::is_closed) is false; with the rule of parity
    /// [`is_even`](Watertight::is_even).
    #[doc(alias = "contains")]
    #[doc(alias = "occupancy")]
    #[doc(alias = "winding_number")]
    pub fn points_inside(
        &mut self,
        points: &[[S; 3]],
        body: BodyId,
        rule: InsideRule,
    ) -> Result<Vec<Located>, Error> {
        self.find_points_inside(points, body, rule, None)
    }

    /// Says of each vertex of a body whether it is inside another, a closed one: shape (n,).
    ///
    /// As [`points_inside`](Self::points_inside) says it of their positions. Vertex numbers that
    /// are empty are outside.
    ///
    /// # Errors
    ///
    /// As [`points_inside`](Self::points_inside), and [`SameBody`](crate::ErrorKind::SameBody) if
    /// both are one.
    pub fn inside(
        &mut self,
        a: BodyId,
        b: BodyId,
        rule: InsideRule,
    ) -> Result<Vec<Located>, Error> {
        self.find_inside(a, b, rule, None)
    }

    /// [`World::points_inside`].
    pub(super) fn find_points_inside(
        &mut self,
        points: &[[S; 3]],
        body: BodyId,
        rule: InsideRule,
        question: Option<Question>,
    ) -> Result<Vec<Located>, Error> {
        self.check_closed(body, rule)?;
        let windings = self.verbs.windings(body, points, question)?;
        Ok(windings.into_iter().map(|it| it.located(rule)).collect())
    }

    /// Refuses a body that is not closed, as a rule needs it.
    pub(super) fn check_closed(&self, body: BodyId, rule: InsideRule) -> Result<(), Error> {
        let found = self.state().body(body)?.mesh().watertight();
        let turned = match rule {
            InsideRule::Parity => &[][..],
            InsideRule::NonZero | InsideRule::Positive => &found.turned,
        };
        let mut edges = [&found.open, turned].concat();
        let count = edges.len();
        if count == 0 {
            return Ok(());
        }
        edges.truncate(NAMED);
        Err(Error {
            body: Some(body),
            kind: ErrorKind::NotClosed { edges, count },
        })
    }

    /// [`World::inside`].
    pub(super) fn find_inside(
        &mut self,
        a: BodyId,
        b: BodyId,
        rule: InsideRule,
        question: Option<Question>,
    ) -> Result<Vec<Located>, Error> {
        if a == b {
            let (body, kind) = (Some(a), ErrorKind::SameBody);
            return Err(Error { body, kind });
        }
        let body = self.state().body(a)?;
        self.check_closed(b, rule)?;
        // Neighbours in this order are neighbours in space.
        let mesh = body.mesh();
        let order = mesh.vertex_order();
        let positions = body.positions();
        let order: Vec<u32> = order
            .iter()
            .copied()
            .filter(|&it| !mesh.is_empty(it))
            .collect();
        let points: Vec<[S; 3]> = order.iter().map(|&it| positions[it as usize]).collect();
        let mut located = vec![Located::default(); positions.len()];
        let windings = self.verbs.windings(b, &points, question);
        let windings = windings.map_err(|error| of_vertex(error, a, &order))?;
        for (vertex, winding) in order.into_iter().zip(windings) {
            located[vertex as usize] = winding.located(rule);
        }
        Ok(located)
    }
}

/// The error of a question about vertices of a body, given the one about points. The body has them,
/// so one is lost by this thread.
pub(super) fn of_vertex(error: Error, body: BodyId, vertices: &[u32]) -> Error {
    match error.kind {
        ErrorKind::BadPoint { point, .. } => Error {
            body: Some(body),
            kind: ErrorKind::NeedsSubnormals {
                vertex: vertices[point] as usize,
            },
        },
        _ => error,
    }
}
