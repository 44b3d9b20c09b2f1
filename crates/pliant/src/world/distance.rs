//! How far two bodies are apart, and a body from all others.
//!
//! Nothing, if their triangles intersect: that is asked first. Else the triangles whose boxes are nearest are measured, until no box is
//! near enough to hold nearer ones. The pair that was nearest the last time is measured before all others: mostly it still
//! nearly is, and then hardly a box is opened that does not have to be.

use super::BodyId;
use super::engine::{Engine, pair_of};
use super::query::{Ask, Request};
use super::selection::Selection;
use super::step::Step;
use super::witness::Witnesses;
use crate::close_pairs::CloseTriangles;
use crate::error::{Error, ErrorKind};
use crate::geometry::Shape;
use crate::held::Held;
use crate::hits::Pair;
use crate::kernels::{Coordinate, dispatch};
use crate::queries::{
    Candidate, Intersections, Kind, NearestPair, close, closest_of_triangles, corners_of,
};
use crate::threads::{Executor, Interrupt, Question};
use crate::traversal::{NearestScratch, TreePair, TwoTrees, gap_square, nearest};
use crate::update::{Partner, Refit};
use std::ops::ControlFlow;

/// What a world keeps for distances.
#[derive(Debug, Default)]
pub(super) struct Distances {
    scratch: NearestScratch,
    /// The triangles that were nearest the last time.
    pub(super) last: Witnesses,
}

impl<const N: usize, S: Coordinate> Engine<N, S> {
    /// The nearest triangles of two bodies, if they are at most so far apart.
    pub(super) fn distance_of(
        &mut self,
        of: [BodyId; 2],
        cut_off: f64,
        question: Option<Question>,
    ) -> Result<Option<CloseTriangles>, Error> {
        check(cut_off)?;
        let [a, b] = of;
        let request = Request {
            of: Selection::Between(a, b),
            most: usize::MAX,
            question,
            within: cut_off,
        };
        if Ask::<Pair>::first(self, &request)?.is_some() {
            return Ok(self.in_common(of));
        }
        let interrupt = Interrupt::new(question);
        let found = self.nearest_triangles(of, cut_off, &interrupt)?;
        self.common.end(&interrupt)?;
        Ok(found)
    }

    /// The nearest triangles of a body and of all others that may meet it, if they are at most so far apart.
    pub(super) fn nearest_body_of(
        &mut self,
        id: BodyId,
        cut_off: f64,
        question: Option<Question>,
    ) -> Result<Option<CloseTriangles>, Error> {
        check(cut_off)?;
        self.common.settle_origin();
        let body = self.common.bodies.get(id)?;
        let (origin, kind) = (self.common.origin.point, Intersections::default());
        let own = body.box_for(&kind, origin);
        let others = self.common.bodies.list.iter();
        let others =
            others.filter(|other| other.id != id && self.common.bodies.do_meet(body, other));
        let gaps = others.map(|other| (gap_square(&own, &other.box_for(&kind, origin)), other.id));
        let mut gaps: Vec<(f64, BodyId)> = gaps.collect();
        gaps.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut statistics = self.common.done_early;
        let (mut nearest, mut within) = (None, cut_off);
        for (gap, other) in gaps {
            if gap > squared(within) {
                break;
            }
            let found = self.distance_of([id, other], within, question);
            statistics += self.common.statistics;
            if let Some(found) = found? {
                let is_nearer = |known: &CloseTriangles| found.distance < known.distance;
                if nearest.as_ref().is_none_or(is_nearer) {
                    within = found.distance;
                    nearest = Some(found);
                }
            }
        }
        self.common.statistics = statistics;
        Ok(nearest)
    }

    /// The triangles of two bodies that intersect, as just asked, with a point in common.
    fn in_common(&self, of: [BodyId; 2]) -> Option<CloseTriangles> {
        let found = self.witnesses.get(of)?;
        let [a, b] = of.map(|id| self.common.bodies.get(id));
        let both = [a.ok()?, b.ok()?];
        // They were perhaps not brought into tree order.
        let [a, b] = [0, 1].map(|which| both[which].corners_now(found[which]));
        let [a, b] = [a, b].map(|corners| corners.map(|[x, y, z]| [x, y, z, z]));
        let corners = [a.each_ref(), b.each_ref()];
        let never = Interrupt::default();
        let closest =
            dispatch!(self.common.instructions, i => closest_of_triangles(i, &corners, &never))?;
        Some(close(pair_of(both, found), &corners, &closest))
    }

    /// The nearest triangles of two bodies that do not intersect.
    fn nearest_triangles(
        &mut self,
        of: [BodyId; 2],
        cut_off: f64,
        interrupt: &Interrupt,
    ) -> Result<Option<CloseTriangles>, Error> {
        let common = &mut self.common;
        let origin = common.origin.point;
        let places = [common.bodies.place(of[0])?, common.bodies.place(of[1])?];
        let instructions = common.instructions;
        let kind = &Intersections::default();
        let both = common.bodies.two(places);
        let [box_a, box_b] = both.each_ref().map(|body| body.box_for(kind, origin));
        if gap_square(&box_a, &box_b) > squared(cut_off) {
            return Ok(None);
        }
        let refit = Refit {
            executor: Executor {
                threads: common.threads.here(),
                interrupt,
            },
            instructions,
            update: common.options.update,
        };
        let mut step = Step {
            kind,
            refit,
            origin,
            scratch: &mut self.intersections.scratch,
            statistics: &mut common.statistics,
        };
        let [a, b] = both;
        let sides = (
            step.ahead(a, Partner::Another),
            step.ahead(b, Partner::Another),
        );
        let (ControlFlow::Continue(a), ControlFlow::Continue(b)) = sides else {
            return Ok(None);
        };
        let mut pair = TwoTrees { a, b };
        let mut found = NearestPair::within(cut_off);
        let mut exact = 0;
        let mut measure = |shapes: [&Shape<'_, S>; 2], triangles: Candidate| {
            let corners = [0, 1].map(|which| corners_of(shapes[which], triangles[which]));
            found.measure(instructions, triangles, &corners, interrupt, &mut exact);
            found.limit()
        };
        let mut limit = squared(cut_off);
        if let Some(last) = self.distances.last.get(of) {
            limit = measure([&pair.a.source, &pair.b.source], last);
        }
        let statistics = &mut *step.statistics;
        let scratch = &mut self.distances.scratch;
        let _ = nearest(refit, &mut pair, scratch, statistics, limit, &mut measure);
        statistics.exact_decisions += exact;
        let Some((triangles, closest)) = found.found() else {
            return Ok(None);
        };
        self.distances.last.keep(of, triangles);
        let corners = [
            corners_of(&pair.a.source, triangles[0]),
            corners_of(&pair.b.source, triangles[1]),
        ];
        let ids = pair.caller_ids();
        Ok(Some(close(
            kind.to_caller(&ids, triangles),
            &corners,
            &closest,
        )))
    }
}

/// The square of a distance, or somewhat more.
fn squared(distance: f64) -> f64 {
    distance * distance * (1.0 + 4.0 * f64::EPSILON)
}

/// Refuses what is no distance. It may be infinite.
fn check(distance: f64) -> Result<(), Error> {
    if distance >= 0.0 {
        return Ok(());
    }
    Err(ErrorKind::BadDistance { distance }.of_query())
}

impl Held for Distances {
    fn held(&self) -> usize {
        self.scratch.held() + self.last.held()
    }
}
