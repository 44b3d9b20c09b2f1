//! N boxes side by side in lanes, and their overlap with one box or with eight.
//!
//! The boxes of eight children, or of eight triangles of a leaf, are one register an axis and side.
//! Two sets of eight are compared all with all: a mask of 64 bits.

use crate::geometry::{Aabb, larger, smaller};
use fearless_simd::f32x8;
use fearless_simd::prelude::*;

/// N closed boxes in structure-of-arrays order.
///
/// An empty lane is NaN. Ordered comparisons with it are false, so it overlaps nothing, not even an
/// infinite box, and merging skips it. A pair of infinities would overlap an infinite box.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoxLanes<const N: usize> {
    pub(super) lo: [[f32; N]; 3],
    pub(super) hi: [[f32; N]; 3],
}

/// Eight boxes, one for each lane of a register: of the eight triangles of a leaf, or of eight
/// elements.
pub(crate) type EightBoxes = BoxLanes<8>;

impl<const N: usize> BoxLanes<N> {
    pub(crate) const EMPTY: Self = Self {
        lo: [[f32::NAN; N]; 3],
        hi: [[f32::NAN; N]; 3],
    };

    #[inline(always)]
    pub(crate) fn get(&self, lane: usize) -> Aabb {
        Aabb {
            lo: std::array::from_fn(|axis| self.lo[axis][lane]),
            hi: std::array::from_fn(|axis| self.hi[axis][lane]),
        }
    }

    #[inline(always)]
    pub(crate) fn set(&mut self, lane: usize, value: &Aabb) {
        for axis in 0..3 {
            self.lo[axis][lane] = value.lo[axis];
            self.hi[axis][lane] = value.hi[axis];
        }
    }

    /// Makes `lane` and all lanes after it empty.
    #[inline]
    pub(crate) fn empty_from(&mut self, lane: usize) {
        for axis in 0..3 {
            for lane in lane..N {
                self.lo[axis][lane] = f32::NAN;
                self.hi[axis][lane] = f32::NAN;
            }
        }
    }

    /// The smallest box that holds all lanes.
    ///
    /// Lanes are used from the first on, so the lower of two lanes is never the only empty one. It
    /// is therefore enough to skip a NaN on the right.
    #[inline(always)]
    pub(crate) fn union(&self) -> Aabb {
        // Halves are folded onto each other, a step of one wide instruction each. Going lane by
        // lane would wait for each comparison.
        let (mut lo, mut hi) = (self.lo, self.hi);
        let mut width = N;
        while width > 1 {
            width /= 2;
            for axis in 0..3 {
                for lane in 0..width {
                    lo[axis][lane] = smaller(lo[axis][lane], lo[axis][lane + width]);
                    hi[axis][lane] = larger(hi[axis][lane], hi[axis][lane + width]);
                }
            }
        }
        Aabb {
            lo: lo.map(|lanes| lanes[0]),
            hi: hi.map(|lanes| lanes[0]),
        }
    }

    /// Longest side of each box. It is NaN for an empty lane.
    #[inline(always)]
    pub(crate) fn longest_sides(&self) -> [f32; N] {
        let mut longest = [0.0; N];
        for lane in 0..N {
            longest[lane] = self.hi[0][lane] - self.lo[0][lane];
        }
        for axis in 1..3 {
            for lane in 0..N {
                longest[lane] = larger(longest[lane], self.hi[axis][lane] - self.lo[axis][lane]);
            }
        }
        longest
    }

    /// Longest side of the box that holds all lanes.
    #[cfg(test)]
    pub(super) fn union_side(&self) -> f32 {
        let all = self.union();
        (0..3).fold(0.0, |most, axis| larger(all.hi[axis] - all.lo[axis], most))
    }

    /// Overlap mask against one box: bit i is set if lane i overlaps `query`. Touching counts.
    #[inline(always)]
    pub(crate) fn overlaps(&self, query: &Aabb) -> u64 {
        // Every lane is computed and no comparison ends the loop, so that six wide compares do it.
        let mut overlaps = [0; 8];
        for lane in 0..N {
            overlaps[lane] = 1;
        }
        for axis in 0..3 {
            for lane in 0..N {
                let below = self.lo[axis][lane] <= query.hi[axis];
                let above = self.hi[axis][lane] >= query.lo[axis];
                overlaps[lane] &= u8::from(below & above);
            }
        }
        // Byte i of this factor is 0 or 1. The multiplier moves it to bit i of the product's
        // highest byte.
        u64::from_le_bytes(overlaps).wrapping_mul(0x0102_0408_1020_4080) >> 56
    }
}

impl<const N: usize> BoxLanes<N> {
    /// Overlap mask by plain code, the definition of [`overlap_mask`]: bit `8 i + j` is set if lane
    /// i overlaps lane j of `other`.
    #[cfg(test)]
    fn overlaps_all(&self, other: &Self) -> u64 {
        (0..N).fold(0, |mask, lane| {
            mask | other.overlaps(&self.get(lane)) << (8 * lane)
        })
    }
}

/// Eight boxes in registers.
pub(super) struct Registers<I: Simd> {
    pub(super) lo: [f32x8<I>; 3],
    pub(super) hi: [f32x8<I>; 3],
}

impl<I: Simd> Registers<I> {
    #[inline(always)]
    pub(super) fn none(i: I) -> Self {
        let none = f32x8::splat(i, 0.0);
        let (lo, hi) = ([none; 3], [none; 3]);
        Self { lo, hi }
    }

    /// Loads N boxes. Lanes from N on are empty.
    #[inline(always)]
    pub(super) fn new<const N: usize>(i: I, lanes: &BoxLanes<N>) -> Self {
        let mut boxes = Self::none(i);
        for axis in 0..3 {
            boxes.lo[axis] = eight(i, &lanes.lo[axis]);
            boxes.hi[axis] = eight(i, &lanes.hi[axis]);
        }
        boxes
    }
}

/// Overlap mask of eight boxes against eight: bit `8 i + j` is set if lane i of `a` overlaps lane j
/// of `b`. Touching counts.
#[inline(always)]
pub(crate) fn overlap_mask<I: Simd, const N: usize>(i: I, a: &BoxLanes<N>, b: &BoxLanes<N>) -> u64 {
    let b = Registers::new(i, b);
    let mut mask = 0;
    for lane in 0..N {
        let x = b.lo[0].simd_le(a.hi[0][lane]) & b.hi[0].simd_ge(a.lo[0][lane]);
        let y = b.lo[1].simd_le(a.hi[1][lane]) & b.hi[1].simd_ge(a.lo[1][lane]);
        let z = b.lo[2].simd_le(a.hi[2][lane]) & b.hi[2].simd_ge(a.lo[2][lane]);
        mask |= (x & y & z).to_bitmask() << (8 * lane);
    }
    mask
}

/// Overlap mask of N boxes against one box, in registers: as [`BoxLanes::overlaps`].
#[inline(always)]
pub(crate) fn lanes_overlapping<I: Simd, const N: usize>(
    i: I,
    lanes: &BoxLanes<N>,
    query: &Aabb,
) -> u64 {
    let Registers { lo, hi } = Registers::new(i, lanes);
    let x = lo[0].simd_le(query.hi[0]) & hi[0].simd_ge(query.lo[0]);
    let y = lo[1].simd_le(query.hi[1]) & hi[1].simd_ge(query.lo[1]);
    let z = lo[2].simd_le(query.hi[2]) & hi[2].simd_ge(query.lo[2]);
    (x & y & z).to_bitmask()
}

/// Priorities of N boxes in a descent to what is near one box, computed plainly: the least first.
/// NaN for an empty lane.
///
/// The square of the gap; of boxes without one, those first that end nearest.
#[inline(always)]
pub(crate) fn priorities<I: Simd, const N: usize>(
    i: I,
    lanes: &BoxLanes<N>,
    query: &Aabb,
) -> [f32; 8] {
    let Registers { lo, hi } = Registers::new(i, lanes);
    let zero = f32x8::splat(i, 0.0);
    let mut sum = zero;
    for axis in 0..3 {
        let below = lo[axis] - query.hi[axis];
        let above = f32x8::splat(i, query.lo[axis]) - hi[axis];
        // The gap is the larger one, or zero; the way to the farther side the smaller one.
        let is_below = below.simd_gt(above);
        let (gap, far) = (is_below.select(below, above), is_below.select(above, below));
        let gap = gap.simd_gt(zero).select(gap, zero);
        sum += gap * gap + far * far * 2.0_f32.powi(-16);
    }
    let mut priorities = [0.0; 8];
    sum.store_array(&mut priorities);
    priorities
}

/// The lane of the least number; the first lane is one, others may be NaN.
#[inline(always)]
pub(crate) fn least_of(numbers: [f32; 8]) -> usize {
    let mut least = 0;
    for lane in 1..8 {
        if numbers[lane] < numbers[least] {
            least = lane;
        }
    }
    least
}

/// Proximity mask: bit `8 i + j` is set unless lane i of `a` and lane j of `b` are surely too far
/// apart.
///
/// Too far means further than the root of `limit`, a square. Only the first `len_a` lanes of `a`
/// and the first `len_b` of `b` are compared. There is at least one of either, and none is empty.
///
/// # Rounding
///
/// The square of a gap computed in `f32` is off by six roundings of itself, and by 2^-148 below the
/// normal range. Where subnormal numbers are flushed, it is off by 2^-64 of itself or 2^-184 more.
/// A limit larger by 2^-20 of itself and by 2^-100 allows for both. Where such a limit overflows
/// `f32`, no square is above it.
#[inline(always)]
pub(crate) fn near_mask<I: Simd, const N: usize>(
    i: I,
    a: &BoxLanes<N>,
    b: &BoxLanes<N>,
    [len_a, len_b]: [usize; 2],
    limit: f64,
) -> u64 {
    let most = at_most(limit);
    let b = Registers::new(i, b);
    let columns = u64::MAX >> (64 - len_b);
    let mut mask = 0;
    for lane in 0..len_a {
        mask |= (near_one(&b, &a.get(lane), most) & columns) << (8 * lane);
    }
    mask
}

/// Proximity mask of the first `len_a` of eight boxes, each with a limit from [`at_most`], and
/// eight: as [`near_mask`]. Empty lanes of `b` are near nothing.
#[inline(always)]
pub(crate) fn near_mask_each<I: Simd>(
    i: I,
    a: &EightBoxes,
    b: &EightBoxes,
    len_a: usize,
    limits: &[f32; 8],
) -> u64 {
    let b = Registers::new(i, b);
    let columns = b.lo[0].simd_eq(b.lo[0]).to_bitmask();
    let mut mask = 0;
    for lane in 0..len_a {
        mask |= (near_one(&b, &a.get(lane), limits[lane]) & columns) << (8 * lane);
    }
    mask
}

/// A limit of squares in `f32`, enlarged as [`near_mask`] says.
#[inline(always)]
pub(crate) fn at_most(limit: f64) -> f32 {
    ((limit * (1.0 + f64::powi(0.5, 20)) + f64::powi(0.5, 100)) as f32).next_up()
}

/// Lanes whose gap from one box has at most this square. Any answer for empty lanes.
#[inline(always)]
fn near_one<I: Simd>(lanes: &Registers<I>, one: &Aabb, most: f32) -> u64 {
    let i = lanes.lo[0].token();
    let zero = f32x8::splat(i, 0.0);
    let mut square = zero;
    for axis in 0..3 {
        let below = lanes.lo[axis] - one.hi[axis];
        let above = f32x8::splat(i, one.lo[axis]) - lanes.hi[axis];
        let gap = below.simd_gt(zero).select(below, zero);
        let gap = above.simd_gt(zero).select(above, gap);
        square += gap * gap;
    }
    square.simd_le(most).to_bitmask()
}

/// Loads N numbers into eight lanes. The rest is empty.
#[inline(always)]
fn eight<I: Simd, const N: usize>(i: I, row: &[f32; N]) -> f32x8<I> {
    if let Ok(eight) = row.as_slice().try_into() {
        return f32x8::load_array_ref(i, eight);
    }
    let mut padded = [f32::NAN; 8];
    padded[..N].copy_from_slice(row);
    f32x8::load_array(i, padded)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernels::{Instructions, dispatch};

    #[test]
    fn an_empty_lane_meets_nothing_and_adds_nothing() {
        let everything = Aabb {
            lo: [f32::NEG_INFINITY; 3],
            hi: [f32::INFINITY; 3],
        };
        let mut lanes = BoxLanes::<8>::EMPTY;
        assert_eq!(lanes.overlaps(&everything), 0);
        let mut union = Aabb {
            lo: [f32::INFINITY; 3],
            hi: [f32::NEG_INFINITY; 3],
        };
        for lane in 0..8 {
            let lo = [(lane * 3 % 8) as f32, -(lane as f32), (lane * 5 % 8) as f32];
            let value = Aabb {
                lo,
                hi: lo.map(|x| x + 0.5),
            };
            lanes.set(lane, &value);
            union.lo = std::array::from_fn(|axis| union.lo[axis].min(value.lo[axis]));
            union.hi = std::array::from_fn(|axis| union.hi[axis].max(value.hi[axis]));
            assert_eq!(lanes.overlaps(&everything), (1 << (lane + 1)) - 1);
            assert_eq!(lanes.union(), union, "{} lanes", lane + 1);
        }
    }

    #[test]
    fn eight_against_eight_agree_with_one_against_eight() {
        let some = |shift: f32| {
            let mut lanes = BoxLanes::<8>::EMPTY;
            for lane in 0..7 {
                let lo = [
                    (lane * 5 % 7) as f32 * 0.5,
                    (lane % 3) as f32 + shift,
                    shift,
                ];
                lanes.set(
                    lane,
                    &Aabb {
                        lo,
                        hi: lo.map(|x| x + 1.0),
                    },
                );
            }
            lanes
        };
        let (a, b) = (some(0.0), some(0.5));
        for instructions in Instructions::all() {
            let mask = dispatch!(instructions, i => overlap_mask(i, &a, &b));
            assert_eq!(mask, a.overlaps_all(&b), "{instructions:?}");
            for lane in 0..8 {
                let one = a.get(lane);
                let mask = dispatch!(instructions, i => lanes_overlapping(i, &b, &one));
                assert_eq!(mask, b.overlaps(&one), "{instructions:?} {lane}");
            }
        }
        for i in 0..8 {
            assert_eq!(
                a.overlaps_all(&b) >> (8 * i) & 0xff,
                b.overlaps(&a.get(i)),
                "lane {i}"
            );
        }
        assert!((8..49).contains(&a.overlaps_all(&b).count_ones()));
    }

    #[test]
    fn lanes_agree_with_single_boxes() {
        let boxes: Vec<Aabb> = (0..27)
            .map(|i| [(i % 3) as f32, (i / 3 % 3) as f32, (i / 9) as f32])
            .map(|lo| Aabb {
                lo,
                hi: lo.map(|x| x + 1.0),
            })
            .collect();
        for query in &boxes {
            for eight in boxes.chunks(8) {
                let mut lanes = BoxLanes::<8>::EMPTY;
                for (lane, value) in eight.iter().enumerate() {
                    lanes.set(lane, value);
                }
                let expected: Vec<usize> = (0..eight.len())
                    .filter(|&lane| eight[lane].overlaps(query))
                    .collect();
                let found: Vec<usize> = (0..8)
                    .filter(|lane| lanes.overlaps(query) >> lane & 1 == 1)
                    .collect();
                assert_eq!(found, expected);
            }
        }
    }
}
