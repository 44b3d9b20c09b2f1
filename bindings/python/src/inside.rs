//! Points of callers and closed bodies: rules by name, points in a world's type, and answers.

use crate::answers::{Any, Column, Rows, named};
use crate::error::Result;
use crate::options;
use crate::state::would_be_rounded;
use numpy::PyArrayMethods;
use pliant::{ClosestPoint, Containment, Depth, InsideRule, Located, Scalar, Side, Watertight};
use pliant_check::{double, single};
use pliant_io::Positions;
use pyo3::prelude::*;

/// The rule of a name.
pub(crate) fn rule(given: &str) -> Result<InsideRule> {
    let rules = [
        ("nonzero", InsideRule::NonZero),
        ("positive", InsideRule::Positive),
        ("parity", InsideRule::Parity),
    ];
    options::named("rule", given, &rules)
}

/// Coordinates of a world, as which points are taken.
pub(crate) trait OfWorld: Scalar {
    /// Takes points of either type; refuses to round them.
    fn take<'a>(points: Positions<'a>, widened: &'a mut Vec<[f64; 3]>) -> Result<&'a [[Self; 3]]>;
}

impl OfWorld for f32 {
    fn take<'a>(points: Positions<'a>, _: &'a mut Vec<[f64; 3]>) -> Result<&'a [[Self; 3]]> {
        single(points).map_err(|_| would_be_rounded("points"))
    }
}

impl OfWorld for f64 {
    fn take<'a>(points: Positions<'a>, widened: &'a mut Vec<[f64; 3]>) -> Result<&'a [[Self; 3]]> {
        Ok(double(points, widened))
    }
}

/// A `Watertight` of Python.
pub(crate) fn watertight(py: Python<'_>, found: Watertight) -> PyResult<Any<'_>> {
    named!(py, "Watertight":
        open = Rows(found.open), turned = Rows(found.turned), doubled = Rows(found.doubled))
}

/// A `Located` of Python, of arrays of this shape.
pub(crate) fn located<'py>(
    py: Python<'py>,
    found: &[Located],
    shape: &[usize],
) -> PyResult<Any<'py>> {
    let side = |it: &Located| match it.side {
        Side::Outside => -1_i8,
        Side::On => 0,
        Side::Inside => 1,
    };
    named!(py, "Located":
        sides = Column(found.iter().map(side).collect()).into_pyobject(py)?.reshape(shape)?,
        windings = Column(found.iter().map(|it| it.winding).collect())
            .into_pyobject(py)?
            .reshape(shape)?)
}

/// A `Containment` of Python.
pub(crate) fn containment<'py>(py: Python<'py>, found: &Containment) -> PyResult<Any<'py>> {
    let all = found.all.iter();
    let row = all.map(|it| [it.body.0, it.component, it.inside.0]);
    named!(py, "Containment":
        all = Rows(row.collect()),
        open = found.open.iter().map(|body| body.0).collect::<Vec<u32>>())
}

/// A `ClosestPoints` of Python.
pub(crate) fn closest<'py>(py: Python<'py>, found: &[Option<ClosestPoint>]) -> PyResult<Any<'py>> {
    let numbers = |of: fn(&ClosestPoint) -> u32| {
        let number = |it: &Option<_>| it.as_ref().map_or(u32::MAX, of);
        Column(found.iter().map(number).collect())
    };
    let rows = |of: fn(&ClosestPoint) -> [f64; 3]| {
        let row = |it: &Option<_>| it.as_ref().map_or([f64::NAN; 3], of);
        Rows(found.iter().map(row).collect())
    };
    let distance = |it: &Option<ClosestPoint>| it.map_or(f64::INFINITY, |it| it.distance);
    let feature = |it: &Option<ClosestPoint>| it.map_or(u8::MAX, |it| it.feature.into());
    named!(py, "ClosestPoints":
        found = Column(found.iter().map(Option::is_some).collect::<Vec<bool>>()),
        bodies = numbers(|it| it.body.0),
        triangles = numbers(|it| it.triangle),
        distance = Column(found.iter().map(distance).collect::<Vec<f64>>()),
        points = rows(|it| it.point),
        barycentric = rows(|it| it.barycentric),
        direction = rows(|it| it.direction.unwrap_or_default()),
        features = Column(found.iter().map(feature).collect::<Vec<u8>>()))
}

/// A `Depth` of Python.
pub(crate) fn depth(py: Python<'_>, found: Depth) -> PyResult<Any<'_>> {
    named!(py, "Depth":
        of_vertices = Column(found.of_vertices),
        vertex = found.vertex,
        at_least = found.at_least,
        at_most = found.at_most)
}
