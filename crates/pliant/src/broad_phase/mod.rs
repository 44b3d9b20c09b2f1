//! From the boxes of all bodies to the pairs that overlap (paper, 3.4).
//!
//! Bodies are numbered by their place in the world. A body's box is its exact one, or a loose one that holds for every pose and
//! stands still.

mod brute_force;
mod sweep_and_prune;

use crate::geometry::Aabb;
use crate::ids::Place;
use crate::threads::Interrupt;
use sweep_and_prune::SweepAndPrune;

/// Two bodies whose boxes overlap, the smaller place first.
type Overlap = [Place; 2];

/// Up to so many bodies, comparing all pairs is as good as anything; "approximately 100" (paper, 3.4).
const MOST_FOR_BRUTE_FORCE: usize = 100;

/// The broad phase of a world, with what it keeps between queries.
#[derive(Debug)]
pub(crate) struct BroadPhase {
    rule: crate::BroadPhase,
    /// None as long as brute force does.
    sweep: Option<SweepAndPrune>,
    overlaps: Vec<Overlap>,
}

impl BroadPhase {
    pub(crate) fn new(rule: crate::BroadPhase) -> Self {
        Self {
            rule,
            sweep: None,
            overlaps: Vec::new(),
        }
    }

    /// The pairs of overlapping boxes, by the places of the boxes, in no order. Bodies are those of the last call, but for
    /// removals told by [`BroadPhase::swap_remove`], then added ones at the end. Interrupted, it finds some of them, and begins anew
    /// the next time.
    pub(crate) fn overlapping(&mut self, boxes: &[Aabb], interrupt: &Interrupt) -> &[Overlap] {
        let sweep = match self.rule {
            crate::BroadPhase::Auto => boxes.len() > MOST_FOR_BRUTE_FORCE,
            crate::BroadPhase::BruteForce => false,
            crate::BroadPhase::SweepAndPrune => true,
        };
        if !sweep {
            self.sweep = None;
            brute_force::overlapping(boxes, interrupt, &mut self.overlaps);
            return &self.overlaps;
        }
        let sweep = self.sweep.get_or_insert_default();
        if sweep.overlapping(boxes, interrupt).is_none() {
            *sweep = SweepAndPrune::default();
        }
        &sweep.pairs
    }

    /// The body at `place` goes, and the last one, at `last`, takes its place.
    pub(crate) fn swap_remove(&mut self, place: usize, last: usize) {
        if let Some(sweep) = &mut self.sweep {
            sweep.swap_remove(place, last);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_number_of_bodies_chooses() {
        let apart = |count: usize| -> Vec<Aabb> {
            (0..count)
                .map(|i| Aabb {
                    lo: [i as f32; 3],
                    hi: [i as f32 + 0.5; 3],
                })
                .collect()
        };
        let mut broad_phase = BroadPhase::new(crate::BroadPhase::Auto);
        for (count, sweeps) in [(100, false), (101, true), (100, false)] {
            let interrupt = Interrupt::default();
            assert!(
                broad_phase
                    .overlapping(&apart(count), &interrupt)
                    .is_empty()
            );
            assert_eq!(broad_phase.sweep.is_some(), sweeps, "{count} bodies");
        }
    }
}
