//! One pass over the caller's positions: copied, bounded, and checked to be finite and in range.

use super::{Coordinate, Instructions, dispatch};
use crate::geometry::{Bounds, larger, smaller};
use fearless_simd::Simd;

/// Points of one step: 8 points are 24 numbers, which are three registers of any width.
const POINTS: usize = 8;

/// Copies points and returns their bounds, or none if a coordinate is out of range. O(points).
///
/// The slices have the same length.
pub(crate) fn copy_checked<S: Coordinate>(
    instructions: Instructions,
    from: &[[S; 3]],
    to: &mut [[S; 3]],
) -> Option<Bounds<S>> {
    dispatch!(instructions, i => in_lanes::<_, _, true>(i, from, to))
}

/// Checks points without copying them. Returns their bounds, or none if a coordinate is out of
/// range.
pub(crate) fn check<S: Coordinate>(
    instructions: Instructions,
    points: &[[S; 3]],
) -> Option<Bounds<S>> {
    dispatch!(instructions, i => in_lanes::<_, _, false>(i, points, &mut []))
}

#[inline(always)]
fn in_lanes<I: Simd, S: Coordinate, const COPY: bool>(
    _: I,
    from: &[[S; 3]],
    to: &mut [[S; 3]],
) -> Option<Bounds<S>> {
    let mut lo = [S::INFINITY; 3 * POINTS];
    let mut hi = [S::NEG_INFINITY; 3 * POINTS];
    // Bounds skip a NaN, but 0 x is NaN for NaN and infinities, and stays NaN in a sum.
    let mut zeros = [S::default(); 3 * POINTS];
    let mut include = |lane: usize, x: S| {
        lo[lane] = smaller(lo[lane], x);
        hi[lane] = larger(hi[lane], x);
        zeros[lane] = zeros[lane] + x * S::default();
    };
    let (chunks, rest) = from.as_chunks::<POINTS>();
    let (chunks_to, rest_to) = to.as_chunks_mut::<POINTS>();
    for (at, from) in chunks.iter().enumerate() {
        if COPY {
            chunks_to[at] = *from;
        }
        let from: &[S; 3 * POINTS] = from
            .as_flattened()
            .try_into()
            .expect("eight points are twenty-four numbers");
        for lane in 0..3 * POINTS {
            include(lane, from[lane]);
        }
    }
    if COPY {
        rest_to.copy_from_slice(rest);
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks and bounds in plain code, the definition of both kernels.
    fn plain<S: Coordinate>(from: &[[S; 3]]) -> Option<Bounds<S>> {
        let mut bounds = Bounds::EMPTY;
        from.iter().for_each(|&point| bounds.include(point));
        let good = from.as_flattened().iter().all(|x| x.is_in_range());
        good.then_some(bounds)
    }

    /// Tries every length round a whole number of registers, with every bad number in every place.
    fn compare<S: Coordinate>(number: impl Fn(f64) -> S, bad: &[S]) {
        let points: Vec<[S; 3]> = (0..35)
            .map(|at| [at * 7 % 5, 3 - at, at * at % 11].map(|x| number(f64::from(x) * 1.5 - 2.25)))
            .collect();
        for instructions in Instructions::all() {
            for len in [0, 1, 7, 8, 9, 16, 31, 35] {
                let mut to = vec![[S::default(); 3]; len];
                let from = &points[..len];
                assert_eq!(
                    copy_checked(instructions, from, &mut to),
                    plain(from),
                    "{instructions:?} {len}"
                );
                assert_eq!(to, from);
                assert_eq!(check(instructions, from), plain(from));
                for place in 0..3 * len {
                    for &bad in bad {
                        let mut from = from.to_vec();
                        from.as_flattened_mut()[place] = bad;
                        assert_eq!(plain(&from), None);
                        let found = copy_checked(instructions, &from, &mut to);
                        assert_eq!(found, None, "{instructions:?} {bad:?} at {place} of {len}");
                        assert_eq!(check(instructions, &from), None);
                    }
                }
            }
        }
    }

    #[test]
    fn all_instructions_copy_bound_and_refuse_alike() {
        compare(|x| x as f32, &[f32::NAN, f32::INFINITY, f32::NEG_INFINITY]);
        let too_far = f64::from(f32::MAX) * (1.0 + f64::EPSILON);
        compare(
            |x| x,
            &[
                f64::NAN,
                f64::INFINITY,
                f64::NEG_INFINITY,
                too_far,
                -too_far,
                f64::MAX,
            ],
        );
    }

    #[test]
    fn the_largest_numbers_are_good() {
        let far = [[f32::MAX, -f32::MAX, 0.0]; 9];
        let mut to = [[0.0; 3]; 9];
        for instructions in Instructions::all() {
            assert_eq!(copy_checked(instructions, &far, &mut to), plain(&far));
        }
    }
}
