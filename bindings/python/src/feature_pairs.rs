//! `pliant.feature_pairs`: each contact of close elements once, as solvers sum it.

use crate::answers::{Any, Column, Rows, named};
use crate::error::Result;
use crate::selection::Selection;
use crate::signals::interruptible;
use crate::world::World;
use pliant::{ClosestFeatures, FeaturePair};
use pliant_check::with_world;
use pyo3::prelude::*;

/// Finds each contact of close elements once, with its features: a FeaturePairs of arrays.
///
/// Rows of close_vertex_triangle_pairs and close_edge_edge_pairs repeat a contact for every
/// triangle and edge that has it. Here a vertex near a vertex, an edge or a face, or two edges near
/// each other, are one row. A barrier that is summed over these, weighted by multiplicity, is the
/// sum over all close pairs, in fewer terms. With weight 1 it would jump where features change.
///
///     contacts = pliant.feature_pairs(world, pliant.Selection.EVERYTHING, thickness)
///     barrier = -(contacts.multiplicity * np.log(contacts.distance / thickness)).sum()
///     edges = contacts.kind == pliant.FeatureKind.EDGE_EDGE
///
/// Which features are closest is exact. Parallel edges have several; the first in order is taken.
/// Rows are sorted by kind, then by bodies and numbers. Multiplicities sum to the lengths of the
/// two lists.
///
/// Raises pliant.Error: NoSuchBody, SameBody, Busy. BadDistance if distance is negative, infinite
/// or NaN.
///
/// Cost: both queries, O(n) for the bodies in the lists, and about a microsecond a row.
#[pyfunction]
pub(crate) fn feature_pairs<'py>(
    py: Python<'py>,
    world: &World,
    of: Selection,
    distance: f64,
) -> Result<Any<'py>> {
    let contacts = world.state.with(py, |state| {
        interruptible(|question| {
            let mut contacts = pliant::FeaturePairs::new();
            let asked = with_world!(&mut state.world, world => {
                contacts.ask(world, (of.0, distance), Some(question))
            });
            asked.map(|()| Vec::from(contacts))
        })
        .map_err(|refused| refused.distance_is("distance"))
    })?;
    let column = |of: fn(&FeaturePair) -> f64| contacts.iter().map(of).collect();
    Ok(named!(py, "FeaturePairs":
        kind = Column(contacts.iter().map(|it| number_of(it.features)).collect::<Vec<u8>>()),
        bodies = Rows(contacts.iter().map(|it| it.bodies.map(|body| body.0)).collect()),
        numbers = Rows(contacts.iter().map(|it| it.numbers).collect()),
        vertices = Rows(contacts.iter().map(|it| it.vertices).collect()),
        weights = Rows(contacts.iter().map(|it| it.weights).collect()),
        distance = Column::<f64>(column(|it| it.distance)),
        direction = Rows(contacts.iter().map(|it| it.direction.unwrap_or_default()).collect()),
        multiplicity = Column(contacts.iter().map(|it| it.multiplicity).collect::<Vec<u32>>()))?)
}

/// Number of a kind, in the order of rows.
pub(crate) fn number_of(features: ClosestFeatures) -> u8 {
    match features {
        ClosestFeatures::VertexVertex => 0,
        ClosestFeatures::VertexEdge => 1,
        ClosestFeatures::EdgeEdge => 2,
        ClosestFeatures::VertexFace => 3,
    }
}
