//! Points in registers, and eight points transposed into lanes.
//!
//! A register holds a point's three coordinates and padding. Eight such points transposed are three
//! registers: all x, all y and all z. Boxes are kept in this form, and eight decisions are made at
//! once on it.

use crate::geometry::vector::{Vector, minus};
use crate::geometry::{OUTWARD, Points, Real};
use crate::ids::TreeVertex;
use fearless_simd::prelude::*;
use fearless_simd::{f32x4, f32x8, f64x4};

/// Coordinate type whose points fit registers of four.
pub(crate) trait Coordinate: Real {
    /// Register of four coordinates.
    type Four<I: Simd>: SimdBase<I, Element = Self, Array = [Self; 4]>;

    /// Converts two registers to `f32`, each number rounded to nearest.
    fn rounded<I: Simd>(two: [Self::Four<I>; 2]) -> [f32x4<I>; 2];

    /// Two points relative to the origin, rounded to the nearest `f64` and then to the nearest
    /// `f32`.
    ///
    /// Where boxes are exact, the points are returned as they are.
    fn relative<I: Simd>(two: [Self::Four<I>; 2], origin: &[f64; 4]) -> [f32x4<I>; 2];

    /// Loads four numbers: a point and padding.
    #[inline(always)]
    fn load<I: Simd>(i: I, four: &[Self; 4]) -> Self::Four<I> {
        Self::Four::load_array_ref(i, four)
    }

    /// Eight points as lanes: all x, all y, all z.
    fn in_lanes<I: Simd>(i: I, points: [&[Self; 4]; 8]) -> Vector<[Self; 8]>;

    /// The corners of a box in `f32`, relative to the origin and rounded outward.
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
        // As `Real::round_down` and `round_up` of f64 define it, lane by lane.
        let lo = lo.min(f32x4::splat(i, f32::MAX));
        let hi = hi.max(f32x4::splat(i, -f32::MAX));
        (
            lo - (lo.abs() * OUTWARD + f32::MIN_POSITIVE),
            hi + (hi.abs() * OUTWARD + f32::MIN_POSITIVE),
        )
    }

    /// The corners of a box in `f32`, relative to the origin, rounded to nearest and clamped to
    /// finite numbers.
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

    /// Differences of corners as lanes: corner a less corner b for every (a, b) in `of`.
    ///
    /// Each coordinate is rounded to the nearest `f32`, of `f64` to the nearest `f64` before.
    /// `corner` returns a corner by number and lane. There are eight items with `count` corners
    /// each, at most eight.
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

/// Differences of two points in each of eight lanes.
///
/// They are computed before anything is rounded, because an `f32` may not hold the points.
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

/// Corners of eight pairs of triangles A and B: numbers 0, 1 and 2 are A's, 3, 4 and 5 are B's.
#[derive(Clone, Copy)]
pub(crate) struct TrianglePairs<'p, S> {
    pub(crate) positions: [&'p Points<S>; 2],
    pub(crate) vertices: [[TreeVertex; 6]; 8],
}

impl<S: Coordinate> TrianglePairs<'_, S> {
    /// Differences of the corners of each pair, for every (a, b) in `of`.
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

/// Eight vectors as lanes: all x, all y, all z.
pub(crate) type Vectors<I> = Vector<f32x8<I>>;

impl Coordinate for f32 {
    type Four<I: Simd> = f32x4<I>;

    #[inline(always)]
    fn in_lanes<I: Simd>(i: I, points: [&[Self; 4]; 8]) -> Vector<[Self; 8]> {
        let mut eight = [f32x4::splat(i, 0.0); 8];
        for lane in 0..8 {
            eight[lane] = f32x4::load_array_ref(i, points[lane]);
        }
        let mut lanes = [[0.0; 8]; 3];
        for (row, of_axis) in lanes_of(eight).iter().zip(&mut lanes) {
            row.store_array(of_axis);
        }
        lanes
    }

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
        // First lanes, then differences of lanes: a transposition for every corner instead of one
        // for every difference.
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
    fn in_lanes<I: Simd>(i: I, points: [&[Self; 4]; 8]) -> Vector<[Self; 8]> {
        let mut lanes = [[0.0; 8]; 3];
        for half in 0..2 {
            let mut four = [f64x4::splat(i, 0.0); 4];
            for lane in 0..4 {
                four[lane] = f64x4::load_array_ref(i, points[4 * half + lane]);
            }
            for (row, of_axis) in turn(four).iter().zip(&mut lanes) {
                row.store_slice(&mut of_axis[4 * half..4 * half + 4]);
            }
        }
        lanes
    }

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

/// Transposes eight points into lanes: all x, all y, all z.
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

/// Transposes four points: all x, all y, all z.
#[inline(always)]
pub(super) fn turn<I: Simd, V: SimdBase<I>>([a, b, c, d]: [V; 4]) -> [V; 3] {
    // First zip: ax cx ay cy, az cz ..; bx dx by dy, ... Second zip: ax bx cx dx, ay by cy dy, az
    // bz cz dz.
    let (ac, bd) = (a.zip_low(c), b.zip_low(d));
    let (ac_high, bd_high) = (a.zip_high(c), b.zip_high(d));
    [ac.zip_low(bd), ac.zip_high(bd), ac_high.zip_low(bd_high)]
}
