//! Cut of a tree at a level: its nodes there, as a division of the body's triangles.

use super::{BoxSet, Child, Tree, Version};
use crate::ids::{NodeId, TreeTriangle};

impl Tree {
    /// Returns the first triangle below every node of a level, ascending. A leaf above the level
    /// counts.
    pub(crate) fn starts_of_cut(&self, level: u32) -> Vec<TreeTriangle> {
        let nodes = self.nodes_of_cut(level).into_iter();
        nodes.map(|node| self.first_triangle(node)).collect()
    }

    /// Whether each node of a level has a valid box in a set, made from this version of its source.
    pub(crate) fn valid_in_cut(&self, level: u32, boxes: &BoxSet, version: Version) -> Vec<bool> {
        let nodes = self.nodes_of_cut(level).into_iter();
        nodes
            .map(|node| boxes.holds(node.wide_node_and_lane().0, version))
            .collect()
    }

    /// Returns the nodes of a level, in the order of their triangles. A leaf above the level
    /// counts.
    fn nodes_of_cut(&self, level: u32) -> Vec<NodeId> {
        let mut nodes = vec![NodeId::ROOT];
        for _ in 0..level.min(self.depth) {
            let below = |node| match self.child(node) {
                Child::Leaf(_) => vec![node],
                Child::Inner(below) => self.nodes_in(below).collect(),
            };
            nodes = nodes.into_iter().flat_map(below).collect();
        }
        nodes
    }

    /// Returns the first triangle below a node.
    fn first_triangle(&self, mut node: NodeId) -> TreeTriangle {
        loop {
            match self.child(node) {
                Child::Leaf(leaf) => return self.leaves.first_triangle(leaf),
                Child::Inner(below) => node = NodeId::new(below, 0),
            }
        }
    }
}
