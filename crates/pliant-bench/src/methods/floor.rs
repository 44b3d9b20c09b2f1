//! Lower bound on the time of any method: one pass over the vertices, and the true pairs decided
//! and sorted.
//!
//! In the first round another method computes the pairs, which are kept for this one. From then on,
//! a step is one pass over all vertices that finds the smallest and largest coordinates, with the
//! widest registers of the machine. If asked for, it also decides the intersecting pairs by the
//! frozen test, in random order, and sorts them.

use crate::decision::exact;
use crate::method::{Counters, Method, Pair};
use crate::motion::{BodyMesh, Shape};
use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, f32x8};

/// A yardstick rather than a method: it knows the answers beforehand.
pub struct Floor {
    /// Method that finds the answers in the first round.
    teller: Box<dyn Method>,
    /// Whether pairs are of bodies with themselves.
    itself: bool,
    /// Whether pairs are decided and sorted, or only vertices are read.
    decides: bool,
    /// Number of steps in a round.
    steps: usize,
    /// Pairs of each step in random order, as far as the first round has come.
    known: Vec<Vec<Pair>>,
    /// Number of steps played.
    played: usize,
    triangles: Vec<Vec<[u32; 3]>>,
    pairs: Vec<Pair>,
    keys: Vec<u64>,
    counters: Counters,
}

impl Floor {
    /// A floor for `steps` steps in every round, whose answers `teller` finds.
    ///
    /// Pairs are of bodies with themselves if `itself`. Without `decides` there is only the pass
    /// over the vertices.
    pub fn new(teller: impl Method + 'static, steps: usize, itself: bool, decides: bool) -> Self {
        Self {
            teller: Box::new(teller),
            itself,
            decides,
            steps,
            known: Vec::new(),
            played: 0,
            triangles: Vec::new(),
            pairs: Vec::new(),
            keys: Vec::new(),
            counters: Counters::default(),
        }
    }

    /// Finds the answer of a step in the first round, and shuffles it.
    fn learn(&mut self, shapes: &[Shape<'_>]) {
        self.teller.step(shapes);
        let mut pairs = if self.itself {
            self.teller.self_pairs().unwrap_or_default().to_vec()
        } else {
            self.teller.all_pairs().to_vec()
        };
        let mut state = 1_u64;
        for place in (1..pairs.len()).rev() {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            pairs.swap(place, (state >> 33) as usize % (place + 1));
        }
        self.known.push(pairs);
    }
}

impl Method for Floor {
    fn name(&self) -> String {
        if self.decides {
            "one pass over the vertices, the frozen decision of the true pairs, sorting them"
                .to_owned()
        } else {
            "one pass over the vertices".to_owned()
        }
    }

    fn build(&mut self, bodies: &[BodyMesh<'_>]) {
        self.teller.build(bodies);
        self.triangles = bodies.iter().map(|body| body.triangles.to_vec()).collect();
    }

    fn step(&mut self, shapes: &[Shape<'_>]) {
        let step = self.played % self.steps;
        self.played += 1;
        if step == self.known.len() {
            self.learn(shapes);
        }
        let level = Level::new();
        for shape in shapes {
            std::hint::black_box(dispatch!(level, i => extent(i, shape.world)));
            self.counters.boxes += 1;
        }
        if !self.decides {
            // Only the first round asks for the answer. Copying it is no work of a step.
            if self.played <= self.steps {
                self.pairs.clone_from(&self.known[step]);
                self.pairs.sort_unstable();
            }
            return;
        }
        let corners = |body: u32, triangle: u32| {
            self.triangles[body as usize][triangle as usize]
                .map(|vertex| shapes[body as usize].world[vertex as usize])
        };
        self.keys.clear();
        for &[body_a, a, body_b, b] in &self.known[step] {
            if exact(&corners(body_a, a), &corners(body_b, b)) {
                // The numbers of all scenes fit.
                self.keys.push(
                    u64::from(body_a) << 56
                        | u64::from(a) << 32
                        | u64::from(body_b) << 24
                        | u64::from(b),
                );
            }
        }
        self.counters.decisions += self.known[step].len() as u64;
        self.keys.sort_unstable();
        self.pairs.clear();
        let low = |key: u64| (key & 0xff_ffff) as u32;
        self.pairs.extend(self.keys.iter().map(|&key| {
            [
                (key >> 56) as u32,
                low(key >> 32),
                (key >> 24 & 0xff) as u32,
                low(key),
            ]
        }));
    }

    fn all_pairs(&mut self) -> &[Pair] {
        &self.pairs
    }

    fn first_pair(&mut self) -> Option<Pair> {
        self.pairs.first().copied()
    }

    fn self_pairs(&mut self) -> Option<&[Pair]> {
        Some(&self.pairs)
    }

    fn take_counters(&mut self) -> Counters {
        std::mem::take(&mut self.counters)
    }
}

/// Smallest and largest coordinates.
#[inline(always)]
fn extent<I: Simd>(i: I, positions: &[[f32; 3]]) -> [[f32; 3]; 2] {
    let (mut lo, mut hi) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    let (chunks, rest) = positions.as_flattened().as_chunks::<24>();
    let mut lows = [f32x8::splat(i, f32::INFINITY); 3];
    let mut highs = [f32x8::splat(i, f32::NEG_INFINITY); 3];
    for chunk in chunks {
        for third in 0..3 {
            let eight = f32x8::from_slice(i, &chunk[8 * third..8 * third + 8]);
            lows[third] = lows[third].min(eight);
            highs[third] = highs[third].max(eight);
        }
    }
    for third in 0..3 {
        for lane in 0..8 {
            let axis = (8 * third + lane) % 3;
            lo[axis] = lo[axis].min(lows[third].as_slice()[lane]);
            hi[axis] = hi[axis].max(highs[third].as_slice()[lane]);
        }
    }
    for (place, &x) in rest.iter().enumerate() {
        lo[place % 3] = lo[place % 3].min(x);
        hi[place % 3] = hi[place % 3].max(x);
    }
    [lo, hi]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pass_finds_the_smallest_and_the_largest() {
        for count in [1_u32, 7, 8, 9, 100] {
            let positions: Vec<[f32; 3]> = (0..count)
                .map(|k| [0, 1, 2].map(|axis| ((k * 37 + axis * 11) % 101) as f32 - 50.0))
                .collect();
            let mut expected = [positions[0]; 2];
            for point in &positions {
                for axis in 0..3 {
                    expected[0][axis] = expected[0][axis].min(point[axis]);
                    expected[1][axis] = expected[1][axis].max(point[axis]);
                }
            }
            let found = dispatch!(Level::new(), i => extent(i, &positions));
            assert_eq!(found, expected, "{count}");
        }
    }
}
