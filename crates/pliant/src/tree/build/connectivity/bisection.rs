//! A graph in two: by whole components, or both halves connected.

use super::coarsening::{Coarsening, Coarser};
use super::components::Components;
use super::far_ends::FarEnds;
use super::graph::Graph;
use super::halves::{Half, Shares};
use super::refinement::{Quality, Refinement};
use super::search::{Search, UNREACHED};
use super::subtree::Subtree;

/// A graph of this many nodes is coarse enough to be cut.
const COARSE: usize = 48;
/// Contracting goes on while it takes one of so many nodes away, or more.
const WORTH_IT: usize = 20;

#[derive(Debug, Default)]
pub(super) struct Bisection {
    search: Search,
    components: Components,
    /// Coarser and coarser; the memory of the largest graph so far.
    levels: Vec<Coarser>,
    coarsening: Coarsening,
    far_ends: FarEnds,
    subtree: Subtree,
    refinement: Refinement,
    /// A cut to compare with, or to make the next of.
    other: Vec<Half>,
}

impl Bisection {
    /// Gives each of two or more nodes a side; none is empty.
    pub(super) fn bisect(&mut self, graph: &Graph, shares: Shares, halves: &mut Vec<Half>) {
        self.search.clear(graph.len());
        self.search.reach(graph, 0);
        if self.search.order.len() < graph.len() {
            self.share_out_components(graph, halves);
        } else {
            self.cut(graph, shares, halves);
        }
    }

    /// The search has reached the first component.
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
        // Components came one after the other.
        halves.clear();
        halves.resize(graph.len(), false);
        let mut nodes = self.search.order.iter();
        for (size, side) in self.components.share_out() {
            for &node in nodes.by_ref().take(size as usize) {
                halves[node as usize] = side;
            }
        }
    }

    /// Cuts a connected graph.
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

    /// Contracts the graph again and again, and returns at which level it is coarse.
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

    /// The best of the cuts between far ends at a level, refined.
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

/// The graph at a level: 0 is the one to be cut.
fn at_level<'a>(level: usize, levels: &'a [Coarser], graph: &'a Graph) -> &'a Graph {
    match level {
        0 => graph,
        _ => &levels[level - 1].graph,
    }
}
