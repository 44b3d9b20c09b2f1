//! Capsules of eight nodes or triangles side by side, and which pairs of eight are surely apart.
//!
//! Boxes of long thin things overlap although these are far apart. Two are apart if their
//! projections on some direction are. Tried are, for a capsule and a box, the three directions that
//! are square to its axis and to an axis of the box. For two capsules these are the direction
//! square to both axes, and the one from axis to axis.

use super::boxes::{BoxLanes, Registers};
use super::coordinate::Vectors;
use crate::geometry::Capsule;
use crate::geometry::vector::{cross, dot, minus, times};
use fearless_simd::prelude::*;
use fearless_simd::{f32x8, mask32x8};

/// Bound on rounding: 2^-20, 16 u.
const RELATIVE_ERROR: f32 = 1.0 / (1 << 20) as f32;
/// Bound on what is lost below the normal range: 2^-120.
const LOST: f32 = 1.0 / (1_u128 << 120) as f32;
/// Bound on what a length loses whose squares are below the normal range, each by 2^-126: 2^-62.
const SHORT: f32 = 1.0 / (1_u64 << 62) as f32;

/// Eight capsules in structure-of-arrays order. A lane without one holds everything.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EightCapsules {
    middle: [[f32; 8]; 3],
    along: [[f32; 8]; 3],
    reach: [f32; 8],
    radius: [f32; 8],
}

/// Eight boxes or fewer, and the capsules of the same things, if they have any.
#[derive(Clone, Copy)]
pub(crate) struct Volumes<'b, const N: usize> {
    pub(crate) boxes: &'b BoxLanes<N>,
    pub(crate) capsules: Option<&'b EightCapsules>,
}

impl EightCapsules {
    pub(crate) const EVERYTHING: Self = Self {
        middle: [[0.0; 8]; 3],
        along: [[0.0; 8]; 3],
        reach: [0.0; 8],
        radius: [f32::INFINITY; 8],
    };

    /// Capsule of a lane.
    pub(crate) fn get(&self, lane: usize) -> Capsule {
        Capsule {
            middle: self.middle.map(|row| row[lane]),
            along: self.along.map(|row| row[lane]),
            reach: self.reach[lane],
            radius: self.radius[lane],
        }
    }

    #[inline(always)]
    pub(crate) fn set(&mut self, lane: usize, capsule: &Capsule) {
        for axis in 0..3 {
            self.middle[axis][lane] = capsule.middle[axis];
            self.along[axis][lane] = capsule.along[axis];
        }
        self.reach[lane] = capsule.reach;
        self.radius[lane] = capsule.radius;
    }
}

/// Capsules in registers: eight, or one in all lanes.
#[derive(Clone, Copy)]
struct Capsules<I: Simd> {
    middle: Vectors<I>,
    along: Vectors<I>,
    reach: f32x8<I>,
    radius: f32x8<I>,
}

/// Middles and half sides of boxes in registers: eight, or one in all lanes.
#[derive(Clone, Copy)]
struct Middles<I: Simd> {
    middle: Vectors<I>,
    half: Vectors<I>,
}

impl<I: Simd> Capsules<I> {
    #[inline(always)]
    fn eight(i: I, all: &EightCapsules) -> Self {
        let nothing = f32x8::splat(i, 0.0);
        let mut eight = Self {
            middle: [nothing; 3],
            along: [nothing; 3],
            reach: f32x8::load_array_ref(i, &all.reach),
            radius: f32x8::load_array_ref(i, &all.radius),
        };
        for axis in 0..3 {
            eight.middle[axis] = f32x8::load_array_ref(i, &all.middle[axis]);
            eight.along[axis] = f32x8::load_array_ref(i, &all.along[axis]);
        }
        eight
    }

    #[inline(always)]
    fn one(i: I, all: &EightCapsules, lane: usize) -> Self {
        let nothing = f32x8::splat(i, 0.0);
        let mut one = Self {
            middle: [nothing; 3],
            along: [nothing; 3],
            reach: f32x8::splat(i, all.reach[lane]),
            radius: f32x8::splat(i, all.radius[lane]),
        };
        for axis in 0..3 {
            one.middle[axis] = f32x8::splat(i, all.middle[axis][lane]);
            one.along[axis] = f32x8::splat(i, all.along[axis][lane]);
        }
        one
    }

    /// Mask of the lanes in which the capsule is surely apart from the box. Their boxes overlap.
    #[inline(always)]
    fn are_off(&self, boxes: &Middles<I>) -> mask32x8<I> {
        let i = self.reach.token();
        let way = minus(self.middle, boxes.middle);
        let mut size = self.along;
        for axis in 0..3 {
            size[axis] = self.along[axis].abs();
        }
        let far = f32x8::splat(i, 1.0 + RELATIVE_ERROR);
        let mut off = self.radius.simd_lt(f32x8::splat(i, 0.0));
        for axis in 0..3 {
            let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
            let apart = (self.along[k] * way[j] - self.along[j] * way[k]).abs();
            let long = (size[j] * size[j] + size[k] * size[k]).sqrt() + SHORT;
            // Bounds on way[j] and way[k], as boxes overlap.
            let near_j = self.middle[j].abs() + size[j] * self.reach + self.radius;
            let near_k = self.middle[k].abs() + size[k] * self.reach + self.radius;
            let error = (size[k] * near_j + size[j] * near_k) * RELATIVE_ERROR + LOST;
            let room = (size[k] * boxes.half[j] + size[j] * boxes.half[k]) * far
                + long * self.radius * far
                + error;
            off |= apart.simd_gt(room);
        }
        off
    }

    /// Bit mask of the lanes in which two capsules are surely apart.
    #[inline(always)]
    fn are_apart(&self, other: &Self) -> mask32x8<I> {
        let way = minus(self.middle, other.middle);
        let square = dot(self.along, self.along);
        let aside = minus(times(square, way), times(dot(way, self.along), self.along));
        self.separates(other, way, cross(self.along, other.along))
            | self.separates(other, way, aside)
    }

    /// Bit mask of the lanes in which a direction separates two capsules.
    #[inline(always)]
    fn separates(&self, other: &Self, way: Vectors<I>, n: Vectors<I>) -> mask32x8<I> {
        let i = self.reach.token();
        let length = dot(n, n).sqrt() + SHORT;
        let room = length * (self.radius + other.radius) * f32x8::splat(i, 1.0 + RELATIVE_ERROR);
        let reach = dot(n, self.along).abs() * self.reach + dot(n, other.along).abs() * other.reach;
        let error = sum_of(n) * (sum_of(way) + self.reach + other.reach) * RELATIVE_ERROR + LOST;
        dot(n, way).abs().simd_gt(room + reach + error)
    }
}

/// Sum of the magnitudes of the components of a vector.
#[inline(always)]
fn sum_of<I: Simd>(v: Vectors<I>) -> f32x8<I> {
    v[0].abs() + v[1].abs() + v[2].abs()
}

impl<I: Simd> Middles<I> {
    #[inline(always)]
    fn eight<const N: usize>(i: I, lanes: &BoxLanes<N>) -> Self {
        let Registers { lo, hi } = Registers::new(i, lanes);
        Self::of(lo, hi)
    }

    #[inline(always)]
    fn one<const N: usize>(i: I, lanes: &BoxLanes<N>, lane: usize) -> Self {
        let Registers { mut lo, mut hi } = Registers::none(i);
        for axis in 0..3 {
            lo[axis] = f32x8::splat(i, lanes.lo[axis][lane]);
            hi[axis] = f32x8::splat(i, lanes.hi[axis][lane]);
        }
        Self::of(lo, hi)
    }

    #[inline(always)]
    fn of(lo: Vectors<I>, hi: Vectors<I>) -> Self {
        let (mut middle, mut half) = (lo, hi);
        for axis in 0..3 {
            let (low, high) = (lo[axis] * 0.5, hi[axis] * 0.5);
            middle[axis] = high + low;
            half[axis] = high - low;
        }
        Self { middle, half }
    }
}

/// Clears the bits of pairs, `8 i + j`, that capsules show to be apart. The boxes of all overlap.
///
/// It is called and not inlined, for there are few who need it.
#[inline(never)]
pub(crate) fn cull_by_capsules<I: Simd, const N: usize>(
    i: I,
    a: Volumes<N>,
    b: Volumes<N>,
    pairs: u64,
) -> u64 {
    i.vectorize(
        #[inline(always)]
        || pairs & !apart(i, a, b, pairs),
    )
}

#[inline(always)]
fn apart<I: Simd, const N: usize>(i: I, a: Volumes<N>, b: Volumes<N>, pairs: u64) -> u64 {
    let boxes = Middles::eight(i, b.boxes);
    let mut apart = 0;
    for lane in 0..N {
        if (pairs >> (8 * lane)) as u8 == 0 {
            continue;
        }
        let mut row = boxes.half[0].simd_lt(boxes.half[0]);
        if let Some(of_a) = a.capsules {
            let one = Capsules::one(i, of_a, lane);
            row |= one.are_off(&boxes);
            if let Some(of_b) = b.capsules {
                row |= one.are_apart(&Capsules::eight(i, of_b));
            }
        }
        if let Some(of_b) = b.capsules {
            row |= Capsules::eight(i, of_b).are_off(&Middles::one(i, a.boxes, lane));
        }
        apart |= row.to_bitmask() << (8 * lane);
    }
    apart
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Aabb, Bounds};
    use crate::kernels::{Instructions, dispatch, overlap_mask};
    use pliant_oracle::{Class, Random, intersect};

    type Triangle = [[f64; 3]; 3];

    /// Boxes and capsules of eight triangles relative to an origin.
    fn volumes(triangles: &[Triangle; 8], origin: [f64; 3]) -> (BoxLanes<8>, EightCapsules) {
        let (mut boxes, mut capsules) = (BoxLanes::EMPTY, EightCapsules::EVERYTHING);
        for (lane, triangle) in triangles.iter().enumerate() {
            let mut bounds = Bounds::EMPTY;
            triangle.iter().for_each(|&corner| bounds.include(corner));
            let [x, y, z] = origin;
            boxes.set(lane, &bounds.to_box([x, y, z, 0.0]));
            let point = |which: usize| [0, 1, 2].map(|axis| triangle[which][axis] - origin[axis]);
            capsules.set(lane, &Capsule::around(3, &point, 0.0));
        }
        (boxes, capsules)
    }

    /// Mask of the pairs that are claimed to be apart. Asserts that it is the same for all
    /// instruction sets, and that neither body needs the other's capsules.
    fn claims(a: &(BoxLanes<8>, EightCapsules), b: &(BoxLanes<8>, EightCapsules)) -> u64 {
        let overlapping = Instructions::all().into_iter().map(|instructions| {
            dispatch!(instructions, i => {
                let pairs = overlap_mask(i, &a.0, &b.0);
                let of = |has_a: bool, has_b: bool| {
                    let a = Volumes { boxes: &a.0, capsules: has_a.then_some(&a.1) };
                    let b = Volumes { boxes: &b.0, capsules: has_b.then_some(&b.1) };
                    pairs & !cull_by_capsules(i, a, b, pairs)
                };
                let (both, first, second) = (of(true, true), of(true, false), of(false, true));
                assert_eq!((first | second) & !both, 0);
                assert_eq!(of(false, false), 0);
                both
            })
        });
        let of_all: Vec<u64> = overlapping.collect();
        assert!(of_all.iter().all(|claims| *claims == of_all[0]));
        of_all[0]
    }

    /// Counts the pairs of triangles that are claimed to be apart, which must be.
    fn check(a: &[Triangle; 8], b: &[Triangle; 8], origin: [f64; 3]) -> u32 {
        let apart = claims(&volumes(a, origin), &volumes(b, origin));
        for (i, a) in a.iter().enumerate() {
            for (j, b) in b.iter().enumerate() {
                if apart >> (8 * i + j) & 1 == 1 {
                    assert!(!intersect(a, b), "{a:?} {b:?} {origin:?}");
                }
            }
        }
        apart.count_ones()
    }

    #[test]
    fn what_is_claimed_to_be_apart_is_at_any_scale() {
        let mut random = Random::new(5);
        let mut claimed = 0;
        for scale in [0, -40, -149, 60, 120].map(|exponent| 2f64.powi(exponent)) {
            for class in Class::ALL {
                for round in 0..12 {
                    let pairs: [[Triangle; 2]; 8] = std::array::from_fn(|_| {
                        class.pair(&mut random).map(|triangle| {
                            let fits = |x: f64| if x.abs() <= 1e38 { x } else { 1.0 };
                            triangle.map(|corner| corner.map(|x| fits(x * scale)))
                        })
                    });
                    let origin = [[0.0; 3], pairs[0][0][0]][round % 2];
                    claimed += check(&pairs.map(|it| it[0]), &pairs.map(|it| it[1]), origin);
                }
            }
        }
        assert!(claimed > 1_000, "{claimed}");
    }

    /// Needles in a cube, each through a point of another or just past it.
    #[test]
    fn needles_that_touch_are_not_claimed_and_most_others_are() {
        let mut random = Random::new(6);
        let (mut claimed, mut total) = (0, 0);
        for round in 0..400 {
            let mut number = |most: u32| f64::from(random.below(2 * most + 1)) - f64::from(most);
            let mut needle = |through: [f64; 3]| {
                let [way, aside] = [4_096, 8].map(|most| [0; 3].map(|_| number(most)));
                let at = |part: f64, side: f64| {
                    [0, 1, 2].map(|axis| through[axis] + part * way[axis] + side * aside[axis])
                };
                [at(-1.0, 0.0), at(1.0, 0.0), at(0.0, 1.0)]
            };
            let place = [round % 7, round % 5, 1 << (round % 20)].map(f64::from);
            let a = [0; 8].map(|_| needle(place));
            // One lane past the place by little, the others somewhere.
            let mut b = [0.0, 1.0, 2.0, 64.0, 300.0, -300.0, 900.0, -2_000.0]
                .map(|off| needle([place[0] + off, place[1] - off, place[2]]));
            b[7][2] = a[0][2];
            claimed += check(&a, &b, place);
            claimed += check(&a, &b, [1e9, -1e7, 0.3]);
            total += 128;
        }
        assert!(claimed > total / 3, "{claimed} of {total}");
    }

    #[test]
    fn a_capsule_holds_its_points_and_no_claim_is_made_of_everything() {
        let everything = [[0.0; 3]; 1];
        let far = Capsule::around(1, &|which| everything[which].map(|x: f64| x + 1e30), 0.0);
        assert!(far.radius.is_infinite());
        let point = Capsule::around(1, &|which| everything[which], 0.5);
        assert!(point.radius >= 0.5 && point.radius < 0.500_001);
        let unused = Aabb {
            lo: [-1.0; 3],
            hi: [1.0; 3],
        };
        let mut boxes = BoxLanes::<8>::EMPTY;
        boxes.set(0, &unused);
        let all = (boxes, EightCapsules::EVERYTHING);
        assert_eq!(claims(&all, &all), 0);
    }

    /// Axes that are off a coordinate axis, or off each other, by less than a square has room for.
    #[test]
    fn what_meets_is_not_apart_where_squares_vanish() {
        let mut random = Random::new(77);
        let mut unit = || f64::from(random.below(1 << 20)) / f64::from(1 << 20) - 0.5;
        let mut claimed = 0;
        for round in 0..4_000 {
            let mut triangles = || -> [Triangle; 8] {
                std::array::from_fn(|lane| {
                    let (axis, small) = ((round + lane) % 3, 2f64.powi(-60 - (lane as i32) * 7));
                    let mut ends = [[0.0; 3]; 3];
                    for end in &mut ends {
                        *end = [(); 3].map(|()| 40.0 * small * unit());
                        end[axis] = 2f64.powi(20 + 5 * (lane as i32 % 5)) * unit();
                        end[(axis + 1) % 3] += if unit() > 0.0 { 64.0 } else { 0.0 };
                    }
                    ends
                })
            };
            let (a, b) = (triangles(), triangles());
            let [of_a, of_b] = [&a, &b].map(|it| volumes(it, [0.0; 3]));
            let mut apart = claims(&of_a, &of_b);
            claimed += apart.count_ones();
            while apart != 0 {
                let pair = apart.trailing_zeros() as usize;
                apart &= apart - 1;
                assert!(
                    !intersect(&a[pair / 8], &b[pair % 8]),
                    "{:?}",
                    (a[pair / 8], b[pair % 8])
                );
            }
        }
        assert!(claimed > 1_000, "{claimed}");
    }
}
