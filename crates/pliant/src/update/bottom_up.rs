//! Some levels of boxes at once: the lowest of them from their vertices, those above merged from their children.
//!
//! "The strength of this method is that a parent AABB can always be calculated very efficiently directly from the AABBs of its
//! children" (paper, 3.3). A leaf has no children; it is made from its triangles, whose boxes are kept, and those above the
//! lowest level likewise.

use super::make::{Work, make_groups_true, merge_groups};
use crate::geometry::Scalar;
use crate::tree::{Below, Tree};

/// Makes the nodes of `top` and of `levels - 1` levels of groups below it true, and the triangles in the leaves among them.
/// `groups` is scratch. Returns how many boxes of nodes it made.
pub(super) fn make_levels_true<const N: usize, S: Scalar>(
    work: Work<'_, '_, S>,
    tree: &mut Tree<N>,
    top: u32,
    levels: u32,
    groups: &mut Vec<u32>,
) -> u64 {
    // The groups of the subtree level by level, in ascending order; those from `lowest` on are the lowest level made here.
    groups.clear();
    let mut lowest = 0;
    if top == 0 {
        // From the root on, levels are whole.
        let level = tree.level(levels.min(tree.depth + 1) - 1);
        groups.extend(0..level.end);
        lowest = level.start as usize;
    } else {
        groups.push(top);
        for _ in 1..levels {
            let end = groups.len();
            for parent in lowest..end {
                for child in tree.groups[groups[parent] as usize].used_children() {
                    if let Below::Group(below) = child.below() {
                        groups.push(below);
                    }
                }
            }
            if groups.len() == end {
                break;
            }
            lowest = end;
        }
    }
    let (above, lowest) = groups.split_at(lowest);
    make_groups_true(work, tree, lowest) + merge_groups(work, tree, above)
}
