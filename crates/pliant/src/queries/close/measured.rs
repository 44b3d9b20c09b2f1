//! Measurement of close pairs: of lists once they are sorted, and for visitors as pairs are found.

use super::closest::closest_of;
use super::hit::{CloseEdgeEdge, CloseVertexTriangle};
use crate::kernels::closest::FourCorners;
use crate::kernels::{Coordinate, Simd};
use crate::queries::{EdgeEdge, VertexTriangle};
use crate::sort::Hit;
use crate::threads::Interrupt;
use pliant_exact::distance::Closest;

/// Pair that can be measured.
pub(crate) trait Measurable: Hit {
    type Close: Copy + std::fmt::Debug + Send + Sync;
    /// Corners of both, each with padding.
    type Corners<'c, S: Coordinate>: Copy;

    /// The pair with placeholders, before it is measured.
    fn unmeasured(self) -> Self::Close;

    /// Measures up to four pairs and shows them to `take`, in order. Returns false if interrupted.
    fn measure<I: Simd, S: Coordinate>(
        i: I,
        hits: &[Self],
        corners: &[Self::Corners<'_, S>; 4],
        interrupt: &Interrupt,
        take: impl FnMut(Self::Close),
    ) -> bool;
}

/// Pair of elements, which have four corners together.
pub(crate) trait ElementPair: Measurable {
    /// Whether the elements are edges; else they are a vertex and a triangle.
    const ARE_EDGES: bool;

    /// The pair with its measurements.
    fn close(self, closest: &Closest) -> Self::Close;
}

impl ElementPair for VertexTriangle {
    const ARE_EDGES: bool = false;

    #[inline]
    fn close(self, closest: &Closest) -> CloseVertexTriangle {
        let [_, a, b, c] = weights(false, closest);
        CloseVertexTriangle {
            pair: self,
            distance: closest.distance,
            direction: direction(closest),
            barycentric: [a, b, c],
        }
    }
}

impl ElementPair for EdgeEdge {
    const ARE_EDGES: bool = true;

    #[inline]
    fn close(self, closest: &Closest) -> CloseEdgeEdge {
        let [a, b, c, d] = weights(true, closest);
        CloseEdgeEdge {
            pair: self,
            distance: closest.distance,
            direction: direction(closest),
            barycentric_a: [a, b],
            barycentric_b: [c, d],
        }
    }
}

/// Implements `Measurable` for both kinds of elements.
macro_rules! measurable {
    ($pair:ty, $close:ty) => {
        impl Measurable for $pair {
            type Close = $close;
            type Corners<'c, S: Coordinate> = FourCorners<'c, S>;

            fn unmeasured(self) -> $close {
                self.close(&Closest::default())
            }

            #[inline(always)]
            fn measure<I: Simd, S: Coordinate>(
                i: I,
                hits: &[Self],
                corners: &[FourCorners<'_, S>; 4],
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

/// Weights of the four corners of two elements in their closest points.
#[inline]
pub(crate) fn weights(are_edges: bool, closest: &Closest) -> [f64; 4] {
    let [x, y] = closest.along;
    if are_edges {
        [1.0 - x, x, 1.0 - y, y]
    } else {
        [1.0, (1.0 - x - y).max(0.0), x, y]
    }
}

/// Direction of the closest points; none if they touch.
#[inline]
pub(crate) fn direction(closest: &Closest) -> Option<[f64; 3]> {
    (closest.distance != 0.0).then_some(closest.direction)
}

/// Measures hits and shows them to `take`, in order. Ends early if interrupted, or if a hit has no
/// corners.
///
/// `pair` returns a hit with the caller's numbers, `corners` the positions of its corners.
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
