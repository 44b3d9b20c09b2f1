//! What a traversal has reached and finds stale.
//!
//! By default one level: the nodes of the wide nodes that were reached, each from the distinct vertices below it. The paper's
//! variant makes "a specified number of levels in their sub-trees" bottom-up at once.

use super::bottom_up::refit_levels;
use super::dirty_set::DirtySet;
use super::refit::refit_from_vertices;
use super::refitted::{Refit, Refitted};
use crate::ids::WideNodeId;
use crate::kernels::Coordinate;

/// Refits wide nodes that were reached and are stale, and with each of them `levels_at_once - 1` levels below; empties the set. The
/// lists are scratch. Returns how many boxes of nodes it made.
pub(super) fn refit_reached<S: Coordinate>(
    refit: &Refit,
    one: &mut Refitted<S>,
    reached: &mut DirtySet,
    [listed, below]: &mut [Vec<WideNodeId>; 2],
) -> u64 {
    listed.clear();
    listed.extend(reached.of(reached.words()).map(WideNodeId));
    reached.clear();
    let levels = refit.update.levels_at_once();
    if levels == 1 {
        return refit_from_vertices(refit, one, listed);
    }
    let mut boxes = 0;
    for &wide_node in &*listed {
        // It may have been refitted with one above it.
        if !one.boxes.is_valid(wide_node) {
            boxes += refit_levels(refit, one, wide_node, levels, below);
        }
    }
    boxes
}
