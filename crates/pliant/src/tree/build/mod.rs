//! Build of the bounding volume hierarchy: partition of a body's triangles into nodes, without
//! boxes.
//!
//! One loop, breadth first, without a stack, however deep the tree: see [`Planner`]. One hook: a
//! [`Split`] reorders the triangles of a node and says where to cut. If it cannot tell the
//! triangles apart (all midpoints in one place), the loop cuts the order it finds. So every build
//! ends. The degree is a number here, not a type.

mod balanced;
mod connectivity;
mod initial_shape;
mod thin;

use crate::held::{self, Held, held};
use crate::threads::Budget;
pub(crate) use balanced::Balanced;
pub(crate) use connectivity::Connectivity;
pub(crate) use initial_shape::{CutAt, InitialShape, midpoint};
use std::ops::Range;
pub(crate) use thin::has_many_thin;

/// Division of triangles: the order of triangles in a tree to be, and its nodes.
#[derive(Debug)]
pub(crate) struct Plan {
    /// Caller's numbers of the triangles, so that every node is a run.
    pub(crate) order: Vec<u32>,
    /// All nodes, level by level; the first is the root. Children of one node are consecutive, in
    /// the order of their triangles.
    pub(crate) nodes: Vec<PlanNode>,
    /// Most triangles in a leaf.
    pub(crate) leaf_size: u32,
    /// Most children of a node.
    pub(crate) degree: usize,
    /// Whether many of the triangles are long and thin.
    pub(crate) has_thin: bool,
}

impl Plan {
    /// Renumbers the triangles: `numbers[t]` in place of t.
    pub(crate) fn with_numbers(mut self, numbers: &[u32]) -> Self {
        for triangle in &mut self.order {
            *triangle = numbers[*triangle as usize];
        }
        self
    }

    /// Moves the plan behind `triangles` other triangles.
    pub(crate) fn behind(mut self, triangles: u32) -> Self {
        for node in &mut self.nodes {
            node.triangles.start += triangles;
            node.triangles.end += triangles;
        }
        self
    }
}

/// Node of a tree to be: a run of triangles and its children.
#[derive(Clone, Debug)]
pub(crate) struct PlanNode {
    /// Run of its triangles in the order.
    pub(crate) triangles: Range<u32>,
    /// Its children among the nodes; empty for a leaf.
    pub(crate) children: Range<u32>,
    pub(crate) level: u32,
}

/// Lengths of the pieces of a node, in order.
pub(crate) type Pieces = Vec<usize>;

/// Rule for dividing triangles: the hook of [`Planner`].
pub(crate) trait Split {
    /// Divides the triangles of a node into pieces, or goes on with that. Returns whether it is
    /// done.
    ///
    /// `triangles` are the caller's numbers, more than `leaf_size` of them. They are reordered, and
    /// the lengths of the pieces are appended in order: at most the degree, none empty. One piece
    /// means that the rule cannot tell the triangles apart. If it is not done, the budget is spent.
    /// It is then called again with the same triangles and pieces.
    fn split(&mut self, triangles: &mut [u32], pieces: &mut Pieces, budget: &mut Budget) -> bool;

    /// Returns the bytes of the heap that it holds.
    fn held(&self) -> usize {
        0
    }
}

/// Divides `count` triangles until each node has at most `leaf_size`.
pub(crate) fn plan(count: usize, degree: usize, leaf_size: u32, rule: impl Split) -> Plan {
    let mut planner = Planner::new(count, degree, leaf_size, rule);
    planner.advance(&mut Budget::whole());
    planner.finish()
}

/// Division of triangles under construction, made some at a time.
///
/// ```text
/// nodes = [all triangles]
/// for each node, first to last:                       breadth first
///     at most `leaf_size` triangles:  it is a leaf
///     else split it into 2 to `degree` nodes and append them
/// ```
pub(crate) struct Planner<R> {
    rule: R,
    plan: Plan,
    /// First node that was not divided.
    next: usize,
    /// Whether its split was begun.
    is_begun: bool,
    /// Pieces that its split has found so far.
    pieces: Pieces,
}

impl<R: Split> Planner<R> {
    /// Begins with all of `count` triangles in one node.
    pub(crate) fn new(count: usize, degree: usize, leaf_size: u32, rule: R) -> Self {
        Self {
            rule,
            plan: Plan {
                order: (0..count as u32).collect(),
                nodes: vec![PlanNode {
                    triangles: 0..count as u32,
                    children: 0..0,
                    level: 0,
                }],
                leaf_size,
                degree,
                has_thin: false,
            },
            next: 0,
            is_begun: false,
            pieces: Vec::with_capacity(degree),
        }
    }

    /// Continues; returns whether all nodes are divided.
    pub(crate) fn advance(&mut self, budget: &mut Budget) -> bool {
        let plan = &mut self.plan;
        while self.next < plan.nodes.len() {
            if budget.is_spent() {
                return false;
            }
            let PlanNode {
                triangles, level, ..
            } = plan.nodes[self.next].clone();
            if triangles.len() > plan.leaf_size as usize {
                let run = &mut plan.order[triangles.start as usize..triangles.end as usize];
                if !self.is_begun {
                    self.pieces.clear();
                }
                self.is_begun = !self.rule.split(run, &mut self.pieces, budget);
                if self.is_begun {
                    return false;
                }
                if self.pieces.len() == 1 {
                    cut_the_order(run.len(), plan.degree, &mut self.pieces);
                }
                let first = plan.nodes.len() as u32;
                plan.nodes[self.next].children = first..first + self.pieces.len() as u32;
                let mut start = triangles.start;
                for &length in &self.pieces {
                    let end = start + length as u32;
                    plan.nodes.push(PlanNode {
                        triangles: start..end,
                        children: 0..0,
                        level: level + 1,
                    });
                    start = end;
                }
            }
            self.next += 1;
        }
        true
    }

    /// Returns the division, when no node is left.
    pub(crate) fn finish(mut self) -> Plan {
        self.plan.nodes.shrink_to_fit();
        self.plan
    }
}

impl Split for Box<dyn Split + Send + Sync> {
    fn split(&mut self, triangles: &mut [u32], pieces: &mut Pieces, budget: &mut Budget) -> bool {
        (**self).split(triangles, pieces, budget)
    }

    fn held(&self) -> usize {
        (**self).held()
    }
}

held!(Plan: order[], nodes[]);

impl<R: Split> Held for Planner<R> {
    fn held(&self) -> usize {
        self.rule.held() + self.plan.held() + held::list(&self.pieces)
    }
}

/// Cuts an order that no rule can improve into equal pieces.
fn cut_the_order(count: usize, degree: usize, pieces: &mut Pieces) {
    pieces.clear();
    let most = degree.min(count);
    pieces.extend((0..most).map(|piece| (piece + 1) * count / most - piece * count / most));
}

/// Sorts the axes of a box, the longest side first; of equal sides the lower axis first.
fn axes_by_length(lo: [f64; 3], hi: [f64; 3]) -> [usize; 3] {
    let mut axes = [0, 1, 2];
    axes.sort_by(|&a, &b| (hi[b] - lo[b]).total_cmp(&(hi[a] - lo[a])));
    axes
}
