//! What users ask: the whole world, two bodies, a body with itself; all pairs, the first, or a visitor.
//!
//! There is one query of each kind, which is shown pairs some at a time: a visitor looks at them one by one, *all* collects and
//! sorts them, *first* stops at once.

use super::body::Body;
use super::crowd;
use super::forest::{Forest, with_trees};
use super::step::{Planted, Step};
use super::{BodyId, World, witness};
use crate::error::Error;
use crate::geometry::{Bounds, Scalar};
use crate::pairs::{BodyPair, Pair};
use crate::sort::sort_by_numbers;
use crate::statistics::Statistics;
use crate::traversal::{Show, Wanted};
use crate::update::Meets;
use std::ops::ControlFlow;

/// The whole world: every two bodies that filters let meet, not a body with itself.
impl<S: Scalar> World<S> {
    /// All intersecting pairs of triangles of different bodies, sorted. Triangles intersect as closed sets: touching counts.
    ///
    /// The slice is valid until the next call. Bodies meet as [`set_filter`](Self::set_filter) and
    /// [`ignore`](Self::ignore) say. Surfaces only: a body wholly inside another meets none of its triangles.
    ///
    /// Cost: the pass over all moved vertices is done already; what comes is the broad phase, O(n + overlaps) for bodies
    /// that move a little, and for bodies whose boxes overlap, what grows with the region where they are close.
    #[doc(alias = "rtcCollide")]
    #[doc(alias = "bvhcast")]
    #[doc(alias = "findCollidingTriangles")]
    pub fn intersection_pairs(&mut self) -> &[Pair] {
        let mut pairs = std::mem::take(&mut self.pairs);
        pairs.clear();
        self.show_intersections(Wanted::All, &mut |[body_a, body_b], found| {
            pairs.extend(found.iter().map(|&[triangle_a, triangle_b]| Pair {
                body_a,
                triangle_a,
                body_b,
                triangle_b,
            }));
            ControlFlow::Continue(())
        });
        // The bodies on the left come in order already.
        for of_one_body in pairs.chunk_by_mut(|p, q| p.body_a == q.body_a) {
            let body_a = of_one_body[0].body_a;
            sort_by_numbers(
                &self.threads,
                of_one_body,
                &mut self.keys,
                |pair| [pair.triangle_a, pair.body_b.0, pair.triangle_b],
                |[triangle_a, body_b, triangle_b]| Pair {
                    body_a,
                    triangle_a,
                    body_b: BodyId(body_b),
                    triangle_b,
                },
            );
        }
        self.pairs = pairs;
        &self.pairs
    }

    /// Some intersecting pair of triangles of different bodies, if there is one. Much cheaper than all where there are many.
    ///
    /// Whether there is one never depends on options or history; which one may.
    pub fn first_intersection(&mut self) -> Option<Pair> {
        if let Some([a, b]) = self
            .witnesses
            .of_world
            .filter(|&bodies| self.do_meet(bodies))
            && let Some([triangle_a, triangle_b]) = self.ask_witness([a, b])
        {
            return Some(Pair {
                body_a: a,
                triangle_a,
                body_b: b,
                triangle_b,
            });
        }
        let found = self.visit_intersections(ControlFlow::Break).break_value();
        self.witnesses.of_world = found.map(|pair| [pair.body_a, pair.body_b]);
        if let Some(bodies) = self.witnesses.of_world {
            self.keep_witness(bodies);
        }
        found
    }

    /// Shows `visit` every intersecting pair of triangles of different bodies once, until it breaks; returns what it broke
    /// with. The order is deterministic, not sorted.
    ///
    /// ```
    /// # use pliant::World;
    /// use std::ops::ControlFlow;
    ///
    /// # let mut world = World::<f32>::new();
    /// # for z in [0.0, 0.5] {
    /// #     world.add(&[[0, 1, 2], [0, 1, 3]], &[[0.0, 0.0, z], [4.0, 0.0, z], [0.0, 4.0, z], [0.0, 0.0, z + 1.0]])?;
    /// # }
    /// let mut budget = 2;
    /// let exhausted = world.visit_intersections(|pair| {
    ///     println!("{} of {} and {} of {}", pair.triangle_a, pair.body_a, pair.triangle_b, pair.body_b);
    ///     budget -= 1;
    ///     if budget == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    /// });
    /// # assert!(exhausted.is_break());
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn visit_intersections<B>(
        &mut self,
        mut visit: impl FnMut(Pair) -> ControlFlow<B>,
    ) -> ControlFlow<B> {
        let mut answer = ControlFlow::Continue(());
        self.show_intersections(Wanted::UntilBreak, &mut |[body_a, body_b], found| {
            let visit = |[triangle_a, triangle_b]: [u32; 2]| {
                visit(Pair {
                    body_a,
                    triangle_a,
                    body_b,
                    triangle_b,
                })
            };
            one_by_one(found, visit, &mut answer)
        });
        answer
    }

    /// Shows every intersecting pair of different bodies, those of two bodies after the other, until `show` breaks; if all
    /// are wanted, it never does.
    fn show_intersections(
        &mut self,
        wanted: Wanted,
        show: &mut dyn FnMut([BodyId; 2], &[[u32; 2]]) -> ControlFlow<usize>,
    ) {
        self.begin(wanted);
        self.find_body_pairs();
        let body_pairs = std::mem::take(&mut self.body_pairs);
        // A visitor that panics takes the list with it: it is then found anew.
        self.body_pairs_hold = false;
        let mut crowd = std::mem::take(&mut self.crowd);
        let (mut step, bodies, forest) = self.step();
        with_trees!(forest, trees => {
            if wanted == Wanted::All && crowd::is_worth_it(step.threads, bodies, &body_pairs) {
                crowd.meet(&mut step, bodies, trees, &body_pairs);
                for (pair, found) in crowd.found() {
                    let ids = body_pairs[pair].map(|place| bodies[place].id());
                    let _ = show(ids, found);
                }
            } else {
                for &places in &body_pairs {
                    let ids = places.map(|place| bodies[place].id());
                    let both = Planted::both(bodies, trees, places);
                    if step.meet(both, &mut |found| show(ids, found)).is_break() {
                        break;
                    }
                }
            }
        });
        self.crowd = crowd;
        self.body_pairs = body_pairs;
        self.body_pairs_hold = true;
    }
}

/// Two bodies by name, whatever filters say.
impl<S: Scalar> World<S> {
    /// All intersecting pairs (triangle of `a`, triangle of `b`), sorted. See
    /// [`intersection_pairs`](Self::intersection_pairs).
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody); [`SameBody`](crate::ErrorKind::SameBody) if `a` is `b`.
    pub fn intersection_pairs_between(
        &mut self,
        a: BodyId,
        b: BodyId,
    ) -> Result<&[[u32; 2]], Error> {
        let places = self.two_bodies(a, b)?;
        Ok(self.collect_pairs(|world, show| world.show_between(places, Wanted::All, show)))
    }

    /// Some intersecting pair (triangle of `a`, triangle of `b`), if there is one.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody); [`SameBody`](crate::ErrorKind::SameBody) if `a` is `b`.
    pub fn first_intersection_between(
        &mut self,
        a: BodyId,
        b: BodyId,
    ) -> Result<Option<[u32; 2]>, Error> {
        self.two_bodies(a, b)?;
        if let Some(pair) = self.ask_witness([a, b]) {
            return Ok(Some(pair));
        }
        let found = self
            .visit_intersections_between(a, b, ControlFlow::Break)?
            .break_value();
        if found.is_some() {
            self.keep_witness([a, b]);
        }
        Ok(found)
    }

    /// Shows `visit` every intersecting pair (triangle of `a`, triangle of `b`) once, until it breaks.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody); [`SameBody`](crate::ErrorKind::SameBody) if `a` is `b`.
    pub fn visit_intersections_between<B>(
        &mut self,
        a: BodyId,
        b: BodyId,
        mut visit: impl FnMut([u32; 2]) -> ControlFlow<B>,
    ) -> Result<ControlFlow<B>, Error> {
        let places = self.two_bodies(a, b)?;
        let mut answer = ControlFlow::Continue(());
        self.show_between(places, Wanted::UntilBreak, &mut |found| {
            one_by_one(found, &mut visit, &mut answer)
        });
        Ok(answer)
    }

    fn show_between(&mut self, places: [usize; 2], wanted: Wanted, show: Show) {
        self.begin(wanted);
        let (mut step, bodies, forest) = self.step();
        with_trees!(forest, trees => {
            let _ = step.meet(Planted::both(bodies, trees, places), show);
        });
    }
}

/// A body with itself: pairs of its triangles that intersect and have no vertex in common.
impl<S: Scalar> World<S> {
    /// All intersecting pairs (smaller triangle, larger triangle) of a body with itself, sorted. Triangles that share a vertex
    /// are left out: they always touch.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    #[doc(alias = "findSelfCollidingTriangles")]
    #[doc(alias = "self_intersections")]
    pub fn self_intersection_pairs(&mut self, body: BodyId) -> Result<&[[u32; 2]], Error> {
        let place = self.place(body)?;
        Ok(self.collect_pairs(|world, show| world.show_itself(place, Wanted::All, show)))
    }

    /// Some intersecting pair of a body with itself, if there is one.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    #[doc(alias = "does_self_intersect")]
    pub fn first_self_intersection(&mut self, body: BodyId) -> Result<Option<[u32; 2]>, Error> {
        self.place(body)?;
        if let Some([a, b]) = self.ask_witness([body; 2]) {
            return Ok(Some([a.min(b), a.max(b)]));
        }
        let found = self
            .visit_self_intersections(body, ControlFlow::Break)?
            .break_value();
        if found.is_some() {
            self.keep_witness([body; 2]);
        }
        Ok(found)
    }

    /// Shows `visit` every intersecting pair of a body with itself once, until it breaks.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn visit_self_intersections<B>(
        &mut self,
        body: BodyId,
        mut visit: impl FnMut([u32; 2]) -> ControlFlow<B>,
    ) -> Result<ControlFlow<B>, Error> {
        let place = self.place(body)?;
        let mut answer = ControlFlow::Continue(());
        self.show_itself(place, Wanted::UntilBreak, &mut |found| {
            one_by_one(found, &mut visit, &mut answer)
        });
        Ok(answer)
    }

    fn show_itself(&mut self, place: usize, wanted: Wanted, show: Show) {
        self.begin(wanted);
        let (mut step, bodies, forest) = self.step();
        with_trees!(forest, trees => {
            let _ = step.meet_itself(Planted::at(bodies, trees, place), show);
        });
    }
}

/// Timing control, and what a query cost.
impl<S: Scalar> World<S> {
    /// Does early what a query of the whole world would do first: finds the bodies that may meet and makes the upper levels
    /// of their trees true. Never needed for right answers.
    pub fn update(&mut self) {
        self.settle_origin();
        self.find_body_pairs();
        let body_pairs = std::mem::take(&mut self.body_pairs);
        self.early(body_pairs.as_flattened());
        self.body_pairs = body_pairs;
    }

    /// Does early what a query that names `body` would do first: makes the upper levels of its tree true. Never needed for
    /// right answers.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn update_body(&mut self, body: BodyId) -> Result<(), Error> {
        let place = self.place(body)?;
        self.settle_origin();
        self.early(&[place]);
        Ok(())
    }

    /// What the last query did, and the calls of [`update`](Self::update) and [`update_body`](Self::update_body) before it.
    pub fn statistics(&self) -> &Statistics {
        &self.statistics
    }
}

/// The pair that answered the last question for a first pair.
impl<S: Scalar> World<S> {
    /// Whether two bodies that were there are there still, and meet in queries of the whole world.
    fn do_meet(&self, [a, b]: [BodyId; 2]) -> bool {
        let [body_a, body_b] =
            [a, b].map(|body| self.places.get(&body).map(|&place| &self.bodies[place]));
        !self.ignored.contains(&(a, b))
            && matches!((body_a, body_b), (Some(body_a), Some(body_b)) if body_a.may_meet(body_b))
    }

    /// A pair of these bodies at or near the last answer, if one intersects, as the caller numbers triangles.
    fn ask_witness(&mut self, bodies: [BodyId; 2]) -> Option<[u32; 2]> {
        let last = self.witnesses.get(bodies)?;
        let both = bodies.map(|body| &self.bodies[self.places[&body]]);
        let mut statistics = self.done_early;
        let found = witness::near(both, last, &mut statistics)?;
        self.statistics = statistics;
        self.done_early = Statistics::default();
        let [a, b] = found;
        let names = [both[0].name(a), both[1].name(b)];
        self.witnesses.keep(bodies, found);
        Some(names)
    }

    /// Keeps the pair at which the last traversal stopped.
    fn keep_witness(&mut self, bodies: [BodyId; 2]) {
        if let Some(found) = self.scratch.broke_at.take() {
            self.witnesses.keep(bodies, found);
        }
    }
}

/// What the queries have in common.
impl<S: Scalar> World<S> {
    /// At the beginning of every query.
    fn begin(&mut self, wanted: Wanted) {
        self.settle_origin();
        self.scratch.begin(wanted);
        self.statistics = std::mem::take(&mut self.done_early);
    }

    /// A query, and the bodies and trees it works on.
    fn step(&mut self) -> (Step<'_>, &mut [Body<S>], &mut Forest) {
        let step = Step {
            update: self.options.update,
            level: self.level,
            threads: &self.threads,
            origin: self.origin,
            scratch: &mut self.scratch,
            statistics: &mut self.statistics,
        };
        (step, &mut self.bodies, &mut self.forest)
    }

    /// Makes the upper levels of some trees true before a query, and keeps account of it for that query.
    fn early(&mut self, places: &[usize]) {
        let before = std::mem::replace(&mut self.statistics, self.done_early);
        let (mut step, bodies, forest) = self.step();
        with_trees!(forest, trees => {
            for &place in places {
                step.refresh_ahead(&mut Planted::at(bodies, trees, place), Meets::Another);
            }
        });
        self.done_early = std::mem::replace(&mut self.statistics, before);
    }

    /// The broad phase: bodies whose boxes overlap and that filters let meet, into `body_pairs`, the smaller id first, in the
    /// order of ids.
    fn find_body_pairs(&mut self) {
        if std::mem::replace(&mut self.body_pairs_hold, true) {
            return;
        }
        let Self {
            bodies,
            ignored,
            broad_phase,
            origin,
            boxes,
            body_pairs,
            ..
        } = self;
        boxes.clear();
        boxes.extend(bodies.iter().map(|body| body.broad_box(*origin)));
        let in_order = |[a, b]: BodyPair| {
            let places = [a as usize, b as usize];
            if bodies[places[0]].id() < bodies[places[1]].id() {
                places
            } else {
                [places[1], places[0]]
            }
        };
        body_pairs.clear();
        body_pairs.extend(
            broad_phase
                .overlapping(boxes)
                .iter()
                .copied()
                .map(in_order)
                .filter(|places| {
                    let [a, b] = places.map(|place| &bodies[place]);
                    a.may_meet(b)
                        && a.exact_box(*origin).overlaps(&b.exact_box(*origin))
                        && !ignored.contains(&(a.id(), b.id()))
                }),
        );
        body_pairs.sort_unstable_by_key(|places| places.map(|place| bodies[place].id()));
    }

    /// For `f64`: moves the point that boxes are relative to when the bodies have moved away from it, because the digits of an
    /// `f32` are best spent on the shape. All boxes are then to be made anew.
    ///
    /// Looking at all bodies costs O(n), so it is done only when as many shapes were taken over as there are bodies.
    fn settle_origin(&mut self) {
        if S::BOXES_ARE_EXACT || self.moves < self.bodies.len() {
            return;
        }
        self.moves = 0;
        let mut extent = Bounds::EMPTY;
        for bounds in self.bodies.iter().map(Body::bounds) {
            extent.include(bounds.lo);
            extent.include(bounds.hi);
        }
        let (lo, hi) = (extent.lo.map(S::to_f64), extent.hi.map(S::to_f64));
        let centre: [f64; 3] = std::array::from_fn(|axis| f64::midpoint(lo[axis], hi[axis]));
        let largest = |values: [f64; 3]| values.into_iter().fold(0.0, f64::max);
        let radius = largest(std::array::from_fn(|axis| (hi[axis] - lo[axis]) / 2.0));
        let away = largest(std::array::from_fn(|axis| {
            (centre[axis] - self.origin[axis]).abs()
        }));
        // Within two radii a box loses two of its 24 bits at most; the slack keeps a moving world from settling every step.
        if away > 2.0 * radius {
            let [x, y, z] = centre;
            self.origin = [x, y, z, 0.0];
            self.bodies.iter_mut().for_each(Body::forget_boxes);
            self.body_pairs_hold = false;
        }
    }

    /// All pairs of a query that is shown them, sorted.
    fn collect_pairs(&mut self, query: impl FnOnce(&mut Self, Show)) -> &[[u32; 2]] {
        let mut pairs = std::mem::take(&mut self.pairs_of_bodies);
        pairs.clear();
        query(self, &mut |found| {
            pairs.extend_from_slice(found);
            ControlFlow::Continue(())
        });
        sort_by_numbers(
            &self.threads,
            &mut pairs,
            &mut self.keys,
            |&pair| pair,
            |pair| pair,
        );
        self.pairs_of_bodies = pairs;
        &self.pairs_of_bodies
    }
}

/// Shows a visitor pairs one by one, until it breaks: keeps what it broke with, and returns where.
fn one_by_one<B>(
    found: &[[u32; 2]],
    mut visit: impl FnMut([u32; 2]) -> ControlFlow<B>,
    answer: &mut ControlFlow<B>,
) -> ControlFlow<usize> {
    for (place, &pair) in found.iter().enumerate() {
        if let ControlFlow::Break(value) = visit(pair) {
            *answer = ControlFlow::Break(value);
            return ControlFlow::Break(place);
        }
    }
    ControlFlow::Continue(())
}
