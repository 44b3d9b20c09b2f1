//! When bodies first meet on their way: all pairs of elements that do, the first of them, and how far everything may go.
//!
//! **The first** is looked for on the first part of the motion, then on a longer one, until something meets: boxes that hold a short way
//! are small. What has met before limits what is still looked at. Times are compared by cells of a fine grid, and exactly where cells are
//! equal.
//!
//! **A step that is free of contact** goes somewhat less far than the first contact. There every corner is rounded, so that the straight
//! motion to the rounded shape is another one; it is decided whether anything meets on that, exactly, and if so a shorter step is tried.
//! What meets at the start of a motion is no contact of the step.

use super::Selection;
use super::asked::{Asked, Common};
use super::bodies::Bodies;
use super::body::Body;
use super::close::InBodies;
use super::query::Request;
use crate::error::Error;
use crate::geometry::Real;
use crate::held::{self, Held};
use crate::hits::Numbered;
use crate::impacts::Impact;
use crate::kernels::Coordinate;
use crate::kernels::closest::Corners;
use crate::predicates::motion::{Contact, Grid, Moving, first_contact};
use crate::queries::{
    EdgeEdgeCandidates, Impacts, Kind, LIMIT, Margin, MayMeet, Measurable, Reach,
    VertexTriangleCandidates,
};
use crate::statistics::Statistics;
use crate::threads::Interrupt;
use std::cmp::Ordering;
use std::ops::ControlFlow;

/// The cells in which the first contact is looked for: 2^-40 wide.
const SEARCHED: f64 = f64::from_bits((1023 - 40) << 52);

/// The next part of a motion that is looked at is so many times as long.
const LONGER: f64 = 4.0;
/// The first is not shorter than this.
const SHORTEST: f64 = 1.0 / 1024.0;

/// Parts of the time of the first contact that are tried as a step, from the longest on: 0.9 of it is promised.
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

/// The earliest contacts that were found so far.
struct Earliest {
    /// The cell of the grid that all of them are in.
    cell: [f64; 2],
    impacts: Vec<Impact>,
    /// Whether what meets at the start is passed over.
    after_start: bool,
}

impl Earliest {
    /// Takes those that are as early as what is known, or earlier; returns the time after which nothing is of interest.
    fn take<H: Copy + Into<Impact>>(&mut self, found: &[H]) -> f64 {
        for &impact in found {
            let impact: Impact = impact.into();
            let cell = [impact.low(), impact.high()];
            if self.after_start && cell[1] == 0.0 || cell[1] > self.cell[1] {
                continue;
            }
            if cell[1] < self.cell[1] {
                self.cell = cell;
                self.impacts.clear();
            }
            self.impacts.push(impact);
        }
        self.cell[1]
    }
}

/// Which elements are looked at.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum OfKind {
    Both,
    VerticesAndTriangles,
    Edges,
}

/// What a world keeps for impacts of either kind.
#[derive(Debug)]
pub(super) struct AskedImpacts<S: Coordinate> {
    pub(super) vertex_triangle: Asked<Impacts<VertexTriangleCandidates<S>>>,
    pub(super) edge_edge: Asked<Impacts<EdgeEdgeCandidates<S>>>,
    /// Room for the earliest contacts.
    earliest: Vec<Impact>,
}

impl<S: Coordinate> Default for AskedImpacts<S> {
    fn default() -> Self {
        Self {
            vertex_triangle: Asked::default(),
            edge_edge: Asked::default(),
            earliest: Vec::new(),
        }
    }
}

impl<S: Coordinate> AskedImpacts<S> {
    /// The first contact of a motion: which elements it is of, and when. Of several at one time that of a vertex and a triangle; the first
    /// in order.
    pub(super) fn first_contact<const N: usize>(
        &mut self,
        common: &mut Common<N, S>,
        request: &Request,
        of: OfKind,
    ) -> Result<Option<(Impact, Contact)>, Error> {
        let mut earliest = self.earliest(common, request, of, false, 0.0)?;
        let first = first_of(common, &mut earliest, request);
        self.earliest = earliest.impacts;
        first
    }

    /// The earliest contacts, of both kinds or one, after the start or at any time; or the first times at which elements come as near as a
    /// distance.
    fn earliest<const N: usize>(
        &mut self,
        common: &mut Common<N, S>,
        request: &Request,
        of: OfKind,
        after_start: bool,
        distance: f64,
    ) -> Result<Earliest, Error> {
        common.bodies.validate(request.of)?;
        let mut earliest = Earliest {
            cell: [f64::INFINITY; 2],
            impacts: std::mem::take(&mut self.earliest),
            after_start,
        };
        earliest.impacts.clear();
        let mut statistics = Statistics::default();
        let mut until = first_part(common, request.of);
        loop {
            let reach = if until < 1.0 {
                Reach::Until(until)
            } else {
                Reach::End
            };
            if of != OfKind::Edges {
                let kind = impacts_until(VertexTriangleCandidates::within, reach, distance);
                let asked = &mut self.vertex_triangle;
                search(asked, &kind, common, request, &mut earliest)?;
                statistics += common.statistics;
            }
            if of != OfKind::VerticesAndTriangles {
                let kind = impacts_until(EdgeEdgeCandidates::within, reach, distance);
                let asked = &mut self.edge_edge;
                search(asked, &kind, common, request, &mut earliest)?;
                statistics += common.statistics;
            }
            if !earliest.impacts.is_empty() || until >= 1.0 {
                break;
            }
            until = (until * LONGER).min(1.0);
        }
        common.statistics = statistics;
        Ok(earliest)
    }

    /// A time up to which everything may go: see [`World::collision_free_step`](crate::World::collision_free_step).
    pub(super) fn free_step<const N: usize>(
        &mut self,
        common: &mut Common<N, S>,
        request: &Request,
    ) -> Result<f64, Error> {
        let distance = request.distance()?;
        let mut earliest =
            self.earliest(common, request, OfKind::Both, distance == 0.0, distance)?;
        let mut statistics = common.statistics;
        let is_free = earliest.impacts.is_empty();
        let latest = if distance > 0.0 {
            Ok(earliest.cell[0])
        } else {
            let time = |(_, contact): (_, Contact)| contact.cell(Grid::new(0.0))[0];
            first_of(common, &mut earliest, request).map(|first| first.map_or(0.0, time))
        };
        self.earliest = earliest.impacts;
        let latest = latest?;
        if is_free {
            return Ok(1.0);
        }
        let mut step = 0.0;
        for part in PARTS {
            step = latest * part;
            let is_free = self.is_free_to(common, step, distance, request)?;
            statistics += common.statistics;
            if is_free {
                break;
            }
        }
        common.statistics = statistics;
        Ok(step)
    }

    /// Whether nothing meets on straight ways to the shapes at a time, rounded, but what meets at the start, or comes as near as a
    /// distance.
    fn is_free_to<const N: usize>(
        &mut self,
        common: &mut Common<N, S>,
        time: f64,
        distance: f64,
        request: &Request,
    ) -> Result<bool, Error> {
        common.statistics = Statistics::default();
        if time == 0.0 {
            return Ok(true);
        }
        let reach = Reach::To(time);
        let kind = impacts_until(VertexTriangleCandidates::within, reach, distance);
        let asked = &mut self.vertex_triangle;
        if !is_free(asked, &kind, common, request, distance > 0.0)? {
            return Ok(false);
        }
        let statistics = common.statistics;
        let kind = impacts_until(EdgeEdgeCandidates::within, reach, distance);
        let asked = &mut self.edge_edge;
        let is_free = is_free(asked, &kind, common, request, distance > 0.0)?;
        common.statistics += statistics;
        Ok(is_free)
    }
}

/// Which part of the motion is looked at first: one in which most vertices move less than an edge.
fn first_part<const N: usize, S: Coordinate>(common: &Common<N, S>, of: Selection) -> f64 {
    let is_of_it = |body: &Body<N, S>| match of {
        Selection::World | Selection::Everything => true,
        Selection::Between(a, b) => body.id == a || body.id == b,
        Selection::Within(a) => body.id == a,
    };
    let all = common.bodies.list.iter();
    let bodies = all.filter(|body| is_of_it(body));
    let edges = bodies.fold(0.0, |most: f64, body| most.max(body.motion_in_edges()));
    let mut part: f64 = 1.0;
    while part > SHORTEST && part * edges > 1.0 {
        part /= LONGER;
    }
    part
}

/// Contacts up to a time, or what comes as near as a distance.
fn impacts_until<K>(within: impl Fn(Margin) -> K, reach: Reach, distance: f64) -> Impacts<K> {
    // Half the distance for each of two, and a little more than the lanes look for.
    let margin = Margin::new((distance * (LIMIT / 2.0 + 0.001)).min(f64::MAX));
    Impacts::of(within(margin), Grid::new(SEARCHED), reach).or_near(distance)
}

/// Of contacts in one cell the exactly earliest, and when that is; of several, the first in order. It looks at every one.
fn first_of<const N: usize, S: Coordinate>(
    common: &mut Common<N, S>,
    earliest: &mut Earliest,
    request: &Request,
) -> Result<Option<(Impact, Contact)>, Error> {
    let interrupt = Interrupt::new(request.question);
    let impacts = &mut earliest.impacts;
    impacts.sort_unstable_by_key(numbers);
    // That cell is one time.
    if earliest.cell[1] == 0.0 {
        common.end(&interrupt)?;
        return Ok(impacts.first().map(|&impact| (impact, Contact::AtStart)));
    }
    let mut first: Option<(Impact, Contact)> = None;
    for &impact in impacts.iter() {
        if interrupt.is_set() {
            break;
        }
        let moving = moving(&common.bodies, &impact);
        let Some(contact) = moving.and_then(|moving| first_contact(&moving)) else {
            continue;
        };
        let is_earlier = first
            .as_ref()
            .is_none_or(|(_, known)| contact.compare(known) == Ordering::Less);
        if is_earlier {
            first = Some((impact, contact));
        }
    }
    common.end(&interrupt)?;
    Ok(first)
}

/// Looks for contacts of one kind that are as early as the earliest, or earlier.
fn search<const N: usize, K>(
    asked: &mut Asked<Impacts<K>>,
    kind: &Impacts<K>,
    common: &mut Common<N, K::Scalar>,
    request: &Request,
    earliest: &mut Earliest,
) -> Result<(), Error>
where
    K: Kind<Scalar: Coordinate>,
    Impacts<K>: Kind<Scalar = K::Scalar, Hit: Into<Impact>>,
{
    let until = kind.until().get();
    kind.until().set(until.min(earliest.cell[1]));
    asked.visit(kind, common, request, &mut |found| {
        // Contacts after the part that is looked at may not be the first of those.
        let before = |impact: &&_| Into::<Impact>::into(**impact).high() <= until;
        for impact in found.iter().filter(before) {
            kind.until()
                .set(earliest.take(std::slice::from_ref(impact)).min(until));
        }
        ControlFlow::Continue(())
    })
}

/// Whether none of one kind meets after the start, or at it if that counts.
fn is_free<const N: usize, K>(
    asked: &mut Asked<Impacts<K>>,
    kind: &Impacts<K>,
    common: &mut Common<N, K::Scalar>,
    request: &Request,
    at_start_too: bool,
) -> Result<bool, Error>
where
    K: Kind<Scalar: Coordinate>,
    Impacts<K>: Kind<Scalar = K::Scalar, Hit: Into<Impact>>,
{
    let mut is_free = true;
    asked.visit(kind, common, request, &mut |found| {
        let counts = |&impact: &_| at_start_too || Into::<Impact>::into(impact).high() > 0.0;
        match found.iter().position(counts) {
            Some(place) => {
                is_free = false;
                ControlFlow::Break(place)
            }
            None => ControlFlow::Continue(()),
        }
    })?;
    Ok(is_free)
}

/// Vertices and triangles first; each in order.
fn numbers(impact: &Impact) -> (bool, [u32; 4]) {
    match impact {
        Impact::VertexTriangle(impact) => (false, impact.numbers()),
        Impact::EdgeEdge(impact) => (true, impact.numbers()),
    }
}

/// The corners of two elements at both ends of the motion; of bodies that a query looked at.
fn moving<const N: usize, S: Coordinate>(bodies: &Bodies<N, S>, impact: &Impact) -> Option<Moving> {
    match impact {
        Impact::VertexTriangle(impact) => moving_of(bodies, &impact.pair),
        Impact::EdgeEdge(impact) => moving_of(bodies, &impact.pair),
    }
}

fn moving_of<const N: usize, S: Coordinate, H>(bodies: &Bodies<N, S>, pair: &H) -> Option<Moving>
where
    H: MayMeet + InBodies + for<'c> Measurable<Corners<'c, S> = Corners<'c, S>>,
{
    let [a, b] = pair.bodies().map(|id| bodies.get(id).ok());
    let (a, b) = (a?, b?);
    let wide = |corners: Corners<S>| corners.map(|&[x, y, z, _]| [x, y, z].map(Real::to_f64));
    let start = pair.corners([&a.places()?, &b.places()?]);
    let end = pair.corners([&a.places_at_end()?, &b.places_at_end()?]);
    Some(Moving {
        are_edges: H::ARE_EDGES,
        corners: [wide(start), wide(end)],
    })
}

impl<S: Coordinate> Held for AskedImpacts<S> {
    fn held(&self) -> usize {
        self.vertex_triangle.held() + self.edge_edge.held() + held::list(&self.earliest)
    }
}
