//! One body with itself: every pair of its triangles once, without those that share a vertex.
//!
//! A pair of one node with itself stands for the pairs within it; it expands into its children with themselves and into
//! the pairs of different children that overlap.

use super::Side;
use super::descent::Meeting;
use crate::geometry::{Scalar, Shape};
use crate::pairs::Candidate;
use crate::tree::Tree;

/// A tree whose root box is true.
pub(crate) struct OneTree<'t, const N: usize, S> {
    pub(crate) side: Side<'t, N, S>,
}

impl<const N: usize, S: Scalar> Meeting<N> for OneTree<'_, N, S> {
    type Coordinate = S;
    const ITSELF: bool = true;

    fn sides(&self) -> [&Side<'_, N, S>; 2] {
        [&self.side; 2]
    }

    fn tree_mut(&mut self, _: usize) -> (&mut Tree<N>, &Shape<'_, S>) {
        (self.side.tree, &self.side.shape)
    }

    fn name(&self, [a, b]: Candidate) -> [u32; 2] {
        let ids = self.side.mesh.triangle_ids();
        let (a, b) = (ids[a as usize], ids[b as usize]);
        [a.min(b), a.max(b)]
    }
}
