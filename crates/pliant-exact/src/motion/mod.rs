//! First contacts: exactly whether and when a vertex and a triangle, or two edges, meet on their
//! way.
//!
//! Corners move on straight lines, and the elements meet where the origin is a difference of their
//! points. These differences are a polygon Q whose corners q_i are affine in the time t
//! (`Polygon`). Signs of polynomials in t tell whether it holds the origin, however degenerate the
//! elements are (`Polygon::holds_origin`). The first time is a root of one of them (`root`), told
//! as a *cell* ([`Contact::cell`]). So what is told is a function of the exact time and the width
//! of a grid alone.

mod before;
mod certain;
mod distant;
mod fraction;
mod grid;
mod moving;
mod polynomial;
mod root;
mod sturm;

use super::integer::{Integer, powers_of_all};
use super::ring::Ring;
use super::vector;
pub use certain::Certain;
use certain::certain;
pub use distant::{distant_until, starts_surely_within};
pub use grid::Grid;
pub use moving::Moving;
use polynomial::Polynomial;
use root::{Root, visit_roots};
use std::cmp::Ordering;
use std::ops::ControlFlow;

/// When two elements first meet.
#[derive(Clone, Debug)]
#[expect(
    clippy::large_enum_variant,
    reason = "there are two at most at a time, and memory for each would be allocated"
)]
pub enum Contact {
    /// At time 0.
    AtStart,
    /// At some time after it, up to 1.
    Later(Later),
}

/// A time after the start.
#[derive(Clone, Debug)]
pub struct Later(Root);

/// A polynomial for each axis.
type Vector = [Polynomial; 3];

/// Difference of two elements: a polygon of three or four moving corners.
///
/// A triangle and a vertex give a triangle: its corners less the vertex. Two edges give a
/// parallelogram: an end of the one edge less an end of the other, in order around.
struct Polygon {
    corners: [Vector; 4],
    /// The polygon in double precision, which is certain of most signs.
    rounded: certain::Polygon,
}

/// How a pair was decided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decided {
    /// In double precision, within a proven bound.
    InFloatingPoint,
    /// In integers of any size.
    InIntegers,
}

/// The cell of a grid in which two elements first meet, if they do in [0, 1]; and how that was
/// decided.
///
/// Exact, for coordinates that are [in range](crate::is_in_range). Times are parts of the motion.
/// Cost: some hundred nanoseconds, or tens of microseconds where rounding does not decide.
#[inline]
pub fn impact(moving: &Moving, grid: Grid) -> (Option<[f64; 2]>, Decided) {
    match quick(moving, grid, 1.0) {
        Certain::Never => (None, Decided::InFloatingPoint),
        Certain::Within(cell) => (Some(cell), Decided::InFloatingPoint),
        Certain::Nothing => {
            let cell = first_contact(moving).map(|contact| contact.cell(grid));
            (cell, Decided::InIntegers)
        }
    }
}

/// The first contact as far as it is known without integers. What surely is after `until`, which is
/// a multiple of 2^-44, may be left out. Cost: some hundred nanoseconds.
#[inline]
pub fn quick(moving: &Moving, grid: Grid, until: f64) -> Certain {
    if moving.begins_with_a_corner_in_common() {
        Certain::Within([0.0; 2])
    } else {
        certain(moving, grid, until)
    }
}

/// The first contact of two elements, if they meet in [0, 1]; exact, in integers.
///
/// The determinant D is a polynomial in t of degree 3; the other signs are signs of polynomials of
/// degree 2 and 1. If D is not zero, the elements meet at roots of it at which the polygon holds
/// the origin. That is at most three questions at algebraic numbers (`root`). If D is zero for all
/// t, the answer changes only where one of the other polynomials has a root. It is that of a closed
/// set, so the first time is 0 or one of these.
///
/// There is no tolerance, and no search without end. Cost: tens of microseconds; milliseconds where
/// coordinates are a thousand powers of two apart.
#[cold]
pub fn first_contact(moving: &Moving) -> Option<Contact> {
    let polygon = Polygon::new(moving);
    let determinant = polygon.determinant();
    if determinant.sign_at_zero() == 0 && polygon.holds_origin([0.0; 2], &Polynomial::sign_at_zero)
    {
        return Some(Contact::AtStart);
    }
    let mut first = None;
    if determinant.is_zero() {
        polygon.visit_polynomials(&mut |polynomial| polygon.find_first(polynomial, &mut first));
    } else {
        polygon.find_first(&determinant, &mut first);
    }
    first.map(|root| Contact::Later(Later(root)))
}

/// One component of the corners of the polygon, in units of a power of two; of a triangle the last
/// is zero.
fn differences(moving: &Moving, axis: usize, unit: i32) -> [Polynomial; 4] {
    let [start, end] = moving
        .corners
        .map(|corners| corners.map(|corner| Integer::new(corner[axis], unit)));
    let difference = |[p, q]: [usize; 2]| {
        let [start, end] = [&start, &end].map(|it| it[p].minus(&it[q]));
        Polynomial::affine(start, &end)
    };
    if moving.are_edges {
        [[0, 2], [1, 2], [1, 3], [0, 3]].map(difference)
    } else {
        [[1, 0], [2, 0], [3, 0], [0, 0]].map(difference)
    }
}

impl Polygon {
    fn new(moving: &Moving) -> Self {
        let [unit, _] = powers_of_all(moving.corners.as_flattened().as_flattened());
        let axes = [0, 1, 2].map(|axis| differences(moving, axis, unit));
        let [x, y, z] = axes.each_ref();
        let corner = |i: usize| [x, y, z].map(|axis| axis[i].clone());
        Self {
            rounded: certain::Polygon::new(moving),
            corners: [0, 1, 2, 3].map(corner),
        }
    }

    fn corners(&self) -> &[Vector] {
        &self.corners[..self.rounded.count]
    }

    /// A component of corner i x corner i + 1.
    fn cross(&self, i: usize, axis: usize) -> Polynomial {
        let [p, q] = [
            &self.corners[i],
            &self.corners[(i + 1) % self.rounded.count],
        ];
        vector::cross_on(axis, p, q)
    }

    fn determinant(&self) -> Polynomial {
        let [p, q, r, _] = &self.corners;
        vector::determinant(p, q, r)
    }

    /// Whether the polygon holds the origin at a time at which the two are in one plane.
    ///
    /// The time is from the one number to the other. `sign` tells the signs of polynomials at it,
    /// and is asked only where floating point is not certain.
    ///
    /// ```text
    /// the origin is in Q if and only if  det(q_0, q_1, q_2) = 0,
    ///                                    on no axis all q_i are beyond the origin on one side,
    ///                                    on no axis two q_i x q_(i+1) have opposite signs
    /// ```
    ///
    /// Proof of the last two for a plane through the origin. Let the q_i x q_(i+1) be l_i n. If Q
    /// has area, its normal is not zero on some axis, on which these have the signs of the l_i or
    /// all the opposite. The origin is in a convex polygon if and only if the l_i have no opposite
    /// signs. (And if it is in it, all q_i are on one side on no axis.)
    ///
    /// Let Q be a segment or a point whose line or direction does not go through the origin. Then
    /// the l_i add up to zero, for they are what Q's area is seen from there. Either two have
    /// opposite signs, or all are zero, and Q is a point. Let all q_i be on one line with the
    /// origin. It is in their hull if and only if they are not all beyond it on one side. Any axis
    /// that is not normal to the line shows that.
    fn holds_origin(&self, about: [f64; 2], sign: &dyn Fn(&Polynomial) -> i8) -> bool {
        let rounded = self.rounded.part(about);
        (0..3).all(|axis| {
            let mut sides = self.corners().iter().enumerate().map(|(i, corner)| {
                match self.rounded.corner_sign(&rounded, i, axis) {
                    0 => sign(&corner[axis]),
                    certain => certain,
                }
            });
            let first = sides.next().unwrap_or(0);
            first == 0 || sides.any(|side| side != first)
        }) && (0..3).all(|axis| {
            let mut known = 0;
            (0..self.rounded.count).all(|i| {
                let turn = match self.rounded.cross_sign(&rounded, i, axis) {
                    0 => sign(&self.cross(i, axis)),
                    certain => certain,
                };
                let is_opposite = turn * known < 0;
                known = if turn == 0 { known } else { turn };
                !is_opposite
            })
        })
    }

    /// Makes `first` the first root of a polynomial at which the polygon holds the origin, if that
    /// is earlier.
    fn find_first(&self, polynomial: &Polynomial, first: &mut Option<Root>) {
        let _ = visit_roots(polynomial, &mut |mut root| {
            root.narrow();
            let is_earlier = first
                .as_ref()
                .is_none_or(|first| root.compare(first) == Ordering::Less);
            let holds_origin =
                || self.holds_origin(root.about(), &|polynomial| root.sign_of(polynomial));
            if is_earlier && !holds_origin() {
                return ControlFlow::Continue(());
            }
            // Those after it are later.
            if is_earlier {
                *first = Some(root);
            }
            ControlFlow::Break(())
        });
    }

    /// Shows all whose signs decide a planar question.
    fn visit_polynomials(&self, show: &mut dyn FnMut(&Polynomial)) {
        for i in 0..self.rounded.count {
            for axis in 0..3 {
                show(&self.corners[i][axis]);
                show(&self.cross(i, axis));
            }
        }
    }
}

impl Contact {
    /// The numbers of a grid next to the time: the largest before it, and the least that is not
    /// before it. Of time 0 both are 0.
    ///
    /// Times are parts of the motion, from 0 to 1. Exact: each step of a binary search asks for a
    /// sign. Cost: some microseconds.
    pub fn cell(&self, grid: Grid) -> [f64; 2] {
        match self {
            Self::AtStart => [0.0; 2],
            Self::Later(later) => later.cell(grid),
        }
    }

    /// The order of two times, earlier first; exact. Cost: microseconds; where both are roots near
    /// each other, tens of them.
    pub fn compare(&self, other: &Self) -> Ordering {
        match (self, other) {
            (Self::Later(Later(a)), Self::Later(Later(b))) => a.compare(b),
            (a, b) => matches!(a, Self::Later(_)).cmp(&matches!(b, Self::Later(_))),
        }
    }
}

impl Later {
    fn cell(&self, grid: Grid) -> [f64; 2] {
        let Self(root) = self;
        let [low, high] = root.about();
        // Perhaps the interval of the root is in one cell.
        let [mut low, mut high] = [grid.down(low), grid.up(high).min(1.0)];
        if low > 0.0 && root.is_at_most(low) {
            low = 0.0;
        }
        if !root.is_at_most(high) {
            high = 1.0;
        }
        // Positive numbers are in the order of their bits. The root is in (low, high].
        loop {
            let [a, b] = [low.to_bits(), high.to_bits()];
            let middle = f64::from_bits(a + (b - a) / 2);
            let [below, above] = [grid.down(middle), grid.up(middle)];
            // The numbers of the grid that are next to the middle; one of them at least is within,
            // or none is.
            let mut next = [below, above].into_iter();
            let Some(at) = next.find(|&x| x > low && x < high) else {
                return [low, high];
            };
            if root.is_at_most(at) {
                high = at;
            } else {
                low = at;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Point;

    fn vertex_triangle(p: [Point; 2], a: [Point; 2], b: [Point; 2], c: [Point; 2]) -> Moving {
        Moving {
            are_edges: false,
            corners: [0, 1].map(|at| [p[at], a[at], b[at], c[at]]),
        }
    }

    fn cell(moving: &Moving, width: f64) -> Option<[f64; 2]> {
        first_contact(moving).map(|contact| contact.cell(Grid::new(width)))
    }

    #[test]
    fn floating_point_is_certain_of_what_is_so() {
        let mut random = pliant_oracle::Random::new(7);
        let [mut never, mut within, mut total] = [0; 3];
        let mut unit = || (random.bits() >> 11) as f64 / f64::powi(2.0, 53);
        for round in 0..20_000 {
            let scale = [1.0, 0.2, 3.0][round % 3];
            let moving = Moving {
                are_edges: round % 2 == 0,
                corners: [0, 1].map(|_| [0; 4].map(|_| [0; 3].map(|_| scale * unit()))),
            };
            let grid = Grid::new([1e-6, 1.0, 0.01, 0.0][round % 4]);
            let exact = first_contact(&moving).map(|contact| contact.cell(grid));
            total += 1;
            match certain(&moving, grid, 1.0) {
                Certain::Never => {
                    never += 1;
                    assert_eq!(exact, None, "{moving:?}");
                }
                Certain::Within(cell) => {
                    within += 1;
                    assert_eq!(exact, Some(cell), "{moving:?}");
                }
                Certain::Nothing => {}
            }
        }
        println!("{never} {within} of {total}");
        assert!(never > total / 2 && within > total / 20);
    }

    const A: [f64; 3] = [0.0, 0.0, 0.0];
    const B: [f64; 3] = [4.0, 0.0, 0.0];
    const C: [f64; 3] = [0.0, 4.0, 0.0];

    #[test]
    fn a_vertex_falls_on_a_triangle() {
        let falls = |x: f64, y: f64, from: f64, to: f64| {
            vertex_triangle([[x, y, from], [x, y, to]], [A; 2], [B; 2], [C; 2])
        };
        assert_eq!(
            cell(&falls(1.0, 1.0, 1.0, -1.0), 0.0),
            Some([0.5f64.next_down(), 0.5])
        );
        assert_eq!(cell(&falls(1.0, 1.0, 1.0, -1.0), 0.25), Some([0.25, 0.5]));
        let [low, high] = cell(&falls(1.0, 1.0, 1.0, -2.0), 0.0).unwrap();
        // The number next to a third is below it.
        assert_eq!([low, high], [1.0 / 3.0, (1.0f64 / 3.0).next_up()]);
        let [low, high] = cell(&falls(1.0, 1.0, 1.0, -2.0), 1e-6).unwrap();
        assert!(low < 1.0 / 3.0 && high > 1.0 / 3.0 && high - low <= 1e-6);
        // On an edge, at a corner, and one step beyond.
        assert_eq!(cell(&falls(2.0, 2.0, 1.0, 0.0), 1.0), Some([0.0, 1.0]));
        assert_eq!(
            cell(&falls(4.0, 0.0, 1.0, 0.0), 0.0),
            Some([1f64.next_down(), 1.0])
        );
        assert_eq!(cell(&falls(2.0, 2f64.next_up(), 1.0, -1.0), 0.0), None);
        assert_eq!(cell(&falls(1.0, 1.0, 1.0, 5e-324), 0.0), None);
        assert_eq!(cell(&falls(1.0, 1.0, 0.0, 1.0), 1e-6), Some([0.0; 2]));
        // Touches at once, so to say.
        assert_eq!(
            cell(&falls(1.0, 1.0, 5e-324, -1.0), 1e-6),
            Some([0.0, f64::powi(0.5, 20)])
        );
        let [low, high] = cell(&falls(1.0, 1.0, 5e-324, -1.0), 0.0).unwrap();
        assert_eq!([low, high], [0.0, 5e-324]);
    }

    #[test]
    fn coplanar_motion() {
        // In the plane of the triangle, from outside, through corner and edge.
        let slides =
            |from: [f64; 3], to: [f64; 3]| vertex_triangle([from, to], [A; 2], [B; 2], [C; 2]);
        assert_eq!(
            cell(&slides([-1.0, 1.0, 0.0], [1.0, 1.0, 0.0]), 0.0),
            Some([0.5f64.next_down(), 0.5])
        );
        assert_eq!(
            cell(&slides([-1.0, -1.0, 0.0], [1.0, 1.0, 0.0]), 0.0),
            Some([0.5f64.next_down(), 0.5])
        );
        assert_eq!(
            cell(&slides([8.0, -4.0, 0.0], [0.0, 4.0, 0.0]), 0.0),
            Some([0.5f64.next_down(), 0.5])
        );
        assert_eq!(cell(&slides([8.0, -3.0, 0.0], [0.0, 5.0, 0.0]), 0.0), None);
        assert_eq!(cell(&slides([3.0, 3.0, 0.0], [5.0, 5.0, 0.0]), 0.0), None);
    }

    #[test]
    fn edges_cross_touch_and_slide() {
        let edges = |a: [[Point; 2]; 2], b: [[Point; 2]; 2]| Moving {
            are_edges: true,
            corners: [0, 1].map(|at| [a[at][0], a[at][1], b[at][0], b[at][1]]),
        };
        let x = |from: f64, to: f64, z: f64| [[from, 0.0, z], [to, 0.0, z]];
        let y = |from: f64, to: f64| [[0.0, from, 0.0], [0.0, to, 0.0]];
        let half = Some([0.5f64.next_down(), 0.5]);
        assert_eq!(
            cell(
                &edges([x(-1.0, 1.0, 1.0), x(-1.0, 1.0, -1.0)], [y(-1.0, 1.0); 2]),
                0.0
            ),
            half
        );
        // Ends meet.
        assert_eq!(
            cell(
                &edges([x(0.0, 1.0, 1.0), x(0.0, 1.0, -1.0)], [y(0.0, 1.0); 2]),
                0.0
            ),
            half
        );
        assert_eq!(
            cell(
                &edges([x(1.0, 2.0, 1.0), x(1.0, 2.0, -1.0)], [y(0.0, 1.0); 2]),
                0.0
            ),
            None
        );
        // Collinear edges slide into each other; parallel ones fall on each other.
        assert_eq!(
            cell(
                &edges([x(3.0, 4.0, 0.0), x(-1.0, 0.0, 0.0)], [x(0.0, 1.0, 0.0); 2]),
                0.0
            ),
            half
        );
        assert_eq!(
            cell(
                &edges([x(0.5, 4.0, 1.0), x(0.5, 4.0, -1.0)], [x(0.0, 1.0, 0.0); 2]),
                0.0
            ),
            half
        );
        assert_eq!(
            cell(
                &edges([x(1.5, 4.0, 1.0), x(1.5, 4.0, -1.0)], [x(0.0, 1.0, 0.0); 2]),
                0.0
            ),
            None
        );
        // Points.
        assert_eq!(
            cell(
                &edges([x(0.5, 0.5, 1.0), x(0.5, 0.5, -1.0)], [x(0.5, 0.5, 0.0); 2]),
                0.0
            ),
            half
        );
    }

    /// When it is known that something meets at the start, what else does so is still of interest.
    #[test]
    fn contact_at_the_start_is_never_too_late() {
        use pliant_oracle::{Elements, MotionClass, Random};
        let mut random = Random::new(5);
        let mut at_start = 0;
        for class in [
            MotionClass::TouchAtStart,
            MotionClass::Coplanar,
            MotionClass::Still,
        ] {
            for _ in 0..300 {
                let (elements, corners) = class.motion(&mut random);
                let moving = Moving {
                    are_edges: matches!(elements, Elements::EdgeEdge),
                    corners,
                };
                let grid = Grid::new(1e-6);
                let cell = match quick(&moving, grid, 0.0) {
                    Certain::Never => None,
                    Certain::Within(cell) => Some(cell),
                    Certain::Nothing => first_contact(&moving).map(|it| it.cell(grid)),
                };
                if matches!(first_contact(&moving), Some(Contact::AtStart)) {
                    assert_eq!(cell, Some([0.0; 2]), "{moving:?}");
                    at_start += 1;
                }
            }
        }
        assert!(at_start > 100, "{at_start}");
    }
}
