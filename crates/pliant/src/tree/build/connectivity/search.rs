//! Breadth-first search.

use super::graph::Graph;

/// What a search found; its memory is used again by the next.
#[derive(Debug, Default)]
pub(super) struct Search {
    /// Nodes in the order in which they were reached.
    pub(super) order: Vec<u32>,
    /// Links to the start, by node.
    pub(super) distances: Vec<u32>,
}

/// The distance of what was not reached.
pub(super) const UNREACHED: u32 = u32::MAX;

impl Search {
    /// Forgets everything; `nodes` is the size of the next graph.
    pub(super) fn clear(&mut self, nodes: usize) {
        self.order.clear();
        self.distances.clear();
        self.distances.resize(nodes, UNREACHED);
    }

    /// Reaches what is connected with `start`; what earlier searches reached since `clear` is not reached again.
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

    /// Searches a connected graph anew, and returns a node that is farthest from the start.
    pub(super) fn farthest(&mut self, graph: &Graph, start: u32) -> u32 {
        self.clear(graph.len());
        self.reach(graph, start);
        *self.order.last().expect("the start was reached")
    }
}
