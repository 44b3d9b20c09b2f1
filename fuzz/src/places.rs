//! Coordinates where exactness is hard: many exact coincidences, and both ends of the range.

use arbitrary::Arbitrary;

/// A map from small numbers to coordinates.
///
/// Every coordinate is finite and at most `f32::MAX`. Unless a variant says otherwise, it is exact
/// in f32.
#[derive(Arbitrary, Clone, Copy, Debug, PartialEq)]
pub enum Grid {
    /// Small integers: triangles that touch, overlap in a plane, repeat.
    Lattice,
    /// Three integers: nearly everything touches.
    Coarse,
    /// Small integers, scaled to the upper end of f32.
    Huge,
    /// Small integers, scaled to subnormal numbers.
    Tiny,
    /// Integers, and numbers next to them: nearly coplanar.
    Beside,
    /// Powers of two from 2^-112 to 2^112, with either sign.
    Powers,
    /// Far from the origin; in f64 with a fraction that f32 does not hold there.
    Far,
}

impl Grid {
    /// Coordinate of a small number. Only if `wide`, it may be one that f32 does not hold.
    pub fn coordinate(self, small: i8, wide: bool) -> f64 {
        let x = f64::from(small);
        match self {
            Self::Lattice => x,
            Self::Coarse => f64::from(small.rem_euclid(3)),
            Self::Huge => x * 2_f64.powi(120),
            Self::Tiny => x * 2_f64.powi(-149),
            Self::Beside => {
                let (whole, steps) = (f64::from(small >> 3), small & 7);
                (0..steps).fold(whole, |x, _| {
                    if x == 0.0 {
                        0.0
                    } else if wide {
                        x.next_up()
                    } else {
                        f64::from((x as f32).next_up())
                    }
                })
            }
            Self::Powers if small == 0 => 0.0,
            Self::Powers => {
                x.signum() * 2_f64.powi(2 * (i32::from(small.unsigned_abs()) - 64).clamp(-56, 56))
            }
            Self::Far => 1e7 + if wide { x / 1024.0 } else { x },
        }
    }

    /// Positions of `points`.
    pub fn places(self, points: &[[i8; 3]], wide: bool) -> Vec<[f64; 3]> {
        let place = |point: &[i8; 3]| point.map(|small| self.coordinate(small, wide));
        points.iter().map(place).collect()
    }
}
