//! The folding sheet: a meander that closes, with small ripples on it.
//!
//! The cross-section is the *sine-generated curve*, the shape of a river's meander: its direction
//! at the length `s` is `bend · sin(2π waves · s)`. It is drawn by its direction, so the cloth
//! keeps its length whatever the bend. From a bend of about 2.04 radians on neighbouring loops
//! touch, ripples included; at 2.405, the first zero of the Bessel function J₀, the curve would get
//! no farther at all and all loops would lie in one place.
//!
//! Two things keep contacts generic. The folds run aslant to the rows of the mesh; if they ran along
//! the columns, a row would stay in one plane, and where it met itself edges would lie in the plane
//! of edges, to the bit. And ripples along the normal keep the folds from touching along whole lines
//! at once.

use crate::motion::Moment;
use crate::rng::Rng;
use crate::scene::Body;
use crate::trig::{cos, sin};
use crate::vector::Vec3;

/// Whole waves of the meander, each two loops.
const WAVES: f64 = 4.0;

/// The side of the cloth.
const SIDE: f64 = 2.0;

/// Sine and cosine of the angle between the rows of the mesh and the cross-section, 11 degrees: a
/// Pythagorean triple.
const SLANT: (f64, f64) = (20.0 / 101.0, 99.0 / 101.0);

/// Plane waves that make the ripples.
const RIPPLES: usize = 6;

/// Root mean square of the ripples, in sides of the cloth.
const HEIGHT: f64 = 0.003;

/// Radians over one side of the cloth: 5 to 10 ripples.
const WAVE_NUMBER: (f64, f64) = (30.0, 60.0);

/// Radians a step, either way.
const SPEED: (f64, f64) = (0.02, 0.1);

/// A sheet that folds onto itself.
#[derive(Debug)]
pub(crate) struct FoldingSheet {
    /// Radians by which the meander bends at first: fast, then ever slower.
    fold: f64,
    /// Radians by which it bends besides, the same at every step, so that it never rests.
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

    /// The largest direction of the cross-section, in radians.
    fn bend(&self, now: Moment) -> f64 {
        let ahead = 1.0 - now.progress;
        let ahead = ahead * ahead * ahead * ahead;
        self.fold * (1.0 - ahead * ahead) + self.press * now.progress
    }

    /// The height of the ripples over the point (x, y) of the unit square.
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
        // Where the cross-section is at the first vertex of the row.
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

/// A point of the unit square, along the cross-section and across it.
fn turned([x, y, _]: Vec3) -> (f64, f64) {
    let (sine, cosine) = SLANT;
    (cosine * x + sine * y, cosine * y - sine * x)
}

/// The direction of the cross-section, in radians, at the length `along`.
fn direction(bend: f64, along: f64) -> f64 {
    bend * sin(std::f64::consts::TAU * WAVES * along)
}

/// The point of the cross-section a length of `step` after (x, y), which is at `along`.
fn onward([x, y]: [f64; 2], bend: f64, along: f64, step: f64) -> [f64; 2] {
    let direction = direction(bend, along + 0.5 * step);
    [x + step * cos(direction), y + step * sin(direction)]
}
