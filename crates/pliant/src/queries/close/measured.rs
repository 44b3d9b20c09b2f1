//! Measuring close pairs: lists once they are sorted, and as pairs are found where visitors see
//! them.

use super::closest::closest_of;
use crate::close_pairs::{CloseEdgeEdge, CloseVertexTriangle};
use crate::hits::{EdgeEdge, Hit, VertexTriangle};
use crate::kernels::closest::Corners;
use crate::kernels::{Coordinate, Simd};
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

/// Shows `take` hits with what is measured of them, in their order. `pair` says what each is as the
/// caller numbers things, and `corners` where its corners are. Interrupted, or where there are
/// none, it ends early.
#[inline(always)]
pub(crate) fn measure_all<'c, I: Simd, S: Coordinate, H: Measurable, T: Copy>(
    i: I,
    hits: &[T],
    interrupt: &Interrupt,
    (pair, mut corners): (impl Fn(T) -> H, impl FnMut(T) -> Option<H::Corners<'c, S>>),
    mut take: impl FnMut(H::Close),
) {
    for some in hits.chunks(4) {
        let mut four = None;
        let mut pairs = [pair(some[0]); 4];
        for (lane, &hit) in some.iter().enumerate() {
            let Some(corners) = corners(hit) else {
                return;
            };
            four.get_or_insert([corners; 4])[lane] = corners;
            pairs[lane] = pair(hit);
        }
        let Some(corners) = &four else {
            return;
        };
        if !H::measure(i, &pairs[..some.len()], corners, interrupt, &mut take) {
            return;
        }
    }
}
