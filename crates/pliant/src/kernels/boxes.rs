//! N boxes side by side, and one box against all of them.

use crate::geometry::Aabb;

/// N closed boxes in structure-of-arrays order. An empty lane is NaN: ordered comparisons with it are false, so it overlaps nothing, not even an
/// infinite box (a pair of infinities would), and `f32::min` and `f32::max` pass it over.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoxLanes<const N: usize> {
    lo: [[f32; N]; 3],
    hi: [[f32; N]; 3],
}

impl<const N: usize> BoxLanes<N> {
    pub(crate) const EMPTY: Self = Self {
        lo: [[f32::NAN; N]; 3],
        hi: [[f32::NAN; N]; 3],
    };

    #[inline]
    pub(crate) fn get(&self, lane: usize) -> Aabb {
        Aabb {
            lo: std::array::from_fn(|axis| self.lo[axis][lane]),
            hi: std::array::from_fn(|axis| self.hi[axis][lane]),
        }
    }

    #[inline]
    pub(crate) fn set(&mut self, lane: usize, value: &Aabb) {
        for axis in 0..3 {
            self.lo[axis][lane] = value.lo[axis];
            self.hi[axis][lane] = value.hi[axis];
        }
    }

    /// The smallest box that holds all lanes.
    #[inline]
    pub(crate) fn union(&self) -> Aabb {
        (0..N).fold(Aabb::EMPTY, |union, lane| union.merge(&self.get(lane)))
    }

    /// Bit i is set if lane i overlaps `query`; touching counts.
    #[inline]
    pub(crate) fn overlaps(&self, query: &Aabb) -> u32 {
        // Every lane is computed and no comparison ends the loop: what a wide register does in six compares.
        let mut mask = 0;
        for lane in 0..N {
            let mut overlaps = true;
            for axis in 0..3 {
                overlaps &= (self.lo[axis][lane] <= query.hi[axis])
                    & (self.hi[axis][lane] >= query.lo[axis]);
            }
            mask |= u32::from(overlaps) << lane;
        }
        mask
    }
}

/// The numbers of the bits set in a mask, lowest first.
#[inline]
pub(crate) fn lanes_of(mask: u32) -> impl Iterator<Item = usize> {
    let mut rest = mask;
    std::iter::from_fn(move || {
        let lane = rest.trailing_zeros();
        rest &= rest.wrapping_sub(1);
        (lane < u32::BITS).then_some(lane as usize)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_lane_meets_nothing_and_adds_nothing() {
        let everything = Aabb {
            lo: [f32::NEG_INFINITY; 3],
            hi: [f32::INFINITY; 3],
        };
        let mut lanes = BoxLanes::<8>::EMPTY;
        assert_eq!(lanes.overlaps(&everything), 0);
        let unit = Aabb {
            lo: [0.0; 3],
            hi: [1.0; 3],
        };
        lanes.set(5, &unit);
        assert_eq!(lanes.overlaps(&everything), 1 << 5);
        assert_eq!(lanes.union(), unit);
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
                assert_eq!(
                    lanes_of(lanes.overlaps(query)).collect::<Vec<_>>(),
                    expected
                );
            }
        }
    }
}
