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
    /// Crossing edges of triangles that share a vertex.
    of_adjacent: Vec<CrossingEdge>,
    all: Vec<CrossingEdge>,
}

impl<S: Coordinate> AskedCrossing<S> {
    /// Returns all hits, sorted.
    pub(crate) fn all(
        &mut self,
        common: &mut Common<S>,
        request: &Request,
    ) -> Result<&[CrossingEdge], Error> {
        self.cross_adjacent(common, request)?;
        let statistics = common.statistics;
        let kind = CrossingEdges::default();
        let of_strangers = self.of_strangers.all_listed(&kind, common, request)?;
        common.statistics += statistics;
        if self.of_adjacent.is_empty() {
            return Ok(of_strangers);
        }
        if of_strangers.len() + self.of_adjacent.len() > request.most {
            let limit = request.most;
            return Err(ErrorKind::TooManyHits { limit }.of_query());
        }
        self.all.clear();
        self.all.extend_from_slice(of_strangers);
        self.all.append(&mut self.of_adjacent);
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
            self.cross_adjacent(common, request)?;
            common.statistics += statistics;
            let _ = visitor(&self.of_adjacent);
        }
        Ok(())
    }

    /// Finds the crossing edges of triangles that share a vertex.
    fn cross_adjacent(&mut self, common: &mut Common<S>, request: &Request) -> Result<(), Error> {
        let request = Request {
            only: Some(ContactKind::Crossing),
            ..*request
        };
        let of_adjacent = &mut self.of_adjacent;
        of_adjacent.clear();
        self.adjacent.each(common, &request, &mut |body, hits| {
            for hit in hits {
                body.cross(hit, of_adjacent);
            }
            ControlFlow::Continue(())
        })?;
        common.statistics.pairs = self.of_adjacent.len() as u64;
        Ok(())
    }
}

empty!(AskedCrossing<S: Coordinate>: of_strangers, adjacent, of_adjacent, all);

held!(AskedCrossing<S: Coordinate>: of_strangers, adjacent, of_adjacent[], all[]);
