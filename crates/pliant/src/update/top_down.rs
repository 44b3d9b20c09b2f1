//! What a traversal has reached and finds not true.
//!
//! By default one level: the nodes of the group that was reached, each from the distinct vertices below it. The paper's
//! variant makes "a specified number of levels in their sub-trees" bottom-up at once.

use super::bottom_up::make_levels_true;
use crate::geometry::{Scalar, Shape};
use crate::tree::{LEAF_LANES, Tree};

/// Makes a group true, and with it `levels - 1` levels below, unless it is true already.
#[inline]
pub(crate) fn reach_group<const N: usize, S: Scalar>(
    tree: &mut Tree<N>,
    group: u32,
    levels: u32,
    shape: &Shape<S>,
    groups: &mut Vec<u32>,
) -> u64 {
    if tree.groups[group as usize].epoch == shape.epoch {
        return 0;
    }
    make_levels_true(tree, group, levels, shape, groups)
}

/// Makes the boxes of a leaf's triangles true, unless they are, or unless the leaf's own box is all there is.
#[inline]
pub(crate) fn reach_leaf<const N: usize, S: Scalar>(
    tree: &mut Tree<N>,
    leaf: u32,
    shape: &Shape<S>,
) -> u64 {
    if !tree.leaves.have_boxes() || tree.leaves.epoch(leaf) == shape.epoch {
        return 0;
    }
    let triangles = tree.leaves.triangles(leaf);
    let count = triangles.len() as u64;
    let blocks = tree.leaves.make_true(leaf, shape.epoch);
    for (place, triangle) in triangles.enumerate() {
        blocks[place / LEAF_LANES].set(place % LEAF_LANES, &shape.box_of(triangle));
    }
    count
}
