//! Where the corners of two elements are, by the caller's numbers.

use super::body::Body;
use crate::hits::{EdgeEdge, VertexTriangle};
use crate::kernels::Coordinate;

/// Two elements that have four corners together.
pub(super) trait FourCorners {
    /// The vertices, each of the first body or the second: vertex, triangle; or both ends of either edge.
    fn vertices<const N: usize, S: Coordinate>(
        &self,
        bodies: [&Body<N, S>; 2],
    ) -> [(usize, u32); 4];
}

impl FourCorners for VertexTriangle {
    #[inline]
    fn vertices<const N: usize, S: Coordinate>(
        &self,
        [_, of_triangle]: [&Body<N, S>; 2],
    ) -> [(usize, u32); 4] {
        let [a, b, c] = of_triangle.topology.triangles()[self.triangle as usize];
        [(0, self.vertex), (1, a), (1, b), (1, c)]
    }
}

impl FourCorners for EdgeEdge {
    #[inline]
    fn vertices<const N: usize, S: Coordinate>(
        &self,
        [of_a, of_b]: [&Body<N, S>; 2],
    ) -> [(usize, u32); 4] {
        let [a0, a1] = of_a.edges()[self.edge_a as usize];
        let [b0, b1] = of_b.edges()[self.edge_b as usize];
        [(0, a0), (0, a1), (1, b0), (1, b1)]
    }
}
