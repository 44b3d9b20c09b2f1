//! A point in one register, and how points become lanes.
//!
//! A register holds a point's three coordinates and padding. Eight points turned by a quarter (their x in
//! one register, their y in the next, their z in a third) are lanes, which is how boxes are kept and how eight decisions are
//! made at once.

use super::vector::{Vector, minus};
use crate::geometry::{OUTWARD, Points, Real};
use crate::ids::TreeVertex;
use fearless_simd::prelude::*;
use fearless_simd::{f32x4, f32x8, f64x4};

/// A coordinate type whose points fit registers of four.
pub(crate) trait Coordinate: Real {
    /// Four coordinates.
    type Four<I: Simd>: SimdBase<I, Element = Self, Array = [Self; 4]>;

    /// Two rows, each number rounded to the nearest f32.
    fn rounded<I: Simd>(two: [Self::Four<I>; 2]) -> [f32x4<I>; 2];

    /// Two points relative to the origin, each number rounded to the nearest f64 and then to the
    /// nearest f32; as they are, where boxes are exact.
    fn relative<I: Simd>(two: [Self::Four<I>; 2], origin: &[f64; 4]) -> [f32x4<I>; 2];

    /// Four numbers from memory: a point and padding.
    #[inline(always)]
    fn load<I: Simd>(i: I, four: &[Self; 4]) -> Self::Four<I> {
        Self::Four::load_array_ref(i, four)
    }

    /// The corners lo and hi of a box in f32, relative to the origin and rounded outward.
    #[inline(always)]
    fn outward<I: Simd>(
        lo: Self::Four<I>,
        hi: Self::Four<I>,
        origin: &[f64; 4],
    ) -> (f32x4<I>, f32x4<I>) {
        let [lo, hi] = Self::relative([lo, hi], origin);
        if Self::BOXES_ARE_EXACT {
            return (lo, hi);
        }
        let i = lo.token();
        // As `Real::round_down` and `round_up` of f64 say, lane by lane.
        let lo = lo.min(f32x4::splat(i, f32::MAX));
        let hi = hi.max(f32x4::splat(i, -f32::MAX));
        (
            lo - (lo.abs() * OUTWARD + f32::MIN_POSITIVE),
            hi + (hi.abs() * OUTWARD + f32::MIN_POSITIVE),
        )
    }

    /// The same corners, rounded to the nearest; what is beyond f32 is the largest.
    #[inline(always)]
    fn nearest<I: Simd>(
        lo: Self::Four<I>,
        hi: Self::Four<I>,
        origin: &[f64; 4],
    ) -> (f32x4<I>, f32x4<I>) {
        let [lo, hi] = Self::relative([lo, hi], origin);
        if Self::BOXES_ARE_EXACT {
            return (lo, hi);
        }
        let i = lo.token();
        let [least, most] = [-f32::MAX, f32::MAX].map(|x| f32x4::splat(i, x));
        (lo.max(least).min(most), hi.max(least).min(most))
    }

    /// Differences of points as lanes, each coordinate rounded to the nearest f32 (of f64 to the
    /// nearest f64 before): for every (a, b) corner a minus corner b. `corner` gives a corner by
    /// its number and lane, of eight things that have `count` corners each, at most eight.
    #[inline(always)]
    fn differences<'p, I: Simd, const D: usize>(
        i: I,
        _count: usize,
        corner: impl Fn(usize, usize) -> &'p [Self; 4],
        of: [(usize, usize); D],
    ) -> [Vectors<I>; D] {
        let mut rows = [[f32x8::splat(i, 0.0); 3]; D];
        for which in 0..D {
            let (a, b) = of[which];
            rows[which] = eight_differences(i, |lane| [corner(a, lane), corner(b, lane)]);
        }
        rows
    }
}

/// The differences of two points each as lanes. They are taken before anything is rounded, because
/// an f32 may not hold the points.
#[inline(always)]
pub(super) fn eight_differences<'p, I: Simd, S: Coordinate>(
    i: I,
    points: impl Fn(usize) -> [&'p [S; 4]; 2],
) -> Vectors<I> {
    let mut eight = [f32x4::splat(i, 0.0); 8];
    for half in 0..4 {
        let [[p, q], [r, s]] = [points(2 * half), points(2 * half + 1)];
        let two = [S::load(i, p) - S::load(i, q), S::load(i, r) - S::load(i, s)];
        [eight[2 * half], eight[2 * half + 1]] = S::rounded(two);
    }
    lanes_of(eight)
}

/// The corners of eight pairs of triangles A and B; of A 0, 1 and 2, of B 3, 4 and 5.
#[derive(Clone, Copy)]
pub(crate) struct Corners<'p, S> {
    pub(crate) positions: [&'p Points<S>; 2],
    pub(crate) vertices: [[TreeVertex; 6]; 8],
}

impl<S: Coordinate> Corners<'_, S> {
    /// Differences of the corners of each pair.
    #[inline(always)]
    pub(super) fn differences<I: Simd, const D: usize>(
        &self,
        i: I,
        of: [(usize, usize); D],
    ) -> [Vectors<I>; D] {
        let corner = |corner: usize, lane: usize| {
            self.positions[corner / 3].padded(self.vertices[lane][corner])
        };
        S::differences(i, 6, corner, of)
    }
}

/// Eight vectors as lanes: their x, their y, their z.
pub(crate) type Vectors<I> = Vector<f32x8<I>>;

impl Coordinate for f32 {
    type Four<I: Simd> = f32x4<I>;

    #[inline(always)]
    fn rounded<I: Simd>(two: [f32x4<I>; 2]) -> [f32x4<I>; 2] {
        two
    }

    #[inline(always)]
    fn relative<I: Simd>(two: [f32x4<I>; 2], _origin: &[f64; 4]) -> [f32x4<I>; 2] {
        two
    }

    #[inline(always)]
    fn differences<'p, I: Simd, const D: usize>(
        i: I,
        count: usize,
        corner: impl Fn(usize, usize) -> &'p [Self; 4],
        of: [(usize, usize); D],
    ) -> [Vectors<I>; D] {
        // Lanes first, differences of lanes then: a turn for every corner instead of one for every difference.
        let zero = f32x8::splat(i, 0.0);
        let mut points = [[zero; 3]; 8];
        for which in 0..count {
            let mut eight = [f32x4::splat(i, 0.0); 8];
            for lane in 0..8 {
                eight[lane] = f32x4::load_array_ref(i, corner(which, lane));
            }
            points[which] = lanes_of(eight);
        }
        let mut rows = [[zero; 3]; D];
        for which in 0..D {
            let (a, b) = of[which];
            rows[which] = minus(points[a], points[b]);
        }
        rows
    }
}

impl Coordinate for f64 {
    type Four<I: Simd> = f64x4<I>;

    #[inline(always)]
    fn rounded<I: Simd>([p, q]: [f64x4<I>; 2]) -> [f32x4<I>; 2] {
        let (p, q) = p.narrow(q).split();
        [p, q]
    }

    #[inline(always)]
    fn relative<I: Simd>([p, q]: [f64x4<I>; 2], origin: &[f64; 4]) -> [f32x4<I>; 2] {
        let origin = f64x4::load_array_ref(p.token(), origin);
        Self::rounded([p - origin, q - origin])
    }
}

/// Eight points as lanes: their x, their y, their z.
#[inline(always)]
pub(super) fn lanes_of<I: Simd>(points: [f32x4<I>; 8]) -> Vectors<I> {
    let [a, b, c, d, e, f, g, h] = points;
    let low = turn([a, b, c, d]);
    let high = turn([e, f, g, h]);
    [
        low[0].combine(high[0]),
        low[1].combine(high[1]),
        low[2].combine(high[2]),
    ]
}

/// Four points as x, y, z.
#[inline(always)]
pub(super) fn turn<I: Simd, V: SimdBase<I>>([a, b, c, d]: [V; 4]) -> [V; 3] {
    // ax cx ay cy, az cz .. ..; bx dx by dy, ...; zipped again: ax bx cx dx, ay by cy dy, az bz cz dz.
    let (ac, bd) = (a.zip_low(c), b.zip_low(d));
    let (ac_high, bd_high) = (a.zip_high(c), b.zip_high(d));
    [ac.zip_low(bd), ac.zip_high(bd), ac_high.zip_low(bd_high)]
}
