//! Elements of one run in a ring: every pair of them once, eight pairs at a time.
//!
//! A ring written twice in a row has its rotation by k at place k. So places i and i + k, read
//! eight at a time, are eight pairs. Rotations by 1 to n / 2 give all pairs of n elements, and few
//! of them twice. Comparing each element with eight others would take twice as many comparisons.

use super::EightBoxes;
use super::boxes::Registers;
use super::gaps::{EightCorners, Limits};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, u32x8};

/// The most elements of a run: eight triangles that share nothing have 24 edges.
pub(crate) const MOST_OF_RUN: usize = 24;
/// Places for the most elements twice, and so for eight from any place of any rotation.
const PLACES: usize = 2 * MOST_OF_RUN;

/// Ring of the boxes of elements with `C` corners each, and of these corners.
pub(crate) struct Ring<const C: usize> {
    lo: [[f32; PLACES]; 3],
    hi: [[f32; PLACES]; 3],
    corners: [[u32; PLACES]; C],
    count: usize,
}

impl<const C: usize> Ring<C> {
    pub(crate) const EMPTY: Self = Self {
        lo: [[0.0; PLACES]; 3],
        hi: [[0.0; PLACES]; 3],
        corners: [[0; PLACES]; C],
        count: 0,
    };

    /// Fills the ring with `count` elements, at most [`MOST_OF_RUN`], which come in groups of
    /// eight.
    #[inline(always)]
    pub(crate) fn fill<'e>(
        &mut self,
        count: usize,
        eights: impl Iterator<Item = (&'e EightBoxes, &'e EightCorners<C>)> + Clone,
    ) {
        self.count = count.min(MOST_OF_RUN);
        // The first copy's last group may have too many; the second copy overwrites these.
        for (start, eights) in [(0, eights.clone()), (self.count, eights)] {
            for (place, (boxes, corners)) in eights.enumerate() {
                let at = (start + 8 * place).min(PLACES - 8);
                for axis in 0..3 {
                    self.lo[axis][at..at + 8].copy_from_slice(&boxes.lo[axis]);
                    self.hi[axis][at..at + 8].copy_from_slice(&boxes.hi[axis]);
                }
                for corner in 0..C {
                    self.corners[corner][at..at + 8].copy_from_slice(&corners[corner]);
                }
            }
        }
    }

    /// Shows the places of every two elements that are possibly near each other, the lower first,
    /// and whether they surely are.
    ///
    /// Elements that share a corner are left out.
    #[inline(always)]
    pub(crate) fn near_pairs<I: Simd>(
        &self,
        i: I,
        limits: Limits,
        mut found: impl FnMut([usize; 2], bool),
    ) {
        let [sure, possible] = limits.in_lanes(i);
        for first in (0..self.count).step_by(8) {
            let (boxes, corners) = self.eight(i, first);
            for turn in 1..=self.count / 2 {
                let (turned, turned_corners) = self.eight(i, first + turn);
                let gaps = boxes.gaps_to(&turned);
                let mut near = gaps.simd_le(possible);
                for corner in corners {
                    for other in turned_corners {
                        near &= !corner.simd_eq(other);
                    }
                }
                // In a rotation by half the ring, the second half repeats the pairs of the first.
                let end = if 2 * turn == self.count {
                    turn
                } else {
                    self.count
                };
                let lanes = 0xff_u64 >> 8_usize.saturating_sub(end.saturating_sub(first)).min(8);
                let mut near = near.to_bitmask() & lanes;
                while near != 0 {
                    let lane = near.trailing_zeros() as usize;
                    near &= near - 1;
                    let a = first + lane;
                    let b = if a + turn < self.count {
                        a + turn
                    } else {
                        a + turn - self.count
                    };
                    let is_sure = gaps.simd_lt(sure).to_bitmask() >> lane & 1 == 1;
                    found([a.min(b), a.max(b)], is_sure);
                }
            }
        }
    }

    /// Loads eight elements in a row, from `place` on.
    #[inline(always)]
    fn eight<I: Simd>(&self, i: I, place: usize) -> (Registers<I>, [u32x8<I>; C]) {
        let at = place.min(PLACES - 8);
        let mut boxes = Registers::none(i);
        for axis in 0..3 {
            boxes.lo[axis] = f32x8::from_slice(i, &self.lo[axis][at..at + 8]);
            boxes.hi[axis] = f32x8::from_slice(i, &self.hi[axis][at..at + 8]);
        }
        let mut corners = [u32x8::splat(i, 0); C];
        for corner in 0..C {
            corners[corner] = u32x8::from_slice(i, &self.corners[corner][at..at + 8]);
        }
        (boxes, corners)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernels::{Instructions, dispatch};
    use pliant_oracle::Random;

    /// Elements on a lattice, so that gaps often equal the margin, with corners of few vertices, so
    /// that many are shared.
    fn eights(random: &mut Random, count: usize) -> Vec<(EightBoxes, EightCorners<2>)> {
        let mut eights = vec![(EightBoxes::EMPTY, [[0; 8]; 2]); count.div_ceil(8)];
        for (place, (boxes, corners)) in (0..).step_by(8).zip(&mut eights) {
            for lane in 0..8 {
                // The first element of a run is repeated to fill the last eight.
                let copied = if place + lane < count { lane } else { 0 };
                for axis in 0..3 {
                    let lo = random.below(6) as f32;
                    boxes.lo[axis][lane] = lo;
                    boxes.hi[axis][lane] = lo + random.below(2) as f32;
                    boxes.lo[axis][lane] = boxes.lo[axis][copied];
                    boxes.hi[axis][lane] = boxes.hi[axis][copied];
                }
                for corner in &mut *corners {
                    corner[lane] = random.below(2 * count as u32 + 1);
                    corner[lane] = corner[copied];
                }
            }
        }
        eights
    }

    #[test]
    fn every_two_are_compared_once() {
        let random = &mut Random::new(7);
        let mut seen = [0; 3];
        for round in 0..20 * (MOST_OF_RUN + 1) {
            let count = round % (MOST_OF_RUN + 1);
            let all = eights(random, count);
            // Gaps are whole numbers. A gap of 1 is near but not surely; in double precision too,
            // if coordinates are that large.
            let limits = [
                Limits::new::<f32>([1.0; 2], 7.0),
                Limits::new::<f64>([1.0; 2], 2e6),
            ][round % 2];
            let element = |place: usize| {
                let ((boxes, corners), lane) = (all[place / 8], place % 8);
                (boxes.get(lane), corners.map(|corner| corner[lane]))
            };
            let mut expected = Vec::new();
            for a in 0..count {
                for b in a + 1..count {
                    let ((box_a, corners_a), (box_b, corners_b)) = (element(a), element(b));
                    if corners_a.iter().any(|corner| corners_b.contains(corner)) {
                        seen[0] += 1;
                        continue;
                    }
                    let gap = (0..3).fold(f32::MIN, |gap, axis| {
                        let below = box_a.lo[axis] - box_b.hi[axis];
                        gap.max(below).max(box_b.lo[axis] - box_a.hi[axis])
                    });
                    if gap <= 1.0 {
                        let is_sure = gap < 1.0;
                        seen[1 + usize::from(is_sure)] += 1;
                        expected.push(([a, b], is_sure));
                    }
                }
            }
            for instructions in Instructions::all() {
                let mut found = Vec::new();
                dispatch!(instructions, i => {
                    let mut ring = Ring::EMPTY;
                    ring.fill(count, all.iter().map(|(boxes, corners)| (boxes, corners)));
                    ring.near_pairs(i, limits, |places, is_sure| found.push((places, is_sure)));
                });
                found.sort_unstable();
                assert_eq!(found, expected, "{count}");
            }
        }
        assert!(seen.into_iter().all(|seen| seen > 1000), "{seen:?}");
    }
}
