//! What a traversal has reached and finds not true.
//!
//! By default one level: the nodes of the group that was reached, each from the distinct vertices below it. The paper's
//! variant makes "a specified number of levels in their sub-trees" bottom-up at once.

use super::bottom_up::make_levels_true;
use crate::geometry::{Scalar, Shape};
use crate::kernels::Level;
use crate::statistics::Statistics;
use crate::tree::Tree;
use fearless_simd::dispatch;

/// Makes groups true, and with each of them `levels - 1` levels below. Returns how many boxes of nodes it made.
pub(crate) fn reach_groups<const N: usize, S: Scalar>(
    level: Level,
    tree: &mut Tree<N>,
    reached: &[u32],
    levels: u32,
    shape: &Shape<S>,
    groups: &mut Vec<u32>,
    statistics: &mut Statistics,
) -> u64 {
    dispatch!(level, i => {
        let mut boxes = 0;
        for &group in reached {
            // A group may have been made with one above it, or be in the list twice.
            if tree.groups[group as usize].epoch != shape.epoch {
                boxes += make_levels_true(i, tree, group, levels, shape, groups, statistics);
            }
        }
        boxes
    })
}
