//! When single pairs of elements first meet, for who has a search of their own.
//!
//! The decision is that of [`World::vertex_triangle_impacts`](crate::World::vertex_triangle_impacts), eight pairs side by side where that
//! is enough.

use crate::error::{Error, ErrorKind};
use crate::kernels::apart::apart;
use crate::kernels::{Instructions, dispatch};
use crate::threads::Interrupt;
use crate::world::scalar::Scalar;
use pliant_exact::motion::{Grid, Moving, impact};

/// When vertices first meet triangles that move: of each pair the vertex and the three corners, at the start and at the end of the motion.
///
/// Corners move on straight lines, in real arithmetic. The answer for a pair is `None` if they never meet, as closed sets, from time 0 to
/// time 1, which is decided exactly; else [low, high]: they are apart from 0 to low, both included, and meet after that and not after high;
/// or [0, 0] if they meet at the start. It is at most `width` wide, which is finite and at least 0, as
/// [`Query::width`](crate::Query::width) says; 10^-6 is a good one.
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
/// Cost: some tens of nanoseconds a pair that does not meet, less than a microsecond for most others; tens of microseconds for what only
/// exact arithmetic can tell, and some ten milliseconds where coordinates of a pair are a thousand powers of two apart. One thread.
///
/// # Errors
///
/// [`DifferentCounts`](crate::ErrorKind::DifferentCounts), [`BadWidth`](crate::ErrorKind::BadWidth), and
/// [`BadCorner`](crate::ErrorKind::BadCorner) for the first coordinate that is NaN, infinite or above `f32::MAX` in magnitude.
#[doc(alias = "point_triangle_ccd")]
pub fn vertex_triangle_impacts<S: Scalar>(
    start: &[[[S; 3]; 4]],
    end: &[[[S; 3]; 4]],
    width: f64,
) -> Result<Vec<Option<[f64; 2]>>, Error> {
    pair_impacts(false, start, end, width, None)
}

/// When edges first meet edges that move: of each pair both ends of the one and both of the other, at the start and at the end of the
/// motion; as [`vertex_triangle_impacts`] says.
///
/// # Errors
///
/// Those of [`vertex_triangle_impacts`].
#[doc(alias = "edge_edge_ccd")]
pub fn edge_edge_impacts<S: Scalar>(
    start: &[[[S; 3]; 4]],
    end: &[[[S; 3]; 4]],
    width: f64,
) -> Result<Vec<Option<[f64; 2]>>, Error> {
    pair_impacts(true, start, end, width, None)
}

/// The corners of a pair at the start and at the end, each with padding.
type Padded = [[[f64; 4]; 4]; 2];

/// So many eights are known to be apart before it is asked whether somebody wants to stop.
const UNINTERRUPTED: usize = 1024;

/// Of vertices and triangles or of edges, ended early where `question` says so: it is asked before each pair that takes long.
///
/// # Errors
///
/// Those of [`vertex_triangle_impacts`], and [`Interrupted`](crate::ErrorKind::Interrupted).
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
            // What is left of the last eight is filled with the first.
            let of = if lane < start.len() { lane } else { 0 };
            eight[lane] = [start[of], end[of]].map(|corners| corners.map(padded));
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

fn padded<S: Scalar>(corner: [S; 3]) -> [f64; 4] {
    let [x, y, z] = corner.map(Scalar::to_f64);
    [x, y, z, z]
}

/// Refuses coordinates that no body may have.
fn check<S: Scalar>(corners: &[[[S; 3]; 4]]) -> Result<(), Error> {
    for (pair, corners) in corners.iter().enumerate() {
        for (corner, position) in corners.iter().enumerate() {
            let position = position.map(Scalar::to_f64);
            if !position.iter().all(|x| x.abs() <= f64::from(f32::MAX)) {
                return Err(ErrorKind::BadCorner {
                    pair,
                    corner,
                    position,
                }
                .of_query());
            }
        }
    }
    Ok(())
}
