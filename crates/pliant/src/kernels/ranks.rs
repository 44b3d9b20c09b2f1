//! Ranks of a few numbers: how many of them are smaller than each.
//!
//! All are compared with all, eight at a time and without branches. Up to some dozens of numbers
//! that is less work than sorting.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, i32x8};

/// The most numbers that can be ranked.
pub(crate) const MOST: usize = 128;

/// Ranks n numbers, at most [`MOST`], none above `i32::MAX`. O(n²) comparisons, eight at a time.
///
/// Ranks behind the first n mean nothing.
#[inline(always)]
pub(crate) fn rank<I: Simd>(i: I, numbers: &[u32], ranks: &mut [u32; MOST]) {
    let mut padded = [0; MOST];
    for (place, &number) in padded.iter_mut().zip(numbers) {
        *place = number as i32;
    }
    let (eights, ranks) = (padded.as_chunks().0, ranks.as_chunks_mut().0);
    match numbers.len().div_ceil(8) {
        0 => {}
        1 => rank_some::<I, 1>(i, numbers, eights, ranks),
        2 => rank_some::<I, 2>(i, numbers, eights, ranks),
        3 => rank_some::<I, 3>(i, numbers, eights, ranks),
        count => {
            // Four groups of eight, as there are registers for.
            for first in (0..count).step_by(4) {
                rank_some::<I, 4>(i, numbers, &eights[first..], &mut ranks[first..]);
            }
        }
    }
}

/// Ranks N groups of eight among all numbers.
#[inline(always)]
fn rank_some<I: Simd, const N: usize>(
    i: I,
    numbers: &[u32],
    eights: &[[i32; 8]],
    ranks: &mut [[u32; 8]],
) {
    let zero = i32x8::splat(i, 0);
    let (mut ranked, mut fewer) = ([zero; N], [zero; N]);
    for some in 0..N {
        ranked[some] = i32x8::load_array(i, eights[some]);
    }
    for &number in numbers {
        let number = i32x8::splat(i, number as i32);
        for some in 0..N {
            // A true lane is minus one.
            fewer[some] += ranked[some]
                .simd_gt(number)
                .select(i32x8::splat(i, -1), zero);
        }
    }
    for some in 0..N {
        let mut of_eight = [0; 8];
        (zero - fewer[some]).store_array(&mut of_eight);
        for lane in 0..8 {
            ranks[some][lane] = of_eight[lane].cast_unsigned();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernels::{Instructions, dispatch};
    use pliant_oracle::Random;

    #[test]
    fn every_count_of_any_numbers() {
        let mut random = Random::new(8);
        for count in 0..=MOST {
            let mut numbers: Vec<u32> = (0..count).map(|_| random.below(1 << 31)).collect();
            if let [first, .., last] = &mut numbers[..] {
                (*first, *last) = (i32::MAX as u32, 0);
            }
            for instructions in Instructions::all() {
                let mut ranks = [0; MOST];
                dispatch!(instructions, i => rank(i, &numbers, &mut ranks));
                for (one, rank) in numbers.iter().zip(ranks) {
                    let smaller = numbers.iter().filter(|other| *other < one);
                    assert_eq!(rank as usize, smaller.count(), "{numbers:?}");
                }
            }
        }
    }
}
