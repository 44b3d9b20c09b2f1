//! A body as queries read it, beside its trees.

use super::super::filter::Filter;
use super::super::mesh::BodyMesh;
use super::super::motion::Motion;
use super::super::shape::BodyShape;
use super::super::thickness::BodyThickness;
use crate::geometry::{Origin, Points};
use crate::ids::BodyId;
use crate::kernels::Coordinate;
use crate::mesh::{Elements, Order};
use crate::queries::{
    Groups, LabelPairs, NearBoxes, NearElements, Needs, OwnEdges, Removed, Thickness,
};
use crate::traversal::Read;
use crate::tree::{Source, Tree};

/// All that a query reads of a body but its trees and their boxes.
pub(super) struct Queried<'b, S> {
    body: BodyId,
    order: &'b Order,
    mesh: &'b dyn OwnEdges,
    source: Source<'b, S>,
    motion: Option<&'b Points<S>>,
    elements: Option<&'b Elements>,
    groups: Option<&'b Groups>,
    rest: Option<&'b Points<S>>,
    labels: Option<&'b LabelPairs>,
    thickness: Option<&'b Thickness>,
    removed: Option<Removed<'b>>,
}

impl<'b, S: Coordinate> Queried<'b, S> {
    #[inline]
    pub(super) fn of(
        (mesh, shape, motion, filter, thickness): (
            &'b BodyMesh<S>,
            &'b BodyShape<S>,
            &'b Motion<S>,
            &'b Filter<S>,
            &'b BodyThickness,
        ),
        needs: &Needs,
        origin: Origin,
    ) -> Self {
        let order = mesh.order();
        let way = motion.on().zip(needs.reach);
        let end = way.map(|(way, reach)| way.held(reach, order, origin));
        Self {
            body: mesh.body(),
            order,
            mesh,
            source: Source::new(
                shape.view(order, origin),
                end,
                needs.grows(thickness.most()),
            ),
            motion: way.map(|(way, reach)| way.going(reach)),
            elements: mesh.known_elements().filter(|_| !needs.triangles()),
            groups: filter.known_groups(),
            rest: filter.known_rest(),
            labels: filter.known_labels(),
            thickness: thickness.known(),
            removed: mesh.removed(),
        }
    }

    /// Data of one of its trees, with the boxes of elements where they are known.
    #[inline]
    pub(super) fn read(&self, tree: &'b Tree, near_boxes: Option<&'b NearBoxes>) -> Read<'b, S> {
        let elements = self.elements.zip(near_boxes);
        Read {
            body: self.body,
            order: self.order,
            mesh: self.mesh,
            tree,
            source: self.source,
            motion: self.motion,
            elements: elements.map(|(edges, boxes)| NearElements {
                edges,
                boxes,
                groups: self.groups,
                removed: self.removed,
            }),
            rest: self.rest,
            labels: self.labels,
            thickness: self.thickness,
            removed: self.removed,
        }
    }
}
