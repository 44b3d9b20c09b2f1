//! Witness cache: the last answer to a query for a first pair, tested again before anything else.
//!
//! Idea: temporal coherence, since triangles that touched a step ago, or their neighbours, mostly
//! touch still. A query for the first pair tests the last answer, then the triangles beside it in
//! tree order. If one of these pairs intersects, no box is refitted, and shapes are not even
//! brought into tree order. Invariant: whether there is a pair does not depend on the witness;
//! which pair is returned does.

use crate::bodies::Body;
use crate::geometry::Bounds;
use crate::held::{self, Held};
use crate::ids::BodyId;
use crate::ids::TreeTriangle;
use crate::kernels::Coordinate;
use crate::queries::{CallerIds, Candidate, Intersections, Kind, OwnEdges, Pair};
use crate::statistics::Statistics;
use crate::threads::Interrupt;
use pliant_exact::{Triangle, intersect};
use std::collections::BTreeMap;

/// Last answers by pair of bodies; a body with itself is listed twice.
#[derive(Debug, Default)]
pub(crate) struct Witnesses {
    answers: BTreeMap<[BodyId; 2], Candidate>,
    /// Bodies of the last answer for the whole world, without and with each body's
    /// self-intersections.
    pub(crate) of_world: [Option<[BodyId; 2]>; 2],
}

impl Witnesses {
    pub(crate) fn get(&self, bodies: [BodyId; 2]) -> Option<Candidate> {
        self.answers.get(&bodies).copied()
    }

    pub(crate) fn keep(&mut self, bodies: [BodyId; 2], answer: Candidate) {
        self.answers.insert(bodies, answer);
    }

    /// Drops the answers of a body that is removed, or whose triangles have a new order.
    pub(crate) fn forget(&mut self, body: BodyId) {
        self.answers.retain(|bodies, _| !bodies.contains(&body));
        for of_world in &mut self.of_world {
            *of_world = of_world.filter(|bodies| !bodies.contains(&body));
        }
    }
}

/// Finds an intersecting pair near a pair, of two bodies or one with itself, in tree order. On
/// either side it tests the triangle alone, then its leaf, then the leaves beside it.
pub(crate) fn near<S: Coordinate>(
    both: [&Body<S>; 2],
    last: Candidate,
    interrupt: &Interrupt,
    statistics: &mut Statistics,
) -> Option<Candidate> {
    among::<1, S>(both, last, interrupt, statistics)
        .or_else(|| among::<8, S>(both, last, interrupt, statistics))
        .or_else(|| among::<64, S>(both, last, interrupt, statistics))
}

/// Two triangles of two bodies, or of one, in the caller's numbering.
pub(crate) fn pair_of<S: Coordinate>(both: [&Body<S>; 2], found: Candidate) -> Pair {
    let ids = CallerIds {
        edges: [&[]; 2],
        bodies: both.map(Body::id),
        orders: both.map(|body| body.mesh().order()),
        meshes: both.map(|body| body.mesh() as &dyn OwnEdges),
    };
    Intersections::<S>::default().to_caller(&ids, found)
}

/// Finds an intersecting pair among `R` triangles on either side.
fn among<const R: usize, S: Coordinate>(
    [a, b]: [&Body<S>; 2],
    [near_a, near_b]: Candidate,
    interrupt: &Interrupt,
    statistics: &mut Statistics,
) -> Option<Candidate> {
    let of_a = Run::<R, S>::around(a, near_a);
    let of_b = Run::<R, S>::around(b, near_b);
    of_a.meet(&of_b, a.id() == b.id(), interrupt, statistics)
}

/// Up to `R` consecutive triangles in tree order, with their boxes.
struct Run<'b, const R: usize, S> {
    body: &'b Body<S>,
    first: TreeTriangle,
    count: usize,
    corners: [Triangle; R],
    boxes: [Bounds<f64>; R],
    all: Bounds<f64>,
}

impl<'b, const R: usize, S: Coordinate> Run<'b, R, S> {
    fn around(body: &'b Body<S>, triangle: TreeTriangle) -> Self {
        let first = triangle.index() / R * R;
        let count = R.min(body.triangle_count() - first);
        let mut corners = [[[0.0; 3]; 3]; R];
        let mut boxes = [Bounds::EMPTY; R];
        let mut all = Bounds::EMPTY;
        for place in 0..count {
            if body.mesh().is_gone(TreeTriangle((first + place) as u32)) {
                // A removed triangle has an empty box, which overlaps none.
                continue;
            }
            corners[place] = body.corners_now(TreeTriangle((first + place) as u32));
            for corner in corners[place] {
                boxes[place].include(corner);
                all.include(corner);
            }
        }
        Self {
            body,
            first: TreeTriangle(first as u32),
            count,
            corners,
            boxes,
            all,
        }
    }

    /// Places of triangles whose boxes overlap a box.
    fn overlapping(&self, other: Bounds<f64>) -> impl Iterator<Item = usize> {
        (0..self.count).filter(move |&place| self.boxes[place].overlaps(&other))
    }

    fn meet(
        &self,
        other: &Self,
        itself: bool,
        interrupt: &Interrupt,
        statistics: &mut Statistics,
    ) -> Option<Candidate> {
        for a in self.overlapping(other.all) {
            if interrupt.is_set() {
                return None;
            }
            for b in other.overlapping(self.boxes[a]) {
                let pair = [self.first.plus(a as u32), other.first.plus(b as u32)];
                if itself
                    && (self.body.mesh().order().share_a_vertex(pair[0], pair[1])
                        || self.body.leaves_out(pair))
                {
                    continue;
                }
                statistics.candidate_pairs += 1;
                let exact = &mut statistics.exact_decisions;
                if intersect(S::PRECISION, &self.corners[a], &other.corners[b], exact) {
                    statistics.pairs += 1;
                    return Some(pair);
                }
            }
        }
        None
    }
}

impl Held for Witnesses {
    fn held(&self) -> usize {
        held::entries::<([BodyId; 2], Candidate)>(self.answers.len())
    }
}
