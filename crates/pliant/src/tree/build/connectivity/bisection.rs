//! Bisection of a graph: by whole components, or into two connected halves.

use super::coarsening::{Coarsening, Coarser};
use super::components::Components;
use super::far_ends::FarEnds;
use super::graph::Graph;
use super::halves::{Half, Shares};
use super::refinement::{Quality, Refinement};
use super::search::{Search, UNREACHED};
use super::subtree::Subtree;

/// Most nodes of a graph that is coarse enough to be cut.
const COARSE: usize = 48;
/// Coarsening goes on while it takes away at least one of this many nodes.
const WORTH_IT: usize = 20;

/// Multilevel bisection; the memory of its steps is reused from graph to graph.
#[derive(Debug, Default)]
pub(super) struct Bisection {
    search: Search,
    components: Components,
    /// Coarser and coarser graphs; as many as the largest graph so far needed.
    levels: Vec<Coarser>,
    coarsening: Coarsening,
    far_ends: FarEnds,
    subtree: Subtree,
    refinement: Refinement,
    /// A second cut, to compare with or to build the next in.
    other: Vec<Half>,
}

impl Bisection {
    /// Assigns each of two or more nodes to a side; neither is empty.
    pub(super) fn bisect(&mut self, graph: &Graph, shares: Shares, halves: &mut Vec<Half>) {
        self.search.clear(graph.len());
        self.search.reach(graph, 0);
        if self.search.order.len() < graph.len() {
            self.share_out_components(graph, halves);
        } else {
            self.cut(graph, shares, halves);
        }
    }

    /// Assigns whole components to sides; the search has reached the first.
    fn share_out_components(&mut self, graph: &Graph, halves: &mut Vec<Half>) {
        let mut reached = self.search.order.len();
        self.components.clear();
        self.components.push(reached as u32);
        for node in 0..graph.len() as u32 {
            if self.search.distances[node as usize] == UNREACHED {
                self.search.reach(graph, node);
                let size = self.search.order.len() - reached;
                self.components.push(size as u32);
                reached += size;
            }
        }
        // The search's order holds one component after the other.
        halves.clear();
        halves.resize(graph.len(), false);
        let mut nodes = self.search.order.iter();
        for (size, side) in self.components.share_out() {
            for &node in nodes.by_ref().take(size as usize) {
                halves[node as usize] = side;
            }
        }
    }

    /// Cuts a connected graph: multilevel, with a subtree as the fallback.
    fn cut(&mut self, graph: &Graph, shares: Shares, halves: &mut Vec<Half>) {
        let coarsest = self.coarsen(graph);
        let mut quality = self.cut_between_far_ends(coarsest, graph, shares, halves);
        for level in (0..coarsest).rev() {
            let coarse_of = self.levels[level].coarse_of.iter();
            self.other.clear();
            self.other
                .extend(coarse_of.map(|&node| halves[node as usize]));
            std::mem::swap(&mut self.other, halves);
            let finer = at_level(level, &self.levels, graph);
            quality = self.refinement.refine(finer, shares, halves);
        }
        if quality.excess > 0 {
            self.subtree.cut_off(graph, shares, &mut self.other);
            if self.refinement.refine(graph, shares, &mut self.other) < quality {
                std::mem::swap(&mut self.other, halves);
            }
        }
    }

    /// Contracts the graph until it is coarse. Returns the level at which it is.
    fn coarsen(&mut self, graph: &Graph) -> usize {
        let most = (graph.total() / COARSE as u32).max(1) * 3 / 2;
        let mut level = 0;
        loop {
            if self.levels.len() == level {
                self.levels.push(Coarser::default());
            }
            let (levels, coarser) = self.levels.split_at_mut(level);
            let finer = at_level(level, levels, graph);
            if finer.len() <= COARSE {
                return level;
            }
            self.coarsening.coarsen(finer, most, &mut coarser[0]);
            if (finer.len() - coarser[0].graph.len()) * WORTH_IT < finer.len() {
                return level;
            }
            level += 1;
        }
    }

    /// Cuts the graph at a level between far ends, refines each cut, and keeps the best.
    fn cut_between_far_ends(
        &mut self,
        level: usize,
        graph: &Graph,
        shares: Shares,
        halves: &mut Vec<Half>,
    ) -> Quality {
        let graph = at_level(level, &self.levels, graph);
        let ends = self.far_ends.find(graph);
        let mut best = Quality::WORST;
        for b in 1..ends {
            for a in 0..b {
                let other = &mut self.other;
                self.far_ends.cut_between(graph, [a, b], shares, other);
                let quality = self.refinement.refine(graph, shares, other);
                if quality < best {
                    best = quality;
                    std::mem::swap(other, halves);
                }
            }
        }
        best
    }
}

/// Returns the graph at a level; level 0 is the graph to be cut.
fn at_level<'a>(level: usize, levels: &'a [Coarser], graph: &'a Graph) -> &'a Graph {
    match level {
        0 => graph,
        _ => &levels[level - 1].graph,
    }
}
