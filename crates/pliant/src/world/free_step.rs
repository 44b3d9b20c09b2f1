//! Steps free of contact, with two facts that the time alone does not tell: contact at the start,
//! and whether anything moves.
//!
//! Contact at the start is a question about the present shape, the worse kind first. Where
//! triangles intersect, an edge may go through a triangle and be near no vertex and no other edge.
//! Each way out of that is then a contact of the step. Elements that are within the distance are
//! not kept from coming nearer. Elements that touch are not kept from going through each other.

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

/// Answer of [`World::free_step`]: how far everything may go, and how that begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeStep {
    /// Time from 0 to 1, to call [`advance_motion`](World::advance_motion) with, as
    /// [`collision_free_step`](World::collision_free_step) gives it.
    pub t: f64,
    /// First pair that is in contact at the start already; `None` if everything begins apart.
    ///
    /// For such pairs `t` does not promise what it promises for all others. Triangles that
    /// intersect come first, then vertices and triangles, then edges; within a kind the order is
    /// the order of lists.
    pub begins_in_contact: Option<InContact>,
    /// Whether any body of the selection has a motion, be it nowhere. If none has, `t` is 1.
    pub moves: bool,
}

/// Pair that is in contact where a step begins: in the present shape, decided exactly.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum InContact {
    /// Triangles that intersect, be it that they only touch.
    Triangles(Pair),
    /// A vertex at most the distance from a triangle, where no triangles intersect.
    VertexTriangle(VertexTriangle),
    /// Two edges at most the distance apart, where no triangles intersect and no vertex is so near
    /// a triangle.
    EdgeEdge(EdgeEdge),
}

/// # Motions: steps free of contact
impl<S: Scalar> World<S> {
    /// Computes how far everything may go and stay further apart than `min_distance`, and how that
    /// begins.
    ///
    /// The distance is in the unit of the positions. The time `t`, from 0 to 1, is to call
    /// [`advance_motion`](Self::advance_motion) with. It is what
    /// [`collision_free_step`](Self::collision_free_step) gives, and promises the same. Without any
    /// motion it is 1, and [`moves`](FreeStep::moves) is false.
    ///
    /// Nothing is promised for what is in contact at the start. Surfaces that are through each
    /// other meet on every way out, so `t` may be small for no other reason. Elements that touch
    /// may go through each other. Elements nearer than `min_distance` are kept from touching, not
    /// from coming nearer.
    ///
    /// [`begins_in_contact`](FreeStep::begins_in_contact) names the first such pair:
    ///
    /// - triangles that intersect in the present shape, as [`intersections`](Self::intersections)
    ///   finds them, unless all six vertices are in one [group](Self::set_vertex_groups);
    /// - if there are none, elements at most `min_distance` apart. With a `min_distance` of 0 they
    ///   touch. They are of the pairs that
    ///   [`vertex_triangle_impacts`](Self::vertex_triangle_impacts) and
    ///   [`edge_edge_impacts`](Self::edge_edge_impacts) look at.
    ///
    /// Both are decided exactly, and touching counts. So a world in which no pair is named never
    /// has one while such steps alone advance it, unless vertex groups let it. Triangles that share
    /// a vertex of the mesh and are through each other beyond it are not found.
    ///
    /// A mesh with edges shorter than `min_distance` is always that near to itself. Then see
    /// whether the pair is [`InContact::Triangles`], or ask with a smaller distance. Elements
    /// further apart than `min_distance` by a thousandth of it or less are in no contact, but may
    /// stop the step at 0.
    ///
    /// ```
    /// # use pliant::{Selection, World};
    /// # let mut world = World::<f64>::new();
    /// # let large = [[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]];
    /// # let floor = world.add(&[[0, 1, 2]], &large)?;
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
    /// Cost: [`collision_free_step`](Self::collision_free_step), both queries for close pairs
    /// within `min_distance`, and the first intersection. [`statistics`](Self::statistics) count
    /// the first of these alone.
    ///
    /// # Errors
    ///
    /// The errors of [`Query`].
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
        // The step comes last, so that statistics are about it.
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
        // Mostly there is none; then groups need not be looked up.
        if self
            .intersections(of)
            .interrupt(question)
            .first()?
            .is_some()
            && let Some(pair) = self.first_intersection(of, question)?
        {
            return Ok(Some(InContact::Triangles(pair)));
        }
        let close = self
            .close_vertex_triangle_pairs(of, distance)
            .leaving_nothing_out();
        if let Some(pair) = least(close.interrupt(question), |close| Some(close.pair))? {
            return Ok(Some(InContact::VertexTriangle(pair)));
        }
        let close = self
            .close_edge_edge_pairs(of, distance)
            .leaving_nothing_out();
        let pair = least(close.interrupt(question), |close| Some(close.pair))?;
        Ok(pair.map(InContact::EdgeEdge))
    }

    /// Finds the first two triangles that intersect and whose vertices are not all of one group.
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

/// Finds the least of the values that `pair` makes of hits, without a list of all.
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
