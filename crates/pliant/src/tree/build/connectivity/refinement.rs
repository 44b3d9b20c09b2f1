//! Refinement of a cut, node by node: shorter borders and more equal halves, which stay connected.
//!
//! After Fiduccia and Mattheyses (*A Linear-Time Heuristic for Improving Network Partitions*,
//! 1982). A pass moves border nodes to the other side, each once, always the one that shortens the
//! border most. It goes on for a while where the border grows, and returns to the best cut it saw.
//! A side that is too heavy gives nodes away until it is not. What differs: a node whose side might
//! fall apart stays (`nearby`).

use super::graph::Graph;
use super::halves::{Half, Shares};
use super::nearby::Nearby;
use std::collections::BinaryHeap;
use std::ops::RangeInclusive;

/// Quality of a cut: less is better, compared field by field.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Quality {
    /// How much heavier a side is than it may be.
    pub(super) excess: u32,
    /// Weight of the links between the halves.
    pub(super) border: u32,
    /// How far the weights are from the shares.
    pub(super) unevenness: u64,
}

impl Quality {
    /// Worse than any cut.
    pub(super) const WORST: Self = Self {
        excess: u32::MAX,
        border: u32::MAX,
        unevenness: u64::MAX,
    };
}

/// Moves after the best cut of a pass until it ends: about as many as a border has edges, the root
/// of the weight.
const PATIENCE: RangeInclusive<usize> = 12..=64;
/// Most passes; usually the second finds nothing.
const MOST_PASSES: u32 = 4;
/// Inverse tolerance: a side may exceed its share by the whole divided by this, for a shorter
/// border.
const TOLERANCE: u32 = 256;

/// Refinement of cuts; its memory is reused from graph to graph.
#[derive(Debug, Default)]
pub(super) struct Refinement {
    /// For each node the weight of its links within its side.
    within: Vec<u32>,
    /// For each node the weight of its links across the border.
    across: Vec<u32>,
    /// For each node the last pass that moved it.
    moved_in: Vec<u32>,
    /// Nodes of each side that may be moved, by gain; outdated entries are skipped.
    candidates: [BinaryHeap<Candidate>; 2],
    moves: Vec<u32>,
    nearby: Nearby,
}

/// Candidate for a move: a node and its gain in one number, ordered by gain, then by the lowest
/// node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Candidate(u64);

impl Candidate {
    #[inline]
    fn new(gain: i32, node: u32) -> Self {
        let ascending = gain.cast_unsigned() ^ 1 << 31;
        Self(u64::from(ascending) << 32 | u64::from(!node))
    }

    #[inline]
    fn node(self) -> u32 {
        !(self.0 as u32)
    }
}

impl Refinement {
    /// Improves a cut with two connected halves, which stay connected. Returns its quality.
    pub(super) fn refine(&mut self, graph: &Graph, shares: Shares, halves: &mut [Half]) -> Quality {
        let mut cut = Cut::new(self, graph, shares, halves);
        let mut quality = cut.quality();
        for pass in 1..=MOST_PASSES {
            let better = cut.improve(pass);
            if better == quality {
                break;
            }
            quality = better;
        }
        quality
    }
}

/// Cut of a graph, with weights and border kept up to date.
struct Cut<'a> {
    graph: &'a Graph,
    shares: Shares,
    /// Most that each half may weigh.
    limits: [u32; 2],
    halves: &'a mut [Half],
    weights: [u32; 2],
    border: u32,
    known: &'a mut Refinement,
}

impl<'a> Cut<'a> {
    fn new(
        known: &'a mut Refinement,
        graph: &'a Graph,
        shares: Shares,
        halves: &'a mut [Half],
    ) -> Self {
        known.within.clear();
        known.across.clear();
        known.moved_in.clear();
        known.moved_in.resize(graph.len(), 0);
        known.nearby.clear(graph.len());
        let mut weights = [0; 2];
        let mut both_ways = 0;
        for node in 0..graph.len() as u32 {
            let side = halves[node as usize];
            let mut sums = [0; 2];
            for link in graph.links(node) {
                sums[usize::from(halves[link.to as usize] != side)] += link.weight;
            }
            known.within.push(sums[0]);
            known.across.push(sums[1]);
            weights[usize::from(side)] += graph.weight(node);
            both_ways += sums[1];
        }
        // Where nodes are heavy no cut is quite even.
        let slack = graph.total() / TOLERANCE + graph.heaviest() / 2;
        Self {
            graph,
            shares,
            limits: shares.limits(graph.total(), slack),
            halves,
            weights,
            border: both_ways / 2,
            known,
        }
    }

    /// Returns the quality of the cut as it is now.
    fn quality(&self) -> Quality {
        let excess = |side: usize| self.weights[side].saturating_sub(self.limits[side]);
        Quality {
            excess: excess(0).max(excess(1)),
            border: self.border,
            unevenness: self.shares.unevenness(self.weights),
        }
    }

    /// Runs one pass. Returns the quality of the cut it leaves, which is not worse than before.
    fn improve(&mut self, pass: u32) -> Quality {
        self.known.candidates.iter_mut().for_each(BinaryHeap::clear);
        self.known.moves.clear();
        for node in 0..self.graph.len() as u32 {
            self.offer(node, pass);
        }
        let border = self.graph.total().isqrt() as usize;
        let patience = border.clamp(*PATIENCE.start(), *PATIENCE.end());
        let (mut best, mut best_moves) = (self.quality(), 0);
        while let Some(node) = self.next(pass) {
            self.change_side(node);
            self.known.moves.push(node);
            self.known.moved_in[node as usize] = pass;
            for link in self.graph.links(node) {
                self.offer(link.to, pass);
            }
            let quality = self.quality();
            if quality < best {
                (best, best_moves) = (quality, self.known.moves.len());
            } else if self.known.moves.len() - best_moves >= patience {
                break;
            }
        }
        for undone in (best_moves..self.known.moves.len()).rev() {
            self.change_side(self.known.moves[undone]);
        }
        best
    }

    /// Makes a node a candidate, if it is on the border and this pass has not moved it.
    #[inline]
    fn offer(&mut self, node: u32, pass: u32) {
        if self.may_be_moved(node, pass) {
            let candidate = Candidate::new(self.gain(node), node);
            self.known.candidates[usize::from(self.halves[node as usize])].push(candidate);
        }
    }

    /// Whether a node is on the border and this pass has not moved it.
    #[inline]
    fn may_be_moved(&self, node: u32, pass: u32) -> bool {
        self.known.across[node as usize] > 0 && self.known.moved_in[node as usize] < pass
    }

    /// Returns by how much the border becomes shorter if a node is moved.
    #[inline]
    fn gain(&self, node: u32) -> i32 {
        self.known.across[node as usize].cast_signed()
            - self.known.within[node as usize].cast_signed()
    }

    /// Takes the best node to move, if there is one.
    fn next(&mut self, pass: u32) -> Option<u32> {
        // If a side is too heavy, it is the fuller one.
        let fuller = self.shares.fuller(self.weights);
        let excess = self.weights[fuller].saturating_sub(self.limits[fuller]);
        loop {
            let best = [self.best(0, pass), self.best(1, pass)];
            let from = if excess == 0 && best[1 - fuller] > best[fuller] {
                1 - fuller
            } else {
                fuller
            };
            let node = best[from]?.node();
            self.known.candidates[from].pop();
            let there = self.weights[1 - from] + self.graph.weight(node);
            let too_much = there.saturating_sub(self.limits[1 - from]);
            let fits = if excess == 0 {
                too_much <= self.graph.heaviest()
            } else {
                too_much < excess
            };
            // A node that must stay is offered again when one beside it is moved.
            if fits && self.known.nearby.may_leave(self.graph, self.halves, node) {
                return Some(node);
            }
        }
    }

    /// Returns the best candidate of a side; removes outdated ones before it.
    fn best(&mut self, side: usize, pass: u32) -> Option<Candidate> {
        while let Some(&candidate) = self.known.candidates[side].peek() {
            let node = candidate.node();
            if usize::from(self.halves[node as usize]) == side
                && self.may_be_moved(node, pass)
                && candidate == Candidate::new(self.gain(node), node)
            {
                return Some(candidate);
            }
            self.known.candidates[side].pop();
        }
        None
    }

    /// Moves a node to the other side.
    fn change_side(&mut self, node: u32) {
        let here = node as usize;
        let weight = self.graph.weight(node);
        self.weights[usize::from(self.halves[here])] -= weight;
        self.halves[here] = !self.halves[here];
        self.weights[usize::from(self.halves[here])] += weight;

        let Refinement { within, across, .. } = &mut *self.known;
        self.border = self.border + within[here] - across[here];
        std::mem::swap(&mut within[here], &mut across[here]);
        for link in self.graph.links(node) {
            let there = link.to as usize;
            if self.halves[there] == self.halves[here] {
                within[there] += link.weight;
                across[there] -= link.weight;
            } else {
                within[there] -= link.weight;
                across[there] += link.weight;
            }
        }
    }
}
