//! Single pairs of elements and of triangles, for callers with a search of their own.

use crate::answers::{Any, Column, Rows, named};
use crate::arrays;
use crate::error::{Result, caught};
use crate::feature_pairs::number_of;
use crate::signals::interruptible_after;
use pliant::PairDistance;
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
    let start = arrays::corners_of_pairs(start).map_err(|refused| refused.about("start"))?;
    let end = arrays::corners_of_pairs(end).map_err(|refused| refused.about("end"))?;
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

/// How far vertices and triangles are apart, pair by pair, without a world: a PairDistances.
///
/// corners is (k, 4, 3) float32 or float64: the vertex and the three corners of the triangle. The
/// distance is off by at most 2^-30 of itself and 2^-1074, and 0 exactly if they touch.
///
/// Raises pliant.Error: BadArray; BadCorner for a coordinate that is NaN, infinite or above 3.4e38
/// in magnitude.
///
/// Cost, on one thread: some tens of nanoseconds a pair; microseconds where they touch, or a
/// triangle hardly has an area.
#[pyfunction]
pub(crate) fn vertex_triangle_distances<'py>(
    py: Python<'py>,
    corners: &Any<'py>,
) -> Result<Any<'py>> {
    distances(py, corners, pliant::vertex_triangle_distances)
}

/// How far edges are apart, pair by pair, without a world: a PairDistances.
///
/// corners is (k, 4, 3) float32 or float64: both ends of one edge, then of the other. Of parallel
/// edges an end of one holds the closest points. All else is as for
/// pliant.vertex_triangle_distances: result, errors and cost.
#[pyfunction]
pub(crate) fn edge_edge_distances<'py>(py: Python<'py>, corners: &Any<'py>) -> Result<Any<'py>> {
    distances(py, corners, pliant::edge_edge_distances)
}

/// Answers both functions.
fn distances<'py>(
    py: Python<'py>,
    corners: &Any<'py>,
    measure: fn(&[[[f64; 3]; 4]]) -> std::result::Result<Vec<PairDistance>, pliant::Error>,
) -> Result<Any<'py>> {
    let pairs = arrays::corners_of_pairs::<4>(corners)?;
    let found = py.detach(|| caught(|| Ok(measure(&pairs)?)))?;
    let kinds: Vec<u8> = found.iter().map(|it| number_of(it.features)).collect();
    Ok(named!(py, "PairDistances":
        distance = Column(found.iter().map(|it| it.distance).collect::<Vec<f64>>()),
        direction = Rows(found.iter().map(|it| it.direction.unwrap_or_default()).collect()),
        weights = Rows(found.iter().map(|it| it.weights).collect()),
        kind = Column(kinds))?)
}

/// Whether and how triangles intersect, pair by pair, without a world: (k,) int8.
///
/// corners is (k, 6, 3) float32 or float64: the corners of one triangle, then of the other. A
/// number is a ContactKind, or -1 if they have no point in common as closed sets. Both are decided
/// exactly.
///
/// Raises pliant.Error: BadArray; BadCorner for a coordinate that is NaN, infinite or above 3.4e38
/// in magnitude.
///
/// Cost, on one thread: some hundred nanoseconds a pair; microseconds where rounding hides a sign.
#[pyfunction]
pub(crate) fn triangle_contacts(py: Python<'_>, corners: &Any<'_>) -> Result<Column<i8>> {
    let pairs = arrays::corners_of_pairs::<6>(corners)?;
    let found = py.detach(|| caught(|| Ok(pliant::triangle_contacts(&pairs)?)))?;
    let kinds = found.iter().map(|kind| kind.map_or(-1, |kind| kind as i8));
    Ok(Column(kinds.collect()))
}
