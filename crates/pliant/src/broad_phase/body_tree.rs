//! A tree of bodies: eight boxes a node, descended once for every body.
//!
//! The tree is complete: bodies in some order, eight in a row to a leaf, eight leaves to a node, and so on up to one root. So
//! it needs no links, and any order of the bodies makes it right; a good one makes it fast. All boxes are refitted before each
//! pass. The order comes from cuts in half across the longest side of the boxes' centres, and is kept while bodies move, until
//! a pass over all of them tests twice as many nodes as the first pass did.
//!
//! Memory is linear in the bodies, whatever overlaps, and the first pairs are known at once: a body's row is the bodies after it
//! whose boxes overlap its own, in order. Not in the paper, which sweeps and prunes; there a list of all overlapping pairs is kept,
//! and bodies that move fast are sorted past most others on every axis.

use super::overlap::Overlap;
use crate::geometry::{Aabb, Bounds};
use crate::held::{self, held};
use crate::ids::Rank;
use crate::kernels::{BoxLanes, Instructions, dispatch};

/// Boxes a node.
const WIDTH: usize = 8;

#[derive(Debug, Default)]
pub(super) struct BodyTree {
    /// All bodies, as the leaves hold them.
    order: Vec<Rank>,
    /// From the leaves to the root: the nodes of each level.
    levels: Vec<Vec<BoxLanes<WIDTH>>>,
    /// Nodes tested since the boxes were refitted; and in the first whole pass after the bodies were ordered.
    tested: usize,
    tested_at_first: Option<usize>,
    /// Scratch: nodes still to be tested, by level and number; and the centres of all boxes.
    open: Vec<(usize, usize)>,
    centres: Vec<[f32; 3]>,
}

impl BodyTree {
    /// Takes the boxes of now, before the rows of a pass are asked for.
    pub(super) fn refit(&mut self, boxes: &[Aabb]) {
        let count = boxes.len();
        let known = self.order.len();
        self.order.retain(|body| body.index() < count);
        let ranks = (0..count as u32).map(Rank);
        self.order.extend(ranks.skip(known));
        let is_worn = self
            .tested_at_first
            .is_some_and(|first| self.tested > 2 * first);
        if is_worn || known < count / 2 || known > 2 * count {
            self.put_in_order(boxes);
            self.tested_at_first = None;
        }
        self.tested = 0;

        // One level more for every eight times as many bodies.
        let depth = count
            .max(2)
            .next_power_of_two()
            .ilog2()
            .div_ceil(WIDTH.ilog2());
        self.levels.resize_with(depth as usize, Vec::new);
        let (leaves, above) = self.levels.split_at_mut(1);
        let of_body = |body: &Rank| boxes[body.index()];
        side_by_side(&self.order, of_body, &mut leaves[0]);
        let mut below = &leaves[0];
        for level in above {
            side_by_side(below, BoxLanes::union, level);
            below = level;
        }
    }

    /// Appends the pairs of a body and those after it whose boxes overlap its own, in order.
    pub(super) fn row(
        &mut self,
        instructions: Instructions,
        body: Rank,
        its_box: &Aabb,
        pairs: &mut Vec<Overlap>,
    ) {
        let first = pairs.len();
        let (order, levels, open) = (&self.order, &self.levels, &mut self.open);
        open.clear();
        if let Some(root) = levels.len().checked_sub(1) {
            open.push((root, 0));
        }
        dispatch!(instructions, _i => {
            while let Some((level, node)) = open.pop() {
                self.tested += 1;
                // Of a level that has a node there is every one up to the last.
                let Some(boxes) = levels[level].get(node) else { continue };
                let mut overlaps = boxes.overlaps(its_box);
                while overlaps != 0 {
                    let child = WIDTH * node + overlaps.trailing_zeros() as usize;
                    overlaps &= overlaps - 1;
                    if level > 0 {
                        open.push((level - 1, child));
                    } else if order[child] > body {
                        pairs.push([body, order[child]]);
                    }
                }
            }
        });
        pairs[first..].sort_unstable();
    }

    /// The nodes that the last pass tested.
    #[cfg(test)]
    pub(super) fn tested(&self) -> usize {
        self.tested
    }

    /// All bodies had their row.
    pub(super) fn end_of_pass(&mut self) {
        self.tested_at_first.get_or_insert(self.tested);
    }

    /// Orders the bodies such that those of a node are near each other.
    fn put_in_order(&mut self, boxes: &[Aabb]) {
        self.centres.clear();
        let halves = |x: &Aabb| std::array::from_fn(|axis| 0.5 * x.lo[axis] + 0.5 * x.hi[axis]);
        self.centres.extend(boxes.iter().map(halves));
        let mut capacity = WIDTH;
        while capacity < self.order.len() {
            capacity *= WIDTH;
        }
        cut(&mut self.order, capacity, &self.centres);
    }
}

/// Nodes of so many boxes as there is room for.
fn side_by_side<T>(of: &[T], its_box: impl Fn(&T) -> Aabb, nodes: &mut Vec<BoxLanes<WIDTH>>) {
    nodes.clear();
    nodes.extend(of.chunks(WIDTH).map(|children| {
        let mut node = BoxLanes::EMPTY;
        for (lane, child) in children.iter().enumerate() {
            node.set(lane, &its_box(child));
        }
        node
    }));
}

/// Orders the bodies of a node that has room for so many, and those of the nodes below it.
fn cut(bodies: &mut [Rank], capacity: usize, centres: &[[f32; 3]]) {
    if capacity > WIDTH {
        cut_in_halves(bodies, capacity / WIDTH, centres);
        for child in bodies.chunks_mut(capacity / WIDTH) {
            cut(child, capacity / WIDTH, centres);
        }
    }
}

/// Orders bodies such that each child, which has room for so many, gets what is near each other.
fn cut_in_halves(bodies: &mut [Rank], child: usize, centres: &[[f32; 3]]) {
    let children = bodies.len().div_ceil(child);
    if children < 2 {
        return;
    }
    let mut extent = Bounds::EMPTY;
    for body in &*bodies {
        extent.include(centres[body.index()]);
    }
    let side = |axis: &usize| extent.hi[*axis] - extent.lo[*axis];
    let longest = (0..3).max_by(|a, b| side(a).total_cmp(&side(b)));
    let axis = longest.expect("three axes");
    let half = children / 2 * child;
    let along = |body: &Rank| centres[body.index()][axis];
    // Equal centres by their rank: the order does not depend on how one is selected.
    bodies.select_nth_unstable_by(half, |a, b| {
        along(a).total_cmp(&along(b)).then_with(|| a.cmp(b))
    });
    let (low, high) = bodies.split_at_mut(half);
    cut_in_halves(low, child, centres);
    cut_in_halves(high, child, centres);
}

held!(BodyTree: order[], open[], centres[]; |tree| held::list(&tree.levels)
    + tree.levels.iter().map(held::list).sum::<usize>());
