//! Continuous collision of moving bodies: all impacts, the first contact, and the longest safe
//! step.
//!
//! - **First contact**: searched on the first part of the motion, then on longer parts, until
//!   something meets. Boxes of a short motion are small. A contact that is found limits the search
//!   and is compared exactly (`queries::Earliest`).
//! - **Step free of contact**: somewhat less far than the first contact. Every corner is rounded
//!   there, so the straight motion to the rounded shape is a different one. Whether anything meets
//!   on that is decided exactly; if so, a shorter step is tried. Elements that meet at the start of
//!   a motion are no contact of the step.

use super::asked::{Asked, Common};
use super::request::Request;
use crate::bodies::Body;
use crate::error::Error;
use crate::held::{empty, held};
use crate::kernels::Coordinate;
use crate::queries::{
    Candidates, Earliest, EdgeEdgeCandidates, First, Impact, Impacts, Kind, LIMIT, Margin, Reach,
    VertexTriangleCandidates,
};
use crate::selection::Selection;
use crate::statistics::Statistics;
use pliant_exact::motion::Grid;

/// Factor by which each searched part of a motion is longer than the last.
const LONGER: f64 = 4.0;
/// Least first part of a motion that is searched.
const SHORTEST: f64 = 1.0 / 1024.0;

/// Fractions of the time of first contact that are tried as a step, the longest first.
///
/// 0.9 of it is promised if everything is apart by 9 units in the last place, up to 0.91 of it. The
/// unit is taken at the largest coordinate. `Real::toward` rounds a difference, its product, and
/// the sum. The difference is at most twice the largest coordinate; the sum is no larger than the
/// ends. These are off by 1, 1 and 1/2 units. So two points come nearer to each other by 5 on an
/// axis, and by less than 9 in all.
const PARTS: [f64; 9] = [
    31.0 / 32.0,
    30.0 / 32.0,
    29.0 / 32.0,
    0.5,
    0.25,
    1.0 / 16.0,
    1.0 / 256.0,
    1.0 / 65536.0,
    0.0,
];

/// Kinds of elements that are tested for contact.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum OfKind {
    Both,
    VerticesAndTriangles,
    Edges,
}

/// State of a world for impacts of both kinds.
#[derive(Debug)]
pub(crate) struct AskedImpacts<S: Coordinate> {
    pub(crate) vertex_triangle: Asked<Impacts<VertexTriangleCandidates<S>>>,
    pub(crate) edge_edge: Asked<Impacts<EdgeEdgeCandidates<S>>>,
}

impl<S: Coordinate> AskedImpacts<S> {
    /// First contact of a motion: its elements and time.
    ///
    /// Of several at one time it is a vertex and a triangle before two edges, and then the first in
    /// order.
    pub(crate) fn first_contact(
        &mut self,
        common: &mut Common<S>,
        request: &Request,
        of: OfKind,
    ) -> Result<Option<First>, Error> {
        Ok(self.earliest(common, request, of, None)?.first())
    }

    /// Earliest contact of both kinds or one. With a distance, the first time at which elements
    /// come that near, and their thickness; where both are 0, the first contact after the start.
    fn earliest(
        &mut self,
        common: &mut Common<S>,
        request: &Request,
        of: OfKind,
        distance: Option<f64>,
    ) -> Result<Earliest, Error> {
        common.bodies.validate(request.of)?;
        let mut statistics = Statistics::default();
        let mut until = first_part(common, request.of);
        loop {
            let reach = if until < 1.0 {
                Reach::Until(until)
            } else {
                Reach::End
            };
            let mut earliest = Earliest::new(distance.is_some(), until);
            if of != OfKind::Edges {
                let asked = &mut self.vertex_triangle;
                earliest = asked.earliest(common, request, reach, distance, earliest)?;
                statistics += common.statistics;
            }
            // At the start a vertex and a triangle come before any edges.
            let is_found = earliest.known_at_start().is_some();
            if of != OfKind::VerticesAndTriangles && !is_found {
                let asked = &mut self.edge_edge;
                earliest = asked.earliest(common, request, reach, distance, earliest)?;
                statistics += common.statistics;
            }
            if earliest.known() <= 1.0 || until >= 1.0 {
                common.statistics = statistics;
                return Ok(earliest);
            }
            until = (until * LONGER).min(1.0);
        }
    }

    /// Time up to which everything may move: see [`World::collision_free_step`].
    ///
    /// [`World::collision_free_step`]: crate::World::collision_free_step
    pub(crate) fn free_step(
        &mut self,
        common: &mut Common<S>,
        request: &Request,
    ) -> Result<f64, Error> {
        let distance = request.distance()?;
        let earliest = self.earliest(common, request, OfKind::Both, Some(distance))?;
        let mut statistics = common.statistics;
        let known = earliest.known();
        if known > 1.0 {
            return Ok(1.0);
        }
        // Elements without distance and thickness are in contact, others only near.
        let contact = earliest.first();
        let contact = contact.map(|first| first.contact.cell(Grid::new(0.0))[0]);
        let latest = contact.map_or(known, |contact| contact.min(known));
        let mut step = 0.0;
        for part in PARTS {
            step = latest * part;
            if self.is_free_to(common, step, distance, request)? {
                // Work in vain is not counted: how much it was depends on the threads.
                statistics += common.statistics;
                break;
            }
        }
        common.statistics = statistics;
        Ok(step)
    }

    /// Whether the straight motion to the rounded shapes at a time is free of contact. Elements
    /// that meet at the start are allowed. With a distance, nothing may come that near.
    fn is_free_to(
        &mut self,
        common: &mut Common<S>,
        time: f64,
        distance: f64,
        request: &Request,
    ) -> Result<bool, Error> {
        common.statistics = Statistics::default();
        if time == 0.0 {
            return Ok(true);
        }
        let asked = &mut self.vertex_triangle;
        if !asked.is_free_to(common, request, time, distance)? {
            return Ok(false);
        }
        let statistics = common.statistics;
        let asked = &mut self.edge_edge;
        let is_free = asked.is_free_to(common, request, time, distance)?;
        common.statistics += statistics;
        Ok(is_free)
    }
}

/// First part of the motion to be searched: one in which most vertices move less than an edge.
fn first_part<S: Coordinate>(common: &Common<S>, of: Selection) -> f64 {
    let is_of_it = |body: &Body<S>| match of {
        Selection::World | Selection::Everything => true,
        Selection::Between(a, b) => body.id() == a || body.id() == b,
        Selection::Within(a) => body.id() == a,
    };
    let all = common.bodies.all();
    let bodies = all.filter(|body| is_of_it(body));
    let edges = bodies.fold(0.0, |most: f64, body| most.max(body.motion_in_edges()));
    let mut part: f64 = 1.0;
    while part > SHORTEST && part * edges > 1.0 {
        part /= LONGER;
    }
    part
}

/// Kind that finds contacts up to a time, or elements that come as near as a distance and their
/// thickness.
fn impacts<E, S>(reach: Reach, distance: Option<f64>) -> Impacts<Candidates<E, S>> {
    // Half the distance for each of two, and a little more than the lanes look for.
    let more = LIMIT + 0.002;
    let thickness = distance.map_or(0.0, |_| more);
    let distance = distance.unwrap_or(0.0);
    let margin = Margin::new((distance * (more / 2.0)).min(f64::MAX)).counting_thickness(thickness);
    Impacts::of(Candidates::within(margin), Grid::new(1.0), reach).or_near(distance)
}

impl<E, S: Coordinate> Asked<Impacts<Candidates<E, S>>>
where
    Candidates<E, S>: Kind,
    Impacts<Candidates<E, S>>: Kind<Scalar = S, Shown: Into<Impact>>,
{
    /// Earliest contact of one kind, if it is earlier than the one known.
    fn earliest(
        &mut self,
        common: &mut Common<S>,
        request: &Request,
        reach: Reach,
        distance: Option<f64>,
        known: Earliest,
    ) -> Result<Earliest, Error> {
        let kind = impacts(reach, distance).earlier_than(known);
        self.search(&kind, common, request)?;
        Ok(kind.into_earliest())
    }

    /// Whether no elements of one kind meet after the start, up to a time. With a distance, none
    /// may come that near at any time.
    fn is_free_to(
        &mut self,
        common: &mut Common<S>,
        request: &Request,
        time: f64,
        distance: f64,
    ) -> Result<bool, Error> {
        let kind = impacts(Reach::To(time), Some(distance)).any();
        self.search(&kind, common, request)?;
        Ok(kind.into_earliest().known() > 1.0)
    }
}

empty!(AskedImpacts<S: Coordinate>: vertex_triangle, edge_edge);

held!(AskedImpacts<S: Coordinate>: vertex_triangle, edge_edge);
