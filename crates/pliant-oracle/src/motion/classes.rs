//! Hard motions: continuous collisions on which a decision is likely to go wrong.
//!
//! Every coordinate is finite and at most `f32::MAX` in magnitude. The motions depend on the seed
//! alone. Most are built from integers: corners that meet at some time, and their moves in a part
//! of the way. So the contact is exact, and a move to a neighbouring number makes the other answer
//! likely.

use super::{Elements, Moving};
use crate::pairs::{Random, power};

/// Whether an `f32` can hold every coordinate.
pub fn motion_fits_f32(motion: &Moving) -> bool {
    let mut coordinates = motion.as_flattened().as_flattened().iter();
    coordinates.all(|&x| f64::from(x as f32) == x)
}

/// A class of hard motions.
///
/// Each class has both kinds of elements. Unless its text says otherwise, it has coordinates of
/// both precisions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MotionClass {
    /// Corners anywhere in a cube at both ends.
    Random,
    /// A point of one element comes near a point of the other, at any velocities: they hit or pass
    /// by.
    Aimed,
    /// Corners on a small lattice at both ends: every degenerate contact there is.
    Lattice,
    /// Degenerate elements: edges that are points, triangles that are segments or points.
    ///
    /// At the start, at the end, at both, or for a moment between.
    Degenerate,
    /// All corners in one plane always, parallel to axes or oblique, at rest or moving.
    Coplanar,
    /// Parallel edges, or an edge of the triangle parallel to the vertex's path.
    ///
    /// When they meet, always, or in one line.
    Parallel,
    /// First contact at the end exactly, or a few units in the last place earlier or later, at any
    /// size.
    TouchAtEnd,
    /// Contact at the start exactly, or nearly, at any size; then they move anywhere.
    TouchAtStart,
    /// A double root: the four corners come into one plane and return to the side they came from;
    /// exactly, or nearly.
    DoubleRoot,
    /// Contact at a corner or edge of the triangle, or at an end of an edge, at a dyadic time;
    /// exactly, or nearly.
    Boundary,
    /// Three roots: the four corners are in one plane three times, of which any may be a contact.
    ThreeRoots,
    /// Rest: nothing moves, or one corner, or one of the two elements.
    Still,
    /// Both move alike and far, from or to places far from the origin; or almost alike.
    Translation,
    /// Corners, elements, axes or ends at sizes of their own, from 2^-60 to 2^60.
    Scales,
    /// Multiples of the smallest `f32` or `f64`, some with coordinates of ordinary size.
    Tiny,
    /// Coordinates up to the largest numbers in range.
    Huge,
    /// Real corners and velocities, with the contact at a corner or along an edge up to rounding.
    Grazing,
    /// Edges that are parallel up to a small angle and cross while they approach.
    ///
    /// Or an edge of the triangle and the path of the vertex.
    NearlyParallel,
    /// Contact within a tiny part of the step from its start.
    Early,
    /// Contact within a tiny part of the step from its end.
    Late,
    /// Any bits that are numbers in range.
    AnyBits,
}

impl MotionClass {
    /// All classes.
    pub const ALL: [Self; 21] = [
        Self::Random,
        Self::Aimed,
        Self::Lattice,
        Self::Degenerate,
        Self::Coplanar,
        Self::Parallel,
        Self::TouchAtEnd,
        Self::TouchAtStart,
        Self::DoubleRoot,
        Self::Boundary,
        Self::ThreeRoots,
        Self::Still,
        Self::Translation,
        Self::Scales,
        Self::Tiny,
        Self::Huge,
        Self::Grazing,
        Self::NearlyParallel,
        Self::Early,
        Self::Late,
        Self::AnyBits,
    ];

    /// Generates the next motion of this class.
    pub fn motion(self, random: &mut Random) -> (Elements, Moving) {
        let elements = if random.one_in(2) {
            Elements::VertexTriangle
        } else {
            Elements::EdgeEdge
        };
        let single = random.one_in(2);
        let maker = &mut Maker {
            elements,
            single,
            random,
        };
        let motion = match self {
            Self::Random => maker.anywhere(),
            Self::Aimed => maker.aimed(),
            Self::Lattice => maker.lattice(),
            Self::Degenerate => maker.degenerate(),
            Self::Coplanar => maker.coplanar(),
            Self::Parallel => maker.parallel(),
            Self::TouchAtEnd => maker.touch_at_end(),
            Self::TouchAtStart => reversed(maker.touch_at_end()),
            Self::DoubleRoot => maker.double_root(),
            Self::Boundary => maker.boundary(),
            Self::ThreeRoots => maker.three_roots(),
            Self::Still => maker.still(),
            Self::Translation => maker.translation(),
            Self::Scales => maker.scales(),
            Self::Tiny => maker.tiny(),
            Self::Huge => maker.huge(),
            Self::Grazing => maker.grazing(),
            Self::NearlyParallel => maker.nearly_parallel(),
            Self::Early => maker.early(),
            Self::Late => reversed(maker.early()),
            Self::AnyBits => maker.any_bits(),
        };
        (elements, maker.shuffled(motion))
    }
}

type Corners = [[f64; 3]; 4];

fn reversed([start, end]: Moving) -> Moving {
    [end, start]
}

fn every(motion: Moving, mut of: impl FnMut(f64) -> f64) -> Moving {
    motion.map(|corners| corners.map(|p| p.map(&mut of)))
}

struct Maker<'a> {
    elements: Elements,
    /// Whether coordinates are `f32`.
    single: bool,
    random: &'a mut Random,
}

impl Maker<'_> {
    /// Clamps into range, and rounds to `f32` if wanted.
    fn rounded(&self, motion: Moving) -> Moving {
        let max = f64::from(f32::MAX);
        every(motion, |x| {
            let x = x.clamp(-max, max);
            if self.single { f64::from(x as f32) } else { x }
        })
    }

    /// Reorders corners, elements and axes at random.
    fn shuffled(&mut self, mut motion: Moving) -> Moving {
        let turn = self.random.below(3) as usize;
        let mirror = self.random.one_in(2);
        let flips = [(); 3].map(|()| self.random.one_in(2));
        let spin = self.random.below(3) as usize;
        for corners in &mut motion {
            match self.elements {
                Elements::VertexTriangle => {
                    corners[1..].rotate_left(spin);
                    if flips[0] {
                        corners.swap(1, 2);
                    }
                }
                Elements::EdgeEdge => {
                    if flips[0] {
                        corners.swap(0, 1);
                    }
                    if flips[1] {
                        corners.swap(2, 3);
                    }
                    if flips[2] {
                        corners.rotate_left(2);
                    }
                }
            }
            for p in corners {
                p.rotate_left(turn);
                if mirror {
                    p.swap(0, 1);
                }
            }
        }
        motion
    }

    /// Moves up to three of the motion's coordinates a little.
    fn nudged(&mut self, motion: Moving) -> Moving {
        let mut motion = self.rounded(motion);
        for _ in 0..self.random.below(4) {
            let [end, corner, axis] = [2, 4, 3].map(|count| self.random.below(count) as usize);
            let x = &mut motion[end][corner][axis];
            *x = self.random.nudged(*x, self.single);
        }
        self.rounded(motion)
    }

    fn whole(&mut self, range: i32) -> f64 {
        f64::from(self.random.between(-range, range))
    }

    fn wholes(&mut self, range: i32) -> [f64; 3] {
        [(); 3].map(|()| self.whole(range))
    }

    fn real(&mut self) -> f64 {
        self.random.real(self.single)
    }

    fn reals(&mut self) -> [f64; 3] {
        [(); 3].map(|()| self.real())
    }

    fn anywhere(&mut self) -> Moving {
        [(); 2].map(|()| [(); 4].map(|()| self.reals()))
    }

    fn lattice(&mut self) -> Moving {
        let range = [1, 2, 3, 6, 1000][self.random.below(5) as usize];
        let mut motion = [(); 2].map(|()| [(); 4].map(|()| self.wholes(range)));
        if self.random.one_in(4) {
            // Some corners stand still.
            for corner in 0..4 {
                if self.random.one_in(2) {
                    motion[1][corner] = motion[0][corner];
                }
            }
        }
        motion
    }

    /// Weights of the corners for a point of each element: integers that add up to `whole` in each.
    ///
    /// A quarter of the points are at the boundary; all if `boundary`.
    fn weights(&mut self, whole: i32, boundary: bool) -> [f64; 4] {
        let boundary = boundary || self.random.one_in(4);
        let part = |random: &mut Random, at_end: bool| match (at_end, random.one_in(2)) {
            (true, true) => 0,
            (true, false) => whole,
            _ => random.between(1, whole - 1),
        };
        let at_end = [(); 2].map(|()| self.random.one_in(2));
        match self.elements {
            Elements::VertexTriangle => {
                let s = part(self.random, boundary && at_end[0]);
                // At an edge: the third corner has no weight.
                let t = if boundary || s == whole {
                    0
                } else {
                    self.random.between(1, whole - s)
                };
                [whole, s, whole - s - t, t].map(f64::from)
            }
            Elements::EdgeEdge => {
                let s = part(self.random, boundary);
                let t = part(self.random, boundary && at_end[1]);
                [s, whole - s, t, whole - t].map(f64::from)
            }
        }
    }

    /// Random integer corners that meet at the point of these weights, all multiples of `whole`.
    ///
    /// The first element is moved to where the other is.
    fn meeting(&mut self, weights: [f64; 4], whole: f64, range: i32) -> Corners {
        let mut corners = [(); 4].map(|()| self.wholes(range).map(|x| x * whole));
        self.make_meet(&mut corners, weights, whole);
        corners
    }

    /// Moves the first element, so that the two weighted points agree.
    ///
    /// Exactly, if the corners are multiples of `whole`.
    fn make_meet(&mut self, corners: &mut Corners, weights: [f64; 4], whole: f64) {
        let first = self.of_first();
        for axis in 0..3 {
            let sum = |range: std::ops::Range<usize>| -> f64 {
                range.map(|i| weights[i] * corners[i][axis]).sum::<f64>() / whole
            };
            let by = sum(first..4) - sum(0..first);
            for corner in &mut corners[..first] {
                corner[axis] += by;
            }
        }
    }

    /// Number of corners of the first element.
    fn of_first(&self) -> usize {
        match self.elements {
            Elements::VertexTriangle => 1,
            Elements::EdgeEdge => 2,
        }
    }

    /// A random power of two as the sum of weights.
    fn some_whole(&mut self) -> i32 {
        [2, 4, 8][self.random.below(3) as usize]
    }

    /// Motion through `places` at the time numerator / 2^bits; `moves` is the motion in each
    /// 2^-bits of the step.
    fn through(places: Corners, moves: Corners, numerator: i32, bits: i32) -> Moving {
        let at = |parts: f64| {
            std::array::from_fn(|i| {
                std::array::from_fn(|axis| places[i][axis] + parts * moves[i][axis])
            })
        };
        let numerator = f64::from(numerator);
        [at(-numerator), at(power(bits) - numerator)]
    }

    /// A dyadic time inside the step, as numerator and bits.
    fn time(&mut self) -> (i32, i32) {
        let bits = self.random.between(1, 4);
        (self.random.between(1, (1 << bits) - 1), bits)
    }

    /// Maps space by an integer map with an integer inverse, which turns axes into any directions.
    fn oblique(&mut self, mut motion: Moving) -> Moving {
        for _ in 0..self.random.below(4) {
            let [from, to] = [(); 2].map(|()| self.random.below(3) as usize);
            if from != to {
                let times = self.whole(2);
                for p in motion.as_flattened_mut() {
                    p[to] += times * p[from];
                }
            }
        }
        motion
    }

    /// Multiplies everything by a power of two.
    fn at_some_size(&mut self, motion: Moving, least: i32, most: i32) -> Moving {
        let scale = power(self.random.between(least, most));
        every(motion, |x| x * scale)
    }

    /// Integer motion that meets at a dyadic time.
    fn met(&mut self, boundary: bool) -> Moving {
        let whole = self.some_whole();
        let weights = self.weights(whole, boundary);
        let range = [2, 5, 50][self.random.below(3) as usize];
        let places = self.meeting(weights, f64::from(whole), range);
        let moves = [(); 4].map(|()| self.wholes(range));
        let (numerator, bits) = self.time();
        Self::through(places, moves, numerator, bits)
    }

    fn aimed(&mut self) -> Moving {
        let weights = self.weights(8, false);
        let mut places = [(); 4].map(|()| self.reals());
        self.make_meet(&mut places, weights, 8.0);
        let miss = self.reals();
        if self.random.one_in(2) {
            // The distance at which it passes by.
            let far = power(-self.random.between(0, 30));
            for p in &mut places[..1] {
                *p = [0, 1, 2].map(|axis| p[axis] + far * miss[axis]);
            }
        }
        let speed = power(self.random.between(-8, 3));
        let moves = [(); 4].map(|()| self.reals().map(|x| x * speed));
        let (numerator, bits) = self.time();
        self.rounded(Self::through(places, moves, numerator, bits))
    }

    fn degenerate(&mut self) -> Moving {
        let mut motion = if self.random.one_in(2) {
            self.met(false)
        } else {
            self.lattice()
        };
        let first = self.of_first();
        let when = self.random.below(4);
        for (end, corners) in motion.iter_mut().enumerate() {
            if when == end as u32 || when == 2 {
                let weights = [(); 4].map(|()| self.random.below(3));
                match self.elements {
                    Elements::VertexTriangle => match weights[0] {
                        0 => corners[2] = corners[1],
                        1 => {
                            // In the middle of the other two, or beyond.
                            let [b, c] = [corners[2], corners[3]];
                            corners[1] = [0, 1, 2].map(|axis| match weights[1] {
                                0 => 2.0 * b[axis] - c[axis],
                                _ => 0.5 * (b[axis] + c[axis]),
                            });
                        }
                        _ => [corners[1], corners[2]] = [corners[3]; 2],
                    },
                    Elements::EdgeEdge => {
                        corners[1] = corners[0];
                        if weights[0] == 0 {
                            corners[3] = corners[2];
                        }
                    }
                }
            }
        }
        if when == 3 {
            // Two corners change places and are one half way. Or all three move to their centre and
            // beyond.
            let [start, end] = &mut motion;
            let of = if first == 1 { [1, 2] } else { [0, 1] };
            [end[of[0]], end[of[1]]] = [start[of[1]], start[of[0]]];
            if first == 1 && self.random.one_in(2) {
                end[3] = [0, 1, 2].map(|axis| start[1][axis] + start[2][axis] - start[3][axis]);
            }
        }
        if self.random.one_in(3) {
            // The other element meets it on the way.
            let by = [0, 1, 2].map(|axis| {
                let at = |i: usize| motion[0][i][axis] + motion[1][i][axis];
                (at(first) - at(0)) / 2.0
            });
            for p in motion.iter_mut().flat_map(|corners| &mut corners[..first]) {
                *p = [0, 1, 2].map(|axis| p[axis] + by[axis]);
            }
        }
        if self.random.one_in(4) {
            self.nudged(motion)
        } else {
            motion
        }
    }

    fn coplanar(&mut self) -> Moving {
        let mut motion = if self.random.one_in(2) {
            let boundary = self.random.one_in(2);
            self.met(boundary)
        } else {
            self.lattice()
        };
        // The plane may move, with all corners.
        let height = [(); 2].map(|()| self.whole(20));
        let still = self.random.one_in(2);
        for (end, corners) in motion.iter_mut().enumerate() {
            for p in corners {
                p[2] = height[if still { 0 } else { end }];
            }
        }
        if self.random.one_in(2) {
            motion = self.oblique(motion);
        }
        if self.random.one_in(4) {
            motion = self.nudged(motion);
        }
        motion
    }

    fn parallel(&mut self) -> Moving {
        let boundary = self.random.one_in(2);
        let whole = self.some_whole();
        let weights = self.weights(whole, boundary);
        let mut places = [(); 4].map(|()| self.wholes(4).map(|x| x * f64::from(whole)));
        let along = self.wholes(3).map(|x| x * f64::from(whole));
        let mut moves = [(); 4].map(|()| self.wholes(4));
        let times = [(); 2].map(|()| self.whole(3));
        let beside = |p: [f64; 3], times: f64| [0, 1, 2].map(|axis| p[axis] + times * along[axis]);
        match self.elements {
            Elements::EdgeEdge => {
                places[1] = beside(places[0], times[0]);
                places[3] = beside(places[2], times[1]);
                if self.random.one_in(3) {
                    places[2] = beside(places[0], self.whole(4));
                    places[3] = beside(places[2], times[1]);
                } else {
                    self.make_meet(&mut places, weights, f64::from(whole));
                }
                if self.random.one_in(2) {
                    // Parallel always.
                    moves[1] = moves[0];
                    moves[3] = moves[2];
                }
            }
            Elements::VertexTriangle => {
                places[2] = beside(places[1], times[0]);
                self.make_meet(&mut places, weights, f64::from(whole));
                // Along the edge, relative to it.
                moves[0] = beside(moves[1], times[1] / f64::from(whole));
                moves[2] = moves[1];
                if self.random.one_in(2) {
                    moves[3] = moves[1];
                }
            }
        }
        if self.random.one_in(4) {
            // In one line always.
            moves = [(); 4].map(|()| along.map(|x| x * self.whole(2)));
        }
        let (numerator, bits) = self.time();
        let motion = Self::through(places, moves, numerator, bits);
        if self.random.one_in(4) {
            self.nudged(motion)
        } else {
            motion
        }
    }

    fn touch_at_end(&mut self) -> Moving {
        let whole = self.some_whole();
        let boundary = self.random.one_in(3);
        let weights = self.weights(whole, boundary);
        let end = self.meeting(weights, f64::from(whole), 9);
        let mut start = [(); 4].map(|()| self.reals().map(|x| x * 64.0));
        if self.random.one_in(2) {
            // One element at rest.
            let first = self.of_first();
            start[first..].copy_from_slice(&end[first..]);
        }
        let motion = self.at_some_size([start, end], -60, 60);
        self.nudged_at(motion, 1)
    }

    /// Moves one coordinate at one end a little, or not.
    fn nudged_at(&mut self, motion: Moving, end: usize) -> Moving {
        let mut motion = self.rounded(motion);
        let [corner, axis] = [4, 3].map(|count| self.random.below(count) as usize);
        let x = &mut motion[end][corner][axis];
        *x = self.random.nudged(*x, self.single);
        self.rounded(motion)
    }

    fn double_root(&mut self) -> Moving {
        let whole = self.some_whole();
        let boundary = self.random.one_in(4);
        let mut weights = self.weights(whole, boundary);
        if self.random.one_in(5) {
            // Beyond an end of an edge, or of a side of the triangle.
            let more = f64::from(self.random.between(1, whole));
            weights[2] += more;
            weights[3] -= more;
        }
        let range = [3, 20][self.random.below(2) as usize];
        // All four are in the plane z = 0, and the heights of the two contact points change alike.
        // So the volume, which is their difference times an area, has a double root.
        let mut places = self.meeting(weights, f64::from(whole), range);
        for p in &mut places {
            p[2] = 0.0;
        }
        let mut moves = self.meeting(weights, f64::from(whole), range);
        for p in &mut moves {
            [p[0], p[1]] = [self.whole(range), self.whole(range)];
        }
        let (numerator, bits) = self.time();
        let motion = Self::through(places, moves, numerator, bits);
        let mut motion = self.oblique(motion);
        if self.random.one_in(2) {
            let end = self.random.below(2) as usize;
            motion = self.nudged_at(motion, end);
        }
        self.nudged(motion)
    }

    fn boundary(&mut self) -> Moving {
        let motion = self.met(true);
        let motion = self.at_some_size(motion, -20, 20);
        if self.random.one_in(2) {
            self.nudged(motion)
        } else {
            motion
        }
    }

    fn three_roots(&mut self) -> Moving {
        // Three differences of corners as rows of a triangular matrix. Its determinant is the
        // product of the three diagonal numbers, each zero at a time of its own. In units of
        // eighths of the step they are integers.
        let mut rows = [[[0.0; 3]; 3]; 2];
        for row in 0..3 {
            for column in row..3 {
                let slope = self.whole(3);
                let (from, slope) = if row == column {
                    let slope = if slope == 0.0 { 1.0 } else { slope };
                    let eighths = f64::from(self.random.between(0, 8));
                    (-slope * eighths, 8.0 * slope)
                } else {
                    (self.whole(12), 8.0 * slope)
                };
                rows[0][row][column] = from;
                rows[1][row][column] = from + slope;
            }
        }
        // Adding multiples of a row to another changes no determinant. It changes where the origin
        // lies when the determinant is zero.
        for _ in 0..4 {
            let [from, to] = [(); 2].map(|()| self.random.below(3) as usize);
            let times = self.whole(2);
            for rows in rows.iter_mut().filter(|_| from != to) {
                for column in 0..3 {
                    rows[to][column] += times * rows[from][column];
                }
            }
        }
        let path = [(); 2].map(|()| self.wholes(20));
        let corners = |end: usize| -> Corners {
            let p = path[end];
            let [x, y, z] = rows[end].map(|row| [0, 1, 2].map(|axis| p[axis] - row[axis]));
            match self.elements {
                Elements::VertexTriangle => [p, x, y, z],
                // The third difference is from the start of the second edge to the end of the
                // first.
                Elements::EdgeEdge => {
                    let other = [0, 1, 2].map(|axis| x[axis] + rows[end][2][axis]);
                    [p, other, x, y]
                }
            }
        };
        let motion = [corners(0), corners(1)];
        let motion = self.oblique(motion);
        if self.random.one_in(4) {
            self.nudged(motion)
        } else {
            motion
        }
    }

    fn still(&mut self) -> Moving {
        let mut motion = match self.random.below(3) {
            0 => self.lattice(),
            1 => self.anywhere(),
            _ => {
                // They meet at the start, or nearly.
                let boundary = self.random.one_in(2);
                let weights = self.weights(8, boundary);
                let mut places = [(); 4].map(|()| self.reals());
                self.make_meet(&mut places, weights, 8.0);
                let motion = [places, [(); 4].map(|()| self.reals())];
                self.nudged(motion)
            }
        };
        let first = self.of_first();
        let at_rest = match self.random.below(4) {
            0 => 0..4,
            1 => 0..first,
            2 => first..4,
            _ => 1..4,
        };
        for corner in at_rest {
            motion[1][corner] = motion[0][corner];
        }
        motion
    }

    fn translation(&mut self) -> Moving {
        let mut motion = match self.random.below(3) {
            0 => self.met(false),
            1 => self.aimed(),
            _ => {
                // Exactly alike: they meet always or never.
                let mut motion = self.lattice();
                motion[1] = motion[0];
                motion
            }
        };
        let by = [(); 2].map(|()| {
            let range = power(self.random.between(0, if self.single { 22 } else { 50 }));
            self.reals().map(|x| (x * range).round())
        });
        for (corners, by) in motion.iter_mut().zip(by) {
            for p in corners {
                *p = [0, 1, 2].map(|axis| p[axis] + by[axis]);
            }
        }
        self.rounded(motion)
    }

    fn scales(&mut self) -> Moving {
        let mut motion = match self.random.below(3) {
            0 => self.met(false),
            1 => self.lattice(),
            _ => self.aimed(),
        };
        let exponents: [i32; 8] = std::array::from_fn(|_| self.random.between(-60, 60));
        match self.random.below(4) {
            0 => {
                for (p, exponent) in motion.as_flattened_mut().iter_mut().zip(exponents) {
                    *p = p.map(|x| x * power(exponent));
                }
            }
            1 => {
                for (corners, exponent) in motion.iter_mut().zip(exponents) {
                    *corners = corners.map(|p| p.map(|x| x * power(exponent)));
                }
            }
            2 => {
                let first = self.of_first();
                for corners in &mut motion {
                    for (i, p) in corners.iter_mut().enumerate() {
                        let exponent = exponents[usize::from(i < first)];
                        *p = p.map(|x| x * power(exponent));
                    }
                }
            }
            _ => {
                for p in motion.as_flattened_mut() {
                    *p = [0, 1, 2].map(|axis| p[axis] * power(exponents[axis]));
                }
            }
        }
        self.rounded(motion)
    }

    /// Integer motions of several kinds, which may be multiplied by any power of two.
    fn of_integers(&mut self) -> Moving {
        match self.random.below(4) {
            0 => self.met(false),
            1 => self.lattice(),
            2 => self.coplanar(),
            _ => self.met(true),
        }
    }

    fn tiny(&mut self) -> Moving {
        let motion = self.of_integers();
        // Integers, so that nothing is rounded.
        let motion = every(motion, f64::round);
        let least = if self.single { -149 } else { -1074 };
        let mut motion = every(motion, |x| x * power(least));
        match self.random.below(4) {
            0 => {
                let axis = self.random.below(3) as usize;
                let up = power(self.random.between(100, 149));
                for p in motion.as_flattened_mut() {
                    p[axis] *= up;
                }
            }
            1 => {
                let corner = self.random.below(8) as usize;
                motion.as_flattened_mut()[corner] = self.reals();
            }
            _ => {}
        }
        motion
    }

    fn huge(&mut self) -> Moving {
        let motion = self.of_integers();
        let coordinates = motion.as_flattened().as_flattened();
        let most = coordinates
            .iter()
            .fold(1.0, |most: f64, x| most.max(x.abs()));
        // The largest power of two that leaves all in range.
        let mut up = power(127);
        while most * up > f64::from(f32::MAX) {
            up /= 2.0;
        }
        let motion = every(motion, |x| x * up);
        if self.random.one_in(3) {
            // Up to the limit.
            let limit = 0.5 * most * up;
            let max = f64::from(f32::MAX);
            return every(
                motion,
                |x| if x.abs() > limit { x.signum() * max } else { x },
            );
        }
        motion
    }

    fn grazing(&mut self) -> Moving {
        let weights = self.weights(8, true);
        let mut places = [(); 4].map(|()| self.reals());
        self.make_meet(&mut places, weights, 8.0);
        let moves = [(); 4].map(|()| self.reals());
        let (numerator, bits) = self.time();
        let motion = Self::through(places, moves, numerator, bits);
        self.nudged(motion)
    }

    fn nearly_parallel(&mut self) -> Moving {
        let weights = self.weights(8, false);
        let along = self.reals();
        let angle = power(-self.random.between(4, if self.single { 24 } else { 54 }));
        let mut places = [(); 4].map(|()| self.reals());
        let mut moves = [(); 4].map(|()| self.reals().map(|x| x * 0.25));
        let off = [(); 2].map(|()| self.reals());
        let beside = |p: [f64; 3], off: [f64; 3]| {
            [0, 1, 2].map(|axis| p[axis] + along[axis] + off[axis] * angle)
        };
        match self.elements {
            Elements::EdgeEdge => {
                places[1] = beside(places[0], off[0]);
                places[3] = beside(places[2], off[1]);
                if self.random.one_in(2) {
                    moves[1] = moves[0];
                    moves[3] = moves[2];
                }
            }
            Elements::VertexTriangle => {
                places[2] = beside(places[1], off[0]);
                moves[0] = beside(moves[1], off[1]);
                moves[2] = moves[1];
            }
        }
        self.make_meet(&mut places, weights, 8.0);
        let (numerator, bits) = self.time();
        let motion = Self::through(places, moves, numerator, bits);
        self.nudged(motion)
    }

    fn early(&mut self) -> Moving {
        let whole = self.some_whole();
        let boundary = self.random.one_in(2);
        let weights = self.weights(whole, boundary);
        let places = self.meeting(weights, f64::from(whole), 9);
        let moves = [(); 4].map(|()| self.wholes(9));
        // Integers in the first bits and the part of the step in the last, few enough for an exact
        // time.
        let bits = self.random.between(4, if self.single { 18 } else { 44 });
        let numerator = self.random.between(1, 3);
        let motion = Self::through(places, moves, numerator, bits);
        self.nudged_at(motion, 0)
    }

    fn any_bits(&mut self) -> Moving {
        let single = self.single;
        let mut number = || loop {
            let bits = self.random.bits();
            let x = if single {
                f64::from(f32::from_bits(bits as u32))
            } else {
                f64::from_bits(bits)
            };
            if x.abs() <= f64::from(f32::MAX) {
                return x;
            }
        };
        let mut motion = [[[0.0; 3]; 4]; 2];
        for x in motion.as_flattened_mut().as_flattened_mut() {
            *x = number();
        }
        if self.random.one_in(2) {
            // Few values, so that some agree.
            let few: [f64; 4] = [motion[0][0][0], motion[0][0][1], -motion[0][0][0], 0.0];
            for x in motion.as_flattened_mut().as_flattened_mut() {
                *x = few[self.random.below(4) as usize];
            }
        }
        motion
    }
}
