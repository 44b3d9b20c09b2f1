//! Invariants of a tree and of its boxes, checked.
//!
//! `World::validate` calls this; the tests call that after every step.

mod connectedness;

use super::{BLOCK_LANES, BoxSet, BoxSource, Child, Tree, capsule_of_node};
use crate::ids::{BlockId, LeafId, NodeId, TreeTriangle, TreeVertex};
use crate::mesh::Order;
use crate::options::Partition;
use connectedness::Connectedness;
use std::collections::BTreeSet;
use std::ops::Range;

/// Returns an error that says what is wrong, unless the condition holds.
macro_rules! ensure {
    ($holds:expr, $($wrong:tt)+) => {
        if !$holds {
            return Err(format!($($wrong)+));
        }
    };
}

impl Tree {
    /// Checks the structure over these triangles, and what the partition promises.
    ///
    /// `Err` says what is wrong. Allocates, and takes its time.
    pub(crate) fn validate(
        &self,
        order: &Order,
        triangles: Range<usize>,
        partition: Partition,
    ) -> Result<(), String> {
        let corners = order.all_corners();
        let first = triangles.start;
        let below = self.triangles_below(NodeId::ROOT)?;
        ensure!(below == triangles, "the root does not hold all triangles");
        let connected = (partition == Partition::Connectivity).then(|| {
            let own = corners[triangles].iter();
            let corners: Vec<_> = own.map(|c| c.map(|vertex| vertex.0)).collect();
            Connectedness::new(corners)
        });
        let (mut visited, mut deepest) = (0, 0);
        let mut open = vec![(NodeId::ROOT, 0)];
        while let Some((node, level)) = open.pop() {
            visited += 1;
            deepest = deepest.max(level);
            let (wide_node, lane) = node.wide_node_and_lane();
            let is_in_level = self.level(level).contains(&wide_node.index());
            ensure!(
                is_in_level,
                "{wide_node:?}: not in the run of its level, {level}"
            );
            let triangles = self.triangles_below(node)?;
            let below = &corners[triangles.clone()];
            let number = self.number_of(node);
            let fan = self.fans().and_then(|fans| fans.of_node(number));
            ensure!(
                fan.is_none_or(|vertex| below.iter().all(|it| it.contains(&TreeVertex(vertex)))),
                "{wide_node:?}, lane {lane}: not all triangles below it have the vertex of its fan"
            );
            let below: BTreeSet<TreeVertex> = below.as_flattened().iter().copied().collect();
            let listed: BTreeSet<TreeVertex> = self.vertices.vertices(number).collect();
            ensure!(
                listed == below,
                "{wide_node:?}, lane {lane}: its vertex list is not the set of vertices below it"
            );
            let own = triangles.start - first..triangles.end - first;
            ensure!(
                connected.as_ref().is_none_or(|all| all.holds_for(own)),
                "{wide_node:?}, lane {lane}: neither one connected piece nor whole components"
            );
            match self.child(node) {
                Child::Leaf(leaf) => self.validate_blocks(leaf)?,
                Child::Inner(below) => {
                    self.validate_division(node, triangles)?;
                    open.extend(self.nodes_in(below).map(|node| (node, level + 1)));
                }
            }
        }
        let (count, depth) = (self.node_count(), self.depth);
        ensure!(
            visited == count && deepest == depth,
            "{visited} nodes down to level {deepest}; {count} and {depth} said"
        );
        Ok(())
    }

    /// Checks that valid boxes are what the source gives, and that no valid box is below a stale
    /// one.
    pub(crate) fn validate_boxes(
        &self,
        boxes: &BoxSet,
        source: &impl BoxSource,
    ) -> Result<(), String> {
        let version = source.version();
        // A node, and whether the wide node above it is valid; nothing is above the root.
        let mut open = vec![(NodeId::ROOT, true)];
        while let Some((node, above)) = open.pop() {
            let (wide_node, lane) = node.wide_node_and_lane();
            let is_valid = boxes.holds(wide_node, version);
            ensure!(above || !is_valid, "{wide_node:?}: valid below a stale one");
            if is_valid {
                let number = self.number_of(node);
                let vertices: Vec<_> = self.vertices.vertices(number).collect();
                let found = boxes.nodes().one(node);
                let expected = source.plainly(vertices.into_iter());
                ensure!(
                    found == expected,
                    "{wide_node:?}, lane {lane}: claims to be valid and is {found:?}, \
                     not {expected:?}"
                );
                if let Some(capsules) = boxes.node_capsules() {
                    let found = capsules[wide_node.index()].get(lane);
                    let expected = capsule_of_node(self, number, source);
                    ensure!(
                        found == expected,
                        "{wide_node:?}, lane {lane}: its capsule is {found:?}, not {expected:?}"
                    );
                }
            }
            match self.child(node) {
                Child::Leaf(leaf) => self.validate_leaf_boxes(leaf, is_valid, boxes, source)?,
                Child::Inner(below) => {
                    open.extend(self.nodes_in(below).map(|node| (node, is_valid)));
                }
            }
        }
        Ok(())
    }

    /// Checks that the children of a node divide its triangles.
    fn validate_division(&self, node: NodeId, triangles: Range<usize>) -> Result<(), String> {
        let Child::Inner(below) = self.child(node) else {
            return Ok(());
        };
        let mut next = triangles.start;
        let mut lanes = 0;
        for child in self.nodes_in(below) {
            let run = self.triangles_below(child)?;
            ensure!(
                run.start == next && !run.is_empty(),
                "{below:?}: its nodes do not divide the triangles above"
            );
            next = run.end;
            lanes += 1;
        }
        ensure!(lanes >= 2, "{below:?}: {lanes} nodes");
        let is_end = next == triangles.end;
        ensure!(
            is_end,
            "{below:?}: its nodes do not hold all triangles above"
        );
        Ok(())
    }

    /// Checks that the blocks of a leaf hold its triangles.
    fn validate_blocks(&self, leaf: LeafId) -> Result<(), String> {
        for (triangle, block) in self.block_of_each_triangle(leaf) {
            let (block, lane) = block;
            let held = self.leaves.first_of_block(block).plus(lane);
            ensure!(
                held == triangle,
                "{leaf:?}: its blocks hold other triangles"
            );
        }
        Ok(())
    }

    /// Checks that valid boxes of a leaf's triangles are what the source gives.
    fn validate_leaf_boxes(
        &self,
        leaf: LeafId,
        above: bool,
        boxes: &BoxSet,
        source: &impl BoxSource,
    ) -> Result<(), String> {
        let is_valid = self.leaves.have_blocks()
            && boxes.is_leaf_valid(leaf)
            && boxes.expects(source.version());
        if !is_valid {
            return Ok(());
        }
        ensure!(
            above,
            "{leaf:?}: the boxes of its triangles are valid and its own is not"
        );
        for (triangle, (block, lane)) in self.block_of_each_triangle(leaf) {
            let found = boxes.blocks().of(block).get(lane as usize);
            let corners = source.shape().triangles[triangle.index()];
            let expected = source.plainly(corners.into_iter());
            ensure!(
                found == expected,
                "{leaf:?}: {triangle:?} has box {found:?}, not {expected:?}"
            );
            if let Some(capsules) = boxes.block_capsules() {
                let found = capsules[block.index()].get(lane as usize);
                let expected = source.capsule(3, &|which| corners[which]);
                ensure!(
                    found == expected,
                    "{leaf:?}: {triangle:?} has capsule {found:?}, not {expected:?}"
                );
            }
        }
        Ok(())
    }

    /// Iterates over a leaf's triangles, each with its block and lane; empty where there are no
    /// blocks.
    fn block_of_each_triangle(
        &self,
        leaf: LeafId,
    ) -> impl Iterator<Item = (TreeTriangle, (BlockId, u32))> {
        let first = self.leaves.blocks(leaf).start;
        let triangles = self
            .leaves
            .have_blocks()
            .then(|| self.leaves.triangles(leaf));
        let triangles = triangles.unwrap_or(0..0).enumerate();
        triangles.map(move |(index, triangle)| {
            let block = BlockId(first + (index / BLOCK_LANES) as u32);
            let lane = (index % BLOCK_LANES) as u32;
            (TreeTriangle(triangle as u32), (block, lane))
        })
    }

    /// Returns the run of triangles below a node, from its first leaf to its last.
    fn triangles_below(&self, node: NodeId) -> Result<Range<usize>, String> {
        let end_of = |last: bool| {
            let mut node = node;
            for _ in 0..=self.depth {
                match self.child(node) {
                    Child::Leaf(leaf) => return Ok(self.leaves.triangles(leaf)),
                    Child::Inner(below) => {
                        let lanes = self.wide_node(below).len();
                        node = NodeId::new(below, if last { lanes - 1 } else { 0 });
                    }
                }
            }
            Err(format!("a path of more than {} levels", self.depth))
        };
        Ok(end_of(false)?.start..end_of(true)?.end)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Topology;
    use crate::tree::build::{Balanced, Connectivity, Split, plan};

    /// Builds a tree by a rule; returns what is wrong with it as a mesh connectivity tree.
    fn fault(triangles: &[[u32; 3]], vertices: usize, rule: impl Split) -> String {
        let mut plan = plan(triangles.len(), 8, 2, rule);
        let topology = Topology::new(triangles, vertices);
        let order = Order::new(&topology, std::mem::take(&mut plan.order));
        let tree = Tree::new(&plan, &order, TreeVertex(0));
        assert_eq!(
            tree.validate(&order, 0..triangles.len(), Partition::Balanced),
            Ok(())
        );
        let found = tree.validate(&order, 0..triangles.len(), Partition::Connectivity);
        found.err().unwrap_or_default()
    }

    #[test]
    fn a_tree_by_shape_is_no_connectivity_tree() {
        // A strip whose triangles lie to and fro.
        let strip: Vec<[u32; 3]> = (0..32).map(|i| [i, i + 1, i + 2]).collect();
        let positions: Vec<[f32; 3]> = (0..34).map(|i| [(i * 13 % 34) as f32, 0.0, 0.0]).collect();
        let balanced = Balanced::new(&strip, &positions, 8, 2);
        let found = fault(&strip, 34, balanced);
        assert!(found.contains("neither one connected piece"), "{found}");
        let connectivity = Connectivity::new(&strip, 8, 2);
        assert_eq!(fault(&strip, 34, connectivity), "");
    }
}
