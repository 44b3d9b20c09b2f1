//! What a traversal has reached and finds not true.
//!
//! By default one level: the nodes of the groups that were reached, each from the distinct vertices below it. The paper's
//! variant makes "a specified number of levels in their sub-trees" bottom-up at once.

use super::bottom_up::make_levels_true;
use super::make::{Work, make_groups_true};
use super::noted::Noted;
use crate::geometry::Scalar;
use crate::tree::Tree;

/// Makes groups true that were reached and are not, and with each of them `levels - 1` levels below; forgets what was reached. The
/// lists are scratch. Returns how many boxes of nodes it made.
pub(super) fn reach_groups<const N: usize, S: Scalar>(
    work: Work<'_, '_, S>,
    tree: &mut Tree<N>,
    reached: &mut Noted,
    levels: u32,
    [listed, groups]: &mut [Vec<u32>; 2],
) -> u64 {
    listed.clear();
    listed.extend(reached.of(reached.words()));
    reached.clear();
    if levels == 1 {
        return make_groups_true(work, tree, listed);
    }
    let mut boxes = 0;
    for &group in &*listed {
        // A group may have been made with one above it.
        if tree.groups[group as usize].epoch != work.shape.epoch {
            boxes += make_levels_true(work, tree, group, levels, groups);
        }
    }
    boxes
}
