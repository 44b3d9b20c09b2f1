//! Two bodies.

use super::descent::Meeting;
use super::{Side, reach};
use crate::geometry::Scalar;
use crate::kernels::Level;
use crate::pairs::{Candidate, NodePair};
use crate::statistics::Statistics;

/// Two trees whose root boxes are true and overlap.
pub(crate) struct TwoTrees<'t, const N: usize, S> {
    pub(crate) a: Side<'t, N, S>,
    pub(crate) b: Side<'t, N, S>,
    /// How many levels are made when one is reached.
    pub(crate) levels_at_once: u32,
}

impl<const N: usize, S: Scalar> Meeting<N> for TwoTrees<'_, N, S> {
    type Coordinate = S;
    const ITSELF: bool = false;

    fn sides(&self) -> [&Side<'_, N, S>; 2] {
        [&self.a, &self.b]
    }

    fn reach(
        &mut self,
        level: Level,
        batch: &[NodePair],
        groups: &mut [Vec<u32>; 2],
        statistics: &mut Statistics,
    ) {
        let levels = self.levels_at_once;
        reach(
            level,
            &mut self.a,
            batch.iter().map(|pair| pair[0]),
            levels,
            groups,
            statistics,
        );
        reach(
            level,
            &mut self.b,
            batch.iter().map(|pair| pair[1]),
            levels,
            groups,
            statistics,
        );
    }

    fn name(&self, [a, b]: Candidate) -> [u32; 2] {
        [
            self.a.mesh.triangle_ids()[a as usize],
            self.b.mesh.triangle_ids()[b as usize],
        ]
    }
}
