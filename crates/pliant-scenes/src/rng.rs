//! Random number generator of the scenes: splitmix64 (Steele, Lea and Flood 2014).
//!
//! It is small, needs no warm-up, and is the same everywhere. Every body draws from its own stream:
//! body 5 is the same in scenes of ten and of a thousand bodies.

use crate::vector::{Vec3, dot, scale};

/// The increment of splitmix64: 2⁶⁴ divided by the golden ratio.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// A stream of random numbers.
#[derive(Debug, Clone)]
pub(crate) struct Rng {
    state: u64,
}

impl Rng {
    /// The stream numbered `stream` of the scene numbered `scene`.
    pub(crate) fn new(seed: u64, scene: u64, stream: u64) -> Self {
        let state = [scene, stream]
            .into_iter()
            .fold(mix(seed), |state, number| {
                mix(state ^ number.wrapping_mul(GOLDEN))
            });
        Self { state }
    }

    /// Uniform over all 2⁶⁴ values.
    pub(crate) fn next(&mut self) -> u64 {
        self.state = self.state.wrapping_add(GOLDEN);
        mix(self.state)
    }

    /// Uniform in [`low`, `high`).
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        let unit = (self.next() >> 11) as f64 * (1.0 / (1_u64 << 53) as f64);
        low + (high - low) * unit
    }

    /// Uniform in [`low`, `high`), with a random sign.
    pub(crate) fn either_sign(&mut self, low: f64, high: f64) -> f64 {
        let size = self.between(low, high);
        if self.next() >> 63 == 0 { size } else { -size }
    }

    /// Uniform angle in a full turn, in radians.
    pub(crate) fn angle(&mut self) -> f64 {
        self.between(0.0, std::f64::consts::TAU)
    }

    /// Uniform unit vector: a random point of the ball, pushed to the surface.
    pub(crate) fn direction(&mut self) -> Vec3 {
        loop {
            let point: Vec3 = std::array::from_fn(|_| self.between(-1.0, 1.0));
            let square = dot(point, point);
            if (0.01..=1.0).contains(&square) {
                return scale(point, 1.0 / square.sqrt());
            }
        }
    }
}

/// Output function of splitmix64: a bijection in which every bit depends on every bit.
fn mix(z: u64) -> u64 {
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::Rng;
    use crate::vector::dot;

    #[test]
    fn is_splitmix64() {
        // The first outputs for state 0, as published with the generator.
        let mut rng = Rng { state: 0 };
        assert_eq!(rng.next(), 0xe220_a839_7b1d_cdaf);
        assert_eq!(rng.next(), 0x6e78_9e6a_a1b9_65f4);
        assert_eq!(rng.next(), 0x06c4_5d18_8009_454f);
    }

    #[test]
    fn streams_differ() {
        let first = |seed, scene, stream| Rng::new(seed, scene, stream).next();
        let mut all: Vec<u64> = (0..4)
            .flat_map(|seed| (0..4).flat_map(move |scene| (0..64).map(move |b| (seed, scene, b))))
            .map(|(seed, scene, stream)| first(seed, scene, stream))
            .collect();
        let drawn = all.len();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), drawn);
    }

    #[test]
    fn directions_are_unit_vectors_without_a_favourite() {
        let mut rng = Rng::new(1, 2, 3);
        let mut mean = [0.0; 3];
        for _ in 0..10_000 {
            let d = rng.direction();
            assert!((dot(d, d) - 1.0).abs() < 1e-15);
            (0..3).for_each(|axis| mean[axis] += d[axis] / 10_000.0);
        }
        assert!(mean.iter().all(|m| m.abs() < 0.03), "{mean:?}");
    }
}
