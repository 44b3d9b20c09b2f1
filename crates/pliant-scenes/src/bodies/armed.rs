//! Body with several deforming arms, from the paper's third experiment (figures 5 and 6).
//!
//! An arm is a cap of the sphere, drawn out along its axis `u`. With `w` falling smoothly from 1 at
//! the tip to 0 at the rim, a point `v` of the cap moves to
//!
//! ```text
//! core · v + w · length · u + sideways(w)
//! ```
//!
//! The first two terms are a graph over the plane orthogonal to `u`. The third shifts each ring of
//! equal `w` as a whole, so an arm cannot intersect itself. Caps do not overlap, so arms meet
//! only where they swing far across; the small core leaves them room.

use crate::bumps::{Bumps, LANES};
use crate::motion::{Moment, Path, Pose, Spin, rounded};
use crate::rng::Rng;
use crate::scene::Body;
use crate::trig::{cos, sin};
use crate::vector::{Vec3, add, dot, scale, upright};

/// Arms of one body.
const ARMS: usize = 7;

/// Radius of the body without its arms; arms reach about 1.3.
const CORE: f64 = 0.55;

/// Root mean square of the bumps, in radii of the core.
const HEIGHT: f64 = 0.03;

/// Distance of a tip from the core: shortest and longest.
const LENGTH: (f64, f64) = (0.6, 0.9);

/// Amplitude of an arm's growth and shrinkage, relative to its length.
const PULSE: f64 = 0.25;

/// Amplitude of a tip's swing to each side.
const SWING: f64 = 0.22;

/// Phase by which the root of an arm is ahead of its tip, in radians.
///
/// More than a quarter turn, so that an arm is curved and not just slanted.
const CURL: f64 = 2.0;

/// Range of the rates of pulse and swing, in radians per step, either way.
const RATE: (f64, f64) = (0.03, 0.08);

/// A sphere with arms that turns and moves.
#[derive(Debug)]
pub(crate) struct ArmedSphere {
    bumps: Bumps,
    arms: [Arm; ARMS],
    spin: Spin,
    path: Path,
}

impl ArmedSphere {
    pub(crate) fn new(rng: &mut Rng, spin: Spin, path: Path) -> Self {
        let axes = spread_directions(rng);
        let rims = rims(&axes);
        let arms = std::array::from_fn(|arm| Arm::new(rng, axes[arm], rims[arm]));
        Self {
            bumps: Bumps::new(rng, HEIGHT),
            arms,
            spin,
            path,
        }
    }

    /// Points of the body in its own frame, each converted by `finish`.
    #[inline]
    fn shape(
        &self,
        now: Moment,
        rest: &[Vec3],
        out: &mut [[f32; 3]],
        finish: impl Fn(Vec3) -> [f32; 3],
    ) {
        let arms = self.arms.each_ref().map(|arm| arm.at(now));
        for (points, out) in rest.chunks(LANES).zip(out.chunks_mut(LANES)) {
            let heights = self.bumps.heights(now.step, points);
            for ((point, height), out) in points.iter().zip(heights).zip(out) {
                let core = scale(*point, CORE * (1.0 + height));
                let shape = arms
                    .iter()
                    .fold(core, |p, arm| add(p, arm.drawn_out(*point)));
                *out = finish(shape);
            }
        }
    }
}

impl Body for ArmedSphere {
    fn place(&self, now: Moment, rest: &[Vec3], out: &mut [[f32; 3]]) {
        let pose = Pose::new(&self.spin, &self.path, now);
        self.shape(now, rest, out, |p| pose.place(p));
    }

    fn pose(&self, now: Moment) -> Option<Pose> {
        Some(Pose::new(&self.spin, &self.path, now))
    }

    fn place_in_own_frame(&self, now: Moment, rest: &[Vec3], out: &mut [[f32; 3]]) {
        self.shape(now, rest, out, rounded);
    }
}

/// One arm: its cap, and the rhythm of its motion.
#[derive(Debug)]
struct Arm {
    /// Unit vector from the centre through the tip, and two directions to swing in.
    axis: Vec3,
    sides: [Vec3; 2],
    /// Cosine of the angle between the axis and the rim of the cap.
    rim: f64,
    length: f64,
    /// Phase in radians, and radians per step.
    pulse: (f64, f64),
    swing: (f64, f64),
}

impl Arm {
    fn new(rng: &mut Rng, axis: Vec3, rim: f64) -> Self {
        let (right, up) = upright(axis);
        let mut rhythm = || (rng.angle(), rng.either_sign(RATE.0, RATE.1));
        let (pulse, swing) = (rhythm(), rhythm());
        let length = rng.between(LENGTH.0, LENGTH.1);
        Self {
            axis,
            sides: [right, up],
            rim,
            length,
            pulse,
            swing,
        }
    }

    fn at(&self, now: Moment) -> ArmNow<'_> {
        let angle = |(phase, rate): (f64, f64)| phase + rate * now.step;
        ArmNow {
            arm: self,
            length: self.length * (1.0 + PULSE * sin(angle(self.pulse))),
            swing: angle(self.swing),
        }
    }
}

/// An arm at one moment.
struct ArmNow<'a> {
    arm: &'a Arm,
    length: f64,
    swing: f64,
}

impl ArmNow<'_> {
    /// Displacement of the point `v` of the sphere by the arm.
    #[inline]
    fn drawn_out(&self, v: Vec3) -> Vec3 {
        let inside = dot(self.arm.axis, v) - self.arm.rim;
        if inside <= 0.0 {
            return [0.0; 3];
        }
        let x = inside / (1.0 - self.arm.rim);
        let w = x * x;
        let angle = self.swing - CURL * w;
        let [right, up] = self.arm.sides;
        let reach = SWING * w;
        let sideways = add(
            scale(right, reach * cos(angle)),
            scale(up, reach * sin(angle)),
        );
        add(scale(self.arm.axis, self.length * w), sideways)
    }
}

/// Directions well apart: each is the one of many random ones that is farthest from all before.
fn spread_directions(rng: &mut Rng) -> [Vec3; ARMS] {
    const CANDIDATES: usize = 100;
    let mut axes = [rng.direction(); ARMS];
    for arm in 1..ARMS {
        let nearest = |v: Vec3| axes[..arm].iter().map(|u| dot(*u, v)).fold(-1.0, f64::max);
        let best = (0..CANDIDATES)
            .map(|_| rng.direction())
            .min_by(|a, b| nearest(*a).total_cmp(&nearest(*b)));
        axes[arm] = best.unwrap_or(axes[arm]);
    }
    axes
}

/// For each axis the cosine of half the angle to the nearest axis: caps touch, never overlap.
fn rims(axes: &[Vec3; ARMS]) -> [f64; ARMS] {
    std::array::from_fn(|arm| {
        let others = axes.iter().enumerate().filter(|(other, _)| *other != arm);
        let next = others.map(|(_, u)| dot(*u, axes[arm])).fold(-1.0, f64::max);
        (0.5 * (1.0 + next)).sqrt()
    })
}

#[cfg(test)]
mod tests {
    use super::{rims, spread_directions};
    use crate::rng::Rng;
    use crate::trig::cos;
    use crate::vector::dot;

    #[test]
    fn arms_have_room() {
        for body in 0..500 {
            let axes = spread_directions(&mut Rng::new(5, 0, body));
            let rims = rims(&axes);
            for (i, a) in axes.iter().enumerate() {
                // At least 22 degrees from axis to rim: an arm, not a hair.
                assert!(
                    rims[i] < cos(22_f64.to_radians()),
                    "body {body}, arm {i}: {}",
                    rims[i]
                );
                for (j, b) in axes.iter().enumerate().skip(i + 1) {
                    let (between, both) = (dot(*a, *b).acos(), rims[i].acos() + rims[j].acos());
                    assert!(
                        between >= both - 1e-9,
                        "body {body}: caps {i} and {j} overlap"
                    );
                }
            }
        }
    }
}
