//! Containment: components of bodies that lie wholly inside other bodies.

use super::handle::World;
use super::inside::of_vertex;
use super::scalar::Scalar;
use crate::error::Error;
use crate::geometry::Bounds;
use crate::ids::BodyId;
use crate::points::{InsideRule, Side};
use crate::queries::ContactKind;
use crate::selection::Selection;
use crate::threads::Question;
use std::collections::BTreeSet;
use std::ops::ControlFlow;

/// Component of a body that lies inside another body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Contained {
    /// Body with the component.
    pub body: BodyId,
    /// The component, as [`World::components`] numbers them.
    pub component: u32,
    /// Body that it lies inside.
    pub inside: BodyId,
}

/// Components inside bodies, from [`World::contained`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Containment {
    /// All components that lie inside a body, sorted.
    pub all: Vec<Contained>,
    /// Bodies that are not closed, so that nothing is said to lie inside them; sorted.
    pub open: Vec<BodyId>,
}

/// # Questions: containment
impl<S: Scalar> World<S> {
    /// Finds the components of bodies that lie inside other bodies.
    ///
    /// A component lies inside a closed body under two conditions. None of its triangles crosses or
    /// overlaps one of the body. Every vertex of it is inside or on the body, and one is inside.
    /// Inside is said by [`NonZero`](InsideRule::NonZero). Of a selection of all bodies these are
    /// the pairs that may meet, as filters say; of two bodies either in the other. A body is never
    /// inside itself, so of one body nothing is listed.
    ///
    /// Of a component that touches the body its corners are looked at: a triangle may span a hole
    /// of the body whose edge it touches. Bodies that are not closed are listed, as nothing is said
    /// of their inside.
    ///
    /// Cost: for bodies whose boxes overlap a ray for each component; where it begins inside, a
    /// query for the contacts of both.
    ///
    /// ```
    /// # use pliant::{Selection, World};
    /// let mut world = World::<f64>::new();
    /// let corners = |x: f64, s: f64| [[x, x, x], [x + s, x, x], [x, x + s, x], [x, x, x + s]];
    /// let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    /// let large = world.add(&faces, &corners(0.0, 9.0))?;
    /// let small = world.add(&faces, &corners(1.0, 1.0))?;
    /// let found = world.contained(Selection::World)?;
    /// assert_eq!((found.all[0].body, found.all[0].inside), (small, large));
    /// assert!(world.intersections(Selection::World).all()?.is_empty());
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody), [`SameBody`](crate::ErrorKind::SameBody).
    #[doc(alias = "envelope")]
    pub fn contained(&mut self, of: Selection) -> Result<Containment, Error> {
        self.find_contained(of, None)
    }

    /// [`World::contained`].
    pub(super) fn find_contained(
        &mut self,
        of: Selection,
        question: Option<Question>,
    ) -> Result<Containment, Error> {
        self.state().common.bodies.validate(of)?;
        let bodies: Vec<BodyId> = match of {
            Selection::Within(_) => Vec::new(),
            _ => self.bodies_of(of),
        };
        let mut found = Containment::default();
        // By their lower ends along an axis, so that few pairs are looked at.
        let mut boxes = Vec::with_capacity(bodies.len());
        for &id in &bodies {
            let body = self.state().body(id)?;
            let is_closed = body.mesh().watertight().is_closed();
            if !is_closed {
                found.open.push(id);
            }
            boxes.push((body.bounds(), id, is_closed));
        }
        let lower = |it: &(Bounds<S>, BodyId, bool)| Scalar::to_f64(it.0.lo[0]);
        boxes.sort_by(|a, b| lower(a).total_cmp(&lower(b)));
        let all = &self.state().common.bodies;
        let mut pairs = Vec::new();
        let closed: Vec<usize> = (0..boxes.len()).filter(|&it| boxes[it].2).collect();
        for (place, (its_box, id, is_closed)) in boxes.iter().enumerate() {
            // Of two open bodies none can be inside the other, and there may be very many.
            let (every, next) = (
                place + 1..boxes.len(),
                closed.partition_point(|&it| it <= place),
            );
            let (every, closed) = match is_closed {
                true => (every, &[][..]),
                false => (0..0, &closed[next..]),
            };
            let rest = every.chain(closed.iter().copied()).map(|it| &boxes[it]);
            for (other, other_id, other_is_closed) in
                rest.take_while(|it| it.0.lo[0] <= its_box.hi[0])
            {
                let may_meet = matches!(of, Selection::Between(..))
                    || all.do_meet(all.get(*id)?, all.get(*other_id)?);
                if !its_box.overlaps(other) || !may_meet {
                    continue;
                }
                pairs.extend(is_closed.then_some([*other_id, *id]));
                pairs.extend(other_is_closed.then_some([*id, *other_id]));
            }
        }
        let mut statistics = self.state().common.done_early;
        for pair in pairs {
            self.components_inside(pair, question, &mut found.all)?;
            statistics += *self.statistics();
        }
        self.verbs.state_mut().common.statistics = statistics;
        found.all.sort_unstable();
        found.open.sort_unstable();
        Ok(found)
    }

    /// Lists the components of a body inside another, which is closed.
    fn components_inside(
        &mut self,
        [body, inside]: [BodyId; 2],
        question: Option<Question>,
        found: &mut Vec<Contained>,
    ) -> Result<(), Error> {
        let components = self.find_components(body)?;
        let triangles = self.triangles(body)?.to_vec();
        let positions = self.positions(body)?;
        // The first corner of each component tells where it may be.
        let mut firsts: Vec<u32> = Vec::new();
        for (&component, corners) in components.iter().zip(&triangles) {
            if component as usize == firsts.len() {
                firsts.push(corners[0]);
            }
        }
        let points: Vec<[S; 3]> = firsts.iter().map(|&it| positions[it as usize]).collect();
        let located = self.find_points_inside(&points, inside, InsideRule::NonZero, question);
        let located = located.map_err(|error| of_vertex(error, body, &firsts))?;
        let may_be = |&component: &u32| located[component as usize].side != Side::Outside;
        let mut left: BTreeSet<u32> = (0..firsts.len() as u32).filter(may_be).collect();
        if left.is_empty() {
            return Ok(());
        }
        let mut touching = BTreeSet::new();
        let contacts = self.contacts(Selection::Between(body, inside));
        let _ = contacts.interrupt(question).visit_some(|contacts| {
            for contact in contacts {
                let component = components[contact.pair.triangle_a as usize];
                if contact.kind == ContactKind::Touching {
                    touching.insert(component);
                } else {
                    left.remove(&component);
                }
            }
            if left.is_empty() {
                return ControlFlow::Break(());
            }
            ControlFlow::Continue(())
        })?;
        // Without a contact all of a component is where one corner is.
        if left.iter().any(|it| touching.contains(it)) {
            let located = self.find_inside(body, inside, InsideRule::NonZero, question)?;
            let mut has_inside = BTreeSet::new();
            for (component, corners) in components.iter().zip(&triangles) {
                let sides = corners.map(|it| located.get(it as usize).map(|it| it.side));
                if sides.contains(&Some(Side::Outside)) {
                    left.remove(component);
                }
                if sides.contains(&Some(Side::Inside)) {
                    has_inside.insert(*component);
                }
            }
            left.retain(|component| has_inside.contains(component));
        }
        found.extend(left.into_iter().map(|component| Contained {
            body,
            component,
            inside,
        }));
        Ok(())
    }
}
