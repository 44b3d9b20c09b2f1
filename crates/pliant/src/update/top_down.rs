//! Top-down refit: the wide nodes that a traversal reached and found stale.
//!
//! By default one level: each node from the distinct vertices below it. The paper's variant makes
//! "a specified number of levels in their sub-trees" at once, bottom-up.

use super::bottom_up::refit_levels;
use super::dirty_set::DirtySet;
use super::refit::refit_from_vertices;
use super::refitted::{Refit, Refitted};
use crate::ids::WideNodeId;
use crate::kernels::Coordinate;
use crate::statistics::Statistics;

impl Refit<'_> {
    /// Refits the reached wide nodes, which are stale, each with `levels_at_once - 1` levels below
    /// it.
    ///
    /// Empties the set. The lists are scratch.
    pub(crate) fn reached<S: Coordinate>(
        &self,
        one: &mut Refitted<S>,
        reached: &mut DirtySet,
        [listed, below]: &mut [Vec<WideNodeId>; 2],
        statistics: &mut Statistics,
    ) {
        listed.clear();
        listed.extend(reached.of(reached.words()).map(WideNodeId));
        reached.clear();
        let levels = self.update.levels_at_once();
        let boxes = &mut statistics.boxes_top_down;
        if levels == 1 {
            *boxes += refit_from_vertices(self, one, listed);
            return;
        }
        for &wide_node in &*listed {
            // It may have been refitted with another above it.
            if !one.boxes.is_valid(wide_node) {
                *boxes += refit_levels(self, one, wide_node, levels, below);
            }
        }
    }
}
