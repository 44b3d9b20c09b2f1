//! Which way the triangles at each vertex face, eight triangles at a time.
//!
//! The triangles at a vertex are its *star*. Idea: seen along an axis, a triangle faces up, down,
//! or uncertainly, and one of its corners is in the middle, from left to right. Both are counted at
//! every vertex. If all triangles of a star face one way, the middles at the vertex say how often
//! they go round it. Invariant: a way is counted only where rounding cannot have changed it, and
//! middles are exact.

use super::{Coordinate, Instructions, dispatch};
use crate::geometry::{Points, Real};
use crate::ids::TreeVertex;
use fearless_simd::Simd;

/// Ways and middles at a vertex.
///
/// Three bits say whether all triangles face up along each axis, three whether all face down. Three
/// fields of [`BITS`] bits count the triangles in which the vertex is in the middle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct StarCounts(u32);

/// The bits of ways.
const WAYS: u32 = (1 << 6) - 1;
/// Width of a field of middles.
const BITS: u32 = 4;
/// A field of ones.
const FIELD: u32 = (1 << BITS) - 1;

impl StarCounts {
    /// Counts of a star without triangles.
    pub(crate) const NONE: Self = Self(WAYS);
    /// All bits, which no star has that is looked at.
    pub(crate) const ALL: Self = Self(u32::MAX);

    /// Adds the counts of other triangles at the vertex.
    pub(crate) fn add(&mut self, Self(more): Self) {
        self.take(more | !WAYS, more & !WAYS);
    }

    /// Takes a triangle: its ways, with all other bits set, and its middles.
    #[inline(always)]
    fn take(&mut self, ways: u32, middles: u32) {
        // Fields of stars that are too large overflow, and are not looked at.
        self.0 = (self.0 & ways).wrapping_add(middles);
    }
}

/// A triangle, as a vertex of it counts it.
#[derive(Clone, Copy)]
pub(crate) struct Counted {
    ways: u32,
    middles: u32,
}

impl Counted {
    #[inline(always)]
    pub(crate) fn add_to(self, counts: &mut StarCounts) {
        counts.take(self.ways, self.middles);
    }

    pub(crate) fn alone(self) -> StarCounts {
        StarCounts(self.ways & WAYS | self.middles)
    }
}

/// How the triangles at a vertex are joined, in a byte.
///
/// Not below [`CLOSED`] if they are closed. The rest is their number, or [`TOO_MANY`]. What is no
/// fan is closed and has none.
pub(crate) type StarRecord = u8;

/// Record of a closed fan, whose triangles go all round the vertex, less their number.
pub(crate) const CLOSED: StarRecord = 1 << 7;

/// Number of triangles of a record that says as many or more: a field holds less.
pub(crate) const TOO_MANY: StarRecord = FIELD as StarRecord + 1;

/// Sets all bits of the counts of stars that may overlap along every axis. O(stars).
///
/// # Proof
///
/// Let all triangles of a fan face up along an axis. Project them. Each takes an angle of less than
/// half a turn at the vertex, and they follow each other round it. So they overlap nowhere if
/// together they take one turn, or less.
///
/// Take a line through the vertex that meets no other corner. Vertices are compared by one
/// coordinate, and where that is equal by the next; that is a line turned a little. Triangles cross
/// it at the vertex where that is their middle corner. Closed fans take whole turns, and cross it
/// twice a turn. Open fans of a turn or more cross it twice at least.
pub(crate) fn mark_overlapping_stars(
    instructions: Instructions,
    counts: &mut [StarCounts],
    records: impl Fn(usize) -> StarRecord,
) {
    dispatch!(instructions, i => mark(i, counts, records));
}

#[inline(always)]
fn mark<I: Simd>(_: I, counts: &mut [StarCounts], records: impl Fn(usize) -> StarRecord) {
    let (eights, rest) = counts.as_chunks_mut::<8>();
    let first_of_rest = 8 * eights.len();
    for (number, eight) in eights.iter_mut().enumerate() {
        let mut of_eight = [0; 8];
        for lane in 0..8 {
            of_eight[lane] = records(8 * number + lane).into();
        }
        for lane in 0..8 {
            eight[lane].0 |= all_if_overlapping(eight[lane], of_eight[lane]);
        }
    }
    for (place, counts) in (first_of_rest..).zip(rest) {
        counts.0 |= all_if_overlapping(*counts, records(place).into());
    }
}

/// All bits if a star may overlap along every axis, else none. Without branches, as lanes need it.
#[inline(always)]
fn all_if_overlapping(StarCounts(counts): StarCounts, record: u32) -> u32 {
    let [closed, too_many] = [CLOSED, TOO_MANY].map(u32::from);
    let is_closed = record / closed;
    // Twice if closed, else once or never.
    let (middles, which) = (2 * is_closed, FIELD - 1 + is_closed);
    let mut overlaps = true;
    for axis in 0..3 {
        let ways = counts >> axis & 0b1001;
        let turns = (counts >> (6 + BITS * axis) ^ middles) & which;
        overlaps &= (ways == 0) | (turns != 0);
    }
    // No fan, or too many to be counted.
    overlaps |= (record == closed) | (record % closed == too_many);
    overlaps &= record > 1;
    u32::from(overlaps).wrapping_neg()
}

/// Middles of a triangle for each of its corners, by its six bits.
///
/// Three bits say for each axis whether corner 0 is in the middle, three whether corner 1 is.
const OF_MIDDLES: [[u32; 3]; 64] = {
    let mut counts = [[0; 3]; 64];
    let mut middles = 0;
    while middles < 64 {
        let mut axis = 0_u32;
        while axis < 3 {
            let corner = match (middles >> axis & 1, middles >> (3 + axis) & 1) {
                (1, _) => 0,
                (_, 1) => 1,
                _ => 2,
            };
            counts[middles][corner] |= 1 << (6 + BITS * axis);
            axis += 1;
        }
        middles += 1;
    }
    counts
};

/// Shows `add` the counts of every triangle at each of its corners. O(triangles).
pub(crate) fn count_stars<S: Coordinate>(
    instructions: Instructions,
    positions: &Points<S>,
    triangles: &[[TreeVertex; 3]],
    add: impl FnMut(usize, TreeVertex, Counted),
) {
    dispatch!(instructions, i => in_eights(i, positions, triangles, add));
}

#[inline(always)]
fn in_eights<I: Simd, S: Coordinate>(
    i: I,
    positions: &Points<S>,
    triangles: &[[TreeVertex; 3]],
    mut add: impl FnMut(usize, TreeVertex, Counted),
) {
    for (number, some) in triangles.chunks(8).enumerate() {
        let mut eight = [some[0]; 8];
        eight[..some.len()].copy_from_slice(some);
        let mut points = [[[S::default(); 8]; 3]; 3];
        for corner in 0..3 {
            let mut padded = [positions.padded(eight[0][corner]); 8];
            for lane in 0..8 {
                padded[lane] = positions.padded(eight[lane][corner]);
            }
            points[corner] = S::in_lanes(i, padded);
        }
        let codes = codes(&points);
        for (lane, corners) in some.iter().enumerate() {
            let [ways, middles] = [codes[lane] & WAYS, codes[lane] >> 6 & 63];
            let of_middles = OF_MIDDLES[middles as usize];
            for corner in 0..3 {
                let counted = Counted {
                    ways: ways | !WAYS,
                    middles: of_middles[corner],
                };
                add(8 * number + lane, corners[corner], counted);
            }
        }
    }
}

/// Ways, then middles, of eight triangles, with the corners of each in lanes.
///
/// # Rounding
///
/// Let u be half of the spacing of numbers at 1. A component of the normal is N = p - q, where p
/// and q are products of two differences. Each product has three roundings, the subtraction has
/// one. So the computed N is off by at most `4 u (|p| + |q|)`, to first order, and by less than `5
/// u (|p| + |q|)`. Below the normal range a difference, a product or a sum loses at most the
/// smallest normal number, times a difference or 1. With M the sum of all differences,
/// [`Real::TINY`] times `M + 1` is far above all of that.
#[inline(always)]
fn codes<S: Real>([a, b, c]: &[[[S; 8]; 3]; 3]) -> [u32; 8] {
    let mut codes = [0; 8];
    for lane in 0..8 {
        let mut code = 0;
        let zero = S::default();
        let (mut e, mut f) = ([zero; 3], [zero; 3]);
        let mut all = S::ONE;
        for axis in 0..3 {
            e[axis] = b[axis][lane] - a[axis][lane];
            f[axis] = c[axis][lane] - a[axis][lane];
            all = all + e[axis].magnitude() + f[axis].magnitude();
        }
        let tiny = all * S::TINY;
        for axis in 0..3 {
            let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
            let (p, q) = (e[next] * f[last], e[last] * f[next]);
            let bound = (p.magnitude() + q.magnitude()) * S::FIVE_ROUNDINGS + tiny;
            code |= u32::from(p - q > bound) << axis;
            code |= u32::from(q - p > bound) << (3 + axis);
            // By the next axis, and where that is equal by the last.
            let is_less = |p: &[[S; 8]; 3], q: &[[S; 8]; 3]| {
                (p[next][lane] < q[next][lane])
                    | (p[next][lane] == q[next][lane]) & (p[last][lane] < q[last][lane])
            };
            let (ab, bc, ca) = (is_less(a, b), is_less(b, c), is_less(c, a));
            code |= u32::from(ab == ca) << (6 + axis);
            code |= u32::from(ab == bc) << (9 + axis);
        }
        codes[lane] = code;
    }
    codes
}

#[cfg(test)]
mod tests {
    use super::*;
    use pliant_oracle::{Class, Random, fits_f32, orientation};

    /// Whether a triangle faces this way, and whether a corner is in the middle.
    fn faces(counts: StarCounts, way: u32) -> bool {
        counts.0 >> way & 1 == 1
    }

    fn is_middle(counts: StarCounts, axis: u32) -> bool {
        counts.0 >> (6 + BITS * axis) & FIELD == 1
    }

    /// Compares a triangle's counts with exact signs. Returns how many ways are certain.
    fn check<S: Coordinate>(triangles: &[[[f64; 3]; 3]], of: impl Fn(f64) -> S) -> u32 {
        let points = triangles.as_flattened().iter().map(|point| point.map(&of));
        let positions = Points::of(points.collect::<Vec<_>>().into_iter());
        let corners: Vec<[TreeVertex; 3]> = (0..triangles.len() as u32)
            .map(|triangle| [0, 1, 2].map(|corner| TreeVertex(3 * triangle + corner)))
            .collect();
        let lists = Instructions::all().into_iter().map(|instructions| {
            let mut list = Vec::new();
            let add = |place, vertex: TreeVertex, counted: Counted| {
                list.push((place, vertex.0, counted.alone()));
            };
            count_stars(instructions, &positions, &corners, add);
            list
        });
        let lists: Vec<Vec<(usize, u32, StarCounts)>> = lists.collect();
        assert!(lists.iter().all(|list| *list == lists[0]));
        assert_eq!(lists[0].len(), 3 * triangles.len());
        let mut certain = 0;
        for (number, &(place, vertex, counts)) in lists[0].iter().enumerate() {
            assert_eq!((place, vertex as usize), (number / 3, number));
            let [a, b, c] = triangles[place];
            for axis in 0..3 {
                // The normal's component is the volume with a step along the axis.
                let mut beyond = [a, b, c];
                let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
                for corner in &mut beyond {
                    corner[axis as usize] = 0.0;
                }
                let mut apex = beyond[0];
                apex[axis as usize] = 1.0;
                let way = orientation(&beyond[0], &beyond[1], &beyond[2], &apex);
                let [up, down] = [faces(counts, axis), faces(counts, 3 + axis)];
                assert!((!up || way > 0) && (!down || way < 0), "{a:?} {b:?} {c:?}");
                certain += u32::from(up | down);
                if way != 0 {
                    let place = |p: [f64; 3]| [p[next as usize], p[last as usize]];
                    let own = place([a, b, c][number % 3]);
                    let others = [a, b, c].map(place).into_iter();
                    let smaller = others.filter(|other| *other < own).count();
                    assert_eq!(is_middle(counts, axis), smaller == 1, "{a:?} {b:?} {c:?}");
                }
            }
        }
        certain
    }

    #[test]
    fn ways_are_right_and_middles_exact_on_hard_triangles_of_any_size() {
        let mut random = Random::new(51);
        let (mut certain, mut certain_narrow) = (0, 0);
        for scale in [0, -40, -64, -100, -126, -149, 60, 120].map(|exponent| 2f64.powi(exponent)) {
            for class in Class::ALL {
                for _ in 0..40 {
                    let pair = class.pair(&mut random);
                    let pair = pair.map(|triangle| {
                        let in_range = |x: f64| if x.abs() <= f32::MAX.into() { x } else { 1.0 };
                        triangle.map(|point| point.map(|x| in_range(x * scale)))
                    });
                    certain += check(&pair, |x| x);
                    if fits_f32(&pair) {
                        certain_narrow += check(&pair, |x| x as f32);
                    }
                }
            }
        }
        assert!(
            certain > 10_000 && certain_narrow > 3_000,
            "{certain} {certain_narrow}"
        );
    }

    /// Sums of triangles that all face one way, and of which one does not.
    #[test]
    fn counts_of_a_star_keep_the_ways_of_all() {
        let triangle = |ways: u32, middles: [u32; 3]| {
            let fields = (0..)
                .zip(middles)
                .map(|(axis, count)| count << (6 + BITS * axis));
            StarCounts(ways | fields.sum::<u32>())
        };
        let mut sum = StarCounts::NONE;
        for _ in 0..15 {
            sum.add(triangle(0b100_011, [0, 1, 0]));
        }
        assert_eq!(sum, triangle(0b100_011, [0, 15, 0]));
        sum.add(triangle(0b010_110, [0, 0, 1]));
        assert_eq!(sum, triangle(0b000_010, [0, 15, 1]));
    }

    /// Stars of every number, closed and open, with all numbers of middles, and of every way.
    #[test]
    fn stars_are_left_unless_they_show_one_way() {
        let mut stars = vec![];
        for count in 0..=TOO_MANY {
            for record in [count, CLOSED + count] {
                for way in 0..6 {
                    for middles in 0..=u32::from(count).min(FIELD) {
                        for faces in 0..2 {
                            let axis = way % 3;
                            let word = faces << way | middles << (6 + BITS * axis);
                            let is_fan = record != CLOSED && count != TOO_MANY;
                            let once = if record < CLOSED {
                                middles < 2
                            } else {
                                middles == 2
                            };
                            let free = is_fan && faces == 1 && once || record < 2;
                            stars.push((StarCounts(word), record, free));
                        }
                    }
                }
            }
        }
        for len in [stars.len(), 8, 7, 0] {
            for instructions in Instructions::all() {
                let mut counts: Vec<_> = stars[..len].iter().map(|star| star.0).collect();
                mark_overlapping_stars(instructions, &mut counts, |place| stars[place].1);
                for (counts, (_, record, free)) in counts.iter().zip(&stars) {
                    assert_eq!(*counts == StarCounts::ALL, !free, "{record}");
                }
            }
        }
    }
}
