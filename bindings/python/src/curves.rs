//! Where listed pairs meet: `pliant.segments`, and `pliant.curves`, which links them.

use crate::answers::{Any, Column, Rows, named};
use crate::arrays;
use crate::error::Result;
use crate::world::World;
use numpy::{IntoPyArray, PyArrayMethods};
use pliant::{CurveColumns, Pair, SegmentColumns};
use pliant_check::with_world;
use pyo3::prelude::*;

/// Says where pairs of triangles meet in the present shapes of a world: a Segments of arrays.
///
/// Takes rows (k, 4) uint32: body, triangle, body, triangle, as intersections and other queries
/// give them. For each pair there is a point, a segment or a polygon. Which corner, edge or inside
/// of either triangle an end lies on is exact. Its coordinates are rounded: they are off by at most
/// 2^-38 of the edge on which it lies, and by four roundings.
///
///     pairs = world.intersections().all()
///     segments = pliant.segments(world, pairs)
///     ends = segments.points[segments.offsets[0]:segments.offsets[1]]     # of the first pair
///
/// Raises pliant.Error: NoSuchBody, NoSuchTriangle, EmptyTriangle. BadArray for other rows.
///
/// Cost: O(n) for the bodies named, and some hundred nanoseconds a pair.
#[pyfunction]
pub(crate) fn segments<'py>(py: Python<'py>, world: &World, pairs: &Any<'py>) -> Result<Any<'py>> {
    let pairs = pairs_of(pairs)?;
    let segments = world.state.with(py, |state| {
        let mut segments = pliant::Segments::new();
        with_world!(&state.world, world => segments.update(world, &pairs))?;
        Ok(SegmentColumns::of(&segments))
    })?;
    Ok(segments_told(segments, py)?)
}

/// Finds the curves in which pairs of triangles meet: a Curves of arrays.
///
/// Takes rows (k, 4) uint32, each pair once, as segments does. Segments that end on the same
/// vertex, edge or triangle of both meshes are linked, by these alone: rounding joins nothing and
/// parts nothing. For the curves in which a body meets itself, add its adjacent_intersections.
///
///     pairs = np.concatenate([world.intersections(pliant.Selection.EVERYTHING).all(),
///                             world.adjacent_intersections().all().pairs])
///     curves = pliant.curves(world, pairs)
///     for number, length in enumerate(curves.length):
///         print(length, curves.closed[number], curves.polyline(number))   # (n, 3) float64
///
/// In general position a curve of closed bodies is closed, or ends at a vertex that both triangles
/// share. Where exactly two segments end in a place, a curve goes on; where more do, all end.
/// Triangles of one plane are in no curve. Points at which surfaces touch and no curve is are told
/// apart. With areas=True, so are the areas that closed curves enclose.
///
/// Raises pliant.Error: NoSuchBody, NoSuchTriangle, EmptyTriangle. BadArray for other rows.
///
/// Cost: that of segments, and some ten nanoseconds a pair. Areas take O(m + n) a curve.
#[pyfunction]
#[pyo3(signature = (world, pairs, *, areas=false))]
pub(crate) fn curves<'py>(
    py: Python<'py>,
    world: &World,
    pairs: &Any<'py>,
    areas: bool,
) -> Result<Any<'py>> {
    let pairs = pairs_of(pairs)?;
    let told = world.state.with(py, |state| {
        let mut curves = pliant::Curves::new();
        with_world!(&state.world, world => {
            curves.update(world, &pairs)?;
            let told = CurveColumns::of(&curves);
            Ok(if areas { told.with_areas(&curves, world)? } else { told })
        })
    })?;
    let segments = segments_told(told.segments, py)?;
    let areas = areas.then_some(Rows(told.areas));
    Ok(named!(py, "Curves":
        segments = segments,
        offsets = Column(told.offsets),
        steps = Column(told.steps),
        reversed = Column(told.reversed),
        swapped = Column(told.swapped),
        length = Column(told.length),
        closed = Column(told.closed),
        ends = Rows(told.ends),
        areas = areas,
        touching = Column(told.touching))?)
}

fn pairs_of(rows: &Any<'_>) -> Result<Vec<Pair>> {
    let rows = arrays::rows_of(rows, "pairs", "queries give")?;
    Ok(rows.into_iter().map(<[u32; 4]>::into).collect())
}

fn segments_told(segments: SegmentColumns, py: Python<'_>) -> PyResult<Any<'_>> {
    let pairs = segments.flat.len();
    let normals = segments.normals.into_flattened().into_pyarray(py);
    named!(py, "Segments":
        offsets = Column(segments.offsets),
        points = Rows(segments.points),
        on = Rows(segments.on),
        parameters = Rows(segments.parameters),
        normals = normals.reshape([pairs, 2, 3])?,
        flat = Column(segments.flat))
}
