//! Where vertices and triangles, and edges and edges, are closest: four pairs side by side, with proven bounds.
//!
//! **Any points bound the distance from above, any direction from below.** Points of two elements are at least as far apart as these are.
//! And for any r, however it was found, the elements are at least as far apart as their projections on it: the least of r.(p - q) over
//! corners p of the one and q of the other, divided by |r|. So points are looked for in plain arithmetic (of each end and edge, and of the
//! insides), those that are nearest are taken, and r is the way between them: where they are right, both bounds are the distance but for
//! rounding. Where they are not, as for slivers, the bounds are apart and say so.
//!
//! **Rounding.** Let u = 2^-53, and S be the sum of the absolute values of the coordinates of t and both sides, all differences of corners,
//! where the way is r = t + x e + y f with x and y of magnitude at most 1. Each coordinate of a computed r is off by at most 3 u of its
//! part of t and 4 u of its parts of e and f; and where the sum of x and y was rounded to 1, it is at most 1 + u, and the point is off
//! by another u of both. So |r| is off by less than 6 u S. A length adds 4 u of itself, which is at most 4 u S (1 + 6 u): upper bounds allow
//! 20 u S. In projections a difference of corners is off by u of itself, a dot product by 3 u of its terms, whose sum is at most |r| S; a
//! division and the length add 6 u: lower bounds allow 20 u S too. Results below the normal range are off by less than 2^-1020 each: where S
//! is at least 2^-200, that is nothing beside 2^-250 S, even in products of four. Where S is smaller, nothing is sure. As r is a
//! direction only if it is no rounding error, the lower bound is none where |r| is below 20 u S.
//!
//! **Triangles.** Two triangles that do not intersect are as far apart as the nearest of their fifteen pairs of elements. The way between
//! the points of that pair bounds the distance of the triangles too, from below by the projections of all their corners: with S for the
//! largest sum of the absolute coordinates of a difference of two of these, with as much room for rounding. Where they intersect, no
//! direction parts them, and the bounds are apart.

use crate::geometry::{ELEMENT_PAIRS, FIRST_OF_EDGES, Real, four_corners, is_swapped};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x4, mask64x4};

/// The four corners of a pair of elements, each with padding.
pub(crate) type Corners<'q, S> = [&'q [S; 4]; 4];

/// Where four pairs of elements are closest.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct FourClosest {
    /// As `predicates::distance::Closest` has it.
    pub(crate) along: [[f64; 4]; 2],
    /// The way from the second to the first.
    pub(crate) way: [[f64; 4]; 3],
    /// Its length.
    pub(crate) distance: [f64; 4],
    /// The true distance is at least that. Perhaps less than none.
    pub(crate) least: [f64; 4],
    /// It is at most that. Perhaps infinite.
    pub(crate) most: [f64; 4],
}

/// 20 u.
const ERROR: f64 = 20.0 * (f64::EPSILON / 2.0);

/// 2^-200.
const SMALLEST: f64 = f64::from_bits((1023 - 200) << 52);

/// The insides of two edges are taken only where they are nearer than any end by more than this part of the square, which for parallel
/// ones they are not: 2^-40.
const NEARER: f64 = 1.0 - f64::from_bits((1023 - 40) << 52);

/// Three coordinates of four.
type Lanes<I> = [f64x4<I>; 3];

/// The nearest points so far: how far along, and the square of their distance.
struct Best<I: Simd> {
    along: [f64x4<I>; 2],
    square: f64x4<I>,
}

impl<I: Simd> Best<I> {
    /// Takes others where a mask says so.
    #[inline(always)]
    fn take(&mut self, mask: mask64x4<I>, along: [f64x4<I>; 2], square: f64x4<I>) {
        self.along = [
            mask.select(along[0], self.along[0]),
            mask.select(along[1], self.along[1]),
        ];
        self.square = mask.select(square, self.square);
    }

    /// Takes others where they are nearer.
    #[inline(always)]
    fn take_nearer(&mut self, along: [f64x4<I>; 2], square: f64x4<I>) {
        let mask = square.simd_lt(self.square);
        self.take(mask, along, square);
    }
}

/// Where points p and triangles a b c are closest: corners in this order.
#[inline(always)]
pub(crate) fn of_vertices_and_triangles<I: Simd, S: Real>(
    i: I,
    pairs: &[Corners<S>; 4],
) -> FourClosest {
    let [p, a, b, c] = [
        lanes(i, pairs, 0),
        lanes(i, pairs, 1),
        lanes(i, pairs, 2),
        lanes(i, pairs, 3),
    ];
    let zero = f64x4::splat(i, 0.0);
    let one = f64x4::splat(i, 1.0);
    let (e1, e2, e3) = (minus(b, a), minus(c, a), minus(c, b));
    let (t, of_b, of_c) = (minus(p, a), minus(p, b), minus(p, c));

    let (s, square) = on_segment(t, e1);
    let mut best = Best {
        along: [s, zero],
        square,
    };
    let (s, square) = on_segment(t, e2);
    best.take_nearer([zero, s], square);
    let (s, square) = on_segment(of_b, e3);
    // Of x and 1 - x the sum is 1 exactly: the first corner counts nothing.
    let x = one - s;
    best.take_nearer([x, one - x], square);

    // The foot on the plane, by Cramer's rule.
    let (d11, d12, d22) = (dot(e1, e1), dot(e1, e2), dot(e2, e2));
    let (t1, t2) = (dot(t, e1), dot(t, e2));
    let whole = d11 * d22 - d12 * d12;
    let (x, y) = ((d22 * t1 - d12 * t2) / whole, (d11 * t2 - d12 * t1) / whole);
    let is_inside = whole.simd_gt(zero) & x.simd_ge(zero) & y.simd_ge(zero) & (x + y).simd_le(one);
    let square = square_of(plus(plus(t, times(zero - x, e1)), times(zero - y, e2)));
    best.take(is_inside & square.simd_lt(best.square), [x, y], square);

    let [x, y] = best.along;
    let way = plus(plus(t, times(zero - x, e1)), times(zero - y, e2));
    let projections = [dot(way, t), dot(way, of_b), dot(way, of_c)];
    let least = projections[0].min(projections[1]).min(projections[2]);
    bounds(i, [x, y], way, least, [t, e1, e2])
}

/// Where edges a0 a1 and b0 b1 are closest: corners in this order.
#[inline(always)]
pub(crate) fn of_edges<I: Simd, S: Real>(i: I, pairs: &[Corners<S>; 4]) -> FourClosest {
    let [a0, a1, b0, b1] = [
        lanes(i, pairs, 0),
        lanes(i, pairs, 1),
        lanes(i, pairs, 2),
        lanes(i, pairs, 3),
    ];
    let zero = f64x4::splat(i, 0.0);
    let one = f64x4::splat(i, 1.0);
    let (e, f) = (minus(a1, a0), minus(b1, b0));
    let (t, t10, t01, t11) = (minus(a0, b0), minus(a1, b0), minus(a0, b1), minus(a1, b1));
    let back = times(f64x4::splat(i, -1.0), e);

    // Ends of the first on the second, and of the second on the first.
    let (y, square) = on_segment(t, f);
    let mut best = Best {
        along: [zero, y],
        square,
    };
    let (y, square) = on_segment(t10, f);
    best.take_nearer([one, y], square);
    let (x, square) = on_segment(t, back);
    best.take_nearer([x, zero], square);
    let (x, square) = on_segment(t01, back);
    best.take_nearer([x, one], square);

    // The feet of the common normal, by Cramer's rule.
    let (d11, d12, d22) = (dot(e, e), dot(e, f), dot(f, f));
    let (t1, t2) = (dot(t, e), dot(t, f));
    let whole = d11 * d22 - d12 * d12;
    let (x, y) = ((d12 * t2 - d22 * t1) / whole, (d11 * t2 - d12 * t1) / whole);
    let is_inside =
        whole.simd_gt(zero) & x.simd_ge(zero) & x.simd_le(one) & y.simd_ge(zero) & y.simd_le(one);
    let square = square_of(plus(plus(t, times(x, e)), times(zero - y, f)));
    let is_nearer = square.simd_lt(best.square * f64x4::splat(i, NEARER));
    best.take(is_inside & is_nearer, [x, y], square);

    let [x, y] = best.along;
    let way = plus(plus(t, times(x, e)), times(zero - y, f));
    let least = dot(way, t)
        .min(dot(way, t10))
        .min(dot(way, t01).min(dot(way, t11)));
    bounds(i, [x, y], way, least, [t, e, f])
}

/// Where two triangles are closest, unless they intersect.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TwoClosest {
    /// The nearest pair of elements, by its number, and how far along these.
    pub(crate) which: usize,
    pub(crate) along: [f64; 2],
    /// The way from the second triangle to the first.
    pub(crate) way: [f64; 3],
    /// Its length.
    pub(crate) distance: f64,
    /// The true distance is at least that. Perhaps less than none, which it is where they intersect.
    pub(crate) least: f64,
    /// It is at most that. Perhaps infinite.
    pub(crate) most: f64,
}

/// Where two triangles are closest, by their corners.
#[inline(always)]
pub(crate) fn of_triangles<I: Simd, S: Real>(
    i: I,
    a: &[&[S; 4]; 3],
    b: &[&[S; 4]; 3],
) -> TwoClosest {
    let mut nearest = TwoClosest {
        distance: f64::INFINITY,
        most: f64::INFINITY,
        ..TwoClosest::default()
    };
    let mut least_of_nearest = f64::NEG_INFINITY;
    let mut first = 0;
    while first < ELEMENT_PAIRS {
        let end = if first < FIRST_OF_EDGES {
            FIRST_OF_EDGES
        } else {
            ELEMENT_PAIRS
        };
        let count = (end - first).min(4);
        let mut pairs = [four_corners(first, a, b); 4];
        for lane in 1..count {
            pairs[lane] = four_corners(first + lane, a, b);
        }
        let found = if first < FIRST_OF_EDGES {
            of_vertices_and_triangles(i, &pairs)
        } else {
            of_edges(i, &pairs)
        };
        for lane in 0..count {
            nearest.most = nearest.most.min(found.most[lane]);
            if found.distance[lane] < nearest.distance {
                nearest.which = first + lane;
                nearest.along = [found.along[0][lane], found.along[1][lane]];
                nearest.way = [found.way[0][lane], found.way[1][lane], found.way[2][lane]];
                nearest.distance = found.distance[lane];
                least_of_nearest = found.least[lane];
            }
        }
        first += count;
    }
    if is_swapped(nearest.which) {
        let [x, y, z] = nearest.way;
        nearest.way = [0.0 - x, 0.0 - y, 0.0 - z];
    }
    nearest.least = f64::NEG_INFINITY;
    let way = nearest.way;
    if least_of_nearest > 0.0 {
        let [mut projection, mut largest] = [f64::INFINITY, 0.0_f64];
        for p in a {
            for q in b {
                let d = [
                    p[0].to_f64() - q[0].to_f64(),
                    p[1].to_f64() - q[1].to_f64(),
                    p[2].to_f64() - q[2].to_f64(),
                ];
                projection = projection.min(way[0] * d[0] + way[1] * d[1] + way[2] * d[2]);
                largest = largest.max(d[0].abs() + d[1].abs() + d[2].abs());
            }
        }
        nearest.least = projection / nearest.distance - ERROR * largest;
    }
    nearest
}

/// How far along a segment from 0 to e the point is that is nearest to t, from 0 to 1; and the square of their distance.
#[inline(always)]
fn on_segment<I: Simd>(t: Lanes<I>, e: Lanes<I>) -> (f64x4<I>, f64x4<I>) {
    let i = t[0].token();
    let (zero, one) = (f64x4::splat(i, 0.0), f64x4::splat(i, 1.0));
    let (part, whole) = (dot(t, e), dot(e, e));
    // Of a segment that is a point, both are zero.
    let inside = part.simd_lt(whole).select(part / whole, one);
    let s = part.simd_gt(zero).select(inside, zero);
    (s, square_of(plus(t, times(zero - s, e))))
}

/// Both bounds of the distance, of a way that was computed from three differences of corners, and its least projection of such.
#[inline(always)]
fn bounds<I: Simd>(
    i: I,
    along: [f64x4<I>; 2],
    way: Lanes<I>,
    projection: f64x4<I>,
    differences: [Lanes<I>; 3],
) -> FourClosest {
    let mut sum = f64x4::splat(i, 0.0);
    for difference in differences {
        for x in difference {
            sum += x.abs();
        }
    }
    let infinity = f64x4::splat(i, f64::INFINITY);
    let error = sum * f64x4::splat(i, ERROR);
    let distance = square_of(way).sqrt();
    let is_known = sum.simd_ge(f64x4::splat(i, SMALLEST));
    let is_a_way = is_known & distance.simd_ge(error);
    let least = is_a_way.select(
        projection / distance - error,
        f64x4::splat(i, 0.0) - infinity,
    );
    let most = is_known.select(distance + error, infinity);
    let mut closest = FourClosest::default();
    for which in 0..2 {
        along[which].store_array(&mut closest.along[which]);
    }
    for axis in 0..3 {
        way[axis].store_array(&mut closest.way[axis]);
    }
    distance.store_array(&mut closest.distance);
    least.store_array(&mut closest.least);
    most.store_array(&mut closest.most);
    closest
}

/// The same corner of four pairs, side by side.
#[inline(always)]
fn lanes<I: Simd, S: Real>(i: I, pairs: &[Corners<S>; 4], which: usize) -> Lanes<I> {
    let load = |lane: usize| {
        let [x, y, z, w] = *pairs[lane][which];
        f64x4::load_array(i, [x.to_f64(), y.to_f64(), z.to_f64(), w.to_f64()])
    };
    let (a, b, c, d) = (load(0), load(1), load(2), load(3));
    // Four rows to columns, of which the last is padding.
    let (ac, bd) = (a.zip_low(c), b.zip_low(d));
    let (ac_high, bd_high) = (a.zip_high(c), b.zip_high(d));
    [ac.zip_low(bd), ac.zip_high(bd), ac_high.zip_low(bd_high)]
}

#[inline(always)]
fn plus<I: Simd>(p: Lanes<I>, q: Lanes<I>) -> Lanes<I> {
    [p[0] + q[0], p[1] + q[1], p[2] + q[2]]
}

#[inline(always)]
fn minus<I: Simd>(p: Lanes<I>, q: Lanes<I>) -> Lanes<I> {
    [p[0] - q[0], p[1] - q[1], p[2] - q[2]]
}

#[inline(always)]
fn times<I: Simd>(by: f64x4<I>, p: Lanes<I>) -> Lanes<I> {
    [by * p[0], by * p[1], by * p[2]]
}

#[inline(always)]
fn dot<I: Simd>(p: Lanes<I>, q: Lanes<I>) -> f64x4<I> {
    p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
}

#[inline(always)]
fn square_of<I: Simd>(p: Lanes<I>) -> f64x4<I> {
    dot(p, p)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernels::{Instructions, dispatch};
    use crate::predicates::distance::{Primitives, closest, hard_pairs};
    use pliant_oracle::{Class, Random, compare_distance, compare_dot, compare_length};
    use std::cmp::Ordering;

    /// A pair in each lane.
    fn four(i: impl Simd, all: [&Primitives; 4]) -> FourClosest {
        let corners = all.map(|elements| {
            let (Primitives::VertexTriangle(four) | Primitives::EdgeEdge(four)) = elements;
            four.map(|[x, y, z]| [x, y, z, z])
        });
        let pairs = corners.each_ref().map(<[_; 4]>::each_ref);
        match all[0] {
            Primitives::VertexTriangle(_) => of_vertices_and_triangles(i, &pairs),
            Primitives::EdgeEdge(_) => of_edges(i, &pairs),
        }
    }

    #[test]
    fn bounds_hold_the_distance() {
        let mut random = Random::new(42);
        let [mut known, mut close, mut total] = [0; 3];
        for round in 0..6_000 {
            let class = Class::ALL[round % Class::ALL.len()];
            let pair = class.pair(&mut random);
            for (elements, a, b) in hard_pairs(&pair) {
                let exact = closest(&elements);
                let mut of_all: Option<FourClosest> = None;
                for instructions in Instructions::all() {
                    let found = dispatch!(instructions, i => four(i, [&elements; 4]));
                    let bits = |found: &FourClosest| format!("{found:?}");
                    let before = of_all.get_or_insert(found);
                    assert_eq!(bits(before), bits(&found));
                }
                let found = of_all.expect("there are instructions");
                let (least, most) = (found.least[0], found.most[0]);
                assert!(most >= 0.0 && !least.is_nan());
                if least > 0.0 {
                    assert_ne!(
                        compare_distance(&a, &b, least),
                        Ordering::Less,
                        "{elements:?} {found:?}"
                    );
                }
                if most < f64::INFINITY {
                    assert_ne!(
                        compare_distance(&a, &b, most),
                        Ordering::Greater,
                        "{elements:?} {found:?}"
                    );
                }
                total += 1;
                known += u32::from(most < f64::INFINITY);
                close += u32::from(most - least <= 1e-9 * exact.distance);
            }
        }
        assert!(
            known > total / 2 && close > total / 5,
            "{known} {close} {total}"
        );
    }

    #[test]
    fn points_and_direction_are_as_far_apart_as_is_said() {
        // Of both ways to find them, where one is certain of itself.
        let mut random = Random::new(43);
        let mut checked = [0; 2];
        for round in 0..4_000 {
            let pair = Class::ALL[round % Class::ALL.len()].pair(&mut random);
            for (elements, a, b) in hard_pairs(&pair) {
                let exact = closest(&elements);
                let found = dispatch!(Instructions::widest(), i => four(i, [&elements; 4]));
                let is_certain =
                    found.most[0] - found.least[0] <= 2f64.powi(-30) * found.distance[0];
                let mut answers = vec![(0, exact.distance, exact.along, exact.direction)];
                if is_certain {
                    let d = found.distance[0];
                    let along = found.along.map(|it| it[0]);
                    answers.push((1, d, along, found.way.map(|it| it[0] / d)));
                }
                let size = a
                    .iter()
                    .chain(&b)
                    .flat_map(|p| (0..3).map(|x| (p[x] - a[0][x]).abs()));
                let size = size.fold(0.0, f64::max);
                if size < 1e-30 {
                    continue;
                }
                for (which, d, [x, y], direction) in answers {
                    let sum = match elements {
                        Primitives::VertexTriangle([p, a, b, c]) => {
                            vec![(1.0, p), (-1.0, a), (-x, b), (x, a), (-y, c), (y, a)]
                        }
                        Primitives::EdgeEdge([a0, a1, b0, b1]) => {
                            vec![(1.0, a0), (x, a1), (-x, a0), (-1.0, b0), (-y, b1), (y, b0)]
                        }
                    };
                    let slack = 2f64.powi(-30) * d + 2f64.powi(-48) * size;
                    assert_ne!(
                        compare_length(&sum, d + slack),
                        Ordering::Greater,
                        "{elements:?} {x} {y} {d}"
                    );
                    if d > f64::MIN_POSITIVE {
                        for p in &a {
                            for q in &b {
                                assert_ne!(
                                    compare_dot(direction, *p, *q, d - slack),
                                    Ordering::Less,
                                    "{elements:?} {direction:?} {d}"
                                );
                            }
                        }
                    }
                    checked[which] += 1;
                }
            }
        }
        assert!(checked[0] > 15_000 && checked[1] > 5_000, "{checked:?}");
    }
}
