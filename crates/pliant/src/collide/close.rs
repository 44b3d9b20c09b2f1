//! Measured close pairs: distance, direction and closest points of each.
//!
//! A list is measured after it is sorted, so that sorting moves small hits. Visitors are shown
//! pairs that were measured on the way.

use super::asked::{Asked, Common};
use super::request::Request;
use crate::bodies::Bodies;
use crate::bodies::Places;
use crate::error::Error;
use crate::ids::BodyId;
use crate::kernels::{Coordinate, Instructions, dispatch};
use crate::queries::{Kind, Measurable, measure_all};
use crate::threads::{Executor, Grain, Interrupt};

/// Pair of elements whose corners are known to bodies.
pub(crate) trait InBodies: Measurable {
    /// Bodies of the first and the second element.
    fn bodies(&self) -> [BodyId; 2];

    /// Corners of both elements, in the caller's order.
    fn corners<'b, S: Coordinate>(&self, bodies: [&Places<'b, S>; 2]) -> Self::Corners<'b, S>;
}

impl<H: InBodies, K: Kind<Hit = H, Shown = H::Close>> Asked<K> {
    /// Returns all hits, sorted, with their measurements.
    pub(crate) fn all_measured(
        &mut self,
        kind: &K,
        common: &mut Common<K::Scalar>,
        request: &Request,
    ) -> Result<&[H::Close], Error> {
        self.all(kind, common, request)?;
        let interrupt = Interrupt::new(request.question);
        let executor = Executor {
            threads: common.threads.here(),
            interrupt: &interrupt,
        };
        let how = (common.instructions, executor);
        measure(&common.bodies, self.sorter.hits(), &mut self.measured, how);
        common.end(&interrupt)?;
        Ok(&self.measured)
    }
}

/// Measures pairs of bodies that a query has just read, into a list that is kept from call to call.
/// An interrupt ends it early.
fn measure<S: Coordinate, H: InBodies>(
    bodies: &Bodies<S>,
    hits: &[H],
    measured: &mut Vec<H::Close>,
    (instructions, executor): (Instructions, Executor),
) {
    let places = |ids: [BodyId; 2]| {
        let [a, b] = ids.map(|id| bodies.get(id).ok());
        Some([a?.places()?, b?.places()?])
    };
    measured.clear();
    measured.extend(hits.iter().map(|&hit| hit.unmeasured()));
    let jobs = hits
        .chunks(Grain::MEASURED.items)
        .zip(measured.chunks_mut(Grain::MEASURED.items));
    let work = |(hits, measured): &mut (&[H], &mut [H::Close])| {
        let mut known: Option<([BodyId; 2], [Places<S>; 2])> = None;
        let corners = |hit: H| {
            let ids = hit.bodies();
            if known.as_ref().is_none_or(|(of, _)| *of != ids) {
                known = places(ids).map(|both| (ids, both));
            }
            let (_, both) = known.as_ref()?;
            Some(hit.corners(both.each_ref()))
        };
        let mut room = measured.iter_mut();
        let take = |close| {
            if let Some(place) = room.next() {
                *place = close;
            }
        };
        let interrupt = executor.interrupt;
        let what = (|hit| hit, corners);
        dispatch!(instructions, i => measure_all(i, hits, interrupt, what, take));
    };
    executor.run_each(jobs, Grain::MEASURED, work, |_| {});
}
