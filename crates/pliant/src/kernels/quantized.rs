//! Boxes of eight triangles quantized to bytes: which of two eights are surely apart, in a quarter of the instructions that the boxes
//! themselves take.
//!
//! A coordinate becomes a whole number of units, and of that the lowest byte is kept. Both roundings go the same way and so keep
//! order: if in whole units one box ends before another begins, it does so in truth. A byte tells two such numbers apart
//! if they differ by less than 128: the sign of the difference of the bytes is then that of the numbers. They do if both eights lie in
//! boxes that overlap, neither of which is longer than [`MOST_UNITS`] units on any side.
//!
//! So the 64 pairs of two eights are two registers of 32 bytes, and a comparison is a subtraction.

use super::boxes::BoxLanes;
use fearless_simd::prelude::*;
use fearless_simd::{f32x8, i8x32, i32x8, u8x32, u64x4};

/// The longest side of a box of eight that fits, in units: after rounding, which moves either end by at most a quarter and then to
/// a whole number, it is at most 63 whole ones.
const MOST_UNITS: f32 = 61.0;
/// No coordinate may be more units from zero: up to here products with the scale are off by at most a quarter of a unit.
pub(crate) const FARTHEST: f32 = (1 << 22) as f32;

/// The boxes of eight triangles in whole units, modulo 256. Byte k of a word is lane k; that of a lane that is not used is padding.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct QuantizedLanes {
    lo: [u64; 3],
    hi: [u64; 3],
    /// All bits if these eight fit, or none: then nothing is surely apart from them.
    fits: u64,
    /// So that eight boxes are 64 bytes, and found by a shift.
    _unused: u64,
}

impl QuantizedLanes {
    /// Says whether these eight fit: the longest side of the box of all of them, and units to a length of one.
    #[inline(always)]
    pub(crate) fn set_fits(&mut self, longest: f32, units: f32) {
        // What is not a number does not fit.
        self.fits = if longest * units <= MOST_UNITS {
            u64::MAX
        } else {
            0
        };
    }
}

/// The quantized boxes of eight boxes, at so many units to a length of one; as if they did not fit.
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
        // Toward zero, on either side of a box: this keeps order too.
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

/// Quantized boxes of eight, each eight times in a row: what many others are compared with.
#[derive(Clone, Copy)]
pub(crate) struct QuantizedRows<I: Simd> {
    lo: [[u8x32<I>; 2]; 3],
    hi: [[u8x32<I>; 2]; 3],
    fits: u64,
}

/// Byte k of these is the lane that is repeated there, in the first four lanes and in the last.
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

    /// Bit 8 i + j is set if lane i is surely apart from lane j of `other`.
    #[inline(always)]
    pub(crate) fn apart(&self, i: I, other: &QuantizedLanes) -> u64 {
        let mut gaps = [u8x32::splat(i, 0); 2];
        for axis in 0..3 {
            let lo = all_lanes(i, other.lo[axis]);
            let hi = all_lanes(i, other.hi[axis]);
            for half in 0..2 {
                // Negative where one ends before the other begins.
                gaps[half] |= self.hi[axis][half] - lo;
                gaps[half] |= hi - self.lo[axis][half];
            }
        }
        let [low, high] = gaps;
        (negative(low) | negative(high) << 32) & self.fits & other.fits
    }
}

/// Eight lanes four times.
#[inline(always)]
fn all_lanes<I: Simd>(i: I, lanes: u64) -> u8x32<I> {
    u64x4::splat(i, lanes).bitcast()
}

/// Which bytes are negative.
#[inline(always)]
fn negative<I: Simd>(bytes: u8x32<I>) -> u64 {
    bytes.bitcast::<i8x32<I>>().simd_lt(0).to_bitmask()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Aabb;
    use crate::kernels::{Instructions, dispatch};
    use pliant_oracle::Random;

    /// Eight boxes in a box of at most `MOST_UNITS` units from a corner on, which lies on all sides of zero.
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
                    let [mut quantized_a, mut quantized_b] = [quantize(i, &a, units), quantize(i, &b, units)];
                    assert_eq!(QuantizedRows::new(i, &quantized_a).apart(i, &quantized_b), 0, "none fits");
                    quantized_a.set_fits(a.union_side(), units);
                    quantized_b.set_fits(b.union_side(), units);
                    let apart = QuantizedRows::new(i, &quantized_a).apart(i, &quantized_b);
                    [apart, crate::kernels::overlap_mask(i, &a, &b)]
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
