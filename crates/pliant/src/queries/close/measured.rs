//! Close pairs that are measured as they are found, for visitors; a list is measured once it is sorted.

use super::closest::closest_of;
use super::hit::{CloseEdgeEdge, CloseVertexTriangle};
use crate::kernels::closest::Corners;
use crate::kernels::{Buffer, Coordinate, Simd, dispatch};
use crate::queries::{Batch, CallerIds, EdgeEdge, Kind, LeafTest, Needs, VertexTriangle};
use crate::sort::Hit;
use crate::statistics::Statistics;
use crate::threads::Interrupt;
use pliant_exact::distance::Closest;

/// Two things that can be measured.
pub(crate) trait Measurable: Hit {
    type Close: Copy + std::fmt::Debug + Send + Sync;
    /// The corners of both, each with padding.
    type Corners<'c, S: Coordinate>: Copy;

    /// Before it was measured.
    fn unmeasured(self) -> Self::Close;

    /// Shows `take` up to four with what is measured, in their order. Returns false if interrupted.
    fn measure<I: Simd, S: Coordinate>(
        i: I,
        hits: &[Self],
        corners: &[Self::Corners<'_, S>; 4],
        interrupt: &Interrupt,
        take: impl FnMut(Self::Close),
    ) -> bool;
}

/// Two elements, which have four corners together.
pub(crate) trait ElementPair: Measurable {
    /// Whether they are edges; else they are a vertex and a triangle.
    const ARE_EDGES: bool;

    /// With what was measured.
    fn close(self, closest: &Closest) -> Self::Close;
}

impl ElementPair for VertexTriangle {
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

/// What both kinds of elements do alike.
macro_rules! measurable {
    ($pair:ty, $close:ty) => {
        impl Measurable for $pair {
            type Close = $close;
            type Corners<'c, S: Coordinate> = Corners<'c, S>;

            fn unmeasured(self) -> $close {
                self.close(&Closest::default())
            }

            #[inline(always)]
            fn measure<I: Simd, S: Coordinate>(
                i: I,
                hits: &[Self],
                corners: &[Corners<'_, S>; 4],
                interrupt: &Interrupt,
                mut take: impl FnMut($close),
            ) -> bool {
                let are_edges = Self::ARE_EDGES;
                closest_of(
                    i,
                    are_edges,
                    corners,
                    hits.len(),
                    interrupt,
                    |lane, closest| {
                        take(hits[lane].close(closest));
                    },
                )
            }
        }
    };
}

measurable!(VertexTriangle, CloseVertexTriangle);
measurable!(EdgeEdge, CloseEdgeEdge);

#[inline]
fn direction(closest: &Closest) -> Option<[f64; 3]> {
    (closest.distance != 0.0).then_some(closest.direction)
}

/// A kind of pairs that are at most some distance apart.
pub(crate) trait CloseKind: Kind<Buffers = (), Hit: Measurable> {
    /// The corners of a hit, in the order in which the caller has them.
    fn callers_corners<'q>(
        leaves: &LeafTest<'q, Self::Scalar>,
        ids: &CallerIds,
        hit: Self::TreeHit,
    ) -> Option<<Self::Hit as Measurable>::Corners<'q, Self::Scalar>>;
}

/// Close pairs of a kind with what was measured of them.
#[derive(Debug)]
pub(crate) struct Measured<C>(pub(crate) C);

impl<C: CloseKind> Kind for Measured<C> {
    type Scalar = C::Scalar;
    type Hit = <C::Hit as Measurable>::Close;
    type TreeHit = C::TreeHit;
    type Buffers = ();

    fn needs(&self) -> Needs {
        self.0.needs()
    }

    fn test(
        &self,
        leaves: &LeafTest<C::Scalar>,
        batch: Batch,
        buffers: &mut (),
        hits: &mut Buffer<C::TreeHit>,
        statistics: &mut Statistics,
    ) {
        self.0.test(leaves, batch, buffers, hits, statistics);
    }

    fn to_caller(&self, ids: &CallerIds, hit: C::TreeHit) -> Self::Hit {
        self.0.to_caller(ids, hit).unmeasured()
    }

    fn to_callers(
        &self,
        leaves: &LeafTest<C::Scalar>,
        ids: &CallerIds,
        hits: &[C::TreeHit],
        of_caller: &mut Vec<Self::Hit>,
    ) {
        dispatch!(leaves.instructions, i => {
            for some in hits.chunks(4) {
                let Some(first) = C::callers_corners(leaves, ids, some[0]) else {
                    return;
                };
                let mut corners = [first; 4];
                let mut of_some = [self.0.to_caller(ids, some[0]); 4];
                for lane in 1..some.len() {
                    corners[lane] = C::callers_corners(leaves, ids, some[lane]).unwrap_or(first);
                    of_some[lane] = self.0.to_caller(ids, some[lane]);
                }
                let of_some = &of_some[..some.len()];
                let take = |close| of_caller.push(close);
                if !C::Hit::measure(i, of_some, &corners, leaves.interrupt, take) {
                    return;
                }
            }
        });
    }
}
