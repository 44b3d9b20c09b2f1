//! What the integration tests share: every configuration, and small bodies to try them on.

#![allow(dead_code, reason = "each test uses its part")]

use pliant::{
    BodyId, BroadPhase, Degree, Options, Pair, Partition, Scalar, Selection, Update, World,
};
use std::num::NonZeroU32;

/// How much of something long a test goes through: all of it if the environment variable THOROUGH is set, else one part in so many.
pub(crate) fn share(all: usize, of: usize) -> usize {
    if is_thorough() { all } else { all / of }
}

/// Whether tests take all there is, which is more than every commit has to wait for.
pub(crate) fn is_thorough() -> bool {
    std::env::var_os("THOROUGH").is_some()
}

/// A body in motion: triangles and one list of positions a frame.
#[derive(Clone, Debug)]
pub(crate) struct Motion {
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) frames: Vec<Vec<[f32; 3]>>,
}

/// Every degree, partition, leaf size, update and broad phase.
pub(crate) fn every_configuration() -> Vec<Options> {
    let hybrid = |level, at_once| Update::Hybrid {
        level,
        levels_at_once: NonZeroU32::new(at_once).unwrap(),
    };
    let mut all = Vec::new();
    for degree in [Degree::Two, Degree::Four, Degree::Eight] {
        for partition in [
            Partition::Centre,
            Partition::Mean,
            Partition::Balanced,
            Partition::Connectivity,
        ] {
            for leaf_size in [1, 3, 8, 20] {
                for update in [
                    Update::BottomUp,
                    Update::TopDown,
                    Update::HYBRID,
                    hybrid(Some(1), 2),
                    hybrid(Some(99), 1),
                    hybrid(None, 9),
                ] {
                    // Sweep and prune and the tree take turns: what they find does not depend on the rest.
                    let turn = all.len() / 2 % 2;
                    let another = [BroadPhase::SweepAndPrune, BroadPhase::Tree][turn];
                    for broad_phase in [BroadPhase::BruteForce, another] {
                        let mut options = Options::default();
                        options.degree = degree;
                        options.partition = partition;
                        options.leaf_size = NonZeroU32::new(leaf_size).unwrap();
                        options.update = update;
                        options.broad_phase = broad_phase;
                        all.push(options);
                    }
                }
            }
        }
    }
    all
}

/// The same values, exactly.
pub(crate) fn widened(positions: &[[f32; 3]]) -> Vec<[f64; 3]> {
    positions
        .iter()
        .map(|position| position.map(f64::from))
        .collect()
}

/// A world with these bodies at their first frame.
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

/// The pairs of two bodies, or of one with itself, whose bodies are known.
pub(crate) trait TrianglesOf {
    /// All of them.
    fn triangles_of(&mut self, of: Selection) -> Vec<[u32; 2]>;

    /// Some of them.
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

/// A small deterministic source of numbers.
pub(crate) struct Lcg(pub(crate) u64);

impl Lcg {
    pub(crate) fn below(&mut self, range: u32) -> u32 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as u32 % range
    }

    /// In [0, 1), a multiple of 2^-20.
    pub(crate) fn unit(&mut self) -> f32 {
        self.below(1 << 20) as f32 / (1 << 20) as f32
    }
}

/// A flat square sheet of 2 (side - 1)^2 triangles in the plane z = 0, of edge length 1.
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
