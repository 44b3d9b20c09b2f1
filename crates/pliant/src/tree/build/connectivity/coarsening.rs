//! Coarsening: a graph of about half as many nodes, by contraction of neighbours.
//!
//! Nodes choose a partner in the order of their numbers, by a rating of their links. A link of
//! weight w between nodes of weights a and b rates w^2 / (a b): nodes stay alike and their borders
//! short. (*expansion*^2 of Holtgrewe, Sanders and Schulz, *Engineering a Scalable High Quality
//! Graph Partitioner*, 2010.) Of equal ratings the first link wins. A node is a connected set of
//! triangles, so connected nodes are connected triangles.

use super::graph::{Graph, Link};

/// Coarser graph, and the map from the finer one's nodes.
#[derive(Debug, Default)]
pub(super) struct Coarser {
    pub(super) graph: Graph,
    /// Coarse node of each node of the finer graph.
    pub(super) coarse_of: Vec<u32>,
}

/// Contraction of graphs; its memory is reused from graph to graph.
#[derive(Debug, Default)]
pub(super) struct Coarsening {
    partners: Vec<u32>,
    /// For each coarse node the place of its link in the current row; a place from an earlier row
    /// is invalid.
    link_places: Vec<u32>,
}

/// Sentinel: a node without a partner, or without a link.
const ALONE: u32 = u32::MAX;

impl Coarsening {
    /// Contracts pairs of neighbours that weigh at most `most` together.
    pub(super) fn coarsen(&mut self, fine: &Graph, most: u32, level: &mut Coarser) {
        self.choose_partners(fine, most);

        // Coarse nodes are numbered in the order of their first fine ones.
        let mut count = 0;
        level.coarse_of.clear();
        for (node, &partner) in self.partners.iter().enumerate() {
            let coarse = if (partner as usize) < node {
                level.coarse_of[partner as usize]
            } else {
                count += 1;
                count - 1
            };
            level.coarse_of.push(coarse);
        }

        level.graph.clear();
        self.link_places.clear();
        self.link_places.resize(count as usize, ALONE);
        for node in 0..fine.len() as u32 {
            let partner = self.partners[node as usize];
            if partner < node {
                continue;
            }
            self.contract(fine, node, partner, level);
        }
    }

    /// Matches each node with a free neighbour, or with itself.
    fn choose_partners(&mut self, fine: &Graph, most: u32) {
        self.partners.clear();
        self.partners.resize(fine.len(), ALONE);
        for node in 0..fine.len() as u32 {
            if self.partners[node as usize] != ALONE {
                continue;
            }
            let mut best: Option<Link> = None;
            for &link in fine.links(node) {
                if self.partners[link.to as usize] == ALONE
                    && fine.weight(node) + fine.weight(link.to) <= most
                    && best.is_none_or(|best| rates_higher(fine, link, best))
                {
                    best = Some(link);
                }
            }
            let partner = best.map_or(node, |link| link.to);
            self.partners[node as usize] = partner;
            self.partners[partner as usize] = node;
        }
    }

    /// Adds the coarse node of two partners, which may be one node.
    fn contract(&mut self, fine: &Graph, node: u32, partner: u32, level: &mut Coarser) {
        let Coarser { graph, coarse_of } = level;
        let own = coarse_of[node as usize];
        let mut weight = fine.weight(node);
        let mut add_links_of = |node: u32| {
            for link in fine.links(node) {
                let to = coarse_of[link.to as usize];
                if to == own {
                    continue;
                }
                let links = graph.new_links();
                // A place from an earlier row names another link of this row, or none.
                let place = self.link_places[to as usize] as usize;
                if let Some(same) = links.get_mut(place).filter(|link| link.to == to) {
                    same.weight += link.weight;
                } else {
                    self.link_places[to as usize] = links.len() as u32;
                    graph.push_link(to, link.weight);
                }
            }
        };
        add_links_of(node);
        if partner != node {
            add_links_of(partner);
            weight += fine.weight(partner);
        }
        graph.push_node(weight);
    }
}

/// Compares the ratings of two links of one node, whose own weight divides both.
#[inline]
fn rates_higher(graph: &Graph, link: Link, than: Link) -> bool {
    let square = |link: Link| u128::from(link.weight) * u128::from(link.weight);
    square(link) * u128::from(graph.weight(than.to))
        > square(than) * u128::from(graph.weight(link.to))
}

#[cfg(test)]
mod tests {
    use super::super::graph::tests::{path, star};
    use super::*;

    #[test]
    fn weights_and_links_are_kept() {
        let mut coarsening = Coarsening::default();
        for (graph, most) in [(path(100), 2), (path(100), 1), (star(7, 9), 3)] {
            let (mut finer, mut level) = (graph, Coarser::default());
            loop {
                coarsening.coarsen(&finer, most, &mut level);
                let coarse = &level.graph;
                assert_eq!(coarse.total(), finer.total());
                assert!(coarse.heaviest() <= most);
                for node in 0..finer.len() as u32 {
                    for link in finer.links(node) {
                        let ends = [node, link.to].map(|end| level.coarse_of[end as usize]);
                        let links = || coarse.links(ends[0]).iter();
                        let found = links().filter(|link| link.to == ends[1]).count();
                        assert_eq!(found, usize::from(ends[0] != ends[1]));
                    }
                }
                if coarse.len() == finer.len() {
                    break;
                }
                finer = std::mem::take(&mut level).graph;
            }
            assert!(finer.len() <= 100 / most as usize * 2, "{}", finer.len());
        }
    }

    #[test]
    fn links_between_pairs_are_merged() {
        // A ring of four: nodes 0 and 1 become one, 2 and 3 the other, with two links between them.
        let mut ring = Graph::default();
        for [a, b] in [[1, 3], [0, 2], [3, 1], [2, 0]] {
            ring.push_link(a, 1);
            ring.push_link(b, 1);
            ring.push_node(1);
        }
        let mut level = Coarser::default();
        Coarsening::default().coarsen(&ring, 4, &mut level);
        assert_eq!(level.coarse_of, [0, 0, 1, 1]);
        assert_eq!(level.graph.links(0), [Link { to: 1, weight: 2 }]);
        assert_eq!(level.graph.links(1), [Link { to: 0, weight: 2 }]);
    }
}
