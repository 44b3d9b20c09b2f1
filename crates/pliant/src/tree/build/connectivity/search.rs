//! Breadth-first search over a graph.

use super::graph::Graph;

/// Breadth-first search: its result; its memory is reused by the next search.
#[derive(Debug, Default)]
pub(super) struct Search {
    /// Nodes in the order in which they were reached.
    pub(super) order: Vec<u32>,
    /// Distance of each node from the start, in links.
    pub(super) distances: Vec<u32>,
}

/// Sentinel: the distance of a node that was not reached.
pub(super) const UNREACHED: u32 = u32::MAX;

impl Search {
    /// Prepares for a graph of `nodes` nodes, none of which is reached.
    pub(super) fn clear(&mut self, nodes: usize) {
        self.order.clear();
        self.distances.clear();
        self.distances.resize(nodes, UNREACHED);
    }

    /// Reaches all that is connected with `start`, except what was reached since
    /// [`clear`](Self::clear).
    pub(super) fn reach(&mut self, graph: &Graph, start: u32) {
        let mut next = self.order.len();
        self.distances[start as usize] = 0;
        self.order.push(start);
        while next < self.order.len() {
            let node = self.order[next];
            let distance = self.distances[node as usize] + 1;
            for link in graph.links(node) {
                let there = &mut self.distances[link.to as usize];
                if *there == UNREACHED {
                    *there = distance;
                    self.order.push(link.to);
                }
            }
            next += 1;
        }
    }

    /// Searches a connected graph from `start`, and returns a node that is farthest.
    pub(super) fn farthest(&mut self, graph: &Graph, start: u32) -> u32 {
        self.clear(graph.len());
        self.reach(graph, start);
        *self.order.last().expect("the start was reached")
    }
}
