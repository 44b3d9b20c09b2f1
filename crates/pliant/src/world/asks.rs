//! The queries of every kind, as a state answers them.

use super::state::State;
use crate::close_pairs::{CloseEdgeEdge, CloseTriangles, CloseVertexTriangle};
use crate::collide::{Ask, OfKind, Request, near, pair_of};
use crate::contacts::Contact;
use crate::error::Error;
use crate::hits::{EdgeEdge, Pair, VertexTriangle};
use crate::ids::BodyId;
use crate::impacts::{EdgeEdgeImpact, VertexTriangleImpact};
use crate::kernels::Coordinate;
use crate::queries::{
    Close, Contacts, EdgeEdgeCandidates, Impacts, Intersections, Kind, Margin, NearTriangles,
    Needs, Reach, VertexTriangleCandidates,
};
use crate::selection::Selection;
use crate::statistics::Statistics;
use crate::threads::Interrupt;
use crate::traversal::Visitor;
use std::ops::ControlFlow;

impl<S: Coordinate> Ask<Pair> for State<S> {
    fn all(&mut self, request: &Request) -> Result<&[Pair], Error> {
        let kind = &Intersections::default();
        self.kinds
            .intersections
            .all(kind, &mut self.common, request)
    }

    /// Begins with the last answer: see `witness`.
    fn first(&mut self, request: &Request) -> Result<Option<Pair>, Error> {
        let last = match request.of {
            Selection::World => self.witnesses.of_world[0],
            Selection::Everything => self.witnesses.of_world[1],
            Selection::Between(a, b) => Some([a, b]),
            Selection::Within(a) => Some([a; 2]),
        };
        if let Some(bodies) = last.filter(|&bodies| self.do_meet(bodies, request.of))
            && let Some(pair) = self.ask_witness(bodies, request)?
        {
            return Ok(Some(pair));
        }
        let found = first_seen(|visitor| Ask::<Pair>::visit(self, request, visitor))?;
        let bodies = found.map(|pair: Pair| [pair.body_a, pair.body_b]);
        match request.of {
            Selection::World => self.witnesses.of_world[0] = bodies,
            Selection::Everything => self.witnesses.of_world[1] = bodies,
            Selection::Between(..) | Selection::Within(_) => {}
        }
        if let (Some(bodies), Some(at)) = (bodies, self.kinds.intersections.tasks.broke_at.take()) {
            self.witnesses.keep(bodies, at);
        }
        Ok(found)
    }

    fn visit(&mut self, request: &Request, visitor: Visitor<Pair>) -> Result<(), Error> {
        let kind = &Intersections::default();
        self.kinds
            .intersections
            .visit(kind, &mut self.common, request, visitor)
    }

    fn prepare(&mut self, request: &Request) -> Result<(), Error> {
        self.common.prepare(Needs::TRIANGLES, request)
    }
}

/// Answers queries of a kind that is made of the request; a list of all of them is made by this method of what is kept.
macro_rules! ask {
    ($hit:ty, $asked:ident.$all:ident, |$request:ident| $kind:expr) => {
        impl<S: Coordinate> Ask<$hit> for State<S> {
            fn all(&mut self, $request: &Request) -> Result<&[$hit], Error> {
                let kind = &$kind;
                self.kinds.$asked.$all(kind, &mut self.common, $request)
            }

            fn first(&mut self, request: &Request) -> Result<Option<$hit>, Error> {
                first_seen(|visitor| Ask::<$hit>::visit(self, request, visitor))
            }

            fn visit(&mut self, $request: &Request, visitor: Visitor<$hit>) -> Result<(), Error> {
                let kind = &$kind;
                self.kinds
                    .$asked
                    .visit(kind, &mut self.common, $request, visitor)
            }

            fn prepare(&mut self, $request: &Request) -> Result<(), Error> {
                let needs = $kind.needs();
                self.common.prepare(needs, $request)
            }
        }
    };
}

/// The first hit that a visit shows.
fn first_seen<H: Copy>(
    visit: impl FnOnce(Visitor<H>) -> Result<(), Error>,
) -> Result<Option<H>, Error> {
    let mut found = None;
    visit(&mut |hits| {
        found = hits.first().copied();
        if found.is_some() {
            ControlFlow::Break(0)
        } else {
            ControlFlow::Continue(())
        }
    })?;
    Ok(found)
}

ask!(Contact, contacts.all_listed, |request| Contacts::<S>::of(
    request.only
));
ask!(VertexTriangle, vertex_triangle.all, |request| {
    VertexTriangleCandidates::<S>::within(request.margin()?)
});
ask!(EdgeEdge, edge_edge.all, |request| {
    EdgeEdgeCandidates::<S>::within(request.margin()?)
});
ask!(
    CloseVertexTriangle,
    close_vertex_triangle.all_measured,
    |request| {
        let candidates = VertexTriangleCandidates::<S>::within;
        Close::within(request.distance()?, candidates)
    }
);
ask!(CloseEdgeEdge, close_edge_edge.all_measured, |request| {
    let candidates = EdgeEdgeCandidates::<S>::within;
    Close::within(request.distance()?, candidates)
});
ask!(CloseTriangles, close_triangles.all_measured, |request| {
    NearTriangles::<S>::within(request.distance()?)
});

/// Answers queries for impacts of one kind.
macro_rules! ask_impacts {
    ($hit:ident, $asked:ident, $candidates:ident, $of:expr) => {
        impl<S: Coordinate> Ask<$hit> for State<S> {
            fn all(&mut self, request: &Request) -> Result<&[$hit], Error> {
                let kind = Self::all_of(request, $candidates::within)?;
                self.kinds
                    .impacts
                    .$asked
                    .all_listed(&kind, &mut self.common, request)
            }

            fn first(&mut self, request: &Request) -> Result<Option<$hit>, Error> {
                let grid = request.grid()?;
                let first = self
                    .kinds
                    .impacts
                    .first_contact(&mut self.common, request, $of)?;
                Ok(first.and_then(|first| $hit::of(first.in_cell_of(grid))))
            }

            fn visit(&mut self, request: &Request, visitor: Visitor<$hit>) -> Result<(), Error> {
                let kind = Self::all_of(request, $candidates::within)?;
                self.kinds
                    .impacts
                    .$asked
                    .visit(&kind, &mut self.common, request, visitor)
            }

            fn prepare(&mut self, request: &Request) -> Result<(), Error> {
                let kind = Self::all_of(request, $candidates::<S>::within)?;
                self.common.prepare(kind.needs(), request)
            }
        }
    };
}

ask_impacts!(
    VertexTriangleImpact,
    vertex_triangle,
    VertexTriangleCandidates,
    OfKind::VerticesAndTriangles
);
ask_impacts!(EdgeEdgeImpact, edge_edge, EdgeEdgeCandidates, OfKind::Edges);

impl<S: Coordinate> State<S> {
    /// All impacts of a kind of candidates.
    fn all_of<K>(request: &Request, within: impl Fn(Margin) -> K) -> Result<Impacts<K>, Error> {
        let candidates = within(Margin::new(0.0));
        Ok(Impacts::of(candidates, request.grid()?, Reach::End))
    }
}

/// The pair that answered the last question for a first pair.
impl<S: Coordinate> State<S> {
    /// Whether bodies that were there are there still, and meet in a query of these.
    fn do_meet(&self, [a, b]: [BodyId; 2], of: Selection) -> bool {
        let (Ok(body_a), Ok(body_b)) = (self.body(a), self.body(b)) else {
            return false;
        };
        match of {
            Selection::World | Selection::Everything => self.common.bodies.do_meet(body_a, body_b),
            Selection::Between(..) => a != b,
            Selection::Within(_) => true,
        }
    }

    /// A pair of these bodies at or near the last answer, if one intersects. What it does is counted in any case.
    fn ask_witness(
        &mut self,
        bodies: [BodyId; 2],
        request: &Request,
    ) -> Result<Option<Pair>, Error> {
        let Some(last) = self.witnesses.get(bodies) else {
            return Ok(None);
        };
        let interrupt = Interrupt::new(request.question);
        let mut statistics = self.common.done_early;
        let both = [self.body(bodies[0])?, self.body(bodies[1])?];
        let found = near(both, last, &interrupt, &mut statistics);
        let pair = found.map(|found| pair_of(both, found));
        if let Some(found) = found {
            self.common.statistics = statistics;
            self.common.done_early = Statistics::default();
            self.witnesses.keep(bodies, found);
        } else {
            self.common.done_early = statistics;
            self.common.end(&interrupt)?;
        }
        Ok(pair)
    }
}
