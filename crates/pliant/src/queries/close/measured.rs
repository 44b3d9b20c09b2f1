//! Close pairs that are measured as they are found, for visitors; a list is measured once it is sorted.

use super::{Close, ElementCandidates, closest_of};
use crate::close_pairs::{CloseEdgeEdge, CloseVertexTriangle};
use crate::geometry::{Aabb, Shape};
use crate::hits::{EdgeEdge, Hit, VertexTriangle};
use crate::kernels::{Buffer, dispatch};
use crate::predicates::distance::Closest;
use crate::queries::{BoxSetNumber, CallerIds, Kind, LeafTest, Leaves};
use crate::statistics::Statistics;

/// Two elements that can be measured.
pub(crate) trait ElementPair: Hit {
    type Close: Copy + std::fmt::Debug + Send + Sync;

    /// Whether they are edges; else they are a vertex and a triangle.
    const ARE_EDGES: bool;

    /// With what was measured.
    fn close(self, closest: &Closest) -> Self::Close;
}

impl ElementPair for VertexTriangle {
    type Close = CloseVertexTriangle;
    const ARE_EDGES: bool = false;

    #[inline]
    fn close(self, closest: &Closest) -> CloseVertexTriangle {
        let [x, y] = closest.along;
        CloseVertexTriangle {
            pair: self,
            distance: closest.distance,
            direction: direction(closest),
            barycentric: [(1.0 - x - y).max(0.0), x, y],
        }
    }
}

impl ElementPair for EdgeEdge {
    type Close = CloseEdgeEdge;
    const ARE_EDGES: bool = true;

    #[inline]
    fn close(self, closest: &Closest) -> CloseEdgeEdge {
        let [x, y] = closest.along;
        CloseEdgeEdge {
            pair: self,
            distance: closest.distance,
            direction: direction(closest),
            barycentric_a: [1.0 - x, x],
            barycentric_b: [1.0 - y, y],
        }
    }
}

#[inline]
fn direction(closest: &Closest) -> Option<[f64; 3]> {
    (closest.distance != 0.0).then_some(closest.direction)
}

/// Close pairs with what was measured of them.
#[derive(Debug)]
pub(crate) struct Measured<K>(pub(crate) Close<K>);

impl<K: ElementCandidates> Kind for Measured<K> {
    type Scalar = K::Scalar;
    type Hit = <K::Hit as ElementPair>::Close;
    type TreeHit = [u32; 2];
    type Buffers = ();
    type Source<'s> = K::Source<'s>;

    const BOX_SET: BoxSetNumber = K::BOX_SET;
    const LEAVES: Leaves = K::LEAVES;
    const HOLDS_MOTIONS: bool = K::HOLDS_MOTIONS;

    fn grows_by(&self) -> f32 {
        self.0.grows_by()
    }

    fn body_box(&self, of_shape: Aabb) -> Aabb {
        self.0.body_box(of_shape)
    }

    fn source<'s>(
        &self,
        shape: Shape<'s, K::Scalar>,
        end: Option<Shape<'s, K::Scalar>>,
    ) -> K::Source<'s> {
        self.0.source(shape, end)
    }

    fn test_runs(
        &self,
        leaves: &LeafTest<K::Scalar>,
        pairs: &[[u32; 2]],
        hits: &mut Buffer<[u32; 2]>,
        statistics: &mut Statistics,
    ) {
        self.0.test_runs(leaves, pairs, hits, statistics);
    }

    fn to_caller(&self, ids: &CallerIds, hit: [u32; 2]) -> Self::Hit {
        self.0.to_caller(ids, hit).close(&Closest::default())
    }

    fn to_callers(
        &self,
        leaves: &LeafTest<K::Scalar>,
        ids: &CallerIds,
        hits: &[[u32; 2]],
        of_caller: &mut Vec<Self::Hit>,
    ) {
        dispatch!(leaves.instructions, i => {
            for some in hits.chunks(4) {
                let Some(first) = K::callers_corners(leaves, ids, some[0]) else {
                    return;
                };
                let mut pairs = [first; 4];
                for (pair, &hit) in pairs.iter_mut().zip(some).skip(1) {
                    *pair = K::callers_corners(leaves, ids, hit).unwrap_or(first);
                }
                let edges = K::Hit::ARE_EDGES;
                let Some(closest) = closest_of(i, edges, &pairs, some.len(), leaves.interrupt) else {
                    return;
                };
                let measured = some.iter().zip(&closest);
                of_caller.extend(measured.map(|(&hit, closest)| self.0.to_caller(ids, hit).close(closest)));
            }
        });
    }
}
