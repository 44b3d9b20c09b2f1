//! Collector of a query's pairs, for every method that proposes its candidates one by one.

use crate::decision::{Decision, Triangle};
use crate::method::{Counters, Method, Pair};
use crate::motion::{BodyMesh, Shape};
use std::ops::ControlFlow;

/// Extent of the answer that a query wants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wanted {
    /// All pairs.
    All,
    /// One pair, whichever comes first.
    First,
}

/// Decides candidates, keeps the pairs that intersect, and stops the search when there are enough.
pub(super) struct Answer {
    decision: Decision,
    wanted: Wanted,
    pairs: Vec<Pair>,
    /// Decisions are counted here; the method adds its boxes and box tests.
    pub(super) counters: Counters,
}

impl Answer {
    pub(super) fn new(decision: Decision) -> Self {
        Self {
            decision,
            wanted: Wanted::All,
            pairs: Vec::new(),
            counters: Counters::default(),
        }
    }

    /// Clears the pairs of the last query.
    pub(super) fn begin(&mut self, wanted: Wanted) {
        self.wanted = wanted;
        self.pairs.clear();
    }

    /// Decides a candidate. Breaks when no more pairs are wanted.
    #[inline]
    pub(super) fn candidate(&mut self, pair: Pair, a: &Triangle, b: &Triangle) -> ControlFlow<()> {
        self.counters.decisions += 1;
        if !(self.decision)(a, b) {
            return ControlFlow::Continue(());
        }
        self.pairs.push(pair);
        match self.wanted {
            Wanted::All => ControlFlow::Continue(()),
            Wanted::First => ControlFlow::Break(()),
        }
    }

    /// All pairs, sorted. A key is a whole number of 128 bits: one comparison instead of four.
    pub(super) fn sorted(&mut self) -> &[Pair] {
        self.pairs.sort_unstable_by_key(|pair| {
            pair.iter()
                .fold(0_u128, |key, &part| key << 32 | u128::from(part))
        });
        &self.pairs
    }

    pub(super) fn first(&self) -> Option<Pair> {
        self.pairs.first().copied()
    }
}

/// A method that proposes candidates one by one. All such methods collect and stop in the same way.
pub(super) trait Proposer {
    /// See [`Method::name`].
    fn name(&self) -> String;
    /// See [`Method::build`].
    fn build(&mut self, bodies: &[BodyMesh<'_>]);
    /// See [`Method::step`].
    fn step(&mut self, shapes: &[Shape<'_>]);
    /// Proposes pairs of triangles of different bodies to the answer, until it breaks.
    fn between_bodies(&mut self) -> ControlFlow<()>;
    /// Proposes pairs of triangles within each body.
    fn within_bodies(&mut self) -> ControlFlow<()>;
    /// Collector of the candidates.
    fn answer(&mut self) -> &mut Answer;
}

impl<P: Proposer> Method for P {
    fn name(&self) -> String {
        Proposer::name(self)
    }

    fn build(&mut self, bodies: &[BodyMesh<'_>]) {
        Proposer::build(self, bodies);
    }

    fn step(&mut self, shapes: &[Shape<'_>]) {
        Proposer::step(self, shapes);
    }

    fn all_pairs(&mut self) -> &[Pair] {
        self.answer().begin(Wanted::All);
        let _ = self.between_bodies();
        self.answer().sorted()
    }

    fn first_pair(&mut self) -> Option<Pair> {
        self.answer().begin(Wanted::First);
        let _ = self.between_bodies();
        self.answer().first()
    }

    fn self_pairs(&mut self) -> Option<&[Pair]> {
        self.answer().begin(Wanted::All);
        let _ = self.within_bodies();
        Some(self.answer().sorted())
    }

    fn take_counters(&mut self) -> Counters {
        std::mem::take(&mut self.answer().counters)
    }
}

/// A pair of one body with itself, in order.
#[inline]
pub(super) fn self_pair(body: usize, a: u32, b: u32) -> Pair {
    [body as u32, a.min(b), body as u32, a.max(b)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_numbers_are_sorted_part_by_part() {
        let mut answer = Answer::new(|_, _| true);
        let pairs = [
            [0, 1, 2, 3],
            [0, 1, 3, 0],
            [0, 2, 0, u32::MAX],
            [1, 0, u32::MAX, 0],
            [1, u32::MAX, 0, 0],
            [2, 0, 0, 0],
        ];
        let point = [[0.0; 3]; 3];
        for pair in pairs.into_iter().rev() {
            assert!(answer.candidate(pair, &point, &point).is_continue());
        }
        assert_eq!(answer.sorted(), pairs);
        assert_eq!(answer.counters.decisions, 6);
    }
}
