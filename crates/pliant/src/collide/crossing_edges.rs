//! Crossing edges of a selection, found by a kind of query. Pairs that share a vertex, and cross
//! beyond it, come from the search for adjacent contacts.

use super::adjacent::AskedAdjacent;
use super::asked::{Asked, Common};
use super::request::Request;
use crate::error::{Error, ErrorKind};
use crate::held::{empty, held};
use crate::kernels::Coordinate;
use crate::queries::{ContactKind, CrossingEdge, CrossingEdges};
use crate::traversal::Visitor;
use std::ops::ControlFlow;

/// Buffers of queries for crossing edges, kept from query to query.
#[derive(Debug)]
pub(crate) struct AskedCrossing<S: Coordinate> {
    of_strangers: Asked<CrossingEdges<S>>,
    adjacent: AskedAdjacent,
    /// Crossing edges of some triangles that share a vertex.
    some: Vec<CrossingEdge>,
    all: Vec<CrossingEdge>,
}

impl<S: Coordinate> AskedCrossing<S> {
    /// Returns all hits, sorted.
    pub(crate) fn all(
        &mut self,
        common: &mut Common<S>,
        request: &Request,
    ) -> Result<&[CrossingEdge], Error> {
        let refused = || {
            ErrorKind::TooManyHits {
                limit: request.most,
            }
            .of_query()
        };
        let mut all = std::mem::take(&mut self.all);
        all.clear();
        let done = self.visit_adjacent(common, request, &mut |some| {
            all.extend_from_slice(some);
            if all.len() > request.most {
                return ControlFlow::Break(0);
            }
            ControlFlow::Continue(())
        });
        self.all = all;
        done?;
        if self.all.len() > request.most {
            return Err(refused());
        }
        let statistics = common.statistics;
        let kind = CrossingEdges::default();
        let of_strangers = self.of_strangers.all_listed(&kind, common, request)?;
        common.statistics += statistics;
        if self.all.is_empty() {
            return Ok(of_strangers);
        }
        if of_strangers.len() + self.all.len() > request.most {
            return Err(refused());
        }
        self.all.extend_from_slice(of_strangers);
        self.all.sort_unstable();
        Ok(&self.all)
    }

    /// Shows every hit once, until the visitor breaks.
    pub(crate) fn visit(
        &mut self,
        common: &mut Common<S>,
        request: &Request,
        visitor: Visitor<CrossingEdge>,
    ) -> Result<(), Error> {
        let kind = CrossingEdges::default();
        let mut goes_on = true;
        self.of_strangers
            .visit(&kind, common, request, &mut |hits| {
                let flow = visitor(hits);
                goes_on = flow.is_continue();
                flow
            })?;
        if goes_on {
            let statistics = common.statistics;
            self.visit_adjacent(common, request, visitor)?;
            common.statistics += statistics;
        }
        Ok(())
    }

    /// Shows the crossing edges of triangles that share a vertex, until the visitor breaks.
    fn visit_adjacent(
        &mut self,
        common: &mut Common<S>,
        request: &Request,
        visitor: Visitor<CrossingEdge>,
    ) -> Result<(), Error> {
        let request = Request {
            only: Some(ContactKind::Crossing),
            leaves_out: false,
            ..*request
        };
        let (some, mut count) = (&mut self.some, 0);
        self.adjacent.each(common, &request, &mut |body, hits| {
            some.clear();
            for hit in hits {
                body.cross(hit, some);
            }
            count += some.len() as u64;
            visitor(some).map_break(|_| ())
        })?;
        common.statistics.pairs = count;
        Ok(())
    }
}

empty!(AskedCrossing<S: Coordinate>: of_strangers, adjacent, some, all);

held!(AskedCrossing<S: Coordinate>: of_strangers, adjacent, some[], all[]);
