//! First contacts of single pairs of elements, for callers with a search of their own.
//!
//! Decisions are those that
//! [`World::vertex_triangle_impacts`](crate::World::vertex_triangle_impacts) makes; separating
//! directions are tried for eight pairs side by side.

use super::{check, padded};
use crate::error::{Error, ErrorKind};
use crate::kernels::apart::apart;
use crate::kernels::{Instructions, dispatch};
use crate::threads::Interrupt;
use crate::world::Scalar;
use pliant_exact::motion::{Grid, Moving, impact};

/// Finds when vertices first meet triangles that move, pair by pair, shape (k, 4, 3) at the start
/// and the end.
///
/// A pair is the vertex and the three corners, in this order. They move on straight lines, in real
/// arithmetic, from time 0 to time 1.
///
/// The answer for a pair is `None` if they never meet, as closed sets, which is decided exactly.
/// Else it is an interval [low, high] of times. They are apart from 0 to low, both included, and
/// first meet after low and not after high. The interval is [0, 0] if they meet at the start. It is
/// at most `width` wide, which is finite and at least 0, as [`Query::width`](crate::Query::width)
/// says; 10^-6 is a good one.
///
/// ```
/// let triangle = [[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
/// let [a, b, c] = triangle;
/// // A vertex falls through a triangle that stands still.
/// let start = [[[1.0, 1.0, 1.0], a, b, c]];
/// let end = [[[1.0, 1.0, -2.0], a, b, c]];
/// let impacts = pliant::vertex_triangle_impacts(&start, &end, 1e-6)?;
/// let [low, high] = impacts[0].expect("it falls through");
/// assert!(low < 1.0 / 3.0 && 1.0 / 3.0 <= high && high - low <= 1e-6);
/// # Ok::<(), pliant::Error>(())
/// ```
///
/// Cost, on one thread: some tens of nanoseconds for a pair that does not meet, less than a
/// microsecond for most others. Where only exact arithmetic can tell it is tens of microseconds. It
/// is some ten milliseconds where coordinates of a pair are a thousand powers of two apart.
///
/// # Errors
///
/// [`DifferentCounts`](crate::ErrorKind::DifferentCounts),
/// [`BadWidth`](crate::ErrorKind::BadWidth). [`BadCorner`](crate::ErrorKind::BadCorner) for the
/// first coordinate that is NaN, infinite or above `f32::MAX` in magnitude.
#[doc(alias = "point_triangle_ccd")]
pub fn vertex_triangle_impacts<S: Scalar>(
    start: &[[[S; 3]; 4]],
    end: &[[[S; 3]; 4]],
    width: f64,
) -> Result<Vec<Option<[f64; 2]>>, Error> {
    pair_impacts(false, start, end, width, None)
}

/// Finds when edges first meet edges that move, pair by pair, shape (k, 4, 3) at the start and the
/// end.
///
/// A pair is both ends of one edge, then both ends of the other. All else is as for
/// [`vertex_triangle_impacts`].
///
/// # Errors
///
/// The errors of [`vertex_triangle_impacts`].
#[doc(alias = "edge_edge_ccd")]
pub fn edge_edge_impacts<S: Scalar>(
    start: &[[[S; 3]; 4]],
    end: &[[[S; 3]; 4]],
    width: f64,
) -> Result<Vec<Option<[f64; 2]>>, Error> {
    pair_impacts(true, start, end, width, None)
}

/// Corners of a pair at the start and at the end, each padded to four lanes.
type Padded = [[[f64; 4]; 4]; 2];

/// Groups of eight pairs between two looks at an interruption. Groups that lanes keep apart cost
/// little, so it need not be looked more often.
const UNINTERRUPTED: usize = 1024;

/// Finds first contacts of vertices and triangles or of edges, and ends early where `question` says
/// so.
///
/// It is asked before each pair that takes long.
///
/// # Errors
///
/// The errors of [`vertex_triangle_impacts`], and [`Interrupted`](crate::ErrorKind::Interrupted).
#[doc(hidden)]
pub fn pair_impacts<S: Scalar>(
    are_edges: bool,
    start: &[[[S; 3]; 4]],
    end: &[[[S; 3]; 4]],
    width: f64,
    question: Option<&(dyn Fn() -> bool + Sync)>,
) -> Result<Vec<Option<[f64; 2]>>, Error> {
    if start.len() != end.len() {
        return Err(ErrorKind::DifferentCounts {
            start: start.len(),
            end: end.len(),
        }
        .of_query());
    }
    if !(width.is_finite() && width >= 0.0) {
        return Err(ErrorKind::BadWidth { width }.of_query());
    }
    for corners in [start, end] {
        check(corners)?;
    }
    let grid = Grid::new(width);
    let instructions = Instructions::widest();
    let mut all = Vec::with_capacity(start.len());
    let interrupt = Interrupt::new(question);
    let interrupted = || Err(ErrorKind::Interrupted.of_query());
    for (place, (start, end)) in start.chunks(8).zip(end.chunks(8)).enumerate() {
        if place % UNINTERRUPTED == 0 && interrupt.is_set() {
            return interrupted();
        }
        let mut eight: [Padded; 8] = [[[[0.0; 4]; 4]; 2]; 8];
        for lane in 0..8 {
            // Lanes that the last group does not fill take its first pair.
            let of = if lane < start.len() { lane } else { 0 };
            eight[lane] = [start[of], end[of]]
                .map(|corners| corners.map(|corner| padded(corner.map(Scalar::to_f64))));
        }
        let mut corners = [[&eight[0][0][0]; 8]; 8];
        for (lane, pair) in eight.iter().enumerate() {
            for (which, corner) in pair.as_flattened().iter().enumerate() {
                corners[which][lane] = corner;
            }
        }
        let are_apart = dispatch!(instructions, i => apart(i, are_edges, &corners, 1.0, 0.0));
        for (lane, corners) in eight.iter().enumerate().take(start.len()) {
            if are_apart >> lane & 1 == 1 {
                all.push(None);
                continue;
            }
            if interrupt.is_set() {
                return interrupted();
            }
            let moving = Moving {
                are_edges,
                corners: corners.map(|corners| corners.map(|[x, y, z, _]| [x, y, z])),
            };
            all.push(impact(&moving, grid).0);
        }
    }
    Ok(all)
}
