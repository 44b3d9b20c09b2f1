//! A step that is free of contact, and what its time alone does not say: whether it begins in contact, and whether anything moves.
//!
//! What is in contact at the start is asked of the shape of now, the worse first. Where triangles
//! intersect, an edge may be through a triangle and near no vertex and no other edge, and each way out
//! of that is a contact of the step. Elements that are within the distance are not kept from coming
//! nearer; where they touch, not from going through each other.

use super::{BodyId, Query, Scalar, Selection, World};
use crate::error::Error;
use crate::hits::{EdgeEdge, Pair, VertexTriangle};
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
    /// [`World::free_step`].
    pub(super) fn find_free_step(
        &mut self,
        of: Selection,
        min_distance: f64,
        question: Option<Question>,
    ) -> Result<FreeStep, Error> {
        let begins_in_contact = self.first_in_contact(of, min_distance, question)?;
        // Last, so that statistics are those of the step.
        let t = self
            .engine
            .collision_free_step(of, min_distance, question)?;
        let bodies = of.bodies(self);
        let mut are_moving = bodies.into_iter().map(|body| self.engine.is_moving(body));
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
        for body in of.bodies(self) {
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
