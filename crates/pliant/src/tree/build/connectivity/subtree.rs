//! Fallback cut for graphs that are like trees: one side is a subtree of a breadth-first tree.
//!
//! Both halves are connected. Where many arms are equally far from two ends, a cut between ends may
//! leave all of them on one side. This cut does not. With at most k links a node, some subtree has
//! at least a k-th of the weight (less one node) and little more than half. So halving ends after
//! few levels on any mesh, where k is six.

use super::graph::Graph;
use super::halves::{Half, Shares};
use super::search::Search;

/// Search for a subtree to cut off; its memory is reused from graph to graph.
#[derive(Debug, Default)]
pub(super) struct Subtree {
    search: Search,
    /// Parent of each node in the breadth-first tree.
    above: Vec<u32>,
    /// Weight of the subtree of each node.
    weights: Vec<u32>,
}

impl Subtree {
    /// Cuts a connected graph of two nodes or more, nearest to the shares.
    pub(super) fn cut_off(&mut self, graph: &Graph, shares: Shares, halves: &mut Vec<Half>) {
        let root = self.search.farthest(graph, 0);
        self.search.farthest(graph, root);
        let Search { order, distances } = &self.search;
        self.above.clear();
        self.above.resize(graph.len(), root);
        self.weights.clear();
        self.weights.resize(graph.len(), 0);
        let mut best = (u64::MAX, root);
        for &node in order[1..].iter().rev() {
            let nearer = |to: u32| distances[to as usize] < distances[node as usize];
            let above = graph.links(node).iter().find(|link| nearer(link.to));
            let above = above.map_or(root, |link| link.to);
            let weight = self.weights[node as usize] + graph.weight(node);
            self.weights[above as usize] += weight;
            self.above[node as usize] = above;
            let unevenness = shares.unevenness([graph.total() - weight, weight]);
            best = best.min((unevenness, node));
        }
        halves.clear();
        halves.resize(graph.len(), false);
        for &node in &order[1..] {
            let above = self.above[node as usize];
            halves[node as usize] = node == best.1 || halves[above as usize];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::graph::tests::{path, star};
    use super::*;

    #[test]
    fn arms_are_cut_off() {
        let (mut subtree, mut halves) = (Subtree::default(), Vec::new());
        let mut smaller = |graph: &Graph| {
            subtree.cut_off(graph, Shares::halves(2), &mut halves);
            let here = halves.iter().filter(|&&side| side).count();
            here.min(graph.len() - here)
        };
        assert_eq!(smaller(&path(2)), 1);
        assert_eq!(smaller(&path(20)), 10);
        assert_eq!(smaller(&star(3, 10)), 10);
        assert_eq!(smaller(&star(6, 10)), 10);
    }
}
