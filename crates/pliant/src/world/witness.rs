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

/// A pair that intersects among the neighbours of a pair, of two bodies or of one with itself: on either side the one, its leaf,
/// its leaf's siblings. In tree order, as everything here.
pub(super) fn near<S: Scalar>(
    both: [&Body<S>; 2],
    last: Candidate,
    statistics: &mut Statistics,
) -> Option<Candidate> {
    among::<1, S>(both, last, statistics)
        .or_else(|| among::<8, S>(both, last, statistics))
        .or_else(|| among::<64, S>(both, last, statistics))
}

/// The same, so many triangles on either side.
fn among<const N: usize, S: Scalar>(
    [a, b]: [&Body<S>; 2],
    [near_a, near_b]: Candidate,
    statistics: &mut Statistics,
) -> Option<Candidate> {
    let of_a = Row::<N, S>::around(a, near_a);
    let of_b = Row::<N, S>::around(b, near_b);
    of_a.meet(&of_b, a.id() == b.id(), statistics)
}

/// Up to N triangles in a row.
struct Row<'b, const N: usize, S> {
    body: &'b Body<S>,
    first: u32,
    count: usize,
    corners: [Triangle; N],
    boxes: [Bounds<f64>; N],
    all: Bounds<f64>,
}

impl<'b, const N: usize, S: Scalar> Row<'b, N, S> {
    fn around(body: &'b Body<S>, triangle: u32) -> Self {
        let first = triangle as usize / N * N;
        let count = N.min(body.triangle_count() - first);
        let mut corners = [[[0.0; 3]; 3]; N];
        let mut boxes = [Bounds::EMPTY; N];
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
            corners,
            boxes,
            all,
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
