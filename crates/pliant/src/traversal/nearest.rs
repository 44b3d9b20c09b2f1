//! Branch and bound over two trees: triangles by increasing gap of their boxes, down to the least
//! distance.
//!
//! A stack holds pairs of nodes with the squared gap of their boxes, the nearest on top. Pairs with
//! a gap above the limit are pruned; the limit shrinks as triangles are measured. Boxes are
//! refitted only when reached: near the closest points of two bodies, and few others. Larsen,
//! Gottschalk, Lin and Manocha (2000, *Fast Distance Queries with Rectangular Swept Sphere
//! Volumes*) descend the same way. Differences: both nodes are opened at once, all their children
//! are compared with SIMD, and boxes are stale until reached.

use super::tree_pair::{TreePair, View};
use crate::geometry::{Aabb, Shape};
use crate::held::{self, held};
use crate::ids::{BlockId, LeafId, NodeId, WideNodeId};
use crate::kernels::{Coordinate, dispatch, near_mask};
use crate::queries::Candidate;
use crate::statistics::Statistics;
use crate::tree::NodePair;
use crate::tree::{Child, Leaves, NodeLanes};
use crate::update::{DirtySet, Refit};
use std::ops::ControlFlow;

/// Buffers of the search, kept from query to query.
#[derive(Debug, Default)]
pub(crate) struct NearestScratch {
    stack: Vec<(f64, NodePair)>,
    triangles: Vec<(f64, Candidate)>,
    reached: DirtySet,
    lists: [Vec<WideNodeId>; 2],
}

/// Measures a candidate of two shapes. Returns the squared distance up to which the search goes on.
pub(crate) type Measure<'m, S> = &'m mut dyn FnMut([&Shape<'_, S>; 2], Candidate) -> f64;

/// Squared gap of two boxes: a lower bound of the squared distance of anything inside.
///
/// Sides of boxes are `f32`, the arithmetic is `f64`. These steps round by 2^-53 each: a
/// difference, the amount taken off it, its square, two sums, and the final reduction. That is at
/// most eight roundings of a square; sixteen are taken off. A thread that flushes subnormal numbers
/// reads sides that are off by less than 2^-126. So 2^-120 is taken off each difference.
pub(crate) fn gap_square(a: &Aabb, b: &Aabb) -> f64 {
    let mut square = 0.0;
    for axis in 0..3 {
        let below = f64::from(b.lo[axis]) - f64::from(a.hi[axis]);
        let above = f64::from(a.lo[axis]) - f64::from(b.hi[axis]);
        let gap = (below.max(above) - f64::powi(0.5, 120)).max(0.0);
        square += gap * gap;
    }
    square * (1.0 - 8.0 * f64::EPSILON)
}

/// Shows `measure` all triangles of two bodies whose boxes have at most the gap of the limit at
/// that time. Triangles with near boxes mostly come before others. Breaks if interrupted.
pub(crate) fn nearest<S: Coordinate>(
    refit: Refit,
    pair: &mut TreePair<S>,
    scratch: &mut NearestScratch,
    statistics: &mut Statistics,
    mut limit: f64,
    measure: Measure<S>,
) -> ControlFlow<()> {
    scratch.stack.clear();
    scratch.stack.push((0.0, [NodeId::ROOT; 2]));
    while let Some((gap, nodes)) = scratch.stack.pop() {
        if gap > limit {
            continue;
        }
        if refit.executor.is_interrupted() {
            return ControlFlow::Break(());
        }
        statistics.node_pairs += 1;
        let [a, b] = pair.views().sides();
        let children = [a.read.tree.child(nodes[0]), b.read.tree.child(nodes[1])];
        if let [Child::Leaf(a), Child::Leaf(b)] = children {
            limit = among_leaves(refit, pair, [a, b], scratch, statistics, limit, measure);
            continue;
        }
        for (which, child) in children.into_iter().enumerate() {
            let Child::Inner(below) = child else {
                continue;
            };
            if !pair.views().sides()[which].boxes.is_valid(below) {
                scratch.reached.insert(below.0);
                let (reached, lists) = (&mut scratch.reached, &mut scratch.lists);
                refit.reached(&mut pair.refitted(which), reached, lists, statistics);
            }
        }
        push_children(
            refit,
            pair.views().sides(),
            nodes,
            children,
            &mut scratch.stack,
            limit,
        );
    }
    ControlFlow::Continue(())
}

/// Pushes the pairs of children with a gap within the limit, the nearest last.
fn push_children<S: Coordinate>(
    refit: Refit,
    [a, b]: [View<'_, S>; 2],
    [node_a, node_b]: NodePair,
    children: [Child; 2],
    stack: &mut Vec<(f64, NodePair)>,
    limit: f64,
) {
    let before = stack.len();
    let (boxes_a, boxes_b) = (a.boxes.nodes(), b.boxes.nodes());
    let mut push = |pair: NodePair| {
        let gap = gap_square(&boxes_a.one(pair[0]), &boxes_b.one(pair[1]));
        if gap <= limit {
            stack.push((gap, pair));
        }
    };
    match children {
        [Child::Inner(below_a), Child::Inner(below_b)] => {
            let lens = [
                a.read.tree.wide_node(below_a).len(),
                b.read.tree.wide_node(below_b).len(),
            ];
            let below = [below_a, below_b];
            let mut mask =
                NodeLanes::near_mask([boxes_a, boxes_b], below, lens, limit, refit.instructions);
            while mask != 0 {
                let bit = mask.trailing_zeros() as usize;
                push([NodeId::new(below_a, bit / 8), NodeId::new(below_b, bit % 8)]);
                mask &= mask - 1;
            }
        }
        [Child::Inner(below), Child::Leaf(_)] => {
            for lane in 0..a.read.tree.wide_node(below).len() {
                push([NodeId::new(below, lane), node_b]);
            }
        }
        [Child::Leaf(_), Child::Inner(below)] => {
            for lane in 0..b.read.tree.wide_node(below).len() {
                push([node_a, NodeId::new(below, lane)]);
            }
        }
        [Child::Leaf(_), Child::Leaf(_)] => {}
    }
    stack[before..].sort_unstable_by(|(a, _), (b, _)| b.total_cmp(a));
}

/// Measures the triangles of two leaves by increasing gap of their boxes. Returns the new limit.
fn among_leaves<S: Coordinate>(
    refit: Refit,
    pair: &mut TreePair<S>,
    leaves: [LeafId; 2],
    scratch: &mut NearestScratch,
    statistics: &mut Statistics,
    mut limit: f64,
    measure: Measure<S>,
) -> f64 {
    let all = pair.views().sides().map(|side| &side.read.tree.leaves);
    scratch.triangles.clear();
    if all.iter().all(|leaves| leaves.have_blocks()) {
        for which in 0..2 {
            if !pair.views().sides()[which]
                .boxes
                .is_leaf_valid(leaves[which])
            {
                scratch.reached.insert(leaves[which].0);
                let mut one = pair.refitted(which);
                refit.reached_leaves(&mut one, &mut scratch.reached, statistics);
            }
        }
        near_triangles(
            refit,
            pair.views().sides(),
            leaves,
            &mut scratch.triangles,
            limit,
        );
    } else {
        let triangle = |which: usize| all[which].first_triangle(leaves[which]);
        let [a, b] = [triangle(0), triangle(1)];
        scratch.triangles.push((0.0, [a, b]));
    }
    let shapes = pair.views().sides().map(|side| side.read.source.shape());
    for &(gap, triangles) in &scratch.triangles {
        if gap > limit {
            break;
        }
        statistics.candidate_pairs += 1;
        limit = measure(shapes, triangles);
    }
    limit
}

/// Lists the triangles of two leaves whose boxes have a gap within the limit, the nearest first.
fn near_triangles<S: Coordinate>(
    refit: Refit,
    sides: [View<'_, S>; 2],
    leaves: [LeafId; 2],
    triangles: &mut Vec<(f64, Candidate)>,
    limit: f64,
) {
    let of: [&Leaves; 2] = [&sides[0].read.tree.leaves, &sides[1].read.tree.leaves];
    let boxes = [sides[0].boxes.blocks(), sides[1].boxes.blocks()];
    for block_a in of[0].blocks(leaves[0]).map(BlockId) {
        for block_b in of[1].blocks(leaves[1]).map(BlockId) {
            let runs = [of[0].run_of_block(block_a), of[1].run_of_block(block_b)];
            let (a, b) = (boxes[0].of(block_a), boxes[1].of(block_b));
            let lens = runs.map(|run| run.count as usize);
            let mut mask = dispatch!(refit.instructions, i => near_mask(i, a, b, lens, limit));
            while mask != 0 {
                let bit = mask.trailing_zeros();
                let gap = gap_square(&a.get(bit as usize / 8), &b.get(bit as usize % 8));
                let pair = [runs[0].first.plus(bit / 8), runs[1].first.plus(bit % 8)];
                triangles.push((gap, pair));
                mask &= mask - 1;
            }
        }
    }
    triangles.sort_unstable_by(|(a, _), (b, _)| a.total_cmp(b));
}

held!(NearestScratch: stack[], triangles[], reached;
    |scratch| scratch.lists.iter().map(held::list).sum::<usize>());

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernels::{BoxLanes, Instructions};
    use pliant_oracle::{Random, compare_length};
    use std::cmp::Ordering;

    /// Boxes of some scale: some overlap, some are side by side, some are far away.
    fn boxes(random: &mut Random, scale: f32) -> Vec<Aabb> {
        let mut side = || {
            let x = (random.below(64) as f32 - 32.0) * 0.37 * scale;
            let y = random.below(9) as f32 * 0.41 * scale;
            [x, x + y]
        };
        let boxes = (0..8).map(|_| {
            let [x, y, z] = [side(), side(), side()];
            Aabb {
                lo: [x[0], y[0], z[0]],
                hi: [x[1], y[1], z[1]],
            }
        });
        boxes.collect()
    }

    /// Nearest points of two boxes.
    fn nearest_points(a: &Aabb, b: &Aabb) -> [[f64; 3]; 2] {
        let mut points = [[0.0; 3]; 2];
        for axis in 0..3 {
            let ends = if b.lo[axis] > a.hi[axis] {
                [a.hi[axis], b.lo[axis]]
            } else if a.lo[axis] > b.hi[axis] {
                [a.lo[axis], b.hi[axis]]
            } else {
                continue;
            };
            for which in 0..2 {
                points[which][axis] = ends[which].into();
            }
        }
        points
    }

    #[test]
    fn gaps_are_never_larger_than_they_are() {
        let mut random = Random::new(45);
        let [mut near, mut far] = [0; 2];
        for round in 0..400 {
            let scale = [1.0, 1e-30, 1e-44, 1e17, 1e36][round % 5];
            let both = [boxes(&mut random, scale), boxes(&mut random, scale)];
            let lanes = both.each_ref().map(|all| {
                let mut lanes = BoxLanes::<8>::EMPTY;
                all.iter()
                    .enumerate()
                    .for_each(|(lane, it)| lanes.set(lane, it));
                lanes
            });
            let [a, b] = [
                both[0][random.below(8) as usize],
                both[1][random.below(8) as usize],
            ];
            let limit = gap_square(&a, &b) * [1.0, 1.01, 0.99][round % 3];
            for instructions in Instructions::all() {
                let mask =
                    dispatch!(instructions, i => near_mask(i, &lanes[0], &lanes[1], [8, 7], limit));
                for bit in 0..64 {
                    let [a, b] = [&both[0][bit / 8], &both[1][bit % 8]];
                    let [p, q] = nearest_points(a, b);
                    let gap = gap_square(a, b).sqrt();
                    let compare = |x: f64| compare_length(&[(1.0, p), (-1.0, q)], x);
                    let surely = gap * (1.0 - f64::EPSILON);
                    assert_ne!(compare(surely), Ordering::Less, "{a:?} {b:?}");
                    // The lower bound is tight: no more is taken off than documented.
                    let most = (gap + f64::powi(0.5, 118)) * (1.0 + f64::powi(0.5, 48));
                    assert_ne!(compare(most), Ordering::Greater, "{a:?} {b:?}");
                    let is_set = mask >> bit & 1 == 1;
                    if bit % 8 == 7 {
                        assert!(!is_set);
                    } else if compare(limit.sqrt() * (1.0 - f64::EPSILON)) != Ordering::Greater {
                        assert!(is_set, "{a:?} {b:?} {limit}");
                        near += 1;
                    } else if compare(
                        (limit.sqrt() + f64::powi(0.5, 49)) * (1.0 + f64::powi(0.5, 18)),
                    ) == Ordering::Greater
                    {
                        assert!(
                            !is_set || limit > f64::from(f32::MAX),
                            "{a:?} {b:?} {limit}"
                        );
                        far += 1;
                    }
                }
            }
        }
        assert!(near > 5_000 && far > 5_000, "{near} {far}");
    }
}
