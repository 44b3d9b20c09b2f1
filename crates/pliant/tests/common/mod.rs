//! Shared by the integration tests: every configuration, and small bodies to try them on.

#![allow(dead_code, reason = "each test uses its part")]

pub(crate) mod kinds;

use pliant::{
    BodyId, BroadPhase, Degree, Options, Pair, Partition, Scalar, Selection, Update, World,
};
use std::collections::BTreeSet;
use std::num::NonZeroU32;

/// The size of a long test: `all` if the environment variable `THOROUGH` is set, else `all / of`.
pub(crate) fn share(all: usize, of: usize) -> usize {
    if is_thorough() { all } else { all / of }
}

/// Whether tests run in full, which takes longer than every commit can wait for.
pub(crate) fn is_thorough() -> bool {
    std::env::var_os("THOROUGH").is_some()
}

/// A body in motion: triangles and one list of positions a frame.
#[derive(Clone, Debug)]
pub(crate) struct Motion {
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) frames: Vec<Vec<[f32; 3]>>,
}

/// How many values each choice of a configuration has: degree, partition, leaf size, update, broad
/// phase.
pub(crate) const CHOICES: [usize; 5] = [3, 4, 4, 6, 3];

/// The configuration with these values of the five choices.
fn configuration(values: &[usize]) -> Options {
    let &[degree, partition, leaf_size, update, broad_phase] = values else {
        panic!("five choices")
    };
    let hybrid = |level, at_once| Update::Hybrid {
        level,
        levels_at_once: NonZeroU32::new(at_once).unwrap(),
    };
    let mut options = Options::default();
    options.degree = [Degree::Two, Degree::Four, Degree::Eight][degree];
    options.partition = [
        Partition::Centre,
        Partition::Mean,
        Partition::Balanced,
        Partition::Connectivity,
    ][partition];
    options.leaf_size = NonZeroU32::new([1, 3, 8, 20][leaf_size]).unwrap();
    options.update = [
        Update::BottomUp,
        Update::TopDown,
        Update::HYBRID,
        hybrid(Some(1), 2),
        hybrid(Some(99), 1),
        hybrid(None, 9),
    ][update];
    options.broad_phase = [
        BroadPhase::BruteForce,
        BroadPhase::SweepAndPrune,
        BroadPhase::Tree,
    ][broad_phase];
    options
}

/// Every degree, partition, leaf size and update, each with brute force and another broad phase.
pub(crate) fn every_configuration() -> Vec<Options> {
    let with_two = |(place, values): (usize, Vec<usize>)| {
        // Sweep and prune and the tree take turns: what they find does not depend on the rest.
        [0, 1 + place % 2].map(|broad_phase| configuration(&[&values[..], &[broad_phase]].concat()))
    };
    let combinations = combinations(&CHOICES[..4]).into_iter().enumerate();
    combinations.flat_map(with_two).collect()
}

/// Configurations in which every two values of two choices occur together; if thorough, all of
/// them.
pub(crate) fn covering_configurations() -> Vec<Options> {
    if is_thorough() {
        return every_configuration();
    }
    let covering = covering(&CHOICES).into_iter();
    covering.map(|values| configuration(&values)).collect()
}

/// All combinations of one value of each choice; the last choice changes fastest.
pub(crate) fn combinations(choices: &[usize]) -> Vec<Vec<usize>> {
    let combination = |mut number: usize| {
        let mut values = vec![0; choices.len()];
        for (value, size) in values.iter_mut().zip(choices).rev() {
            *value = number % size;
            number /= size;
        }
        values
    };
    (0..choices.iter().product()).map(combination).collect()
}

/// Pairs of values in a combination, each as two choices and their values.
pub(crate) fn value_pairs(values: &[usize]) -> impl Iterator<Item = [usize; 4]> {
    let two = (0..values.len()).flat_map(move |a| (a + 1..values.len()).map(move |b| [a, b]));
    two.map(|[a, b]| [a, b, values[a], values[b]])
}

/// Covering array of strength two: combinations in which every two choices have all pairs of
/// values.
///
/// Most faults show with one value or with two together (Kuhn, Wallace and Gallo 2004). Greedy:
/// each combination has the most of the pairs that are still missing.
pub(crate) fn covering(choices: &[usize]) -> Vec<Vec<usize>> {
    let all = combinations(choices);
    let mut missing: BTreeSet<[usize; 4]> = all.iter().flat_map(|it| value_pairs(it)).collect();
    let mut chosen = Vec::new();
    while !missing.is_empty() {
        let has_missing = |values: &&Vec<usize>| {
            let pairs = value_pairs(values);
            pairs.filter(|pair| missing.contains(pair)).count()
        };
        let best = all.iter().rev().max_by_key(has_missing).unwrap();
        for pair in value_pairs(best) {
            missing.remove(&pair);
        }
        chosen.push(best.clone());
    }
    chosen
}

/// Whether every two choices have every pair of their values in one of the combinations.
pub(crate) fn covers_every_pair(choices: &[usize], combinations: &[Vec<usize>]) -> bool {
    let sizes = choices.iter().enumerate();
    let mut two = sizes
        .clone()
        .flat_map(|a| sizes.clone().skip(a.0 + 1).map(move |b| [a, b]));
    two.all(|[(a, &of_a), (b, &of_b)]| {
        let mut pairs = (0..of_a).flat_map(|i| (0..of_b).map(move |j| [i, j]));
        pairs.all(|pair| combinations.iter().any(|it| [it[a], it[b]] == pair))
    })
}

/// Positions in double precision, exactly the same values.
pub(crate) fn widened(positions: &[[f32; 3]]) -> Vec<[f64; 3]> {
    positions
        .iter()
        .map(|position| position.map(f64::from))
        .collect()
}

/// A world of these bodies, each with its triangles and positions.
pub(crate) fn world_of<S: Scalar>(
    options: Options,
    bodies: &[(&[[u32; 3]], Vec<[S; 3]>)],
) -> (World<S>, Vec<BodyId>) {
    let mut world = World::with_options(options);
    let ids = bodies
        .iter()
        .map(|(triangles, positions)| world.add(triangles, positions).unwrap())
        .collect();
    (world, ids)
}

/// Pairs of triangles of two bodies, or of one with itself, without the bodies.
pub(crate) trait TrianglesOf {
    /// All pairs of the selection.
    fn triangles_of(&mut self, of: Selection) -> Vec<[u32; 2]>;

    /// Any one pair of the selection.
    fn first_of(&mut self, of: Selection) -> Option<[u32; 2]>;
}

impl<S: Scalar> TrianglesOf for World<S> {
    fn triangles_of(&mut self, of: Selection) -> Vec<[u32; 2]> {
        let pairs = self.intersections(of).all().unwrap();
        for pair in pairs {
            match of {
                Selection::Between(a, b) => assert_eq!([pair.body_a, pair.body_b], [a, b]),
                Selection::Within(a) => assert_eq!([pair.body_a, pair.body_b], [a, a]),
                Selection::World | Selection::Everything => {}
            }
        }
        pairs.iter().map(Pair::triangles).collect()
    }

    fn first_of(&mut self, of: Selection) -> Option<[u32; 2]> {
        let pair = self.intersections(of).first().unwrap();
        pair.map(|pair| pair.triangles())
    }
}

/// Linear congruential generator: the same numbers for the same seed.
pub(crate) struct Lcg(pub(crate) u64);

impl Lcg {
    pub(crate) fn below(&mut self, range: u32) -> u32 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as u32 % range
    }

    /// A number in [0, 1), a multiple of 2^-20.
    pub(crate) fn unit(&mut self) -> f32 {
        self.below(1 << 20) as f32 / (1 << 20) as f32
    }
}

/// A flat square sheet in the plane z = 0, one unit wide, of 2 (side - 1)^2 triangles.
pub(crate) fn sheet(side: u32) -> (Vec<[u32; 3]>, Vec<[f32; 3]>) {
    let mut triangles = Vec::new();
    for y in 0..side - 1 {
        for x in 0..side - 1 {
            let corner = y * side + x;
            triangles.push([corner, corner + 1, corner + side]);
            triangles.push([corner + 1, corner + side + 1, corner + side]);
        }
    }
    let step = 1.0 / (side - 1) as f32;
    let positions = (0..side * side)
        .map(|i| [(i % side) as f32 * step, (i / side) as f32 * step, 0.0])
        .collect();
    (triangles, positions)
}
