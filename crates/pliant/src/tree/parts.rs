//! A level of a tree as a division of the body's triangles.

use super::{Below, NodeId, Tree};

impl<const N: usize> Tree<N> {
    /// The first triangle below every node of a level, ascending. A leaf above that level stands for itself.
    pub(crate) fn starts_of_parts(&self, level: u32) -> Vec<u32> {
        self.parts(level)
            .into_iter()
            .map(|node| self.first_triangle(node))
            .collect()
    }

    /// Whether the box of every node of a level is true for a body of this epoch.
    pub(crate) fn made_parts(&self, level: u32, epoch: u64) -> Vec<bool> {
        self.parts(level)
            .into_iter()
            .map(|node| self.groups[node.group_and_lane::<N>().0].epoch == epoch)
            .collect()
    }

    /// The nodes of a level, in the order of their triangles.
    fn parts(&self, level: u32) -> Vec<NodeId> {
        let mut nodes = vec![NodeId::ROOT];
        for _ in 0..level.min(self.depth) {
            let below = |node| match self.child(node).below() {
                Below::Leaf(_) => vec![node],
                Below::Group(group) => {
                    let lanes = 0..self.groups[group as usize].len();
                    lanes.map(|lane| NodeId::new::<N>(group, lane)).collect()
                }
            };
            nodes = nodes.into_iter().flat_map(below).collect();
        }
        nodes
    }

    fn first_triangle(&self, mut node: NodeId) -> u32 {
        loop {
            match self.child(node).below() {
                Below::Leaf(leaf) => return self.leaves.triangles(leaf).start,
                Below::Group(group) => node = NodeId::new::<N>(group, 0),
            }
        }
    }
}
