//! Some levels of boxes at once: the lowest of them from their vertices, those above merged from their children.
//!
//! "The strength of this method is that a parent AABB can always be calculated very efficiently directly from the AABBs of its
//! children" (paper, 3.3). A leaf above the lowest level has no children and is made from its own vertices.

use crate::geometry::{Scalar, Shape};
use crate::tree::{Below, Tree};

/// Makes the nodes of `top` and of `levels - 1` levels of groups below it true. `groups` is scratch.
pub(super) fn make_levels_true<const N: usize, S: Scalar>(
    tree: &mut Tree<N>,
    top: u32,
    levels: u32,
    shape: &Shape<S>,
    groups: &mut Vec<u32>,
) -> u64 {
    // The groups of the subtree level by level; those from `lowest` on are the lowest level made here.
    groups.clear();
    groups.push(top);
    let mut lowest = 0;
    for _ in 1..levels {
        let end = groups.len();
        for parent in lowest..end {
            for child in tree.groups[groups[parent] as usize].used_children() {
                if let Below::Group(below) = child.below() {
                    groups.push(below);
                }
            }
        }
        lowest = end;
        if groups.len() == end {
            break;
        }
    }

    let mut boxes = 0;
    for (place, &group) in groups.iter().enumerate().rev() {
        let group = group as usize;
        let lanes = tree.groups[group].len();
        for lane in 0..lanes {
            let value = match tree.groups[group].children[lane].below() {
                Below::Group(below) if place < lowest => tree.groups[below as usize].boxes.union(),
                Below::Leaf(leaf) if tree.leaves.triangles(leaf).len() == 1 => {
                    shape.box_of(tree.leaves.triangles(leaf).start)
                }
                _ => tree
                    .vertices
                    .box_of(tree.groups[group].first_node as usize + lane, shape),
            };
            tree.groups[group].boxes.set(lane, &value);
        }
        tree.groups[group].epoch = shape.epoch;
        boxes += lanes as u64;
    }
    boxes
}
