//! Some levels of boxes at once: the lowest of them from their vertices, those above merged from their children.
//!
//! "The strength of this method is that a parent AABB can always be calculated very efficiently directly from the AABBs of its
//! children" (paper, 3.3). A leaf has no children; it is made from its triangles, whose boxes are kept, and those above the
//! lowest level likewise.

use crate::geometry::{Scalar, Shape};
use crate::kernels::extent::{self, Extent};
use crate::statistics::Statistics;
use crate::tree::{Below, LEAF_LANES, Tree};
use fearless_simd::Simd;

/// Makes the nodes of `top` and of `levels - 1` levels of groups below it true, and the triangles in the leaves among them.
/// `groups` is scratch. Returns how many boxes of nodes it made.
#[inline(always)]
pub(super) fn make_levels_true<I: Simd, const N: usize, S: Scalar>(
    i: I,
    tree: &mut Tree<N>,
    top: u32,
    levels: u32,
    shape: &Shape<S>,
    groups: &mut Vec<u32>,
    statistics: &mut Statistics,
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
        let count = make_group_true(i, tree, group as usize, place < lowest, shape, statistics);
        boxes += count as u64;
    }
    boxes
}

/// Makes one group true: from the groups below it if these are true, else from the vertices below it.
#[inline(always)]
fn make_group_true<I: Simd, const N: usize, S: Scalar>(
    i: I,
    tree: &mut Tree<N>,
    group: usize,
    below_is_true: bool,
    shape: &Shape<S>,
    statistics: &mut Statistics,
) -> usize {
    let count = tree.groups[group].len();
    let first_node = tree.groups[group].first_node as usize;
    let mut boxes: [Extent<I>; 8] = [extent::nothing(i); 8];
    for lane in 0..count {
        boxes[lane] = match tree.groups[group].children[lane].below() {
            Below::Leaf(leaf) => make_leaf_true(i, tree, leaf, shape, statistics),
            Below::Group(below) if below_is_true => {
                extent::of_box(i, &tree.groups[below as usize].boxes.union())
            }
            Below::Group(_) => {
                let (run, border) = tree.vertices.run_and_border(first_node + lane);
                extent::of_points(i, shape, run, border)
            }
        };
    }
    let group = &mut tree.groups[group];
    extent::store(boxes, count, &mut group.boxes);
    group.epoch = shape.epoch;
    count
}

/// Makes the boxes of a leaf's triangles, where they are kept, and returns the leaf's.
#[inline(always)]
fn make_leaf_true<I: Simd, const N: usize, S: Scalar>(
    i: I,
    tree: &mut Tree<N>,
    leaf: u32,
    shape: &Shape<S>,
    statistics: &mut Statistics,
) -> Extent<I> {
    let triangles = tree.leaves.triangles(leaf);
    if !tree.leaves.have_boxes() {
        return extent::of_triangle(i, shape, triangles.start);
    }
    statistics.triangle_boxes += triangles.len() as u64;
    let triangles = &shape.triangles[triangles.start as usize..triangles.end as usize];
    let mut all = None;
    for (block, triangles) in tree
        .leaves
        .boxes_mut(leaf)
        .iter_mut()
        .zip(triangles.chunks(LEAF_LANES))
    {
        let of_all = extent::of_block(i, shape, triangles, block);
        all = Some(all.map_or(of_all, |all| extent::union(all, of_all)));
    }
    all.expect("a leaf has triangles")
}
