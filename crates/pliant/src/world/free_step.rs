//! A step that is free of contact, and what its time alone does not say: whether it begins in contact, and whether anything moves.
//!
//! What is in contact at the start is asked of the shape of now, the worse first. Where triangles
//! intersect, an edge may be through a triangle and near no vertex and no other edge, and each way out
//! of that is a contact of the step. Elements that are within the distance are not kept from coming
//! nearer; where they touch, not from going through each other.

use super::handle::World;
use super::query::Query;
use super::scalar::Scalar;
use crate::error::Error;
use crate::ids::BodyId;
use crate::queries::{EdgeEdge, Pair, VertexTriangle};
use crate::selection::Selection;
use crate::threads::Question;
use std::collections::BTreeMap;
use std::ops::ControlFlow;

/// How far everything may go, and how that begins: what [`World::free_step`] gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeStep {
    /// A time from 0 to 1, to call [`advance_motion`](World::advance_motion) with: that of
    /// [`collision_free_step`](World::collision_free_step).
    pub t: f64,
    /// Two that are in contact at the start already, so that `t` does not promise for them what it
    /// promises for all others; none if everything begins apart. Of several the first: triangles that
    /// intersect, then vertices and triangles, then edges; of one kind the first in the order of lists.
    pub begins_in_contact: Option<InContact>,
    /// Whether a body that was asked about has a motion, be it nowhere. If none has, `t` is 1.
    pub moves: bool,
}

/// Two that are in contact where a step begins: in the shape of now, decided exactly.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum InContact {
    /// Triangles that intersect, be it that they touch.
    Triangles(Pair),
    /// No triangles intersect, but a vertex is at most the distance from a triangle.
    VertexTriangle(VertexTriangle),
    /// Nor that, but two edges are at most the distance apart.
    EdgeEdge(EdgeEdge),
}

impl<S: Scalar> World<S> {
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

    /// [`World::free_step`].
    pub(super) fn find_free_step(
        &mut self,
        of: Selection,
        min_distance: f64,
        question: Option<Question>,
    ) -> Result<FreeStep, Error> {
        let begins_in_contact = self.first_in_contact(of, min_distance, question)?;
        // Last, so that statistics are those of the step.
        let t = self.verbs.collision_free_step(of, min_distance, question)?;
        let bodies = self.bodies_of(of).into_iter();
        let mut are_moving = bodies.map(|body| Ok(self.state().body(body)?.is_moving()));
        let moves = are_moving.try_fold(false, |any, moves| Ok(any || moves?))?;
        Ok(FreeStep {
            t,
            begins_in_contact,
            moves,
        })
    }

    fn first_in_contact(
        &mut self,
        of: Selection,
        distance: f64,
        question: Option<Question>,
    ) -> Result<Option<InContact>, Error> {
        // Mostly there is none, and nothing need be known of groups.
        if self
            .intersections(of)
            .interrupt(question)
            .first()?
            .is_some()
            && let Some(pair) = self.first_intersection(of, question)?
        {
            return Ok(Some(InContact::Triangles(pair)));
        }
        let close = self.close_vertex_triangle_pairs(of, distance);
        if let Some(pair) = least(close.interrupt(question), |close| Some(close.pair))? {
            return Ok(Some(InContact::VertexTriangle(pair)));
        }
        let close = self.close_edge_edge_pairs(of, distance);
        let pair = least(close.interrupt(question), |close| Some(close.pair))?;
        Ok(pair.map(InContact::EdgeEdge))
    }

    /// The first two triangles that intersect and whose vertices are not all of one group.
    fn first_intersection(
        &mut self,
        of: Selection,
        question: Option<Question>,
    ) -> Result<Option<Pair>, Error> {
        let mut groups = BTreeMap::new();
        for body in self.bodies_of(of) {
            groups.insert(
                body,
                (self.triangles(body)?.to_vec(), self.vertex_groups(body)?),
            );
        }
        let group = |body: BodyId, triangle: u32| {
            let (triangles, groups) = groups.get(&body)?;
            let [a, b, c] = triangles[triangle as usize].map(|vertex| groups[vertex as usize]);
            (a != 0 && a == b && b == c).then_some(a)
        };
        let intersections = self.intersections(of).interrupt(question);
        least(intersections, |pair| {
            let of_a = group(pair.body_a, pair.triangle_a);
            let is_kept_apart = of_a.is_some() && of_a == group(pair.body_b, pair.triangle_b);
            (!is_kept_apart).then_some(*pair)
        })
    }
}

/// The least of what some hits are, without a list of all.
fn least<H: Copy, P: Ord>(
    query: Query<'_, H>,
    pair: impl Fn(&H) -> Option<P>,
) -> Result<Option<P>, Error> {
    let mut least = None;
    let _ = query.visit_some(|hits| {
        least = least
            .take()
            .into_iter()
            .chain(hits.iter().filter_map(&pair))
            .min();
        ControlFlow::<()>::Continue(())
    })?;
    Ok(least)
}
