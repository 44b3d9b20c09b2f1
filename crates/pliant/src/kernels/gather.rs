//! Gather: points brought into tree order, and bounds of every row of points.
//!
//! While a point is in a register its bounds cost next to nothing. Boxes of upper nodes, whose
//! points are long runs, are then made from bounds of rows instead of points.

use super::{Coordinate, Instructions, dispatch};
use crate::geometry::{IN_A_ROW, RowBounds};
use fearless_simd::prelude::*;

/// Gathers the points that `order` names, each with padding, and the bounds of every [`IN_A_ROW`]
/// points.
///
/// O(points). The last points, fewer than a row, get no bounds.
pub(crate) fn gather<S: Coordinate>(
    instructions: Instructions,
    from: &[[S; 3]],
    order: &[u32],
    points: &mut [[S; 4]],
    bounds: &mut [RowBounds<S>],
) {
    dispatch!(instructions, i => in_rows(i, from, order, points, bounds));
}

#[inline(always)]
fn in_rows<I: Simd, S: Coordinate>(
    i: I,
    from: &[[S; 3]],
    order: &[u32],
    points: &mut [[S; 4]],
    bounds: &mut [RowBounds<S>],
) {
    let (rows, rest) = points.as_chunks_mut::<IN_A_ROW>();
    let (orders, rest_order) = order.as_chunks::<IN_A_ROW>();
    for ((row, order), bounds) in rows.iter_mut().zip(orders).zip(bounds) {
        take(from, order, row);
        let (mut lo, mut hi) = ([S::load(i, &row[0]); 4], [S::load(i, &row[0]); 4]);
        for four in row.as_chunks::<4>().0 {
            for which in 0..4 {
                let point = S::load(i, &four[which]);
                lo[which] = lo[which].min(point);
                hi[which] = hi[which].max(point);
            }
        }
        (lo[0].min(lo[1]).min(lo[2].min(lo[3]))).store_slice(&mut bounds[0]);
        (hi[0].max(hi[1]).max(hi[2].max(hi[3]))).store_slice(&mut bounds[1]);
    }
    // Fewer points than a row need no bounds: nobody reads them.
    take(from, rest_order, rest);
}

/// Gathers points, each with padding.
#[inline(always)]
fn take<S: Copy>(from: &[[S; 3]], order: &[u32], points: &mut [[S; 4]]) {
    for (place, &point) in points.iter_mut().zip(order) {
        let [x, y, z] = from[point as usize];
        *place = [x, y, z, z];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Bounds;
    use crate::kernels::Instructions;

    fn check<S: Coordinate>(number: impl Fn(f64) -> S) {
        for len in [0, 1, IN_A_ROW - 1, IN_A_ROW, 3 * IN_A_ROW + 5] {
            let from: Vec<[S; 3]> = (0..len)
                .map(|at| [at * 37 % 101, at * 11 % 17, at].map(|x| number(x as f64 * 0.3 - 4.0)))
                .collect();
            let order: Vec<u32> = (0..len).map(|at| (at * 7 % len) as u32).collect();
            for instructions in Instructions::all() {
                let mut points = vec![[S::default(); 4]; len];
                let mut bounds = vec![[[S::default(); 4]; 2]; len.div_ceil(IN_A_ROW)];
                gather(instructions, &from, &order, &mut points, &mut bounds);
                for (found, &point) in points.iter().zip(&order) {
                    assert_eq!(found[..3], from[point as usize], "{instructions:?}");
                }
                for (order, found) in order.as_chunks::<IN_A_ROW>().0.iter().zip(&bounds) {
                    let mut row = Bounds::EMPTY;
                    order
                        .iter()
                        .for_each(|&point| row.include(from[point as usize]));
                    assert_eq!(
                        found.map(|corner| [corner[0], corner[1], corner[2]]),
                        [row.lo, row.hi]
                    );
                }
            }
        }
    }

    #[test]
    fn all_instructions_take_points_and_bound_rows() {
        check(|x| x as f32);
        check(|x| x);
    }
}
