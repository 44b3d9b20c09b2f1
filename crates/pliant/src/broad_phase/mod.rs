//! Broad phase: from the boxes of all bodies to the pairs of bodies whose boxes overlap (paper,
//! 3.4).
//!
//! Bodies are numbered by rank, the order of their ids. A body's box is its exact one, or a loose
//! one that stands still and holds every pose. Pairs come in order, the smaller rank first. They
//! come row by row, so that callers hold as many at once as they like; sweep and prune returns its
//! whole list. A row is a body with the bodies after it.

mod body_tree;
mod brute_force;
mod overlap;
mod rows;
mod sweep_and_prune;

use crate::held::held;
use crate::ids::Rank;
use crate::kernels::Instructions;
use crate::threads::{Executor, Interrupt};
use body_tree::BodyTree;
pub(crate) use overlap::{Boxes, Overlap};
use rows::Pass;
pub(crate) use rows::{Keep, Show};
use std::ops::ControlFlow;
use sweep_and_prune::{SweepAndPrune, Unfinished};

/// The most bodies for which comparing all pairs is as good as any other way; "approximately 100"
/// (paper, 3.4).
const MOST_FOR_BRUTE_FORCE: usize = 100;
/// The most pairs per body that sweep and prune keeps. Beyond, with many bodies in one place, the
/// tree takes over.
const MOST_PAIRS_A_BODY: usize = 16;

/// Broad phase of a world, and its memory between passes.
#[derive(Debug)]
pub(crate) struct BroadPhase {
    rule: crate::BroadPhase,
    way: Way,
    sweep: SweepAndPrune,
    tree: BodyTree,
    pass: Pass,
}

/// Algorithm by which a pass finds its pairs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    BruteForce,
    Sweep,
    Tree,
}

impl BroadPhase {
    pub(crate) fn new(rule: crate::BroadPhase) -> Self {
        Self {
            rule,
            way: Way::BruteForce,
            sweep: SweepAndPrune::default(),
            tree: BodyTree::default(),
            pass: Pass::default(),
        }
    }

    /// Begins a pass over the boxes of all bodies, by rank. Interrupted, it begins anew the next
    /// time.
    ///
    /// The bodies are the last pass's without the ones removed by [`BroadPhase::remove`], and then
    /// added bodies at the end.
    pub(crate) fn begin(&mut self, boxes: Boxes, interrupt: &Interrupt) {
        let of_bodies = boxes.of_bodies;
        self.pass.begin(of_bodies.len());
        self.way = match self.rule {
            crate::BroadPhase::Auto if of_bodies.len() > MOST_FOR_BRUTE_FORCE => Way::Tree,
            crate::BroadPhase::Auto | crate::BroadPhase::BruteForce => Way::BruteForce,
            crate::BroadPhase::SweepAndPrune => Way::Sweep,
            crate::BroadPhase::Tree => Way::Tree,
        };
        if self.way == Way::Sweep {
            let most = of_bodies.len() * MOST_PAIRS_A_BODY;
            let found = self.sweep.overlapping(of_bodies, most, interrupt);
            if let ControlFlow::Break(why) = found {
                self.sweep = SweepAndPrune::default();
                if why == Unfinished::TooMany {
                    self.way = Way::Tree;
                }
            }
        }
        if self.way == Way::Tree {
            self.tree.refit(boxes);
        }
    }

    /// Shows the next pairs of the pass that are kept, in order, about `most` at once. Returns
    /// whether more may follow. Pairs of different environments may come or not.
    ///
    /// A call looks at all pairs of at least one body. After an interruption it returns true.
    pub(crate) fn next(
        &mut self,
        threads: (Executor, Instructions),
        boxes: Boxes,
        (most, keep): (usize, Keep),
        show: Show,
    ) -> bool {
        if self.way == Way::Sweep {
            let kept = self.sweep.pairs.chunks(1).filter(|pair| keep(pair[0]));
            kept.for_each(show);
            return false;
        }
        let tree = (self.way == Way::Tree).then_some(&self.tree);
        let done = self.pass.next(threads, tree, boxes, (most, keep), show);
        if let Some(tested) = done
            && self.way == Way::Tree
        {
            self.tree.end_of_pass(tested);
        }
        done.is_none()
    }

    /// Has the bodies ordered anew, because some are in other environments.
    pub(crate) fn regroup(&mut self) {
        self.tree.forget_order();
    }

    /// Removes the body of a rank. The ranks of later bodies move down by one.
    pub(crate) fn remove(&mut self, rank: Rank) {
        self.sweep.remove(rank);
    }
}

held!(BroadPhase: sweep, tree, pass);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Aabb;
    use crate::threads::Threads;
    use std::num::NonZeroUsize;

    struct Lcg(u64);

    impl Lcg {
        fn below(&mut self, range: u32) -> u32 {
            self.0 = self
                .0
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 33) as u32 % range
        }

        /// A cube on a lattice, so that many faces are equal.
        fn cube(&mut self, range: u32) -> Aabb {
            let lo = [(); 3].map(|()| self.below(range) as f32);
            let hi = lo.map(|x| x + self.below(3) as f32);
            Aabb { lo, hi }
        }
    }

    const RULES: [crate::BroadPhase; 4] = [
        crate::BroadPhase::Auto,
        crate::BroadPhase::BruteForce,
        crate::BroadPhase::SweepAndPrune,
        crate::BroadPhase::Tree,
    ];

    /// All pairs of a pass on one thread.
    fn pairs(broad_phase: &mut BroadPhase, boxes: &[Aabb]) -> Vec<Overlap> {
        pairs_of(1, broad_phase, boxes)
    }

    /// All pairs of a pass, some at a time.
    fn pairs_of(threads: usize, broad_phase: &mut BroadPhase, boxes: &[Aabb]) -> Vec<Overlap> {
        let threads = &Threads::private(NonZeroUsize::new(threads).unwrap());
        let interrupt = &Interrupt::default();
        let executor = Executor { threads, interrupt };
        let boxes = Boxes {
            of_bodies: boxes,
            environments: &[],
        };
        broad_phase.begin(boxes, interrupt);
        let mut pairs = Vec::new();
        for (instructions, most) in Instructions::all().into_iter().cycle().zip(1..) {
            let any: (usize, Keep) = (40 * most, &|_| true);
            let show: Show = &mut |found| pairs.extend_from_slice(found);
            if !broad_phase.next((executor, instructions), boxes, any, show) {
                break;
            }
        }
        pairs
    }

    /// Expected pairs of a pass, by comparing all boxes.
    fn expected(boxes: &[Aabb]) -> Vec<Overlap> {
        let ranks = || (0..boxes.len() as u32).map(Rank);
        let later = |a: Rank| ranks().filter(move |&b| b > a).map(move |b| [a, b]);
        let overlap = |[a, b]: &Overlap| boxes[a.index()].overlaps(&boxes[b.index()]);
        ranks().flat_map(later).filter(overlap).collect()
    }

    #[test]
    fn every_rule_finds_all_pairs_in_order_whatever_bodies_do() {
        for seed in 0..12 {
            let mut random = Lcg(seed);
            let range = 8 + random.below(30);
            let mut all = RULES.map(BroadPhase::new);
            let mut boxes: Vec<Aabb> = (0..random.below(700)).map(|_| random.cube(range)).collect();
            for step in 0..30 {
                let expected = expected(&boxes);
                for broad_phase in &mut all {
                    for threads in [1, 1 + seed as usize % 5] {
                        let found = pairs_of(threads, broad_phase, &boxes);
                        assert_eq!(found, expected, "seed {seed}, step {step}, {threads}");
                    }
                }
                match random.below(6) {
                    // All move a little.
                    0..=2 => {
                        for value in &mut boxes {
                            let by = [(); 3].map(|()| random.below(3) as f32 - 1.0);
                            for axis in 0..3 {
                                value.lo[axis] += by[axis];
                                value.hi[axis] += by[axis];
                            }
                        }
                    }
                    // All jump, most of them into one place.
                    3 => {
                        for value in &mut boxes {
                            let to = if random.below(4) == 0 { range } else { 2 };
                            *value = random.cube(to);
                        }
                    }
                    4 => boxes.extend((0..random.below(99)).map(|_| random.cube(range))),
                    // Several go between two passes, perhaps one that was just added.
                    _ => {
                        boxes.push(random.cube(range));
                        for _ in 0..random.below(99) {
                            if !boxes.is_empty() {
                                let rank = random.below(boxes.len() as u32);
                                all.iter_mut()
                                    .for_each(|broad_phase| broad_phase.remove(Rank(rank)));
                                boxes.remove(rank as usize);
                            }
                        }
                        boxes.extend((0..random.below(9)).map(|_| random.cube(range)));
                    }
                }
            }
        }
    }

    #[test]
    fn boxes_without_end_overlap_what_they_hold() {
        let point = |x: f32| Aabb {
            lo: [x; 3],
            hi: [x; 3],
        };
        let everything = Aabb {
            lo: [f32::NEG_INFINITY; 3],
            hi: [f32::INFINITY; 3],
        };
        for count in [0, 1, 2, 8, 9, 64, 65, 600] {
            let mut boxes: Vec<Aabb> = (0..count)
                .map(|at| point((at * 7 % count) as f32))
                .collect();
            boxes.push(everything);
            for rule in RULES {
                let found = pairs(&mut BroadPhase::new(rule), &boxes);
                assert_eq!(found, expected(&boxes), "{count} {rule:?}");
            }
        }
    }

    /// Environments in one place cost what they cost apart, also when they change.
    #[test]
    fn environments_in_one_place_cost_what_they_cost_apart() {
        let threads = &Threads::private(NonZeroUsize::MIN);
        let interrupt = &Interrupt::default();
        let executor = Executor { threads, interrupt };
        let instructions = Instructions::all()[0];
        let mut random = Lcg(7);
        let bodies = |random: &mut Lcg| (0..3000).map(|_| random.cube(4)).collect::<Vec<_>>();
        let ask = |broad_phase: &mut BroadPhase, boxes: Boxes| {
            let environment = |rank: Rank| boxes.environments.get(rank.index());
            let keep: Keep = &|[a, b]| environment(a) == environment(b);
            let mut found = Vec::new();
            broad_phase.begin(boxes, interrupt);
            let more = (usize::MAX, keep);
            let show: Show = &mut |pairs| found.extend_from_slice(pairs);
            assert!(!broad_phase.next((executor, instructions), boxes, more, show));
            found
        };
        for _ in 0..3 {
            let of_bodies = bodies(&mut random);
            let environments: Vec<u32> = of_bodies.iter().map(|_| random.below(600)).collect();
            let apart = |(value, &by): (&Aabb, &u32)| {
                let by = 8.0 * by as f32;
                let [lo, hi] = [value.lo, value.hi].map(|[x, y, z]| [x + by, y, z]);
                Aabb { lo, hi }
            };
            let apart: Vec<Aabb> = of_bodies.iter().zip(&environments).map(apart).collect();
            let in_one_place = Boxes {
                of_bodies: &of_bodies,
                environments: &environments,
            };
            let far_apart = Boxes {
                of_bodies: &apart,
                environments: &[],
            };
            let [mut one, mut other] = [(); 2].map(|()| BroadPhase::new(crate::BroadPhase::Tree));
            let none = Boxes {
                environments: &[],
                ..in_one_place
            };
            assert!(ask(&mut one, none).len() > 500_000);
            one.regroup();
            let expected = ask(&mut other, far_apart);
            assert!(expected.len() > 1000, "{}", expected.len());
            assert_eq!(ask(&mut one, in_one_place), expected);
            let tested = [one.tree.tested(), other.tree.tested()];
            assert!(10 * tested[0] < 11 * tested[1], "{tested:?}");
        }
    }

    /// Bodies in a row, each apart from the next; or all in one place.
    fn row(count: usize, distance: f32) -> Vec<Aabb> {
        let lo = (0..count).map(|at| [at as f32 * distance; 3]);
        lo.map(|lo| Aabb {
            lo,
            hi: lo.map(|x| x + 0.5),
        })
        .collect()
    }

    #[test]
    fn the_number_of_bodies_chooses() {
        let mut broad_phase = BroadPhase::new(crate::BroadPhase::Auto);
        for (count, way) in [
            (100, Way::BruteForce),
            (101, Way::Tree),
            (100, Way::BruteForce),
        ] {
            assert!(pairs(&mut broad_phase, &row(count, 1.0)).is_empty());
            assert_eq!(broad_phase.way, way, "{count} bodies");
        }
    }

    #[test]
    fn many_bodies_in_one_place_are_not_swept() {
        let mut broad_phase = BroadPhase::new(crate::BroadPhase::SweepAndPrune);
        for (count, distance, way) in [
            (200, 1.0, Way::Sweep),
            (200, 0.0, Way::Tree),
            (30, 0.0, Way::Sweep),
            (200, 0.01, Way::Tree),
            (200, 1.0, Way::Sweep),
        ] {
            let boxes = row(count, distance);
            assert_eq!(pairs(&mut broad_phase, &boxes), expected(&boxes));
            assert_eq!(broad_phase.way, way, "{count} bodies, {distance}");
        }
    }

    /// A crowd in which everybody goes elsewhere keeps finding its neighbours among few nodes.
    #[test]
    fn a_tree_whose_order_is_worn_is_ordered_anew() {
        let mut random = Lcg(5);
        let mut boxes: Vec<Aabb> = (0..4096).map(|_| random.cube(300)).collect();
        let mut broad_phase = BroadPhase::new(crate::BroadPhase::Tree);
        let mut tested = Vec::new();
        for _ in 0..4 {
            for _ in 0..2 {
                assert_eq!(pairs(&mut broad_phase, &boxes), expected(&boxes));
                tested.push(broad_phase.tree.tested());
            }
            boxes.iter_mut().for_each(|value| *value = random.cube(300));
        }
        let first = tested[0];
        assert!(
            tested
                .iter()
                .skip(1)
                .step_by(2)
                .all(|&tested| tested < 2 * first)
        );
        assert!(tested[2] > 2 * first, "it was worn: {tested:?}");
    }
}
