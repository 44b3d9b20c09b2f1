//! Rigid motion of a body: the path of its centre, and its rotation.

use crate::rng::Rng;
use crate::trig::{cos, sin};
use crate::vector::{Vec3, add, between, dot};

/// A point in time of a scene.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Moment {
    /// Number of the step, from 1.
    pub(crate) step: f64,
    /// Progress of the motion: 0 at the first step, 1 at the last.
    pub(crate) progress: f64,
}

impl Moment {
    /// The moment of a step in a motion of `steps` steps; clamped to the first and the last.
    pub(crate) fn of(step: u32, steps: u32) -> Self {
        let step = f64::from(step.clamp(1, steps));
        Self {
            step,
            progress: (step - 1.0) / f64::from(steps - 1),
        }
    }
}

/// Path of the centre of a body.
#[derive(Debug)]
pub(crate) enum Path {
    /// A straight line between two points, from the first step to the last, at constant speed.
    Straight { from: Vec3, to: Vec3 },
    /// An oscillation round a point, along each axis at its own rate.
    Sway {
        home: Vec3,
        reach: f64,
        phases: Vec3,
        rates: Vec3,
    },
}

impl Path {
    /// Draws a sway of `reach` along each axis, with a period within `steps` (shortest, longest).
    pub(crate) fn sway(rng: &mut Rng, home: Vec3, reach: f64, steps: (f64, f64)) -> Self {
        let phases = std::array::from_fn(|_| rng.angle());
        let rate = std::f64::consts::TAU;
        let rates = std::array::from_fn(|_| rng.either_sign(rate / steps.1, rate / steps.0));
        Self::Sway {
            home,
            reach,
            phases,
            rates,
        }
    }

    fn centre(&self, now: Moment) -> Vec3 {
        match *self {
            Self::Straight { from, to } => between(from, to, now.progress),
            Self::Sway {
                home,
                reach,
                phases,
                rates,
            } => std::array::from_fn(|axis| {
                home[axis] + reach * sin(phases[axis] + rates[axis] * now.step)
            }),
        }
    }
}

/// A rotation about a fixed axis at constant speed.
#[derive(Debug)]
pub(crate) struct Spin {
    axis: Vec3,
    /// Angle at step 0, in radians.
    angle: f64,
    /// Radians per step.
    rate: f64,
}

impl Spin {
    /// No rotation.
    pub(crate) const NONE: Self = Self {
        axis: [0.0, 0.0, 1.0],
        angle: 0.0,
        rate: 0.0,
    };

    /// Draws a random axis and angle, and a speed of `slowest` to `fastest` radians per step,
    /// either way.
    pub(crate) fn new(rng: &mut Rng, slowest: f64, fastest: f64) -> Self {
        Self {
            axis: rng.direction(),
            angle: rng.angle(),
            rate: rng.either_sign(slowest, fastest),
        }
    }

    /// Rows of the rotation matrix of axis and angle (Rodrigues).
    fn rows(&self, now: Moment) -> [Vec3; 3] {
        let angle = self.angle + self.rate * now.step;
        let (s, c) = (sin(angle), cos(angle));
        let [x, y, z] = self.axis;
        let k = 1.0 - c;
        [
            [c + x * x * k, x * y * k - z * s, x * z * k + y * s],
            [y * x * k + z * s, c + y * y * k, y * z * k - x * s],
            [z * x * k - y * s, z * y * k + x * s, c + z * z * k],
        ]
    }
}

/// Rigid motion of a body at one moment: a map from the body's own frame to the world.
///
/// A scene computes in f64 and rounds once. Let `l` be a vertex's position in the body's own frame,
/// from [`local_positions`](crate::Scene::local_positions), and `w` its position in the world, from
/// [`positions`](crate::Scene::positions). Then `rotation · l + translation` differs from `w` by
/// two roundings to f32, and by f64 arithmetic, which is negligible. On every axis the difference
/// is at most 2⁻²⁴ (|l| + |w|), and a millionth of that. Here |l| is the length of `l`, and |w| the
/// magnitude of that coordinate of `w`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Rows of the rotation matrix; orthonormal to 1e-14.
    pub rotation: [[f64; 3]; 3],
    /// Origin of the body's own frame in the world.
    pub translation: [f64; 3],
}

impl Pose {
    pub(crate) fn new(spin: &Spin, path: &Path, now: Moment) -> Self {
        Self {
            rotation: spin.rows(now),
            translation: path.centre(now),
        }
    }

    /// Maps the point `p` of the body to the world, and rounds once to f32.
    #[inline]
    pub(crate) fn place(&self, p: Vec3) -> [f32; 3] {
        rounded(add(self.rotation.map(|row| dot(row, p)), self.translation))
    }
}

/// Rounds to f32, the precision of a scene.
#[inline]
pub(crate) fn rounded(p: Vec3) -> [f32; 3] {
    p.map(|x| x as f32)
}

#[cfg(test)]
mod tests {
    use super::{Moment, Path, Spin};
    use crate::rng::Rng;
    use crate::vector::{cross, dot};

    #[test]
    fn spins_are_rotations_about_their_axis() {
        let mut rng = Rng::new(1, 0, 0);
        for step in 1..=50 {
            let spin = Spin::new(&mut rng, 0.01, 0.1);
            let now = Moment {
                step: f64::from(step),
                progress: 0.0,
            };
            let [x, y, z] = spin.rows(now);
            assert!(
                (dot(x, cross(y, z)) - 1.0).abs() < 1e-14,
                "keeps volume and hand"
            );
            for (row, other, product) in [(x, x, 1.0), (y, y, 1.0), (x, y, 0.0), (y, z, 0.0)] {
                assert!((dot(row, other) - product).abs() < 1e-14);
            }
            for (axis, row) in [x, y, z].into_iter().enumerate() {
                assert!(
                    (dot(row, spin.axis) - spin.axis[axis]).abs() < 1e-14,
                    "the axis stays"
                );
            }
            let trace = x[0] + y[1] + z[2];
            let angle = spin.angle + spin.rate * now.step;
            assert!((trace - (1.0 + 2.0 * angle.cos())).abs() < 1e-13);
        }
    }

    #[test]
    fn a_straight_path_ends_where_it_should() {
        let (from, to) = ([1.0, 2.0, 3.0], [-1.0, 2.0, 4.0]);
        let path = Path::Straight { from, to };
        for (progress, expected) in [(0.0, from), (0.5, [0.0, 2.0, 3.5]), (1.0, to)] {
            let centre = path.centre(Moment {
                step: 7.0,
                progress,
            });
            assert_eq!(centre.map(f64::to_bits), expected.map(f64::to_bits));
        }
    }

    #[test]
    fn a_sway_stays_in_reach() {
        let path = Path::sway(
            &mut Rng::new(2, 0, 0),
            [1.0, 0.0, -1.0],
            0.25,
            (50.0, 100.0),
        );
        let mut widest: f64 = 0.0;
        for step in 1..=200 {
            let [x, y, z] = path.centre(Moment {
                step: f64::from(step),
                progress: 0.0,
            });
            widest = widest
                .max((x - 1.0).abs())
                .max(y.abs())
                .max((z + 1.0).abs());
        }
        assert!((0.24..=0.25).contains(&widest), "{widest}");
    }
}
