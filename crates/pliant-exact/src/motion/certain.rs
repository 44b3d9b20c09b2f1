//! The first contact in double precision, where rounding cannot change it: most pairs.
//!
//! [0, 1] is halved, the earlier half first, until each part is known to have no contact or to have
//! one. In a part with one root of the determinant, Newton's method guesses the cell of the root;
//! signs at its ends prove it. Signs over a part are the common signs of Bernstein coefficients (de
//! Casteljau). An answer is that of `first_contact`, or none; the bounds are at `OF_POINT`. Ends at
//! which a sign is not certain, and what has taken many parts, are left to integers.

use super::super::Point;
use super::super::float::{U, common_sign, power, sign_beyond};
use super::super::vector::{cross, cross_on, determinant, minus};
use super::grid::Grid;
use super::moving::Moving;
use std::array::from_fn;

/// The first contact of a pair, as far as it is certain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Certain {
    /// No contact in [0, 1].
    Never,
    /// First contact in this cell of the grid.
    Within([f64; 2]),
    /// Nothing is certain: integers are to decide.
    Nothing,
}

// Errors, each in units of u = 2^-53 of the larger magnitudes at both ends of the motion.
//
// Let M be the larger magnitude of a component of a corner q of the polygon at both ends.
// Components are differences of coordinates, off by u of themselves. Both a and 1 - a are exact, so
// q(a) = (1 - a) q(0) + a q(1) is off by less than 4 u M. Consider each Bernstein coefficient of an
// axis of p x q, a sum of products of such. It is off by less than 12 u (M_px M_qy + M_py M_qx), to
// first order.
//
// Let P be the sum of the six products of components of three corners that make a determinant, of
// their M. A determinant at ends of the motion is off by 8 u P (three differences, a product and a
// difference, a product and two sums). A coefficient, the mean of three such, is off by 11 u P. One
// of a part is off by 3 u P more for each halving; after at most 44 of them by 143 u P. A value at
// a fraction takes three rounds of means of two, with weights that are exact: 6 u P more. Beyond
// first order these are less than 2^-40 of themselves larger.
//
// What is lost below the normal range is at most 2^-1021 a step, times components below 2^130. That
// holds even where subnormal numbers are flushed to zero. The allowances end with a constant that
// is far above that.
const OF_POINT: f64 = 4.0 * U;
const OF_CROSS: f64 = 16.0 * U;
const OF_DETERMINANT: f64 = 256.0 * U;
const LOST_OF_POINT: f64 = power(-1000);
const LOST_OF_CROSS: f64 = power(-850);
const LOST_OF_DETERMINANT: f64 = power(-700);

/// Halvings of [0, 1], one in the other; times that many times halved are exact.
const DEEPEST: usize = 44;
/// The number of parts that are looked at, at most; a crossing takes about 25.
const MOST_PARTS: usize = 200;

/// A polygon's corners at one time.
pub(super) type Corners = [Point; 4];

/// A part of the motion.
#[derive(Clone, Copy, Default)]
struct Part {
    low: f64,
    high: f64,
    /// Bernstein coefficients of the determinant.
    determinant: [f64; 4],
    /// Whether on some axis all cross products have one sign throughout.
    is_inside: bool,
    /// Whether its determinant has one root, at which nothing is certain.
    is_hard: bool,
}

/// The state of a part that may have one root of its determinant.
enum OneRoot {
    Decided(Certain),
    Undecided,
    IsNotOne,
}

/// The difference of two elements at both ends of the motion, and the largest magnitudes of each
/// component.
pub(super) struct Polygon {
    pub(super) count: usize,
    ends: [Corners; 2],
    most: Corners,
}

/// The first contact of a pair, by cells of a grid, as far as it is certain. What surely is after
/// `until` may be left out; that is 0 or a multiple of 2^-44.
///
/// [0, 1] is halved, the earlier half first, until each part is known to have no contact or to have
/// one. On a part [a, b] a polynomial is a mean of its Bernstein coefficients there, with weights
/// that are not negative. So where all have one sign, it has it throughout. Of a part it is enough
/// to know one of these (see `motion` for the signs that decide):
///
/// ```text
/// the determinant has one sign, and is not zero                       no contact
/// on an axis all corners of the polygon are on one side               no contact
/// on an axis two of the q_i x q_(i+1) have opposite signs throughout  no contact
/// on an axis all q_i x q_(i+1) have one sign throughout, and the
/// determinant has opposite signs at a and b                           contact between a and b
/// ```
///
/// Parts are cut at fractions of two, as the cells of a grid are. A part with a contact that is
/// within one cell names the cell, and all that is earlier was free of contact. Ends at which a
/// sign is not certain, and what has taken many parts, are left to integers.
///
/// Mostly the determinant soon has one root in a part, or none: coefficients change their sign as
/// many times as there are roots, or more. Of one root the cell is guessed by Newton's method.
/// Signs at its ends prove that it is in there, and the rest of the part is of no interest.
#[inline]
pub(super) fn certain(moving: &Moving, grid: Grid, until: f64) -> Certain {
    let polygon = Polygon::new(moving);
    let (determinant, error) = polygon.determinant();
    if common_sign(determinant, error) != 0 {
        return Certain::Never;
    }
    let whole = Part {
        high: 1.0,
        determinant,
        ..Part::default()
    };
    // Most are decided here, before there is room for parts.
    if let OneRoot::Decided(certain) = polygon.at_one_root(&whole, error, grid, until) {
        return certain;
    }
    let mut parts = [Part::default(); DEEPEST + 2];
    let mut count: usize = 1;
    parts[0] = whole;
    for _ in 0..MOST_PARTS {
        let Some(last) = count.checked_sub(1) else {
            return Certain::Never;
        };
        count = last;
        let mut part = parts[last];
        // What meets in a part but the first does so after its beginning; in the first perhaps at
        // it.
        let is_late = part.low >= until && part.low > 0.0;
        if is_late || common_sign(part.determinant, error) != 0 {
            continue;
        }
        if !part.is_hard {
            match polygon.at_one_root(&part, error, grid, until) {
                OneRoot::Decided(Certain::Never) => continue,
                OneRoot::Decided(certain) => return certain,
                OneRoot::Undecided => part.is_hard = true,
                OneRoot::IsNotOne => {}
            }
        }
        if !part.is_inside {
            match polygon.sides(part.low, part.high) {
                Sides::Apart => continue,
                Sides::Inside => part.is_inside = true,
                Sides::Unknown => {}
            }
        }
        if part.is_inside {
            let [first, _, _, last] = part.determinant;
            if first.abs() <= error || last.abs() <= error {
                return Certain::Nothing;
            }
            if (first < 0.0) != (last < 0.0) {
                let cell = grid.cell_of(part.low, part.high);
                if grid.is_cell(cell) {
                    return Certain::Within(cell);
                }
                if grid.spacing < power(-(DEEPEST as i32)) {
                    return Certain::Nothing;
                }
            }
        }
        let middle = 0.5 * (part.low + part.high);
        // A part this short is a power of two.
        if part.high - part.low <= power(-(DEEPEST as i32)) {
            return Certain::Nothing;
        }
        let [earlier, later] = divided(part.determinant, 0.5);
        parts[count] = Part {
            low: middle,
            determinant: later,
            ..part
        };
        parts[count + 1] = Part {
            high: middle,
            determinant: earlier,
            ..part
        };
        count += 2;
    }
    Certain::Nothing
}

/// About the root of a polynomial that has one, by Newton's method, or halving where that leaves
/// the interval in which it is.
fn root_of(coefficients: [f64; 4], enough: f64) -> f64 {
    let [first, _, _, last] = coefficients;
    let [mut low, mut high] = [0.0, 1.0];
    let mut t = first / (first - last);
    for _ in 0..16 {
        let (value, slope) = value_at(coefficients, t);
        if (value < 0.0) == (first < 0.0) {
            low = t;
        } else {
            high = t;
        }
        let mut next = t - value / slope;
        // Where there is no slope it may be no number, and that is not in the interval either.
        if !(next > low && next < high) {
            next = 0.5 * (low + high);
        }
        if (next - t).abs() <= enough {
            return next;
        }
        t = next;
    }
    t
}

/// The value of a polynomial, of which these are the Bernstein coefficients, and its slope.
fn value_at(coefficients: [f64; 4], t: f64) -> (f64, f64) {
    let [[_, _, abc, value], [_, bcd, ..]] = divided(coefficients, t);
    (value, 3.0 * (bcd - abc))
}

/// The Bernstein coefficients of the parts before and after a time: means of means (de Casteljau).
/// At a half the products are exact, so that a mean is rounded once.
#[inline]
fn divided([a, b, c, d]: [f64; 4], t: f64) -> [[f64; 4]; 2] {
    let s = 1.0 - t;
    let mean = |x: f64, y: f64| s * x + t * y;
    let (ab, bc, cd) = (mean(a, b), mean(b, c), mean(c, d));
    let (abc, bcd) = (mean(ab, bc), mean(bc, cd));
    let all = mean(abc, bcd);
    [[a, ab, abc, all], [all, bcd, cd, d]]
}

/// Corners made component by component of two others.
#[inline]
fn of_both(p: &Corners, q: &Corners, made: impl Fn(f64, f64) -> f64) -> Corners {
    from_fn(|corner| from_fn(|axis| made(p[corner][axis], q[corner][axis])))
}

/// The sides of a part on which corners are, and edges turn.
enum Sides {
    Apart,
    Inside,
    Unknown,
}

impl Polygon {
    pub(super) fn new(moving: &Moving) -> Self {
        let ends = moving.corners.map(|[p, a, b, c]| {
            if moving.are_edges {
                [[p, b], [a, b], [a, c], [p, c]].map(|[p, q]| minus(&p, &q))
            } else {
                [minus(&a, &p), minus(&b, &p), minus(&c, &p), [0.0; 3]]
            }
        });
        let most = of_both(&ends[0], &ends[1], |p, q| p.abs().max(q.abs()));
        Self {
            count: if moving.are_edges { 4 } else { 3 },
            ends,
            most,
        }
    }

    /// The Bernstein coefficients of the determinant of the first three corners, and their error.
    fn determinant(&self) -> ([f64; 4], f64) {
        let [start, end] = &self.ends;
        let of = |p: &Point, q: &Point, r: &Point| determinant(q, r, p);
        let [p, q, r, _] = start;
        let [p1, q1, r1, _] = end;
        let coefficients = [
            of(p, q, r),
            (of(p1, q, r) + of(p, q1, r) + of(p, q, r1)) / 3.0,
            (of(p, q1, r1) + of(p1, q, r1) + of(p1, q1, r)) / 3.0,
            of(p1, q1, r1),
        ];
        let [p, q, r, _] = &self.most;
        let sum = p[0] * (q[1] * r[2] + q[2] * r[1])
            + p[1] * (q[2] * r[0] + q[0] * r[2])
            + p[2] * (q[0] * r[1] + q[1] * r[0]);
        (coefficients, sum * OF_DETERMINANT + LOST_OF_DETERMINANT)
    }

    /// A corner at both ends of the motion, and the larger magnitudes of its components.
    pub(super) fn corner(&self, i: usize) -> (Point, Point, Point) {
        (self.ends[0][i], self.ends[1][i], self.most[i])
    }

    /// Where the corners are at a time; each component is off by 4 u of the larger one at both
    /// ends.
    pub(super) fn at(&self, t: f64) -> Corners {
        let s = 1.0 - t;
        of_both(&self.ends[0], &self.ends[1], |p, q| s * p + t * q)
    }

    /// Where the corners are at both ends of a part.
    pub(super) fn part(&self, [low, high]: [f64; 2]) -> [Corners; 2] {
        [self.at(low), self.at(high)]
    }

    /// Whether on an axis all corners seem to be on one side at the start, and none beyond the
    /// other at a time. Then an exact look is worth it.
    pub(super) fn is_perhaps_apart(&self, axis: usize, t: f64) -> bool {
        let s = 1.0 - t;
        let is_beyond = |side: f64| {
            (0..self.count).all(|i| {
                let (start, end, most) = self.corner(i);
                let there = s * start[axis] + t * end[axis];
                side * start[axis] > 0.0 && side * there >= -most[axis] * OF_POINT
            })
        };
        is_beyond(1.0) || is_beyond(-1.0)
    }

    /// The sign that a component of a corner has throughout a part, if that is certain and not
    /// zero.
    pub(super) fn corner_sign(&self, [first, last]: &[Corners; 2], i: usize, axis: usize) -> i8 {
        let error = self.most[i][axis] * OF_POINT + LOST_OF_POINT;
        common_sign([first[i][axis], last[i][axis]], error)
    }

    /// The sign that a component of corner i x corner i + 1 has throughout a part, if that is
    /// certain and not zero.
    pub(super) fn cross_sign(&self, [first, last]: &[Corners; 2], i: usize, axis: usize) -> i8 {
        let j = if i + 1 < self.count { i + 1 } else { 0 };
        let cross = |p: &Point, q: &Point| cross_on(axis, p, q);
        let turns = [
            cross(&first[i], &first[j]),
            0.5 * (cross(&first[i], &last[j]) + cross(&last[i], &first[j])),
            cross(&last[i], &last[j]),
        ];
        let (x, y) = ((axis + 1) % 3, (axis + 2) % 3);
        let [p, q] = [&self.most[i], &self.most[j]];
        let error = (p[x] * q[y] + p[y] * q[x]) * OF_CROSS + LOST_OF_CROSS;
        common_sign(turns, error)
    }

    /// The contact in a part whose determinant has one root, by the cell that it is in.
    fn at_one_root(&self, part: &Part, error: f64, grid: Grid, until: f64) -> OneRoot {
        let sign = |x: f64| sign_beyond(x, error);
        let [first, second, third, last] = part.determinant.map(sign);
        // Whatever the sign of one in the middle is, there is one change.
        if first * last >= 0 || second != first && third != last {
            return OneRoot::IsNotOne;
        }
        let length = part.high - part.low;
        let value = |t: f64| value_at(part.determinant, (t - part.low) / length).0;
        // The sign has not changed yet: the root is later.
        if until < part.high && sign(value(until)) == first {
            return OneRoot::Decided(Certain::Never);
        }
        if length < grid.spacing || grid.spacing < power(-(DEEPEST as i32)) {
            return OneRoot::Undecided;
        }
        let guess = root_of(part.determinant, 0.25 * grid.spacing / length);
        let guess = part.low + guess * length;
        let cell = [0.0, grid.spacing].map(|more| grid.down(guess) + more);
        let has_it = |ends: [f64; 2]| ends.map(|t| sign(value(t))) == [first, last];
        // It may be in the cell beside that of the guess, or at the end of one, where no sign is
        // certain.
        for beside in [0.0, -grid.spacing, grid.spacing] {
            let ends = cell.map(|t| t + beside);
            if ends[0] >= part.low && ends[1] <= part.high && has_it(ends) {
                return match self.sides(ends[0], ends[1]) {
                    Sides::Apart => OneRoot::Decided(Certain::Never),
                    Sides::Inside => OneRoot::Decided(Certain::Within(ends)),
                    Sides::Unknown => OneRoot::Undecided,
                };
            }
        }
        let [low, high] = [cell[0] - grid.spacing, cell[1] + grid.spacing];
        if low < part.low || high > part.high || !has_it([low, high]) {
            return OneRoot::Undecided;
        }
        OneRoot::Decided(match self.sides(low, high) {
            Sides::Apart => Certain::Never,
            _ => Certain::Nothing,
        })
    }

    /// Whether the determinant surely has no root at the start, and one at most after it and up to
    /// a time. The time is a multiple of 2^-44.
    pub(super) fn has_one_root_until(&self, until: f64) -> bool {
        let (determinant, error) = self.determinant();
        let [before, _] = divided(determinant, until);
        let [first, second, third, last] = before.map(|x| sign_beyond(x, error));
        // Whatever the signs are that are not certain, there is one change.
        let is_late = second == first && (third == first || last == -first);
        let is_early = third == -first && last == -first;
        first != 0 && (is_late || is_early)
    }

    fn sides(&self, low: f64, high: f64) -> Sides {
        let part = self.part([low, high]);
        for axis in 0..3 {
            let first = self.corner_sign(&part, 0, axis);
            if first != 0 && (1..self.count).all(|i| self.corner_sign(&part, i, axis) == first) {
                return Sides::Apart;
            }
        }
        let axis = steepest(&part);
        let [mut is_any_negative, mut is_any_unknown, mut is_any_positive] = [false; 3];
        for i in 0..self.count {
            let sign = self.cross_sign(&part, i, axis);
            is_any_negative |= sign < 0;
            is_any_unknown |= sign == 0;
            is_any_positive |= sign > 0;
        }
        match [is_any_negative, is_any_unknown, is_any_positive] {
            [true, _, true] => Sides::Apart,
            [_, false, _] => Sides::Inside,
            _ => Sides::Unknown,
        }
    }
}

/// The axis on which the polygon, in the middle of a part, is seen largest, or about so.
fn steepest([first, last]: &[Corners; 2]) -> usize {
    let [a, b, c, _] = of_both(first, last, |p, q| p + q);
    let normal = cross(&minus(&b, &a), &minus(&c, &a)).map(f64::abs);
    let mut steepest = 0;
    for axis in 1..3 {
        if normal[axis] > normal[steepest] {
            steepest = axis;
        }
    }
    steepest
}
