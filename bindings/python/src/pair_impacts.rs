//! When single pairs of elements meet, for who has a search of their own.

use crate::answers::{Any, Column};
use crate::arrays;
use crate::error::{Result, caught};
use crate::signals::interruptible_after;
use pyo3::prelude::*;

/// (hit, low, high): bool (k,), float64 (k,), float64 (k,).
type Answer = (Column<bool>, Column<f64>, Column<f64>);

/// When vertices first meet triangles that move: start and end (k, 4, 3) float64, of each pair the vertex and the three corners of the
/// triangle, at the start and at the end of the motion. Corners move on straight lines.
///
/// Returns (hit, low, high): bool (k,), float64 (k,), float64 (k,). Whether a pair meets, as closed sets, is decided exactly; they are
/// apart from time 0 to low, both included, and meet after that and not after high; both are 0 if they meet at the start, and NaN where
/// there is no hit. high - low is at most width; with 0 they are neighbouring numbers. Ctrl-C is looked for between pairs.
#[pyfunction]
#[pyo3(signature = (start, end, width=1e-6))]
pub(crate) fn vertex_triangle_impacts(
    py: Python<'_>,
    start: &Any<'_>,
    end: &Any<'_>,
    width: f64,
) -> Result<Answer> {
    answer(py, false, [start, end], width)
}

/// When edges first meet edges that move: start and end (k, 4, 3) float64, of each pair both ends of the one edge and both of the other, at
/// the start and at the end of the motion. The answer is that of vertex_triangle_impacts.
#[pyfunction]
#[pyo3(signature = (start, end, width=1e-6))]
pub(crate) fn edge_edge_impacts(
    py: Python<'_>,
    start: &Any<'_>,
    end: &Any<'_>,
    width: f64,
) -> Result<Answer> {
    answer(py, true, [start, end], width)
}

fn answer(
    py: Python<'_>,
    are_edges: bool,
    [start, end]: [&Any<'_>; 2],
    width: f64,
) -> Result<Answer> {
    let start = arrays::pairs_of_elements(start).map_err(|refused| refused.about("start"))?;
    let end = arrays::pairs_of_elements(end).map_err(|refused| refused.about("end"))?;
    // A single pair may take long, so that it is looked for signals before each that does.
    let ask = |question: &(dyn Fn() -> bool + Sync)| {
        pliant::pair_impacts(are_edges, &start, &end, width, Some(question))
    };
    let found = py.detach(|| caught(|| interruptible_after(1, ask)))?;
    let column = |side: usize| {
        let times = found
            .iter()
            .map(|cell| cell.map_or(f64::NAN, |cell| cell[side]));
        Column(times.collect())
    };
    let hit = Column(found.iter().map(Option::is_some).collect());
    Ok((hit, column(0), column(1)))
}
