//! Bounding boxes: of a run of points and some others, of twelve points, and of triangles.

use super::Coordinate;
use super::boxes::BoxLanes;
use super::coordinate::{lanes_of, turn};
use crate::geometry::{Aabb, IN_A_ROW, OUTWARD, Shape};
use crate::ids::TreeVertex;
use fearless_simd::f32x4;
use fearless_simd::prelude::*;

/// A box in two registers: its lower and its upper corner, each with padding.
pub(crate) type Extent<I> = (f32x4<I>, f32x4<I>);

/// Number of vertices that most leaves have at most: eight triangles of a surface have ten to
/// twelve.
pub(crate) const TWELVE: usize = 12;

/// Stores the first `count` boxes side by side in lanes. Other lanes are empty.
#[inline(always)]
pub(crate) fn store<I: Simd, const N: usize>(
    boxes: [Extent<I>; 8],
    count: usize,
    lanes: &mut BoxLanes<N>,
) {
    let (mut lo, mut hi) = ([boxes[0].0; 8], [boxes[0].1; 8]);
    for lane in 1..8 {
        (lo[lane], hi[lane]) = boxes[lane];
    }
    let (lo, hi) = (lanes_of(lo), lanes_of(hi));
    for axis in 0..3 {
        lanes.lo[axis].copy_from_slice(&lo[axis].as_slice()[..N]);
        lanes.hi[axis].copy_from_slice(&hi[axis].as_slice()[..N]);
    }
    if count < N {
        lanes.empty_from(count);
    }
}

/// Four boxes as lanes, and their union.
#[derive(Clone, Copy)]
pub(crate) struct Four<I: Simd> {
    lo: [f32x4<I>; 3],
    hi: [f32x4<I>; 3],
    all: Extent<I>,
}

impl<I: Simd> Four<I> {
    /// Transposes four boxes. Four at a time stay in registers; eight would not.
    #[inline(always)]
    pub(crate) fn new(boxes: [Extent<I>; 4]) -> Self {
        let [a, b, c, d] = boxes;
        Self {
            lo: turn([a.0, b.0, c.0, d.0]),
            hi: turn([a.1, b.1, c.1, d.1]),
            all: (
                a.0.min(b.0).min(c.0.min(d.0)),
                a.1.max(b.1).max(c.1.max(d.1)),
            ),
        }
    }

    /// Stores these and four later boxes side by side, the first `count` of them. Returns the union
    /// of all eight.
    #[inline(always)]
    pub(crate) fn store(self, later: Self, count: usize, lanes: &mut BoxLanes<8>) -> Extent<I> {
        for axis in 0..3 {
            self.lo[axis]
                .combine(later.lo[axis])
                .store_array(&mut lanes.lo[axis]);
            self.hi[axis]
                .combine(later.hi[axis])
                .store_array(&mut lanes.hi[axis]);
        }
        if count < 8 {
            lanes.empty_from(count);
        }
        (self.all.0.min(later.all.0), self.all.1.max(later.all.1))
    }
}

/// The empty box, for lanes that are not used.
#[inline(always)]
pub(crate) fn nothing<I: Simd>(i: I) -> Extent<I> {
    (f32x4::splat(i, f32::NAN), f32x4::splat(i, f32::NAN))
}

/// Loads a box that is known already.
#[inline(always)]
pub(crate) fn of_box<I: Simd>(i: I, known: &Aabb) -> Extent<I> {
    let wide = |[x, y, z]: [f32; 3]| f32x4::simd_from(i, [x, y, z, z]);
    (wide(known.lo), wide(known.hi))
}

/// Stores an extent as a box.
#[cfg(test)]
pub(crate) fn to_box<I: Simd>((lo, hi): Extent<I>) -> Aabb {
    let [lo, hi] = [lo, hi].map(|corner| {
        let [x, y, z, _] = corner.to_array();
        [x, y, z]
    });
    Aabb { lo, hi }
}

/// The smallest box that holds two boxes.
#[inline(always)]
pub(crate) fn union<I: Simd>(a: Extent<I>, b: Extent<I>) -> Extent<I> {
    (a.0.min(b.0), a.1.max(b.1))
}

/// A box grown by a distance on every side, as `Aabb::grown` defines it.
#[inline(always)]
pub(crate) fn grown<I: Simd>(i: I, (lo, hi): Extent<I>, distance: f32) -> Extent<I> {
    let distance = f32x4::splat(i, distance);
    let (lo, hi) = (lo - distance, hi + distance);
    (
        lo - (lo.abs() * OUTWARD + f32::MIN_POSITIVE),
        hi + (hi.abs() * OUTWARD + f32::MIN_POSITIVE),
    )
}

/// Bounding box of the points of a run and of some others, at least one in all.
#[inline(always)]
pub(crate) fn of_points<I: Simd, S: Coordinate>(
    i: I,
    shape: &Shape<S>,
    run: std::ops::Range<usize>,
    others: &[TreeVertex],
) -> Extent<I> {
    if run.is_empty()
        && let Ok(others) = others.try_into()
    {
        return of_twelve(i, shape, others);
    }
    // A long run is some points, then rows that have bounds of their own, then some points.
    let rows = run.start.div_ceil(IN_A_ROW)..run.end / IN_A_ROW;
    let (head, rows, tail) = if rows.start < rows.end {
        let (start, end) = (rows.start * IN_A_ROW, rows.end * IN_A_ROW);
        (run.start..start, rows, end..run.end)
    } else {
        (run.clone(), 0..0, 0..0)
    };
    let first = match others.first() {
        Some(&other) => shape.positions.padded(other),
        None => &shape.positions.points[run.start],
    };
    let first = S::load(i, first);
    let (mut lo, mut hi) = ([first; 4], [first; 4]);
    include(i, &shape.positions.points[head], &mut lo, &mut hi);
    for [row_lo, row_hi] in &shape.positions.bounds[rows] {
        lo[0] = lo[0].min(S::load(i, row_lo));
        hi[0] = hi[0].max(S::load(i, row_hi));
    }
    include(i, &shape.positions.points[tail], &mut lo, &mut hi);
    let (fours, rest) = others.as_chunks::<4>();
    for four in fours {
        for which in 0..4 {
            let point = S::load(i, shape.positions.padded(four[which]));
            lo[which] = lo[which].min(point);
            hi[which] = hi[which].max(point);
        }
    }
    for &other in rest {
        let point = S::load(i, shape.positions.padded(other));
        (lo[1], hi[1]) = (lo[1].min(point), hi[1].max(point));
    }
    let lo = lo[0].min(lo[1]).min(lo[2].min(lo[3]));
    let hi = hi[0].max(hi[1]).max(hi[2].max(hi[3]));
    S::outward(lo, hi, &shape.origin)
}

/// Includes consecutive points, several at a time, so that no minimum waits for the one before.
#[inline(always)]
fn include<I: Simd, S: Coordinate>(
    i: I,
    points: &[[S; 4]],
    lo: &mut [S::Four<I>; 4],
    hi: &mut [S::Four<I>; 4],
) {
    let (fours, rest) = points.as_chunks::<4>();
    for four in fours {
        for which in 0..4 {
            let point = S::load(i, &four[which]);
            lo[which] = lo[which].min(point);
            hi[which] = hi[which].max(point);
        }
    }
    for point in rest {
        let point = S::load(i, point);
        (lo[0], hi[0]) = (lo[0].min(point), hi[0].max(point));
    }
}

/// Bounding box of twelve points, which is enough for most leaves.
#[inline(always)]
pub(crate) fn of_twelve<I: Simd, S: Coordinate>(
    i: I,
    shape: &Shape<S>,
    points: &[TreeVertex; TWELVE],
) -> Extent<I> {
    let first = S::load(i, shape.positions.padded(points[0]));
    let (mut lo, mut hi) = ([first; 2], [first; 2]);
    for which in 1..TWELVE {
        let point = S::load(i, shape.positions.padded(points[which]));
        lo[which % 2] = lo[which % 2].min(point);
        hi[which % 2] = hi[which % 2].max(point);
    }
    S::outward(lo[0].min(lo[1]), hi[0].max(hi[1]), &shape.origin)
}

/// Bounding box of one triangle.
#[inline(always)]
pub(crate) fn of_corners<I: Simd, S: Coordinate>(
    i: I,
    Shape {
        positions, origin, ..
    }: &Shape<S>,
    corners: [TreeVertex; 3],
) -> Extent<I> {
    let a = S::load(i, positions.padded(corners[0]));
    let b = S::load(i, positions.padded(corners[1]));
    let c = S::load(i, positions.padded(corners[2]));
    S::outward(a.min(b).min(c), a.max(b).max(c), origin)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Bounds, Points};
    use crate::ids::TreeTriangle;
    use crate::kernels::{Instructions, dispatch};

    /// Compares the boxes of all instruction sets with the boxes of `Shape` and `Bounds`, bit for
    /// bit.
    fn check<S: Coordinate>(points: &[[S; 3]], origin: [f64; 4]) {
        let positions = Points::of(points.iter().copied());
        let triangles: Vec<[TreeVertex; 3]> = (0..points.len() as u32 - 2)
            .map(|first| [first, first + 2, first + 1].map(TreeVertex))
            .collect();
        let shape = Shape {
            positions: &positions,
            triangles: &triangles,
            origin,
            version: 1,
        };
        for instructions in Instructions::all() {
            dispatch!(instructions, i => {
                for (triangle, &corners) in triangles.iter().enumerate() {
                    let expected = shape.box_of(TreeTriangle(triangle as u32));
                    let found = to_box(of_corners(i, &shape, corners));
                    assert_eq!(found, expected, "{instructions:?}");
                }
                for count in 1..=8 {
                    let mut lanes = BoxLanes::<8>::EMPTY;
                    let mut boxes = [nothing(i); 8];
                    for lane in 0..count {
                        boxes[lane] = of_corners(i, &shape, triangles[lane]);
                    }
                    store(boxes, count, &mut lanes);
                    for lane in 0..count {
                        assert_eq!(lanes.get(lane), shape.box_of(TreeTriangle(lane as u32)));
                    }
                    for lane in count..8 {
                        assert!(lanes.get(lane).lo.iter().all(|x| x.is_nan()));
                    }
                    assert_eq!(to_box(of_box(i, &lanes.union())), lanes.union());
                }
                for (run, others) in [
                    (4..9, &[][..]),
                    (2..2, &[1]),
                    (5..6, &[0, 8]),
                    (0..3, &[7, 5, 9]),
                    (3..3, &[7, 5, 9, 0, 2, 2, 6, 6]),
                    (3..3, &[7, 5, 9, 0, 2, 1, 6, 11, 13, 4, 3, 3]),
                ] {
                    let others: Vec<TreeVertex> = others.iter().copied().map(TreeVertex).collect();
                    let mut bounds = Bounds::EMPTY;
                    let of_run = run.clone().map(|place| TreeVertex(place as u32));
                    let all = of_run.chain(others.iter().copied());
                    all.for_each(|vertex| bounds.include(positions.get(vertex)));
                    assert_eq!(to_box(of_points(i, &shape, run, &others)), bounds.to_box(origin));
                }
            });
        }
    }

    #[test]
    fn all_instructions_make_the_same_boxes() {
        let wave = |i: usize| {
            [
                (i * i) as f64 * 0.37 - 3.0,
                1.0 / (i as f64 - 4.5),
                -1e6 * i as f64,
            ]
        };
        let points: Vec<[f64; 3]> = (0..14).map(wave).collect();
        let narrow: Vec<[f32; 3]> = points.iter().map(|point| point.map(|x| x as f32)).collect();
        check(&narrow, [0.0; 4]);
        check(&points, [0.1, -7.0, 1e5, 0.0]);
        let far = f64::from(f32::MAX);
        let wild: Vec<[f64; 3]> = (0..14)
            .map(|i| {
                [
                    [far, -far, 1e-320, 5e-40, 0.0][i % 5],
                    [1e-310, far][i % 2],
                    3.0,
                ]
            })
            .collect();
        check(&wild, [-far, 1e-300, 3.0, 0.0]);
    }
}
