//! Bumps that wander over a sphere: a sum of plane waves that travel through it.
//!
//! The height at the unit vector `v` is Σ a sin(k d·v + phase + speed · step). Each wave has a
//! random direction `d` and wave number `k`. The bumps stay smooth and of one size everywhere,
//! whereas a wave in longitude and latitude would crowd at the poles. They never repeat, and are
//! the same for every size of mesh.

use crate::rng::Rng;
use crate::trig::sin;
use crate::vector::{Vec3, dot, scale};

/// Points raised at once, so that the compiler can compute the sines in SIMD lanes.
pub(crate) const LANES: usize = 8;

/// Waves of one body: enough that no single one is seen.
const WAVES: usize = 24;

/// Range of wave numbers, in radians per unit of length: bumps about half a radius wide.
const WAVE_NUMBER: (f64, f64) = (9.0, 15.0);

/// Range of speeds, in radians per step, either way: a bump rises and falls in 125 to 630 steps.
const SPEED: (f64, f64) = (0.01, 0.05);

/// Height field on the unit sphere that changes with the step.
#[derive(Debug)]
pub(crate) struct Bumps {
    waves: [Wave; WAVES],
    amplitude: f64,
}

/// A plane wave.
#[derive(Debug)]
struct Wave {
    /// Direction times wave number.
    vector: Vec3,
    phase: f64,
    speed: f64,
}

impl Bumps {
    /// Draws random bumps; `height` is their root mean square.
    pub(crate) fn new(rng: &mut Rng, height: f64) -> Self {
        let waves = std::array::from_fn(|_| Wave {
            vector: scale(rng.direction(), rng.between(WAVE_NUMBER.0, WAVE_NUMBER.1)),
            phase: rng.angle(),
            speed: rng.either_sign(SPEED.0, SPEED.1),
        });
        // The mean square of a sine is 1/2.
        Self {
            waves,
            amplitude: height * (2.0 / WAVES as f64).sqrt(),
        }
    }

    /// Heights over up to [`LANES`] unit vectors; lanes beyond them are meaningless.
    ///
    /// Each lane adds the waves in order, so its result does not depend on other lanes.
    pub(crate) fn heights(&self, step: f64, points: &[Vec3]) -> [f64; LANES] {
        let mut block = [[0.0; 3]; LANES];
        block[..points.len()].copy_from_slice(points);
        let mut sums = [0.0; LANES];
        for wave in &self.waves {
            let phase = wave.phase + wave.speed * step;
            for (sum, point) in sums.iter_mut().zip(&block) {
                *sum += sin(dot(wave.vector, *point) + phase);
            }
        }
        sums.map(|sum| sum * self.amplitude)
    }
}

#[cfg(test)]
mod tests {
    use super::{Bumps, LANES};
    use crate::rng::Rng;
    use crate::surface::sphere;

    #[test]
    fn have_the_height_asked_for() {
        let rest = sphere(5_120).unwrap().rest;
        let squares: Vec<f64> = (0..20)
            .flat_map(|body| {
                let bumps = Bumps::new(&mut Rng::new(3, 0, body), 0.09);
                let heights = rest.chunks(LANES).flat_map(move |points| {
                    bumps.heights(17.0, points).into_iter().take(points.len())
                });
                heights.map(|h| h * h).collect::<Vec<_>>()
            })
            .collect();
        let mean = squares.iter().sum::<f64>() / squares.len() as f64;
        assert!((mean.sqrt() - 0.09).abs() < 0.005, "{}", mean.sqrt());
    }

    #[test]
    fn do_not_depend_on_the_company() {
        let bumps = Bumps::new(&mut Rng::new(4, 0, 0), 0.1);
        let rest = sphere(80).unwrap().rest;
        let together = bumps.heights(5.0, &rest[..LANES]);
        for (lane, point) in rest[..LANES].iter().enumerate() {
            assert_eq!(
                bumps.heights(5.0, &[*point])[0].to_bits(),
                together[lane].to_bits()
            );
        }
    }
}
