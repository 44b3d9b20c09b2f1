//! Boxes of eight triangles quantized to bytes, which reject pairs that are surely apart.
//!
//! That takes a quarter of the instructions of a test of the boxes: 64 pairs are two registers of
//! 32 bytes, compared by subtraction. A coordinate becomes a whole number of units, of which only
//! the lowest byte is kept. Both ends of a box are rounded the same way, which keeps order: boxes
//! that are apart in whole units are apart in truth. The sign of a difference of bytes is right if
//! the two numbers differ by less than 128. They do if the boxes of both eights overlap, and
//! neither is longer than [`MOST_UNITS`] units on any side.

use super::boxes::BoxLanes;
use fearless_simd::prelude::*;
use fearless_simd::{f32x8, i8x32, i32x8, u8x32, u64x4};

/// The longest side, in units, of a box of eight that fits.
///
/// Rounding moves either end by at most a quarter and then to a whole number, so the side is at
/// most 63 whole units.
const MOST_UNITS: f32 = 61.0;
/// The largest coordinate, in units from zero. Up to here products with the scale are off by at
/// most a quarter of a unit.
pub(crate) const FARTHEST: f32 = (1 << 22) as f32;

/// Boxes of eight triangles in whole units, modulo 256. Byte k of a word is lane k; bytes of unused
/// lanes are padding.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct QuantizedLanes {
    lo: [u64; 3],
    hi: [u64; 3],
    /// Mask that says whether these eight fit: all bits, or none. If none, nothing is surely apart
    /// from them.
    fits: u64,
    /// Padding to 64 bytes, so that a shift finds the place of eight boxes.
    _unused: u64,
}

impl QuantizedLanes {
    /// Sets whether these eight fit, from the longest side of the box of all and the number of
    /// units in a length of one.
    #[inline(always)]
    pub(crate) fn set_fits(&mut self, longest: f32, units: f32) {
        // NaN does not fit.
        self.fits = if longest * units <= MOST_UNITS {
            u64::MAX
        } else {
            0
        };
    }
}

/// Quantizes eight boxes, at `units` units to a length of one. The result does not fit until
/// [`set_fits`](QuantizedLanes::set_fits) says so.
#[inline(always)]
pub(crate) fn quantize<I: Simd>(i: I, boxes: &BoxLanes<8>, units: f32) -> QuantizedLanes {
    let rows = [
        &boxes.lo[0],
        &boxes.lo[1],
        &boxes.lo[2],
        &boxes.hi[0],
        &boxes.hi[1],
        &boxes.hi[2],
    ];
    let mut whole = [i32x8::splat(i, 0); 8];
    for row in 0..6 {
        // Truncation goes toward zero for either side of a box. That keeps order too.
        whole[row] = i32x8::truncate_from(f32x8::load_array_ref(i, rows[row]) * units);
    }
    let [a, b, c, d, e, f, ..] = whole;
    let first = a.narrow(b).narrow(c.narrow(d)).bitcast::<u64x4<I>>();
    let second = e.narrow(f);
    let second = second.narrow(second).bitcast::<u64x4<I>>();
    let [lo_x, lo_y, lo_z, hi_x] = first.to_array();
    let [hi_y, hi_z, ..] = second.to_array();
    QuantizedLanes {
        lo: [lo_x, lo_y, lo_z],
        hi: [hi_x, hi_y, hi_z],
        ..QuantizedLanes::default()
    }
}

/// Quantized boxes of eight, each repeated eight times, to be compared with many others.
#[derive(Clone, Copy)]
pub(crate) struct QuantizedRows<I: Simd> {
    lo: [[u8x32<I>; 2]; 3],
    hi: [[u8x32<I>; 2]; 3],
    fits: u64,
}

/// Lane that is repeated at byte k, of the first four lanes and of the last four.
const REPEATED: [[u8; 32]; 2] = {
    let mut lanes = [[0; 32]; 2];
    let mut byte = 0;
    while byte < 32 {
        lanes[0][byte] = (byte / 8) as u8;
        lanes[1][byte] = (byte / 8) as u8 + 4;
        byte += 1;
    }
    lanes
};

impl<I: Simd> QuantizedRows<I> {
    #[inline(always)]
    pub(crate) fn new(i: I, lanes: &QuantizedLanes) -> Self {
        let places = [
            u8x32::load_array_ref(i, &REPEATED[0]),
            u8x32::load_array_ref(i, &REPEATED[1]),
        ];
        let empty = [[u8x32::splat(i, 0); 2]; 3];
        let mut rows = Self {
            lo: empty,
            hi: empty,
            fits: lanes.fits,
        };
        for axis in 0..3 {
            let lo = all_lanes(i, lanes.lo[axis]);
            let hi = all_lanes(i, lanes.hi[axis]);
            for half in 0..2 {
                rows.lo[axis][half] = lo.swizzle_dyn_within_blocks(places[half]);
                rows.hi[axis][half] = hi.swizzle_dyn_within_blocks(places[half]);
            }
        }
        rows
    }

    /// Rejection mask: bit `8 i + j` is set if lane i is surely apart from lane j of `other`.
    #[inline(always)]
    pub(crate) fn apart(&self, i: I, other: &QuantizedLanes) -> u64 {
        let mut gaps = [u8x32::splat(i, 0); 2];
        for axis in 0..3 {
            let lo = all_lanes(i, other.lo[axis]);
            let hi = all_lanes(i, other.hi[axis]);
            for half in 0..2 {
                // Negative where one box ends before the other begins.
                gaps[half] |= self.hi[axis][half] - lo;
                gaps[half] |= hi - self.lo[axis][half];
            }
        }
        let [low, high] = gaps;
        (negative(low) | negative(high) << 32) & self.fits & other.fits
    }
}

/// Eight lanes, repeated four times.
#[inline(always)]
fn all_lanes<I: Simd>(i: I, lanes: u64) -> u8x32<I> {
    u64x4::splat(i, lanes).bitcast()
}

/// Bit mask of the negative bytes.
#[inline(always)]
fn negative<I: Simd>(bytes: u8x32<I>) -> u64 {
    bytes.bitcast::<i8x32<I>>().simd_lt(0).to_bitmask()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Aabb;
    use crate::kernels::{Instructions, dispatch, overlap_mask};
    use pliant_oracle::Random;

    /// Eight boxes in a box of at most `units` units from `corner` on, which lies on all sides of
    /// zero.
    fn eight(random: &mut Random, corner: [f32; 3], units: f32) -> (BoxLanes<8>, Aabb) {
        let mut boxes = BoxLanes::EMPTY;
        let mut part = || random.below(1_000_001) as f32 / 1e6;
        let longest = part() * MOST_UNITS / units;
        for lane in 0..8 {
            let mut one = Aabb {
                lo: corner,
                hi: corner,
            };
            for axis in 0..3 {
                let (a, b) = (part() * longest, part() * longest);
                one.lo[axis] += a.min(b);
                one.hi[axis] = one.lo[axis].max(corner[axis] + a.max(b));
            }
            boxes.set(lane, &one);
        }
        let all = boxes.union();
        (boxes, all)
    }

    #[test]
    fn what_is_surely_apart_is_apart() {
        let mut random = Random::new(5);
        let (mut apart_in_truth, mut surely) = (0, 0);
        for round in 0..20_000 {
            let units = [1.0, 0.37, 1e3, 7e-4][round % 4];
            let far = [0.0, 20.0, 1e4, 4e6][round / 4 % 4] / units;
            let corner = [far, -far, -20.0 / units];
            let other = corner.map(|x| x + (random.below(121) as f32 - 60.0) / units);
            let (a, all_a) = eight(&mut random, corner, units);
            let (b, all_b) = eight(&mut random, other, units);
            if !all_a.overlaps(&all_b) {
                continue;
            }
            for instructions in Instructions::all() {
                let [apart, overlap] = dispatch!(instructions, i => {
                    let mut quantized_a = quantize(i, &a, units);
                    let mut quantized_b = quantize(i, &b, units);
                    let rejected = QuantizedRows::new(i, &quantized_a).apart(i, &quantized_b);
                    assert_eq!(rejected, 0, "none fits");
                    quantized_a.set_fits(a.union_side(), units);
                    quantized_b.set_fits(b.union_side(), units);
                    let apart = QuantizedRows::new(i, &quantized_a).apart(i, &quantized_b);
                    [apart, overlap_mask(i, &a, &b)]
                });
                assert_eq!(apart & overlap, 0, "{instructions:?} {a:?} {b:?}");
                surely += apart.count_ones();
                apart_in_truth += overlap.count_zeros();
            }
        }
        assert!(
            surely * 10 > apart_in_truth * 8,
            "{surely} of {apart_in_truth}"
        );
    }
}
