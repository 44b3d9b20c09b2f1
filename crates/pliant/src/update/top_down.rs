//! What a traversal has reached and finds not true.
//!
//! By default one level: the nodes of the groups that were reached, each from the distinct vertices below it. The paper's
//! variant makes "a specified number of levels in their sub-trees" bottom-up at once.

use super::bottom_up::make_levels_true;
use super::make::{Work, make_groups_true};
use crate::geometry::Scalar;
use crate::statistics::Statistics;
use crate::tree::Tree;

/// Makes groups true that are not, and with each of them `levels - 1` levels below. Returns how many boxes of nodes it made.
pub(super) fn reach_groups<const N: usize, S: Scalar>(
    work: Work<'_, '_, S>,
    tree: &mut Tree<N>,
    reached: &mut Vec<u32>,
    levels: u32,
    groups: &mut Vec<u32>,
    statistics: &mut Statistics,
) -> u64 {
    // In the order of memory, and each once.
    reached.sort_unstable();
    reached.dedup();
    if levels == 1 {
        return make_groups_true(work, tree, reached, statistics);
    }
    let mut boxes = 0;
    for &group in &*reached {
        // A group may have been made with one above it.
        if tree.groups[group as usize].epoch != work.shape.epoch {
            boxes += make_levels_true(work, tree, group, levels, groups, statistics);
        }
    }
    boxes
}
