//! First cut of a connected graph, between two nodes that are far apart.
//!
//! Let p and q be the distances to two nodes a and b. One side is where p - q is at most some
//! value: the one that comes nearest to the shares. Both halves are connected for any value, since
//! p - q never grows on the way to a, nor shrinks on the way to b. A step towards a takes one from
//! p, and at most one from q. Between far ends a cut runs across the graph, and so is short.

use super::graph::Graph;
use super::halves::{Half, Shares};
use super::search::Search;

/// Most ends that are found. All pairs of ends are worth a try.
const MOST_ENDS: usize = 3;
/// Most ends in a small graph.
const FEW_ENDS: usize = 2;
/// Nodes below which a graph is small.
const FEW_NODES: usize = 32;

/// Search for far ends, and cuts between them; its memory is reused from graph to graph.
#[derive(Debug, Default)]
pub(super) struct FarEnds {
    ends: Vec<u32>,
    /// Breadth-first searches, one from each end.
    searches: [Search; MOST_ENDS],
    /// Weight of the nodes by p - q.
    histogram: Vec<u32>,
}

impl FarEnds {
    /// Finds ends of a connected graph of two nodes or more. Returns how many.
    ///
    /// Each is as far as possible from the ends before.
    pub(super) fn find(&mut self, graph: &Graph) -> usize {
        let most = if graph.len() < FEW_NODES {
            FEW_ENDS
        } else {
            MOST_ENDS
        };
        self.ends.clear();
        let mut next = self.searches[0].farthest(graph, 0);
        while self.ends.len() < most && !self.ends.contains(&next) {
            let farthest = self.searches[self.ends.len()].farthest(graph, next);
            self.ends.push(next);
            next = if self.ends.len() == 1 {
                farthest
            } else {
                self.farthest_from_all(graph)
            };
        }
        self.ends.len()
    }

    /// Returns the node whose nearest end is farthest; of several the first.
    fn farthest_from_all(&self, graph: &Graph) -> u32 {
        let searches = &self.searches[..self.ends.len()];
        let nearest_end = |node: u32| {
            let distances = searches
                .iter()
                .map(|search| search.distances[node as usize]);
            distances.min()
        };
        let nodes = (0..graph.len() as u32).rev();
        nodes.max_by_key(|&node| nearest_end(node)).unwrap_or(0)
    }

    /// Cuts between two of the ends found, nearest to the shares.
    pub(super) fn cut_between(
        &mut self,
        graph: &Graph,
        [a, b]: [usize; 2],
        shares: Shares,
        halves: &mut Vec<Half>,
    ) {
        let (p, q) = (&self.searches[a].distances, &self.searches[b].distances);
        let apart = p[self.ends[b] as usize];
        // p - q, shifted: from 0 at a to twice the distance of the ends at b.
        let value = |node: usize| p[node] + apart - q[node];
        self.histogram.clear();
        self.histogram.resize(2 * apart as usize + 1, 0);
        for node in 0..graph.len() {
            self.histogram[value(node) as usize] += graph.weight(node as u32);
        }
        // The value at b would leave the other side nothing; any other is better.
        let mut weight = 0;
        let mut best = (u64::MAX, 0);
        for (value, here) in (0..).zip(&self.histogram) {
            weight += here;
            let unevenness = shares.unevenness([weight, graph.total() - weight]);
            best = best.min((unevenness, value));
        }
        halves.clear();
        halves.extend((0..graph.len()).map(|node| value(node) > best.1));
    }
}

#[cfg(test)]
mod tests {
    use super::super::graph::tests::{path, star};
    use super::*;

    fn on_each_side(halves: &[Half]) -> [usize; 2] {
        [false, true].map(|side| halves.iter().filter(|&&other| other == side).count())
    }

    #[test]
    fn a_path_is_cut_by_shares() {
        let (mut ends, mut halves) = (FarEnds::default(), Vec::new());
        for (children, expected) in [(2, [14, 14]), (7, [12, 16])] {
            let path = path(28);
            assert_eq!(ends.find(&path), 2);
            ends.cut_between(&path, [0, 1], Shares::halves(children), &mut halves);
            assert_eq!(on_each_side(&halves), expected);
        }
    }

    #[test]
    fn ends_are_the_tips_of_a_star() {
        let mut ends = FarEnds::default();
        assert_eq!(ends.find(&star(5, 10)), 3);
        let mut tips = ends.ends.clone();
        tips.retain(|tip| tip % 10 == 0);
        tips.dedup();
        assert_eq!(tips.len(), 3);
    }

    #[test]
    fn two_nodes_are_two_ends() {
        let (mut ends, mut halves) = (FarEnds::default(), Vec::new());
        let pair = path(2);
        assert_eq!(ends.find(&pair), 2);
        ends.cut_between(&pair, [0, 1], Shares::halves(2), &mut halves);
        assert_eq!(on_each_side(&halves), [1, 1]);
    }
}
