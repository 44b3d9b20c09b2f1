//! Times of impact of single pairs of elements, for callers with a search of their own.

use crate::answers::{Any, Column};
use crate::arrays;
use crate::error::{Result, caught};
use crate::signals::interruptible_after;
use pyo3::prelude::*;

/// Arrays (hit, low, high): bool (k,), float64 (k,), float64 (k,).
type Answer = (Column<bool>, Column<f64>, Column<f64>);

/// When vertices meet moving triangles, pair by pair, without a world: (hit, low, high).
///
/// For a search of your own. start and end are (k, 4, 3) float32 or float64, the vertex and the
/// three corners of the triangle at times 0 and 1. Corners move on straight lines.
///
/// Returns three arrays (k,): hit is bool, low and high are float64. Whether a pair meets, as
/// closed sets, is decided exactly. It is apart from time 0 to low, both included, and meets after
/// low and by high. Both are 0 if it meets at the start, and NaN without a hit. high - low is at
/// most width; with 0 they are neighbouring numbers.
///
/// Raises pliant.Error: BadArray, DifferentCounts if start and end differ in k. BadWidth if width
/// is negative, infinite or NaN. BadCorner for a coordinate that is NaN, infinite or above 3.4e38
/// in magnitude.
///
/// Cost: O(k), on one thread: some tens of nanoseconds for a pair that stays apart, mostly less
/// than a microsecond for one that meets. Pairs that only exact arithmetic decides take tens of
/// microseconds; some ten milliseconds if their coordinates are a thousand powers of two apart.
/// Ctrl-C is looked for between pairs.
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

/// When edges meet moving edges, pair by pair, without a world: (hit, low, high).
///
/// start and end are (k, 4, 3) float32 or float64, both ends of one edge and of the other, at times
/// 0 and 1. All else is as for pliant.vertex_triangle_impacts: result, errors and cost.
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

/// Answers both functions.
fn answer(
    py: Python<'_>,
    are_edges: bool,
    [start, end]: [&Any<'_>; 2],
    width: f64,
) -> Result<Answer> {
    let start = arrays::pairs_of_elements(start).map_err(|refused| refused.about("start"))?;
    let end = arrays::pairs_of_elements(end).map_err(|refused| refused.about("end"))?;
    // A single pair may take long, so signals are looked for before each that does.
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
