//! Folding sheet: a meander that closes, with small ripples on it.
//!
//! The cross-section is the *sine-generated curve*, the shape of a river's meander. Its direction
//! at arc length `s` is `bend · sin(2π waves · s)`. The curve is integrated from its direction, so
//! the cloth keeps its length whatever the bend.
//!
//! - From a bend of about 2.04 radians, neighbouring loops touch, ripples included.
//! - At 2.405, the first zero of the Bessel function J₀, all loops would lie in one place.
//! - The folds run at an angle to the rows of the mesh. Parallel to the columns, a row would stay
//!   in one plane, and where it met itself edges would be exactly coplanar.
//! - Ripples along the normal keep folds from touching along whole lines at once.

use crate::motion::Moment;
use crate::rng::Rng;
use crate::scene::Body;
use crate::trig::{cos, sin};
use crate::vector::Vec3;

/// Whole waves of the meander, with two loops each.
const WAVES: f64 = 4.0;

/// Side of the cloth.
const SIDE: f64 = 2.0;

/// Sine and cosine of the angle between the rows of the mesh and the cross-section.
///
/// The angle is 11 degrees; the numbers are from a Pythagorean triple.
const SLANT: (f64, f64) = (20.0 / 101.0, 99.0 / 101.0);

/// Plane waves that make the ripples.
const RIPPLES: usize = 6;

/// Root mean square of the ripples, in sides of the cloth.
const HEIGHT: f64 = 0.003;

/// Range of wave numbers, in radians per side of the cloth: 5 to 10 ripples.
const WAVE_NUMBER: (f64, f64) = (30.0, 60.0);

/// Range of speeds in radians per step, either way.
const SPEED: (f64, f64) = (0.02, 0.1);

/// A sheet that folds onto itself.
#[derive(Debug)]
pub(crate) struct FoldingSheet {
    /// Radians by which the meander bends: fast at first, then ever slower.
    fold: f64,
    /// Radians of additional bend, added evenly over all steps, so that the sheet never rests.
    press: f64,
    ripples: [Ripple; RIPPLES],
}

/// A plane wave over the sheet: sin(number · (cos, sin)·(x, y) + phase + speed · step).
#[derive(Debug)]
struct Ripple {
    vector: [f64; 2],
    phase: f64,
    speed: f64,
}

impl FoldingSheet {
    pub(crate) fn new(rng: &mut Rng, fold: f64, press: f64) -> Self {
        let ripples = std::array::from_fn(|_| {
            let (number, angle) = (rng.between(WAVE_NUMBER.0, WAVE_NUMBER.1), rng.angle());
            Ripple {
                vector: [number * cos(angle), number * sin(angle)],
                phase: rng.angle(),
                speed: rng.either_sign(SPEED.0, SPEED.1),
            }
        });
        Self {
            fold,
            press,
            ripples,
        }
    }

    /// Largest angle of the cross-section's direction, in radians.
    fn bend(&self, now: Moment) -> f64 {
        let ahead = 1.0 - now.progress;
        let ahead = ahead * ahead * ahead * ahead;
        self.fold * (1.0 - ahead * ahead) + self.press * now.progress
    }

    /// Height of the ripples over the point (x, y) of the unit square.
    fn ripple(&self, now: Moment, [x, y, _]: Vec3) -> f64 {
        let wave =
            |r: &Ripple| sin(r.vector[0] * x + r.vector[1] * y + r.phase + r.speed * now.step);
        let sum: f64 = self.ripples.iter().map(wave).sum();
        HEIGHT * (2.0 / RIPPLES as f64).sqrt() * sum
    }
}

impl Body for FoldingSheet {
    fn place(&self, now: Moment, rest: &[Vec3], out: &mut [[f32; 3]]) {
        let columns = rest.len().isqrt();
        let spacing = 1.0 / (columns - 1) as f64;
        let bend = self.bend(now);
        // Point of the cross-section at the first vertex of the row.
        let mut first = [0.0, 0.0];
        for (rest, out) in rest.chunks(columns).zip(out.chunks_mut(columns)) {
            let [mut x, mut y] = first;
            for (point, out) in rest.iter().zip(out) {
                let (along, across) = turned(*point);
                let height = self.ripple(now, *point);
                let direction = direction(bend, along);
                let place = [
                    x - height * sin(direction),
                    y + height * cos(direction),
                    across,
                ];
                *out = place.map(|x| (SIDE * x) as f32);
                [x, y] = onward([x, y], bend, along, spacing * SLANT.1);
            }
            let (along, _) = turned(rest[0]);
            first = onward(first, bend, along, spacing * SLANT.0);
        }
    }
}

/// Coordinates of a point of the unit square along and across the cross-section.
fn turned([x, y, _]: Vec3) -> (f64, f64) {
    let (sine, cosine) = SLANT;
    (cosine * x + sine * y, cosine * y - sine * x)
}

/// Direction of the cross-section in radians, at the length `along`.
fn direction(bend: f64, along: f64) -> f64 {
    bend * sin(std::f64::consts::TAU * WAVES * along)
}

/// Point of the cross-section a length of `step` beyond (x, y), which is at `along`.
fn onward([x, y]: [f64; 2], bend: f64, along: f64, step: f64) -> [f64; 2] {
    let direction = direction(bend, along + 0.5 * step);
    [x + step * cos(direction), y + step * sin(direction)]
}
