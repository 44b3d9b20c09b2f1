//! The one pass over positions that the caller brings: copied, bounded, and checked to be numbers in range.

use crate::geometry::{Bounds, Scalar, larger, smaller};
use fearless_simd::{Level, Simd, dispatch};

/// Eight points are twenty-four numbers: as many as three registers hold, whatever their width.
const POINTS: usize = 8;

/// Copies points, and returns their bounds, or none if a coordinate is out of range. The slices are equally long.
pub(crate) fn take_over<S: Scalar>(
    level: Level,
    from: &[[S; 3]],
    to: &mut [[S; 3]],
) -> Option<Bounds<S>> {
    dispatch!(level, i => in_lanes(i, from, to))
}

#[inline(always)]
fn in_lanes<I: Simd, S: Scalar>(_: I, from: &[[S; 3]], to: &mut [[S; 3]]) -> Option<Bounds<S>> {
    let mut lo = [S::INFINITY; 3 * POINTS];
    let mut hi = [S::NEG_INFINITY; 3 * POINTS];
    // Bounds pass a NaN over, but 0 x is NaN for NaN and infinities, and stays so in a sum.
    let mut zeros = [S::default(); 3 * POINTS];
    let mut include = |lane: usize, x: S| {
        lo[lane] = smaller(lo[lane], x);
        hi[lane] = larger(hi[lane], x);
        zeros[lane] = zeros[lane] + x * S::default();
    };
    let (chunks, rest) = from.as_chunks::<POINTS>();
    let (chunks_to, rest_to) = to.as_chunks_mut::<POINTS>();
    for (from, to) in chunks.iter().zip(chunks_to) {
        *to = *from;
        let from: &[S; 3 * POINTS] = from
            .as_flattened()
            .try_into()
            .expect("eight points are twenty-four numbers");
        for lane in 0..3 * POINTS {
            include(lane, from[lane]);
        }
    }
    rest_to.copy_from_slice(rest);
    for (lane, &x) in rest.as_flattened().iter().enumerate() {
        include(lane, x);
    }
    let mut bounds = Bounds::EMPTY;
    for lane in 0..3 * POINTS {
        let axis = lane % 3;
        bounds.lo[axis] = smaller(bounds.lo[axis], lo[lane]);
        bounds.hi[axis] = larger(bounds.hi[axis], hi[lane]);
    }
    let numbers = zeros.iter().all(|&sum| sum == S::default());
    let in_range = |corner: [S; 3]| corner.iter().all(|x| x.is_in_range());
    (numbers && (from.is_empty() || in_range(bounds.lo) && in_range(bounds.hi))).then_some(bounds)
}
