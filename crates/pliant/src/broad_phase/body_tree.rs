//! Bounding volume hierarchy over bodies: eight boxes a node, descended once for every body.
//!
//! The tree is complete, with eight bodies in a row to a leaf and eight leaves to a node, so it
//! needs no links. Any order of the bodies makes it right; a good one, by environment before place,
//! makes it fast. All boxes are refitted before each pass, and the order is kept until a pass tests
//! twice as many nodes as its first. Memory is O(n), whatever overlaps, and the first pairs are
//! known at once. Differs from the paper, which sweeps and prunes: there all overlapping pairs are
//! kept, and fast bodies are sorted past most others on every axis.

use super::overlap::{Boxes, Overlap};
use crate::geometry::{Aabb, Bounds};
use crate::held::{self, held};
use crate::ids::Rank;
use crate::kernels::{BoxLanes, Instructions, dispatch};

/// Boxes of a node.
const WIDTH: usize = 8;

/// Complete tree of the bodies' boxes.
#[derive(Debug, Default)]
pub(super) struct BodyTree {
    /// All bodies, in the order of the leaves.
    order: Vec<Rank>,
    /// Nodes of each level, from the leaves to the root.
    levels: Vec<Vec<BoxLanes<WIDTH>>>,
    /// Environments of each level's nodes. No levels if all bodies are in one.
    environments: Vec<Vec<Environments>>,
    /// Nodes tested in the last whole pass, and in the first after the bodies were ordered.
    tested: usize,
    tested_at_first: Option<usize>,
    /// Scratch: the centres of all boxes.
    centres: Vec<[f32; 3]>,
}

/// Lowest and highest environment of each of a node's children.
#[derive(Clone, Copy, Debug)]
struct Environments {
    lowest: [u32; WIDTH],
    highest: [u32; WIDTH],
}

/// Scratch of the rows of one thread: nodes still to be tested, by level and number, and how many
/// were.
#[derive(Debug, Default)]
pub(super) struct Descent {
    open: Vec<(usize, usize)>,
    pub(super) tested: usize,
}

impl BodyTree {
    /// Refits all boxes, before the rows of a pass are asked for, and orders the bodies anew if the
    /// order is worn. O(n), or O(n log n) with a new order.
    pub(super) fn refit(&mut self, boxes: Boxes) {
        let count = boxes.of_bodies.len();
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

        // One more level for every factor of eight in the number of bodies.
        let depth = count
            .max(2)
            .next_power_of_two()
            .ilog2()
            .div_ceil(WIDTH.ilog2());
        self.levels.resize_with(depth as usize, Vec::new);
        let (leaves, above) = self.levels.split_at_mut(1);
        let of_body = |body: &Rank| boxes.of_bodies[body.index()];
        side_by_side(&self.order, of_body, &mut leaves[0]);
        let mut below = &leaves[0];
        for level in above {
            side_by_side(below, BoxLanes::union, level);
            below = level;
        }
        self.refit_environments(boxes.environments);
    }

    fn refit_environments(&mut self, of_bodies: &[u32]) {
        let depth = if of_bodies.is_empty() {
            0
        } else {
            self.levels.len()
        };
        self.environments.resize_with(depth, Vec::new);
        let Some((leaves, above)) = self.environments.split_first_mut() else {
            return;
        };
        leaves.clear();
        leaves.extend(self.order.chunks(WIDTH).map(|bodies| {
            Environments::of(bodies.iter().map(|body| [of_bodies[body.index()]; 2]))
        }));
        let mut below = &*leaves;
        for level in above {
            level.clear();
            let nodes = below.chunks(WIDTH);
            level.extend(nodes.map(|nodes| Environments::of(nodes.iter().map(Environments::ends))));
            below = level;
        }
    }

    /// Has the bodies ordered anew before the next pass.
    pub(super) fn forget_order(&mut self) {
        self.order.clear();
    }

    /// Appends the row of a body: pairs with later bodies whose boxes overlap its own, in order.
    pub(super) fn row(
        &self,
        instructions: Instructions,
        body: Rank,
        boxes: Boxes,
        Descent { open, tested }: &mut Descent,
        pairs: &mut Vec<Overlap>,
    ) {
        let first = pairs.len();
        let (order, levels, environments) = (&self.order, &self.levels, &self.environments);
        let its_box = &boxes.of_bodies[body.index()];
        let its_environment = boxes.environments.get(body.index());
        open.clear();
        if let Some(root) = levels.len().checked_sub(1) {
            open.push((root, 0));
        }
        dispatch!(instructions, _i => {
            while let Some((level, node)) = open.pop() {
                *tested += 1;
                // A level is complete up to its last node, so a missing node has no boxes.
                let Some(boxes) = levels[level].get(node) else { continue };
                let mut overlaps = boxes.overlaps(its_box);
                if let Some(&environment) = its_environment {
                    overlaps &= environments[level][node].with(environment);
                }
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

    /// Number of nodes that the last pass tested.
    #[cfg(test)]
    pub(super) fn tested(&self) -> usize {
        self.tested
    }

    /// Ends a whole pass, in which all bodies had their row.
    pub(super) fn end_of_pass(&mut self, tested: usize) {
        self.tested = tested;
        self.tested_at_first.get_or_insert(tested);
    }

    /// Orders the bodies so that bodies of one node are near each other. O(n log n).
    fn put_in_order(&mut self, boxes: Boxes) {
        self.centres.clear();
        let halves = |x: &Aabb| std::array::from_fn(|axis| 0.5 * x.lo[axis] + 0.5 * x.hi[axis]);
        self.centres.extend(boxes.of_bodies.iter().map(halves));
        let mut capacity = WIDTH;
        while capacity < self.order.len() {
            capacity *= WIDTH;
        }
        cut(
            &mut self.order,
            capacity,
            (&self.centres, boxes.environments),
        );
    }
}

impl Environments {
    /// Environments of up to eight children, from the lowest and highest of each.
    fn of(children: impl Iterator<Item = [u32; 2]>) -> Self {
        let mut all = Self {
            lowest: [u32::MAX; WIDTH],
            highest: [0; WIDTH],
        };
        for (lane, [lowest, highest]) in children.enumerate() {
            (all.lowest[lane], all.highest[lane]) = (lowest, highest);
        }
        all
    }

    /// Lowest and highest environment of all children.
    fn ends(&self) -> [u32; 2] {
        let lowest = self.lowest.iter().fold(u32::MAX, |a, &b| a.min(b));
        let highest = self.highest.iter().fold(0, |a, &b| a.max(b));
        [lowest, highest]
    }

    /// Mask of the children that may hold a body of an environment.
    #[inline(always)]
    fn with(&self, environment: u32) -> u64 {
        let mut mask = 0;
        for lane in 0..WIDTH {
            let has = (self.lowest[lane] <= environment) & (environment <= self.highest[lane]);
            mask |= u64::from(has) << lane;
        }
        mask
    }
}

/// Packs boxes side by side into nodes.
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

/// Centres of the boxes of all bodies, and their environments, if there are several.
type Centres<'b> = (&'b [[f32; 3]], &'b [u32]);

/// Orders the bodies of a node with room for `capacity` bodies, and recursively of the nodes below
/// it.
fn cut(bodies: &mut [Rank], capacity: usize, by: Centres) {
    if capacity > WIDTH {
        cut_in_halves(bodies, capacity / WIDTH, by);
        for child in bodies.chunks_mut(capacity / WIDTH) {
            cut(child, capacity / WIDTH, by);
        }
    }
}

/// Orders bodies so that each child, with room for `child` bodies, gets bodies near each other.
///
/// Halves are cut across the longest side of the box of all centres, or first between environments.
fn cut_in_halves(bodies: &mut [Rank], child: usize, by: Centres) {
    let children = bodies.len().div_ceil(child);
    if children < 2 {
        return;
    }
    let (centres, environments) = by;
    let half = children / 2 * child;
    let mut extent = Bounds::EMPTY;
    for body in &*bodies {
        extent.include(centres[body.index()]);
    }
    let side = |axis: &usize| extent.hi[*axis] - extent.lo[*axis];
    let longest = (0..3).max_by(|a, b| side(a).total_cmp(&side(b)));
    let axis = longest.expect("three axes");
    let along = |body: &Rank| centres[body.index()][axis];
    let environment = |body: &Rank| environments.get(body.index());
    // Bodies with equal centres go by rank, so that the order does not depend on how the median is
    // selected.
    bodies.select_nth_unstable_by(half, |a, b| {
        let first = environment(a).cmp(&environment(b));
        let then = || along(a).total_cmp(&along(b));
        first.then_with(then).then_with(|| a.cmp(b))
    });
    let (low, high) = bodies.split_at_mut(half);
    cut_in_halves(low, child, by);
    cut_in_halves(high, child, by);
}

held!(Descent: open[]);

held!(BodyTree: order[], centres[]; |tree| {
    let levels = held::list(&tree.levels) + tree.levels.iter().map(held::list).sum::<usize>();
    let environments = &tree.environments;
    levels + held::list(environments) + environments.iter().map(held::list).sum::<usize>()
});
