//! Intersections: triangles that intersect as closed sets in the present shape, decided exactly.
//!
//! `pliant_exact` defines them. Within a body, triangles that share a vertex of the mesh are left
//! out: they always touch. `eight` decides candidates side by side on signs that single precision
//! makes certain, and leaves few to `pliant_exact`.

pub(super) mod eight;
mod hit;

use super::{Batch, CallerIds, Candidate, FoundBy, Kind, LeafTest, Needs, shows_hits};
use crate::held::empty;
use crate::kernels::Coordinate;
use eight::Undecided;
pub use hit::Pair;
use std::marker::PhantomData;

/// Kind of query: pairs of triangles that intersect.
#[derive(Debug)]
pub(crate) struct Intersections<S> {
    scalar: PhantomData<S>,
}

empty!(Intersections<S>: scalar);

impl<S: Coordinate> Kind for Intersections<S> {
    type Scalar = S;
    type Hit = Pair;
    type TreeHit = Candidate;
    type Buffers = Undecided;

    shows_hits!();

    fn needs(&self) -> Needs {
        Needs::TRIANGLES
    }

    fn test(&self, leaves: &LeafTest<S>, batch: Batch, found: &mut FoundBy<Self>) {
        let candidates = batch.triangles();
        let (undecided, statistics) = (&mut found.buffers, &mut found.statistics);
        eight::decide(leaves, candidates, undecided, &mut found.hits, statistics);
    }

    #[inline]
    fn to_caller(&self, ids: &CallerIds, [a, b]: Candidate) -> Pair {
        let [body_a, body_b] = ids.bodies;
        let a = ids.orders[0].caller_triangle(a).0;
        let b = ids.orders[1].caller_triangle(b).0;
        // In one body the smaller triangle is first.
        let [triangle_a, triangle_b] = if body_a == body_b {
            [a.min(b), a.max(b)]
        } else {
            [a, b]
        };
        Pair {
            body_a,
            triangle_a,
            body_b,
            triangle_b,
        }
    }
}
