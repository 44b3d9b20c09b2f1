//! Adjacent contacts of a selection's bodies: each body with itself, all of them side by side.

use super::asked::Common;
use super::request::Request;
use crate::bodies::{Bodies, Body};
use crate::error::{Error, ErrorKind};
use crate::held::{self, Held, held};
use crate::ids::Place;
use crate::kernels::{Coordinate, Instructions};
use crate::queries::{
    AdjacentContact, AdjacentSearch, AdjacentSink, Needs, StarredBody, TreeAdjacent,
};
use crate::selection::Selection;
use crate::sort::sort_lists;
use crate::statistics::Statistics;
use crate::threads::{Executor, Grain, Interrupt, PerThread};
use crate::traversal::Visitor;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Buffers of queries for adjacent contacts, kept from query to query.
#[derive(Debug, Default)]
pub(crate) struct AskedAdjacent {
    /// Bodies that are asked about.
    places: Vec<Place>,
    searches: PerThread<AdjacentSearch>,
    /// Hits of every thread. With one thread the first list holds all hits in the end, otherwise
    /// `listed`.
    lists: PerThread<Vec<AdjacentContact>>,
    listed: Vec<AdjacentContact>,
}

impl AskedAdjacent {
    /// Returns all hits, sorted. Bodies are searched side by side, large ones on all threads.
    pub(crate) fn all<S: Coordinate>(
        &mut self,
        common: &mut Common<S>,
        request: &Request,
    ) -> Result<&[AdjacentContact], Error> {
        let interrupt = Interrupt::new(request.question);
        common.begin(request)?;
        let (step, bodies, _) = common.step(Needs::TRIANGLES, &interrupt, false);
        let executor = step.refit.executor;
        let threads = executor.count();
        self.lists.for_threads(threads);
        self.lists.iter_mut().for_each(Vec::clear);
        self.searches.for_threads(threads);
        let (searches, lists, count) = (&self.searches, &self.lists, AtomicUsize::new(0));
        let keep = |body: &StarredBody<S>, found: &[TreeAdjacent]| {
            let before = count.fetch_add(found.len(), Ordering::Relaxed);
            if before.saturating_add(found.len()) > request.most {
                return ControlFlow::Break(());
            }
            let found = found.iter().map(|hit| body.to_caller(hit));
            lists.own().extend(found);
            ControlFlow::Continue(())
        };
        let search = |body: &mut Body<S>, executor: Executor, statistics: &mut Statistics| {
            let threads = (step.refit.instructions, executor);
            let sink: AdjacentSink<S> = &mut &keep;
            search_body(
                &mut searches.own(),
                body,
                request,
                threads,
                statistics,
                sink,
            )
        };
        self.places.clear();
        self.places.extend(bodies_asked(bodies, request.of));
        if self.places.len() < 2 || !executor.are_many() {
            for &place in &self.places {
                if search(bodies.at_mut(place), executor, step.statistics).is_break() {
                    break;
                }
            }
        } else {
            self.places.sort_unstable();
            let bodies = bodies.some_mut(self.places.iter().copied());
            let mut jobs: Vec<_> = bodies.map(|body| (body, Statistics::default())).collect();
            let size = |(body, _): &(&mut Body<S>, _)| body.triangle_count();
            let triangles = jobs.iter().map(size).sum();
            let nanoseconds = Grain::STARS.time(triangles) + Grain::BODIES.time(jobs.len());
            executor.run_uneven(
                &mut jobs,
                size,
                nanoseconds,
                |(body, statistics), executor| {
                    let _ = search(body, executor, statistics);
                },
            );
            for (_, statistics) in jobs {
                *step.statistics += statistics;
            }
        }
        if count.into_inner() > request.most {
            let limit = request.most;
            return Err(ErrorKind::TooManyHits { limit }.of_query());
        }
        let executor = common.executor(&interrupt);
        let all = sort_lists(&mut self.lists, executor, &mut self.listed);
        common.end(&interrupt)?;
        Ok(all)
    }

    /// Shows every hit once, body by body, until the visitor breaks.
    pub(crate) fn visit<S: Coordinate>(
        &mut self,
        common: &mut Common<S>,
        request: &Request,
        visitor: Visitor<AdjacentContact>,
    ) -> Result<(), Error> {
        let mut shown = std::mem::take(&mut self.listed);
        let done = self.each(common, request, &mut |body, found| {
            shown.clear();
            shown.extend(found.iter().map(|hit| body.to_caller(hit)));
            visitor(&shown).map_break(|_| ())
        });
        self.listed = shown;
        done
    }

    /// Passes every hit once to a sink, body by body, until that breaks.
    pub(super) fn each<S: Coordinate>(
        &mut self,
        common: &mut Common<S>,
        request: &Request,
        sink: AdjacentSink<S>,
    ) -> Result<(), Error> {
        let interrupt = Interrupt::new(request.question);
        common.begin(request)?;
        let (step, bodies, _) = common.step(Needs::TRIANGLES, &interrupt, false);
        let threads = (step.refit.instructions, step.refit.executor);
        self.searches.for_threads(1);
        let mut search = self.searches.own();
        self.places.clear();
        self.places.extend(bodies_asked(bodies, request.of));
        for &place in &self.places {
            let body = bodies.at_mut(place);
            let statistics = &mut *step.statistics;
            if search_body(&mut search, body, request, threads, statistics, sink).is_break() {
                break;
            }
        }
        drop(search);
        common.end(&interrupt)
    }

    /// Does early what a query does first: finds the stars of the mesh, and brings shapes into tree
    /// order.
    pub(crate) fn prepare<S: Coordinate>(
        common: &mut Common<S>,
        request: &Request,
    ) -> Result<(), Error> {
        let interrupt = Interrupt::new(request.question);
        common.bodies.validate(request.of)?;
        let (step, bodies, _) = common.step(Needs::TRIANGLES, &interrupt, true);
        let threads = (step.refit.instructions, step.refit.executor);
        let asked: Vec<Place> = bodies_asked(bodies, request.of).collect();
        let mut asked = asked.into_iter();
        let _ = asked.try_for_each(|place| bodies.at_mut(place).starred(threads).map(|_| ()));
        common.end(&interrupt)
    }
}

/// Bodies of a selection that meet themselves, in the order of their ids.
fn bodies_asked<S: Coordinate>(bodies: &Bodies<S>, of: Selection) -> impl Iterator<Item = Place> {
    let is_asked = move |body: &Body<S>| match of {
        Selection::Within(id) => body.id() == id,
        Selection::Everything => bodies.do_meet(body, body),
        Selection::World | Selection::Between(..) => false,
    };
    let places = bodies.places().iter().copied();
    places.filter(move |&place| is_asked(bodies.at(place)))
}

/// Passes the hits of one body to the sink. Breaks if the sink does, or if interrupted.
fn search_body<S: Coordinate>(
    search: &mut AdjacentSearch,
    body: &mut Body<S>,
    request: &Request,
    threads: (Instructions, Executor),
    statistics: &mut Statistics,
    sink: AdjacentSink<S>,
) -> ControlFlow<()> {
    statistics.body_pairs += 1;
    let Some(mut starred) = body.starred(threads) else {
        return ControlFlow::Break(());
    };
    starred.labels = starred.labels.filter(|_| request.leaves_out);
    search.search(&starred, request.only, threads, statistics, sink)
}

held!(AskedAdjacent: places[], listed[]; |asked| {
    asked.searches.held_by(Held::held) + asked.lists.held_by(held::list)
});
