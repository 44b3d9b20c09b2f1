//! Distance of two bodies, and of a body from all others.
//!
//! The distance is zero if their triangles intersect, which is asked first. Otherwise triangles are
//! measured by increasing gap of their boxes, until no box left can hold nearer ones. The pair that
//! was nearest the last time is measured first. It is mostly still almost the nearest, and then
//! hardly any unneeded box is opened.

use super::asked::Common;
use super::witness::{Witnesses, pair_of};
use crate::bodies::Body;
use crate::error::{Error, ErrorKind};
use crate::geometry::Shape;
use crate::held::held;
use crate::ids::BodyId;
use crate::kernels::{Coordinate, dispatch};
use crate::queries::{
    BodyBoxes, Candidate, CloseTriangles, NearestPair, Needs, close, closest_of_triangles,
    corners_of,
};
use crate::threads::Interrupt;
use crate::traversal::{NearestScratch, TreePair, gap_square, nearest};
use crate::update::Partner;
use std::ops::ControlFlow;

/// State of a world for distance queries.
#[derive(Debug, Default)]
pub(crate) struct Distances {
    scratch: NearestScratch,
    /// Triangles that were nearest the last time.
    pub(crate) last: Witnesses,
    /// Other bodies with their squared gaps, for a query of one body against all others.
    pub(crate) others: Vec<(f64, BodyId)>,
}

/// Lists all others that may meet a body, with the squared gap of the boxes, the nearest first.
///
/// Costs O(n log n) for n bodies.
pub(crate) fn others_by_gap<S: Coordinate>(
    common: &mut Common<S>,
    id: BodyId,
    listed: &mut Vec<(f64, BodyId)>,
) -> Result<(), Error> {
    listed.clear();
    common.settle_origin();
    let body = common.bodies.get(id)?;
    let (origin, boxes) = (common.origin.point, BodyBoxes::default());
    let own = body.box_for(boxes, origin);
    let others = common.bodies.all();
    let others = others.filter(|other| other.id() != id && common.bodies.do_meet(body, other));
    let gaps = others.map(|other| (gap_square(&own, &other.box_for(boxes, origin)), other.id()));
    listed.extend(gaps);
    listed.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    Ok(())
}

/// Measures two triangles that intersect: a common point of two bodies.
pub(crate) fn in_common<S: Coordinate>(
    common: &Common<S>,
    of: [BodyId; 2],
    found: Candidate,
) -> Option<CloseTriangles> {
    let [a, b] = of.map(|id| common.bodies.get(id));
    let both = [a.ok()?, b.ok()?];
    // The bodies may not be in tree order.
    let [a, b] = [0, 1].map(|which| both[which].corners_now(found[which]));
    let [a, b] = [a, b].map(|corners| corners.map(|[x, y, z]| [x, y, z, z]));
    let corners = [a.each_ref(), b.each_ref()];
    let never = Interrupt::default();
    let closest = dispatch!(common.instructions, i => closest_of_triangles(i, &corners, &never))?;
    Some(close(pair_of(both, found), &corners, &closest))
}

impl Distances {
    /// Finds the nearest triangles of two bodies that do not intersect. None if they are further
    /// apart than `cut_off`.
    pub(crate) fn nearest<S: Coordinate>(
        &mut self,
        common: &mut Common<S>,
        of: [BodyId; 2],
        cut_off: f64,
        interrupt: &Interrupt,
    ) -> Result<Option<CloseTriangles>, Error> {
        let places = [common.bodies.place(of[0])?, common.bodies.place(of[1])?];
        let mut found = NearestPair::within(cut_off);
        let mut limit = found.limit();
        let (mut step, bodies, _) = common.step(Needs::TRIANGLES, interrupt, false);
        let (refit, origin) = (step.refit, step.origin);
        let instructions = refit.instructions;
        let both = bodies.two(places);
        let [box_a, box_b] = both
            .each_ref()
            .map(|body| body.box_for(BodyBoxes::default(), origin));
        if gap_square(&box_a, &box_b) > limit {
            return Ok(None);
        }
        let [body_a, body_b] = both;
        let ready = (
            step.bring_body_into_tree_order(body_a),
            step.bring_body_into_tree_order(body_b),
        );
        if ready.0.is_break() || ready.1.is_break() {
            return Ok(None);
        }
        let mut exact = 0;
        let mut last = self.last.get(of);
        for (a, b) in parts_of(body_a, body_b) {
            let sides = (
                step.ahead(body_a, a, Partner::Another),
                step.ahead(body_b, b, Partner::Another),
            );
            let (ControlFlow::Continue(a), ControlFlow::Continue(b)) = sides else {
                return Ok(None);
            };
            let removed = [a.read.removed, b.read.removed];
            let last_shapes = [*a.read.source.shape(), *b.read.source.shape()];
            let mut pair = TreePair::Two([a, b]);
            let mut measure = |shapes: [&Shape<'_, S>; 2], triangles: Candidate| {
                let is_gone = |which: usize| {
                    removed[which].is_some_and(|removed| removed.has(triangles[which]))
                };
                if !is_gone(0) && !is_gone(1) {
                    let corners = [0, 1].map(|which| corners_of(shapes[which], triangles[which]));
                    found.measure(instructions, triangles, &corners, interrupt, &mut exact);
                }
                found.limit()
            };
            if let Some(last) = last.take() {
                limit = measure(last_shapes.each_ref(), last);
            }
            let statistics = &mut *step.statistics;
            let scratch = &mut self.scratch;
            let _ = nearest(refit, &mut pair, scratch, statistics, limit, &mut measure);
            limit = found.limit();
        }
        step.statistics.exact_decisions += exact;
        let Some((triangles, closest)) = found.found() else {
            return Ok(None);
        };
        self.last.keep(of, triangles);
        let both = [&*body_a, &*body_b];
        let corners = [0, 1].map(|which| both[which].padded_corners(triangles[which]));
        Ok(Some(close(pair_of(both, triangles), &corners, &closest)))
    }
}

/// All pairs of parts of two bodies.
fn parts_of<S: Coordinate>(
    a: &Body<S>,
    b: &Body<S>,
) -> impl Iterator<Item = (usize, usize)> + use<S> {
    let [of_a, of_b] = [a.part_count(), b.part_count()];
    (0..of_a).flat_map(move |a| (0..of_b).map(move |b| (a, b)))
}

/// Refuses a negative distance or NaN; infinity is allowed.
pub(crate) fn check(distance: f64) -> Result<(), Error> {
    if distance >= 0.0 {
        return Ok(());
    }
    Err(ErrorKind::BadDistance { distance }.of_query())
}

held!(Distances: scratch, last, others[]);
