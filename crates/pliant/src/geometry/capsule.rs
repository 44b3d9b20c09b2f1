//! Capsules: all points within a distance of a segment, for what is long and thin.
//!
//! An axis-aligned box of a long thin triangle is mostly empty, a capsule is not. Source: the
//! line swept spheres of Larsen, Gottschalk, Lin and Manocha 1999. Invariant: the capsule holds
//! every point that it was made round, whatever rounding did.

use super::vector::{dot, minus, square_of, times};

/// Capsule: the points within `radius` of the segment from `middle - reach along` to
/// `middle + reach along`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Capsule {
    pub(crate) middle: [f32; 3],
    /// Direction of the segment: of length one half, so that no sum of products overflows.
    pub(crate) along: [f32; 3],
    pub(crate) reach: f32,
    pub(crate) radius: f32,
}

/// Largest coordinate or length of a capsule: 2^60. Squares then fit `f32`.
const FARTHEST: f64 = (1_u64 << 60) as f64;
/// Part by which a radius is made larger, for rounding in double precision: 2^-45.
const ROUNDING: f64 = 1.0 / (1_u64 << 45) as f64;

impl Capsule {
    /// Capsule that holds all of space: it is apart from nothing.
    pub(crate) const EVERYTHING: Self = Self {
        middle: [0.0; 3],
        along: [0.0; 3],
        reach: 0.0,
        radius: f32::INFINITY,
    };

    /// Capsule round `count` points, at least one, and round all points within `distance` of them.
    ///
    /// Its direction is from the point farthest from the first to the point farthest from that.
    /// Coordinates may be off by 2^-53 of themselves. O(count).
    pub(crate) fn around(count: usize, point: &dyn Fn(usize) -> [f64; 3], distance: f32) -> Self {
        let points = || (0..count).map(point);
        let farthest = |from: [f64; 3]| {
            let mut best = (0.0, from);
            for point in points() {
                let square = square_of(minus(point, from));
                if square > best.0 {
                    best = (square, point);
                }
            }
            best
        };
        let (_, start) = farthest(point(0));
        let (square_of_length, end) = farthest(start);
        let (way, length) = (minus(end, start), square_of_length.sqrt());
        let along = if length > 0.0 {
            way.map(|x| (0.5 * x / length) as f32)
        } else {
            [0.0; 3]
        };
        let wide = along.map(f64::from);
        let scale = 1.0 / square_of(wide).max(0.1);
        // The middle is halfway between the ends, and halfway to the point farthest from the axis.
        let (mut aside, mut low, mut high) = ([0.0; 3], 0.0_f64, 0.0_f64);
        for point in points() {
            let from = minus(point, start);
            let part = dot(from, wide) * scale;
            (low, high) = (low.min(part), high.max(part));
            let off = minus(from, times(part, wide));
            if square_of(off) > square_of(aside) {
                aside = off;
            }
        }
        let half = |axis: usize| 0.5 * ((low + high) * wide[axis] + aside[axis]);
        let middle = [0, 1, 2].map(|axis| (start[axis] + half(axis)) as f32);
        let reach = (0.5 * (high - low)) as f32;
        // From here on rounded numbers are what they are: whatever the segment, all are within the
        // largest distance from it.
        let (from, most) = (middle.map(f64::from), f64::from(reach));
        let mut radius = 0.0_f64;
        for point in points() {
            let way = minus(point, from);
            let part = (dot(way, wide) * scale).clamp(-most, most);
            radius = radius.max(square_of(minus(way, times(part, wide))));
        }
        let radius = radius.sqrt();
        let farthest = from
            .iter()
            .fold(0.0, |farthest: f64, x| farthest.max(x.abs()));
        let largest = farthest + most + radius;
        // Differences of coordinates, and parts of the reach, are rounded.
        let radius = radius + ROUNDING * largest + f64::from(distance);
        if largest.max(radius) >= FARTHEST {
            return Self::EVERYTHING;
        }
        let radius = (radius * (1.0 + ROUNDING)) as f32;
        Self {
            middle,
            along,
            reach,
            radius: radius.next_up() + 4.0 * f32::MIN_POSITIVE,
        }
    }
}
