//! Search for a number among eight.

use fearless_simd::prelude::*;
use fearless_simd::u32x8;

/// Bit mask of the lanes in which the number is the wanted one.
#[inline(always)]
pub(crate) fn find_lane<I: Simd>(i: I, row: &[u32; 8], wanted: u32) -> u64 {
    u32x8::load_array_ref(i, row).simd_eq(wanted).to_bitmask()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernels::{Instructions, dispatch};

    #[test]
    fn all_instructions_find_every_lane() {
        let row = [7, u32::MAX, 0, 7, 1 << 31, 3, 7, 1];
        for instructions in Instructions::all() {
            for wanted in [0, 1, 2, 3, 7, 1 << 31, u32::MAX] {
                let expected = (0..8).fold(0, |mask, lane| {
                    mask | u64::from(row[lane] == wanted) << lane
                });
                assert_eq!(
                    dispatch!(instructions, i => find_lane(i, &row, wanted)),
                    expected,
                    "{instructions:?}"
                );
            }
        }
    }
}
