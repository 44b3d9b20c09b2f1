//! Close pairs that were found, measured: distance, direction and closest points of each.
//!
//! A list is measured once it is sorted, so that what is sorted is small; visitors are shown what was measured on the way.

use super::asked::{Asked, Common};
use super::request::Request;
use crate::bodies::Bodies;
use crate::bodies::Places;
use crate::error::Error;
use crate::held::{self, Held};
use crate::ids::BodyId;
use crate::kernels::{Coordinate, Instructions, Simd, dispatch};
use crate::queries::{CloseKind, Measurable, Measured};
use crate::threads::{Executor, Interrupt};
use crate::traversal::Visitor;

/// Pairs in a job: some tens of microseconds.
const JOB: usize = 1024;

/// Two things whose corners are known to bodies.
pub(crate) trait InBodies: Measurable {
    /// Which bodies the first and the second are of.
    fn bodies(&self) -> [BodyId; 2];

    /// The corners in these bodies, in the caller's order.
    fn corners<'b, S: Coordinate>(&self, bodies: [&Places<'b, S>; 2]) -> Self::Corners<'b, S>;
}

/// What a world keeps for close pairs of one kind.
#[derive(Debug)]
pub(crate) struct AskedClose<C: CloseKind> {
    lists: Asked<C>,
    visits: Asked<Measured<C>>,
    measured: Vec<<C::Hit as Measurable>::Close>,
}

impl<C: CloseKind> Default for AskedClose<C> {
    fn default() -> Self {
        Self {
            lists: Asked::default(),
            visits: Asked::default(),
            measured: Vec::new(),
        }
    }
}

impl<C: CloseKind<Hit: InBodies>> AskedClose<C> {
    /// All that are close, sorted.
    pub(crate) fn all(
        &mut self,
        kind: &Measured<C>,
        common: &mut Common<C::Scalar>,
        request: &Request,
    ) -> Result<&[<C::Hit as Measurable>::Close], Error> {
        let hits = self.lists.all(&kind.0, common, request)?;
        let interrupt = Interrupt::new(request.question);
        let executor = Executor {
            threads: common.threads.here(),
            interrupt: &interrupt,
        };
        let how = (common.instructions, executor);
        measure(&common.bodies, hits, &mut self.measured, how);
        common.end(&interrupt)?;
        Ok(&self.measured)
    }

    /// Shows every one once, until the visitor breaks.
    pub(crate) fn visit(
        &mut self,
        kind: &Measured<C>,
        common: &mut Common<C::Scalar>,
        request: &Request,
        visitor: Visitor<<C::Hit as Measurable>::Close>,
    ) -> Result<(), Error> {
        self.visits.visit(kind, common, request, visitor)
    }
}

impl<C: CloseKind> Held for AskedClose<C> {
    fn held(&self) -> usize {
        self.lists.held() + self.visits.held() + held::list(&self.measured)
    }
}

/// Some pairs that are to be measured.
struct Job<'m, H: Measurable> {
    hits: &'m [H],
    measured: &'m mut [H::Close],
}

/// Measures pairs, all of whose bodies a query has just looked at, into a list that is kept from call to call. Interrupted, it ends early.
fn measure<S: Coordinate, H: InBodies>(
    bodies: &Bodies<S>,
    hits: &[H],
    measured: &mut Vec<H::Close>,
    (instructions, executor): (Instructions, Executor),
) {
    measured.clear();
    let interrupt = executor.interrupt;
    let places = |ids: [BodyId; 2]| {
        let [a, b] = ids.map(|id| bodies.get(id).ok());
        Some([a?.places()?, b?.places()?])
    };
    if !executor.are_many() {
        measured.reserve(hits.len());
        for hits in hits.chunks(JOB) {
            if executor.is_interrupted() {
                return;
            }
            measure_some(instructions, &places, hits, interrupt, &mut |close| {
                measured.push(close);
            });
        }
        return;
    }
    measured.extend(hits.iter().map(|&hit| hit.unmeasured()));
    let jobs = hits.chunks(JOB).zip(measured.chunks_mut(JOB));
    let mut jobs: Vec<_> = jobs
        .map(|(hits, measured)| Job { hits, measured })
        .collect();
    executor.run(&mut jobs, |_, job: &mut Job<H>| {
        let mut room = job.measured.iter_mut();
        measure_some(instructions, &places, job.hits, interrupt, &mut |close| {
            if let Some(place) = room.next() {
                *place = close;
            }
        });
    });
}

/// Measures some pairs, and shows `take` each in their order. Interrupted, it ends early. What is called here for some pairs at a time is
/// `dyn`, so that measuring is compiled for what is measured and no degree.
fn measure_some<'b, S: Coordinate, H: InBodies>(
    instructions: Instructions,
    places: &(dyn Fn([BodyId; 2]) -> Option<[Places<'b, S>; 2]> + Sync),
    hits: &[H],
    interrupt: &Interrupt,
    take: &mut dyn FnMut(H::Close),
) {
    dispatch!(instructions, i => measure_by(i, places, hits, interrupt, take));
}

/// The same by some instructions.
#[inline(always)]
fn measure_by<'b, I: Simd, S: Coordinate, H: InBodies>(
    i: I,
    places: &(dyn Fn([BodyId; 2]) -> Option<[Places<'b, S>; 2]> + Sync),
    hits: &[H],
    interrupt: &Interrupt,
    take: &mut dyn FnMut(H::Close),
) {
    let mut known: Option<([BodyId; 2], [Places<S>; 2])> = None;
    for hits in hits.chunks(4) {
        let mut pairs = None;
        for (lane, hit) in hits.iter().enumerate() {
            let ids = hit.bodies();
            if known.as_ref().is_none_or(|(of, _)| *of != ids) {
                known = places(ids).map(|both| (ids, both));
            }
            let Some((_, both)) = &known else {
                return;
            };
            let corners = hit.corners(both.each_ref());
            pairs.get_or_insert([corners; 4])[lane] = corners;
        }
        let Some(pairs) = pairs else {
            return;
        };
        if !H::measure(i, hits, &pairs, interrupt, &mut *take) {
            return;
        }
    }
}
