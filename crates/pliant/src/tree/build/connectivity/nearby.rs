//! Bounded search: whether a side of a cut stays connected without one of its nodes.
//!
//! It does if the node's neighbours on its side reach each other there without it. On a surface
//! they do so around a vertex, a few steps away. So a search of bounded length can nearly always
//! say yes. At its bound it says no, which is always safe.

use super::graph::Graph;
use super::halves::Half;

/// Most links that are followed.
const BOUND: usize = 256;

/// Bounded search near a node; its memory is reused from graph to graph.
#[derive(Debug, Default)]
pub(super) struct Nearby {
    /// For each node the last search that looked for it (an even number) or reached it (the odd one
    /// above).
    marks: Vec<u32>,
    last_mark: u32,
    queue: Vec<u32>,
}

impl Nearby {
    /// Prepares for a graph of `nodes` nodes.
    pub(super) fn clear(&mut self, nodes: usize) {
        self.marks.clear();
        self.marks.resize(nodes, 0);
        self.last_mark = 1;
    }

    /// Whether a side is known to stay connected, and not empty, without one of its nodes.
    pub(super) fn may_leave(&mut self, graph: &Graph, halves: &[Half], node: u32) -> bool {
        let side = halves[node as usize];
        let (wanted, reached) = (self.last_mark + 1, self.last_mark + 2);
        self.last_mark = reached;
        self.queue.clear();
        let mut missing = 0_u32;
        let links = graph.links(node);
        for link in &links[..links.len().min(BOUND)] {
            if halves[link.to as usize] == side {
                self.marks[link.to as usize] = wanted;
                missing += 1;
                if missing == 1 {
                    self.queue.push(link.to);
                }
            }
        }
        if missing == 0 || links.len() > BOUND {
            return false;
        }
        self.marks[self.queue[0] as usize] = reached;
        self.marks[node as usize] = reached;
        missing -= 1;

        let (mut next, mut followed) = (0, 0);
        while missing > 0 && next < self.queue.len() && followed < BOUND {
            let links = graph.links(self.queue[next]);
            let links = &links[..links.len().min(BOUND - followed)];
            for link in links {
                let mark = &mut self.marks[link.to as usize];
                if *mark != reached && halves[link.to as usize] == side {
                    missing -= u32::from(*mark == wanted);
                    *mark = reached;
                    self.queue.push(link.to);
                }
            }
            next += 1;
            followed += links.len();
        }
        missing == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ring of nodes, each linked with the next.
    fn ring(count: u32) -> Graph {
        let mut graph = Graph::default();
        for node in 0..count {
            graph.push_link((node + count - 1) % count, 1);
            graph.push_link((node + 1) % count, 1);
            graph.push_node(1);
        }
        graph
    }

    #[test]
    fn a_ring_stays_connected_and_a_path_does_not() {
        let graph = ring(6);
        let mut nearby = Nearby::default();
        nearby.clear(graph.len());
        let mut halves = [true; 6];
        assert!((0..6).all(|node| nearby.may_leave(&graph, &halves, node)));
        halves[0] = false;
        let may_leave = [1, 2, 3, 4, 5].map(|node| nearby.may_leave(&graph, &halves, node));
        assert_eq!(may_leave, [true, false, false, false, true]);
        // Alone on its side.
        assert!(!nearby.may_leave(&graph, &halves, 0));
    }

    #[test]
    fn what_is_too_far_to_see_is_no() {
        let near = ring(BOUND as u32 / 2);
        let far = ring(BOUND as u32);
        let mut nearby = Nearby::default();
        for (graph, expected) in [(near, true), (far, false)] {
            nearby.clear(graph.len());
            let halves = vec![true; graph.len()];
            assert_eq!(nearby.may_leave(&graph, &halves, 7), expected);
        }
    }

    #[test]
    fn a_node_with_too_many_links_stays() {
        // Nodes 0 and 1 are linked with all others except the last, which is linked with node 0
        // alone.
        let last = BOUND as u32 + 1;
        let mut graph = Graph::default();
        (1..=last).for_each(|other| graph.push_link(other, 1));
        graph.push_node(1);
        (0..last)
            .filter(|&other| other != 1)
            .for_each(|other| graph.push_link(other, 1));
        graph.push_node(1);
        for node in 2..=last {
            graph.push_link(0, 1);
            if node < last {
                graph.push_link(1, 1);
            }
            graph.push_node(1);
        }
        let mut nearby = Nearby::default();
        nearby.clear(graph.len());
        assert!(!nearby.may_leave(&graph, &vec![false; graph.len()], 0));
        assert!(nearby.may_leave(&graph, &vec![false; graph.len()], last));
    }
}
