//! The pair that answered the last question for a first pair: asked again before anything else.
//!
//! What touched a step ago mostly touches still, or its neighbours do. So a query for the first pair begins with the last
//! answer, then with the triangles beside it in the order of the trees, and looks at nothing else if one of them intersects:
//! no box is made, and the shapes are not even brought into tree order. Whether there is a pair does not depend on it; which
//! one it is does.

use super::BodyId;
use super::body::Body;
use crate::geometry::{Bounds, Scalar};
use crate::narrow_phase::{Triangle, intersect};
use crate::pairs::Candidate;
use crate::statistics::Statistics;
use std::collections::BTreeMap;

/// The last answers, by the bodies asked for; a body with itself is asked for twice.
#[derive(Debug, Default)]
pub(super) struct Witnesses {
    answers: BTreeMap<[BodyId; 2], Candidate>,
    /// The bodies of the last answer for the whole world.
    pub(super) of_world: Option<[BodyId; 2]>,
}

impl Witnesses {
    pub(super) fn get(&self, bodies: [BodyId; 2]) -> Option<Candidate> {
        self.answers.get(&bodies).copied()
    }

    pub(super) fn keep(&mut self, bodies: [BodyId; 2], answer: Candidate) {
        self.answers.insert(bodies, answer);
    }

    /// A body is removed, or its triangles have a new order.
    pub(super) fn forget(&mut self, body: BodyId) {
        self.answers.retain(|bodies, _| !bodies.contains(&body));
        self.of_world = self.of_world.filter(|bodies| !bodies.contains(&body));
    }
}

/// How many triangles in a row are looked at, on either side: the one, its leaf, its leaf's siblings.
const NEIGHBOURS: [usize; 3] = [1, 8, 64];

/// A pair that intersects among the neighbours of a pair, of two bodies or of one with itself. In tree order, as everything here.
pub(super) fn near<S: Scalar>(
    [a, b]: [&Body<S>; 2],
    [near_a, near_b]: Candidate,
    statistics: &mut Statistics,
) -> Option<Candidate> {
    NEIGHBOURS.into_iter().find_map(|count| {
        let of_a = Row::around(a, near_a, count);
        let of_b = Row::around(b, near_b, count);
        of_a.meet(&of_b, a.id() == b.id(), statistics)
    })
}

/// Some triangles in a row.
struct Row<'b, S> {
    body: &'b Body<S>,
    first: u32,
    count: usize,
    corners: [Triangle; NEIGHBOURS[2]],
    boxes: [Bounds<f64>; NEIGHBOURS[2]],
    all: Bounds<f64>,
}

impl<'b, S: Scalar> Row<'b, S> {
    fn around(body: &'b Body<S>, triangle: u32, count: usize) -> Self {
        let first = triangle as usize / count * count;
        let count = count.min(body.triangle_count() - first);
        let mut corners = [[[0.0; 3]; 3]; NEIGHBOURS[2]];
        let mut boxes = [Bounds::EMPTY; NEIGHBOURS[2]];
        let mut all = Bounds::EMPTY;
        for place in 0..count {
            corners[place] = body.corners_now((first + place) as u32);
            for corner in corners[place] {
                boxes[place].include(corner);
                all.include(corner);
            }
        }
        Self {
            body,
            first: first as u32,
            count,
            all,
            corners,
            boxes,
        }
    }

    /// The places of triangles whose boxes overlap a box.
    fn overlapping(&self, other: Bounds<f64>) -> impl Iterator<Item = usize> {
        (0..self.count).filter(move |&place| self.boxes[place].overlaps(&other))
    }

    fn meet(&self, other: &Self, itself: bool, statistics: &mut Statistics) -> Option<Candidate> {
        for a in self.overlapping(other.all) {
            for b in other.overlapping(self.boxes[a]) {
                let pair = [self.first + a as u32, other.first + b as u32];
                if itself && self.body.mesh.share_a_vertex(pair[0], pair[1]) {
                    continue;
                }
                statistics.candidate_pairs += 1;
                if intersect::<S>(&self.corners[a], &other.corners[b], statistics) {
                    statistics.pairs += 1;
                    return Some(pair);
                }
            }
        }
        None
    }
}
