//! Incremental sweep and prune (Cohen, Lin, Manocha, Ponamgi 1995; paper, 3.4).
//!
//! The ends of all boxes are kept in three lists, one an axis, sorted by insertion: bodies that
//! move a little exchange few neighbours. An exchange of two ends says that a pair may begin or
//! cease to overlap ([`SweepAndPrune::sort_by_exchanges`]). Of equal values the lower end comes
//! first: touching is overlapping. Differs from the original: only overlapping pairs are kept, as a
//! sorted list, in O(n + pairs) memory, instead of three bits for every pair. When bodies jump and
//! exchanges exceed a budget, the lists are sorted from scratch and swept once along the axis with
//! the fewest overlaps.

use super::overlap::Overlap;
use crate::geometry::Aabb;
use crate::held::{self, held};
use crate::ids::Rank;
use crate::threads::Interrupt;
use pliant_exact::DEBUG;
use std::cmp::Ordering;
use std::ops::ControlFlow;

/// Exchanges per end after which sorting from scratch is cheaper.
///
/// An exchange takes a few nanoseconds. In a full sort an end takes about log2(n) comparisons.
const EXCHANGES_PER_END: usize = 16;

/// One end of an interval.
#[derive(Clone, Copy, Debug)]
struct End {
    value: f32,
    /// The body's rank, doubled, plus one for the upper end.
    body_and_side: u32,
}

impl End {
    fn body(self) -> Rank {
        Rank(self.body_and_side >> 1)
    }

    fn is_upper(self) -> bool {
        self.body_and_side & 1 == 1
    }

    /// Whether this end comes before another: by value, and lower ends first of equal values.
    /// Values are never NaN.
    #[inline]
    fn belongs_before(self, other: Self) -> bool {
        self.value < other.value
            || (self.value == other.value && !self.is_upper() && other.is_upper())
    }

    fn order(self, other: Self) -> Ordering {
        let by_value = self.value.partial_cmp(&other.value);
        let by_side = || self.is_upper().cmp(&other.is_upper());
        by_value.expect("a number").then_with(by_side)
    }
}

/// Reason why a pass over the lists did not come to its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unfinished {
    Interrupted,
    /// There are more pairs than may be kept.
    TooMany,
}

/// Sorted ends and overlapping pairs, as the last query left them.
#[derive(Debug, Default)]
pub(super) struct SweepAndPrune {
    axes: [Vec<End>; 3],
    /// Overlapping pairs, sorted, without duplicates.
    pub(super) pairs: Vec<Overlap>,
    /// Rank that each present body has in the lists, or `NEW`, by its present rank.
    listed_as: Vec<Rank>,
    /// Whether the lists still hold bodies that are gone.
    some_are_gone: bool,
    // Scratch: pairs that began and ceased to overlap, the next list of pairs, and intervals open
    // in a sweep.
    new: Vec<Overlap>,
    gone: Vec<Overlap>,
    next: Vec<Overlap>,
    open: Vec<Rank>,
}

/// Rank in the lists of a body that is not in them.
const NEW: Rank = Rank(u32::MAX);

/// Number of ends that are sorted or swept between two looks at the interruption.
const UNINTERRUPTED: usize = 256;

impl SweepAndPrune {
    /// Updates `pairs` for new boxes: see [`super::BroadPhase::begin`]. `most` is the largest
    /// number of pairs to be kept.
    ///
    /// O(n + exchanges) where bodies move a little, O(n log n) and a sweep where they jump. After a
    /// break it cannot be used again.
    pub(super) fn overlapping(
        &mut self,
        boxes: &[Aabb],
        most: usize,
        interrupt: &Interrupt,
    ) -> ControlFlow<Unfinished> {
        self.listed_as.resize(boxes.len(), NEW);
        if std::mem::take(&mut self.some_are_gone) {
            self.forget_the_gone();
        }
        for (axis, ends) in self.axes.iter_mut().enumerate() {
            for end in &mut *ends {
                let value = &boxes[end.body().index()];
                end.value = if end.is_upper() {
                    value.hi[axis]
                } else {
                    value.lo[axis]
                };
            }
            // New bodies stand behind all others, overlapping nothing, and are sorted in like
            // bodies that moved.
            for body in (0..boxes.len()).filter(|&body| self.listed_as[body] == NEW) {
                let body_and_side = 2 * body as u32;
                ends.push(End {
                    value: boxes[body].lo[axis],
                    body_and_side,
                });
                ends.push(End {
                    value: boxes[body].hi[axis],
                    body_and_side: body_and_side + 1,
                });
            }
        }
        let new = self.listed_as.iter().filter(|&&rank| rank == NEW).count();
        for (listed_as, rank) in self.listed_as.iter_mut().zip((0..).map(Rank)) {
            *listed_as = rank;
        }
        let mut budget = self.axes[0].len() * EXCHANGES_PER_END;
        let many_are_new = new > boxes.len() / 2;
        if many_are_new || !self.sort_by_exchanges(boxes, most, &mut budget, interrupt)? {
            self.sort_from_scratch(boxes, most, interrupt)?;
        }
        self.reserve(boxes.len());
        ControlFlow::Continue(())
    }

    /// Removes a body: see [`super::BroadPhase::remove`]. The next query repairs the lists, in one
    /// pass for all removed bodies.
    pub(super) fn remove(&mut self, rank: Rank) {
        // A body added since the last query is in no list yet.
        if rank.index() < self.listed_as.len() {
            self.listed_as.remove(rank.index());
            self.some_are_gone = true;
        }
    }

    /// Takes removed bodies out of the lists, and gives the others their present ranks.
    fn forget_the_gone(&mut self) {
        let listed = self.axes[0].len() / 2;
        let mut ranks = vec![NEW; listed];
        for (&listed_as, rank) in self.listed_as.iter().zip((0..).map(Rank)) {
            if listed_as != NEW {
                ranks[listed_as.index()] = rank;
            }
        }
        let rank_of = |body: Rank| ranks[body.index()];
        for ends in &mut self.axes {
            ends.retain_mut(|end| {
                let rank = rank_of(end.body());
                end.body_and_side = rank.0.wrapping_mul(2) + u32::from(end.is_upper());
                rank != NEW
            });
        }
        self.pairs.retain_mut(|pair| {
            *pair = pair.map(rank_of);
            !pair.contains(&NEW)
        });
    }

    /// Sorts the lists by insertion and updates the pairs. Returns false if the budget does not
    /// suffice; pairs and order must then be made anew.
    ///
    /// Each exchange of a lower with an upper end is a change of overlap on one axis:
    ///
    /// - A lower end moves below an upper end: the intervals begin to overlap. If the boxes do, the
    ///   pair is noted as new.
    /// - An upper end moves below a lower end: the intervals cease to overlap. The pair is noted as
    ///   gone.
    ///
    /// Two ends are exchanged at most once in a sort, and only towards their final order. So a pair
    /// noted as gone is truly apart and a pair noted as new truly overlaps, whatever the order of
    /// the axes.
    fn sort_by_exchanges(
        &mut self,
        boxes: &[Aabb],
        most: usize,
        budget: &mut usize,
        interrupt: &Interrupt,
    ) -> ControlFlow<Unfinished, bool> {
        self.new.clear();
        self.gone.clear();
        for ends in &mut self.axes {
            for sorted in 1..ends.len() {
                if sorted.is_multiple_of(UNINTERRUPTED) && interrupt.is_set() {
                    return ControlFlow::Break(Unfinished::Interrupted);
                }
                let moving = ends[sorted];
                let mut place = sorted;
                while place > 0 && moving.belongs_before(ends[place - 1]) {
                    let passed = ends[place - 1];
                    ends[place] = passed;
                    place -= 1;
                    if moving.is_upper() == passed.is_upper() {
                        continue;
                    }
                    let (a, b) = (
                        moving.body().min(passed.body()),
                        moving.body().max(passed.body()),
                    );
                    if moving.is_upper() {
                        if self.pairs.binary_search(&[a, b]).is_ok() {
                            self.gone.push([a, b]);
                        }
                    } else if boxes[a.index()].overlaps(&boxes[b.index()]) {
                        self.new.push([a, b]);
                    }
                }
                ends[place] = moving;
                let Some(rest) = budget.checked_sub(sorted - place) else {
                    return ControlFlow::Continue(false);
                };
                *budget = rest;
            }
        }
        self.merge();
        if self.pairs.len() > most {
            return ControlFlow::Break(Unfinished::TooMany);
        }
        ControlFlow::Continue(true)
    }

    /// Updates the pairs: removes the ones noted as gone, and adds the ones noted as new.
    fn merge(&mut self) {
        if self.new.is_empty() && self.gone.is_empty() {
            return;
        }
        for list in [&mut self.new, &mut self.gone] {
            list.sort_unstable();
            list.dedup();
        }
        let next = &mut self.next;
        next.clear();
        let mut new = self.new.iter().copied().peekable();
        let mut gone = self.gone.iter().copied().peekable();
        for &pair in &self.pairs {
            while let Some(new) = new.next_if(|&new| new < pair) {
                next.push(new);
            }
            // A known pair overlaps on every axis, so on none of them can it begin to.
            assert!(!DEBUG || new.peek() != Some(&pair), "{pair:?}");
            if gone.next_if_eq(&pair).is_none() {
                next.push(pair);
            }
        }
        next.extend(new);
        self.pairs.clone_from(next);
    }

    /// Reserves room for all that a later query can note if it finds as many pairs, so that
    /// repeated motion allocates nothing.
    ///
    /// A pair begins and ceases to overlap at most once on each axis.
    fn reserve(&mut self, bodies: usize) {
        for list in [&mut self.new, &mut self.gone, &mut self.next] {
            list.clear();
            list.reserve(3 * self.pairs.len());
        }
        self.open.clear();
        self.open.reserve(bodies);
    }

    /// Sorts all three lists, and sweeps along the axis on which the fewest intervals overlap. O(n
    /// log n) and the sweep.
    fn sort_from_scratch(
        &mut self,
        boxes: &[Aabb],
        most: usize,
        interrupt: &Interrupt,
    ) -> ControlFlow<Unfinished> {
        for ends in &mut self.axes {
            if interrupt.is_set() {
                return ControlFlow::Break(Unfinished::Interrupted);
            }
            ends.sort_unstable_by(|a, b| a.order(*b));
        }
        let sparsest = self
            .axes
            .iter()
            .min_by_key(|ends| interval_overlaps(ends))
            .expect("three axes");
        self.pairs.clear();
        self.open.clear();
        for (at, end) in sparsest.iter().enumerate() {
            if at.is_multiple_of(UNINTERRUPTED) && interrupt.is_set() {
                return ControlFlow::Break(Unfinished::Interrupted);
            }
            if self.pairs.len() > most {
                return ControlFlow::Break(Unfinished::TooMany);
            }
            let body = end.body();
            if end.is_upper() {
                let place = self.open.iter().position(|&open| open == body);
                self.open
                    .swap_remove(place.expect("an interval begins before it ends"));
                continue;
            }
            for &open in &self.open {
                if boxes[body.index()].overlaps(&boxes[open.index()]) {
                    self.pairs.push([body.min(open), body.max(open)]);
                }
            }
            self.open.push(body);
        }
        self.pairs.sort_unstable();
        ControlFlow::Continue(())
    }
}

/// Number of pairs of intervals that overlap in a sorted list of ends.
fn interval_overlaps(ends: &[End]) -> usize {
    let (mut open, mut overlaps) = (0, 0);
    for end in ends {
        if end.is_upper() {
            open -= 1;
        } else {
            overlaps += open;
            open += 1;
        }
    }
    overlaps
}

held!(SweepAndPrune: pairs[], new[], gone[], next[], listed_as[], open[];
    |sweep| sweep.axes.iter().map(held::list).sum::<usize>());

#[cfg(test)]
mod tests {
    use super::super::brute_force;
    use super::*;

    /// A limit above any number of pairs here.
    const MANY: usize = 1 << 20;

    struct Lcg(u64);

    impl Lcg {
        fn below(&mut self, range: u32) -> u32 {
            self.0 = self
                .0
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 33) as u32 % range
        }

        /// A cube on a lattice, so that many ends are equal.
        fn cube(&mut self, range: u32) -> Aabb {
            let lo = [(); 3].map(|()| self.below(range) as f32);
            let hi = lo.map(|x| x + self.below(3) as f32);
            Aabb { lo, hi }
        }
    }

    fn check(sweep: &mut SweepAndPrune, boxes: &[Aabb]) {
        let (mut expected, never) = (Vec::new(), Interrupt::default());
        (0..boxes.len() as u32).for_each(|body| brute_force::row(boxes, Rank(body), &mut expected));
        assert!(sweep.overlapping(boxes, MANY, &never).is_continue());
        assert_eq!(sweep.pairs, expected);
    }

    #[test]
    fn equals_brute_force_under_moves_jumps_additions_and_removals() {
        for seed in 0..40 {
            let mut random = Lcg(seed);
            let range = 4 + random.below(30);
            let mut sweep = SweepAndPrune::default();
            let mut boxes: Vec<Aabb> = (0..random.below(60)).map(|_| random.cube(range)).collect();
            for _ in 0..60 {
                check(&mut sweep, &boxes);
                match random.below(6) {
                    // All move a little, or not at all.
                    0..=2 => {
                        for value in &mut boxes {
                            let step = [(); 3].map(|()| random.below(3) as f32 - 1.0);
                            for axis in 0..3 {
                                value.lo[axis] += step[axis];
                                value.hi[axis] += step[axis];
                            }
                        }
                    }
                    // All jump.
                    3 => boxes
                        .iter_mut()
                        .for_each(|value| *value = random.cube(range)),
                    4 => boxes.extend(
                        (0..random.below(8))
                            .map(|_| random.cube(range))
                            .collect::<Vec<_>>(),
                    ),
                    // Several go between two queries, perhaps one that was just added.
                    _ => {
                        boxes.push(random.cube(range));
                        for _ in 0..random.below(4) {
                            if !boxes.is_empty() {
                                let rank = random.below(boxes.len() as u32);
                                sweep.remove(Rank(rank));
                                boxes.remove(rank as usize);
                            }
                        }
                        boxes.extend(
                            (0..random.below(3))
                                .map(|_| random.cube(range))
                                .collect::<Vec<_>>(),
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn holds_overlapping_pairs_only() {
        // A row of 2,000 boxes, each touching the next: 2 million pairs, 1,999 of them overlapping.
        let row: Vec<Aabb> = (0..2000)
            .map(|i| Aabb {
                lo: [i as f32, 0.0, 0.0],
                hi: [i as f32 + 1.0, 1.0, 1.0],
            })
            .collect();
        let mut sweep = SweepAndPrune::default();
        check(&mut sweep, &row);
        assert_eq!(sweep.pairs.len(), 1999);
        let shifted: Vec<Aabb> = row
            .iter()
            .map(|b| Aabb {
                lo: b.lo.map(|x| x + 0.25),
                hi: b.hi.map(|x| x + 0.25),
            })
            .collect();
        check(&mut sweep, &shifted);
    }

    #[test]
    fn coherent_motion_is_sorted_by_few_exchanges() {
        let row = |shift: f32| -> Vec<Aabb> {
            let lo = (0..1000).map(|i| [i as f32 + shift * (i % 3) as f32, 0.0, 0.0]);
            lo.map(|lo| Aabb {
                lo,
                hi: lo.map(|x| x + 0.7),
            })
            .collect()
        };
        let mut sweep = SweepAndPrune::default();
        let never = Interrupt::default();
        assert!(sweep.overlapping(&row(0.0), MANY, &never).is_continue());
        for step in 1..10 {
            let boxes = row(step as f32 * 0.05);
            check(&mut sweep, &boxes);
        }
        // Each body passes few others: exchanges for a hundred bodies would be enough for all
        // steps.
        for (axis, ends) in sweep.axes.iter_mut().enumerate() {
            for end in ends {
                let value = &row(0.6)[end.body().index()];
                end.value = if end.is_upper() {
                    value.hi[axis]
                } else {
                    value.lo[axis]
                };
            }
        }
        let mut budget = 1000;
        assert_eq!(
            sweep.sort_by_exchanges(&row(0.6), MANY, &mut budget, &never),
            ControlFlow::Continue(true),
            "sorted within the budget"
        );
        assert!(budget < 1000, "and not for nothing");
        // The jump of all bodies to the other end is beyond any budget.
        let mut reversed = row(0.6);
        reversed.reverse();
        for ends in &mut sweep.axes[..1] {
            for end in ends {
                let value = &reversed[end.body().index()];
                end.value = if end.is_upper() {
                    value.hi[0]
                } else {
                    value.lo[0]
                };
            }
        }
        let sorted = sweep.sort_by_exchanges(&reversed, MANY, &mut 16_000, &never);
        assert_eq!(sorted, ControlFlow::Continue(false));
        // Interrupted, it says so.
        let question = || true;
        let interrupt = Interrupt::new(Some(&question));
        let outcome = sweep.overlapping(&reversed, MANY, &interrupt);
        assert_eq!(outcome, ControlFlow::Break(Unfinished::Interrupted));
    }
}
