//! Two bodies.

use super::Side;
use super::descent::Meeting;
use crate::geometry::{Scalar, Shape};
use crate::pairs::Candidate;
use crate::tree::Tree;

/// Two trees whose root boxes are true and overlap.
pub(crate) struct TwoTrees<'t, const N: usize, S> {
    pub(crate) a: Side<'t, N, S>,
    pub(crate) b: Side<'t, N, S>,
}

impl<const N: usize, S: Scalar> Meeting<N> for TwoTrees<'_, N, S> {
    type Coordinate = S;
    const ITSELF: bool = false;

    fn sides(&self) -> [&Side<'_, N, S>; 2] {
        [&self.a, &self.b]
    }

    fn tree_mut(&mut self, which: usize) -> (&mut Tree<N>, &Shape<'_, S>) {
        let side = if which == 0 { &mut self.a } else { &mut self.b };
        (side.tree, &side.shape)
    }

    fn name(&self, [a, b]: Candidate) -> [u32; 2] {
        [
            self.a.mesh.triangle_ids()[a as usize],
            self.b.mesh.triangle_ids()[b as usize],
        ]
    }
}
