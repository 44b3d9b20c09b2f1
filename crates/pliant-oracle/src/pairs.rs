//! Hard pairs of triangles: pairs on which a decision is likely to go wrong.
//!
//! Every coordinate is finite and at most `f32::MAX` in magnitude, the range that the library
//! accepts. The pairs depend on the seed alone: no clock, no platform mathematics.

use crate::Triangle;

/// Pseudo-random number generator SplitMix64 (Steele, Lea and Flood 2014).
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// Starts a sequence of numbers. Each seed has its own.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    }

    /// A random number in 0..count.
    pub fn below(&mut self, count: u32) -> u32 {
        (((self.bits() >> 32) * u64::from(count)) >> 32) as u32
    }

    pub(crate) fn between(&mut self, least: i32, most: i32) -> i32 {
        least + self.below(most.abs_diff(least) + 1) as i32
    }

    pub(crate) fn one_in(&mut self, count: u32) -> bool {
        self.below(count) == 0
    }

    /// A random number in [-1, 1) with 53 bits, or 24.
    pub(crate) fn real(&mut self, single: bool) -> f64 {
        let bits = if single { 24 } else { 53 };
        (self.bits() >> (64 - bits)) as f64 * power(1 - bits) - 1.0
    }

    fn lattice(&mut self, range: i32) -> Triangle {
        let mut place = || f64::from(self.between(-range, range));
        std::array::from_fn(|_| std::array::from_fn(|_| place()))
    }

    fn triangle(&mut self, single: bool) -> Triangle {
        std::array::from_fn(|_| std::array::from_fn(|_| self.real(single)))
    }

    /// Moves a number by a few units in the last place, often by none.
    pub(crate) fn nudged(&mut self, x: f64, single: bool) -> f64 {
        (0..self.below(3)).fold(x, |x, _| match (single, self.one_in(2)) {
            (true, true) => f64::from((x as f32).next_up()),
            (true, false) => f64::from((x as f32).next_down()),
            (false, true) => x.next_up(),
            (false, false) => x.next_down(),
        })
    }
}

/// 2^exponent, subnormal ones included.
pub(crate) fn power(exponent: i32) -> f64 {
    if exponent < -1022 {
        f64::from_bits(1 << (exponent + 1074))
    } else {
        f64::from_bits(u64::from(exponent.abs_diff(-1023)) << 52)
    }
}

/// Whether an `f32` can hold every coordinate.
pub fn fits_f32(pair: &[Triangle; 2]) -> bool {
    let coordinates = pair.as_flattened().as_flattened();
    coordinates.iter().all(|&x| f64::from(x as f32) == x)
}

/// A class of hard pairs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Class {
    /// Corners anywhere in a cube.
    Random,
    /// Corners on a small lattice: many touching, coplanar, equal and degenerate triangles.
    Lattice,
    /// Both triangles in one plane, up to rounding and a few units in the last place.
    NearlyCoplanar,
    /// Both triangles exactly in one plane, which is not the plane of two axes.
    Coplanar,
    /// A corner computed as a point of the other triangle, and rounded: it touches, or misses by a
    /// hair.
    NearlyTouching,
    /// Two segments: skew, crossing, or in one line.
    Segments,
    /// A point with a triangle, a segment, or a point.
    Points,
    /// One side a million or more times shorter than the others, or three corners almost in a line.
    Slivers,
    /// A vertex in common, or nearly.
    SharedVertex,
    /// An edge in common, or nearly; sometimes in one plane.
    SharedEdge,
    /// A triangle and itself with corners in another order, perhaps nudged.
    Identical,
    /// Each corner, triangle or axis at a scale of its own, from 1e-38 to 1e38.
    Scales,
    /// Multiples of the smallest `f32`, some with coordinates of ordinary size.
    Subnormal,
    /// `f64` coordinates about 2^-306, where the product of three differences begins to lose
    /// digits.
    NearUnderflow,
    /// `f64` coordinates down to the smallest, some with coordinates up to the largest accepted.
    BelowUnderflow,
    /// Any bits that are a number in range.
    AnyBits,
}

impl Class {
    /// All classes.
    pub const ALL: [Self; 16] = [
        Self::Random,
        Self::Lattice,
        Self::NearlyCoplanar,
        Self::Coplanar,
        Self::NearlyTouching,
        Self::Segments,
        Self::Points,
        Self::Slivers,
        Self::SharedVertex,
        Self::SharedEdge,
        Self::Identical,
        Self::Scales,
        Self::Subnormal,
        Self::NearUnderflow,
        Self::BelowUnderflow,
        Self::AnyBits,
    ];

    /// Generates the next pair of this class.
    pub fn pair(self, random: &mut Random) -> [Triangle; 2] {
        // Half of the pairs have `f32` coordinates, unless the class says which.
        let single = random.one_in(2);
        let pair = match self {
            Self::Random => {
                let [a, mut b] = [random.triangle(single), random.triangle(single)];
                if random.one_in(3) {
                    // Small and far from the origin: the digits are spent on the place.
                    b = a.map(|p| p.map(|x| x + random.real(true) * power(-20)));
                }
                rounded([a, b], single)
            }
            Self::Lattice => lattice(random),
            Self::NearlyCoplanar => nearly_coplanar(random, single),
            Self::Coplanar => coplanar(random),
            Self::NearlyTouching => nearly_touching(random, single),
            Self::Segments => segments(random, single),
            Self::Points => points(random, single),
            Self::Slivers => slivers(random, single),
            Self::SharedVertex => shared(random, single, 1),
            Self::SharedEdge => shared(random, single, 2),
            Self::Identical => {
                let a = either(random, single)[0];
                let nudge = random.one_in(2);
                let keep =
                    |x, random: &mut Random| if nudge { random.nudged(x, single) } else { x };
                [a, a.map(|p| p.map(|x| keep(x, random)))]
            }
            Self::Scales => scales(random, single),
            Self::Subnormal => subnormal(random),
            Self::NearUnderflow => near_underflow(random),
            Self::BelowUnderflow => below_underflow(random),
            Self::AnyBits => any_bits(random, single),
        };
        shuffled(pair, random)
    }
}

/// Reorders corners and triangles at random.
fn shuffled(mut pair: [Triangle; 2], random: &mut Random) -> [Triangle; 2] {
    for triangle in &mut pair {
        triangle.rotate_left(random.below(3) as usize);
        if random.one_in(2) {
            triangle.swap(0, 1);
        }
    }
    if random.one_in(2) {
        pair.swap(0, 1);
    }
    pair
}

/// Clamps into the range that is accepted, and rounds to `f32` if wanted.
fn rounded(pair: [Triangle; 2], single: bool) -> [Triangle; 2] {
    let max = f64::from(f32::MAX);
    pair.map(|triangle| {
        triangle.map(|p| {
            p.map(|x| {
                let x = x.clamp(-max, max);
                if single { f64::from(x as f32) } else { x }
            })
        })
    })
}

fn lattice(random: &mut Random) -> [Triangle; 2] {
    let range = [1, 2, 3, 6, 1000][random.below(5) as usize];
    [random.lattice(range), random.lattice(range)]
}

/// A pair in general position, or on a lattice.
fn either(random: &mut Random, single: bool) -> [Triangle; 2] {
    if random.one_in(2) {
        lattice(random)
    } else {
        [random.triangle(single), random.triangle(single)]
    }
}

fn nearly_coplanar(random: &mut Random, single: bool) -> [Triangle; 2] {
    let (mut a, mut b) = (random.triangle(single), random.triangle(single));
    let slope = [random.real(true), random.real(true), random.real(true)];
    for p in a.iter_mut().chain(&mut b) {
        p[2] = p[0] * slope[0] + p[1] * slope[1] + slope[2];
    }
    // Any of the three axes may be the computed one.
    let turn = random.below(3) as usize;
    [a, b]
        .iter_mut()
        .flatten()
        .for_each(|p| p.rotate_left(turn));
    rounded([a, b], single).map(|triangle| {
        triangle.map(|mut p| {
            p.rotate_left(turn);
            p.map(|x| random.nudged(x, single))
        })
    })
}

fn coplanar(random: &mut Random) -> [Triangle; 2] {
    // Two directions and a place in small integers: everything computed from them is exact.
    let [[u, v, place], _] = [random.lattice(3), random.lattice(1)];
    let range = [2, 4, 9, 1000][random.below(4) as usize];
    let mut corner = || -> [f64; 3] {
        let [s, t] = [(); 2].map(|()| f64::from(random.between(-range, range)));
        [0, 1, 2].map(|axis| place[axis] + s * u[axis] + t * v[axis])
    };
    [(); 2].map(|()| [corner(), corner(), corner()])
}

/// The point s p + (1 - s) q, rounded.
fn mixed(p: [f64; 3], q: [f64; 3], s: f64) -> [f64; 3] {
    [0, 1, 2].map(|axis| s * p[axis] + (1.0 - s) * q[axis])
}

fn nearly_touching(random: &mut Random, single: bool) -> [Triangle; 2] {
    let [a, mut b] = [random.triangle(single), random.triangle(single)];
    let [s, t] = [(); 2].map(|()| f64::from(random.between(0, 16)) / 16.0);
    // A point of an edge, or of the face.
    let on_edge = mixed(a[0], a[1], s);
    let touched = if random.one_in(2) {
        on_edge
    } else {
        mixed(on_edge, a[2], t)
    };
    let place = rounded([[touched; 3]; 2], single)[0][0].map(|x| random.nudged(x, single));
    if random.one_in(3) {
        // An edge of b passes through it.
        let [p, q] = [b[0], place];
        b[1] = [0, 1, 2].map(|axis| 2.0 * q[axis] - p[axis]);
    } else {
        b[0] = place;
    }
    rounded([a, b], single)
}

fn segments(random: &mut Random, single: bool) -> [Triangle; 2] {
    let [mut a, mut b] = either(random, single);
    if random.one_in(4) {
        // On one line.
        for p in a.iter_mut().chain(&mut b) {
            *p = [p[0], 2.0 * p[0], -p[0]];
        }
    }
    // The third corner is one of the two, or between them.
    for triangle in [&mut a, &mut b] {
        triangle[2] = match random.below(3) {
            0 => triangle[0],
            1 => triangle[1],
            _ => mixed(triangle[0], triangle[1], 0.5),
        };
    }
    if random.one_in(4) {
        // They cross, or nearly.
        b[1] = [0, 1, 2].map(|axis| a[0][axis] + a[1][axis] - b[0][axis]);
        b[2] = b[0];
    }
    rounded([a, b], single)
}

fn points(random: &mut Random, single: bool) -> [Triangle; 2] {
    let [a, mut b] = either(random, single);
    let point = match random.below(4) {
        0 => b[0],
        1 => a[0],
        2 => mixed(a[0], a[1], 0.5),
        _ => mixed(mixed(a[0], a[1], 0.5), a[2], 0.25),
    };
    b = [point; 3];
    rounded(
        [
            if random.one_in(4) {
                [a[0], a[1], a[0]]
            } else {
                a
            },
            b,
        ],
        single,
    )
}

fn slivers(random: &mut Random, single: bool) -> [Triangle; 2] {
    let pair = either(random, single).map(|mut triangle| {
        let from = if random.one_in(2) {
            triangle[0]
        } else {
            mixed(
                triangle[0],
                triangle[1],
                f64::from(random.between(0, 8)) / 8.0,
            )
        };
        let by = power(-random.between(18, 50));
        triangle[2] = from.map(|x| random.real(true).mul_add(by, x));
        triangle
    });
    let [a, mut b] = rounded(pair, single);
    if random.one_in(2) {
        b[0] = mixed(a[0], a[1], 0.5);
    }
    rounded([a, b], single)
}

fn shared(random: &mut Random, single: bool, count: usize) -> [Triangle; 2] {
    let [a, mut b] = if random.one_in(3) {
        coplanar(random)
    } else {
        either(random, single)
    };
    b[..count].copy_from_slice(&a[..count]);
    if random.one_in(3) {
        // Or nearly in common.
        for p in &mut b[..count] {
            *p = p.map(|x| random.nudged(x, single));
        }
    }
    [a, b]
}

fn scales(random: &mut Random, single: bool) -> [Triangle; 2] {
    let mut pair = either(random, single);
    let exponents: [i32; 6] = std::array::from_fn(|_| random.between(-126, 126));
    match random.below(4) {
        0 => {
            for (p, exponent) in pair.as_flattened_mut().iter_mut().zip(exponents) {
                *p = p.map(|x| x * power(exponent));
            }
        }
        1 => {
            for (triangle, exponent) in pair.iter_mut().zip(exponents) {
                *triangle = triangle.map(|p| p.map(|x| x * power(exponent)));
            }
        }
        2 => {
            for p in pair.as_flattened_mut() {
                *p = [0, 1, 2].map(|axis| p[axis] * power(exponents[axis]));
            }
        }
        // The largest numbers.
        _ => {
            for p in pair.as_flattened_mut() {
                *p = p.map(|x| x.signum() * f64::from(f32::MAX) * f64::from(x.abs() > 0.5));
            }
        }
    }
    rounded(pair, single)
}

fn subnormal(random: &mut Random) -> [Triangle; 2] {
    let mut pair = lattice(random).map(|triangle| triangle.map(|p| p.map(|x| x * power(-149))));
    if random.one_in(3) {
        let axis = random.below(3) as usize;
        let scale = power(random.between(100, 149));
        for p in pair.as_flattened_mut() {
            p[axis] *= scale;
        }
    }
    if random.one_in(3) {
        let corner = random.below(6) as usize;
        pair.as_flattened_mut()[corner] = [(); 3].map(|()| random.real(true));
    }
    pair
}

fn near_underflow(random: &mut Random) -> [Triangle; 2] {
    let pair = either(random, false);
    // Exponents at which products of three differences, of two, and single values leave the normal
    // range.
    let around = [-306, -290, -340, -358, -485, -535][random.below(6) as usize];
    let scale = power(around + random.between(-3, 3));
    let ordinary = random.below(6) as usize;
    let mut pair = pair.map(|triangle| triangle.map(|p| p.map(|x| x * scale)));
    if ordinary < 3 {
        // One axis of ordinary size lifts the product of the other two.
        for p in pair.as_flattened_mut() {
            p[ordinary] /= scale;
        }
    }
    pair
}

fn below_underflow(random: &mut Random) -> [Triangle; 2] {
    let lowest = [-1074, -1060, -1022, -1000, -700, -540][random.below(6) as usize];
    let mut pair = lattice(random).map(|triangle| triangle.map(|p| p.map(|x| x * power(lowest))));
    match random.below(4) {
        0 => {
            let corner = random.below(6) as usize;
            let scale = power(random.between(-300, 126));
            pair.as_flattened_mut()[corner] = [(); 3].map(|()| random.real(false) * scale);
        }
        1 => {
            let axis = random.below(3) as usize;
            let scale = power(random.between(-300, 110));
            for p in pair.as_flattened_mut() {
                p[axis] = f64::from(random.between(-3, 3)) * scale;
            }
        }
        2 => {
            // Large coordinates that differ in the last digit only, and small ones that tell the
            // side.
            let large = random.real(false) * power(random.between(0, 126));
            for p in pair.as_flattened_mut() {
                p[0] = random.nudged(large, false);
            }
        }
        _ => {}
    }
    rounded(pair, false)
}

/// Eight pairs of elements of two triangles, by their corners.
///
/// Each is a corner and the other triangle, or two edges. The number is the count of corners of the
/// first element.
pub fn element_pairs([a, b]: &[Triangle; 2]) -> Vec<(usize, [[f64; 3]; 4])> {
    let corners = (0..2).flat_map(|corner| [[a, b], [b, a]].map(|pair| (corner, pair)));
    let corners = corners.map(|(corner, [a, b])| (1, [a[corner], b[0], b[1], b[2]]));
    let edges = [(0, 0), (1, 0), (2, 1), (0, 2)].map(|(i, j)| {
        let corners = [a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]];
        (2, corners)
    });
    corners.chain(edges).collect()
}

fn any_bits(random: &mut Random, single: bool) -> [Triangle; 2] {
    let mut number = || loop {
        let bits = random.bits();
        let x = if single {
            f64::from(f32::from_bits(bits as u32))
        } else {
            f64::from_bits(bits)
        };
        if x.abs() <= f64::from(f32::MAX) {
            return x;
        }
    };
    let mut pair = [[[0.0; 3]; 3]; 2];
    pair.as_flattened_mut()
        .as_flattened_mut()
        .fill_with(&mut number);
    if random.one_in(2) {
        // Few values, so that some agree.
        let few: [f64; 4] = [pair[0][0][0], pair[0][0][1], -pair[0][0][0], 0.0];
        let coordinates = pair.as_flattened_mut().as_flattened_mut();
        coordinates.fill_with(|| few[random.below(4) as usize]);
    }
    pair
}
