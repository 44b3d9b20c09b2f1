//! A second kind of query, for tests only: triangles whose boxes, grown by a distance, overlap, neighbours in the mesh included.
//!
//! It shows that nothing but `intersections` knows intersections: it has a source of boxes, a set of boxes, a hit and a rule for
//! neighbours of its own. The tests here ask it between the steps of an ordinary query and find the boxes of that untouched.

use super::{BoxSetNumber, CallerIds, Candidate, Kind, LeafTest, Leaves};
use crate::geometry::Shape;
use crate::hits::{Hit, Numbered};
use crate::kernels::{Buffer, Coordinate};
use crate::statistics::Statistics;
use crate::tree::Grown;
use std::marker::PhantomData;

/// Triangles whose grown boxes overlap.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Near<S> {
    distance: f32,
    scalar: PhantomData<S>,
}

impl<S> Near<S> {
    pub(crate) fn within(distance: f32) -> Self {
        Self {
            distance,
            scalar: PhantomData,
        }
    }
}

/// Body, triangle, body, triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct NearPair(pub(crate) [u32; 4]);

impl Numbered for NearPair {
    fn numbers(&self) -> [u32; 4] {
        self.0
    }
}

impl Hit for NearPair {
    fn of_numbers(numbers: [u32; 4]) -> Self {
        Self(numbers)
    }
}

impl<S: Coordinate> Kind for Near<S> {
    type Scalar = S;
    type Hit = NearPair;
    type TreeHit = Candidate;
    type Buffers = ();
    type Source<'s> = Grown<Shape<'s, S>>;

    const BOX_SET: BoxSetNumber = 3;
    const LEAVES: Leaves = Leaves::AllTriangles;

    fn grows_by(&self) -> Option<f32> {
        Some(self.distance)
    }

    fn source<'s>(&self, source: Shape<'s, S>, _: Option<Shape<'s, S>>) -> Grown<Shape<'s, S>> {
        Grown {
            source,
            distance: self.distance,
        }
    }

    fn test(
        &self,
        _: &LeafTest<S>,
        candidates: &mut Buffer<Candidate>,
        (): &mut (),
        hits: &mut Buffer<Candidate>,
        statistics: &mut Statistics,
    ) {
        statistics.candidate_pairs += candidates.len() as u64;
        statistics.pairs += candidates.len() as u64;
        hits.extend(candidates.as_slice());
    }

    fn to_caller(&self, ids: &CallerIds, [a, b]: Candidate) -> NearPair {
        let a = [ids.bodies[0].0, ids.orders[0].caller_triangle(a).0];
        let b = [ids.bodies[1].0, ids.orders[1].caller_triangle(b).0];
        let [a, b] = if a[0] == b[0] {
            [a.min(b), a.max(b)]
        } else {
            [a, b]
        };
        NearPair([a[0], a[1], b[0], b[1]])
    }
}
