//! Views of a body for debugging: the cut of its trees at a level, the boxes of the cut, and every
//! invariant.

use super::Body;
use crate::bodies::debug_view::NodeBox;
use crate::bodies::motion::Way;
use crate::geometry::{Bounds, Origin};
use crate::ids::TreeTriangle;
use crate::kernels::Coordinate;
use crate::options::Options;
use crate::tree::{BoxSource, Grown};
use std::ops::Range;

impl<S: Coordinate> Body<S> {
    /// Number of the part of the cut that each triangle is in, by the caller's numbers.
    pub(crate) fn tree_cut(&self, level: u32) -> Vec<u32> {
        let order = self.mesh.order().triangle_order();
        let mut part_of = vec![u32::MAX; self.mesh.triangles().len()];
        for (part, triangles) in (0..).zip(self.parts_of_cut(level)) {
            for place in triangles {
                if !self.mesh.is_gone(TreeTriangle(place as u32)) {
                    part_of[order[place] as usize] = part;
                }
            }
        }
        part_of
    }

    /// Box of every part of the cut.
    pub(crate) fn tree_boxes(&self, level: u32, origin: Origin) -> Vec<NodeBox<S>> {
        let positions = self.stored_positions();
        let (shape, order) = (&self.shape, self.mesh.order());
        let points = shape.sorted(order);
        let version = shape.view_of(&points, order, origin).version();
        let parts = self.parts_of_cut(level);
        let valid = self.parts.all();
        let valid = valid.flat_map(|part| part.valid_in_cut(level, version));
        let node_box = |(triangles, valid): (Range<usize>, bool)| {
            let mut bounds = Bounds::EMPTY;
            for &vertex in order.all_corners()[triangles].as_flattened() {
                bounds.include(positions[order.caller_vertex(vertex).index()]);
            }
            NodeBox {
                lower: bounds.lo,
                upper: bounds.hi,
                valid,
            }
        };
        parts.into_iter().zip(valid).map(node_box).collect()
    }

    /// Triangles of every part of the cut through all trees, as places in tree order.
    fn parts_of_cut(&self, level: u32) -> Vec<Range<usize>> {
        let starts = self
            .parts
            .all()
            .map(|part| part.tree().starts_of_cut(level));
        let starts: Vec<_> = starts.flatten().collect();
        let ends = starts[1..].iter().map(|start| start.index());
        let ends = ends.chain([self.triangle_count()]);
        let starts = starts.iter().copied().map(TreeTriangle::index);
        starts.zip(ends).map(|(start, end)| start..end).collect()
    }

    /// Checks the structure of the trees and the mesh, and that each valid box is the box of the
    /// present vertices below it.
    ///
    /// An error says in a sentence what is wrong.
    pub(crate) fn validate(&self, options: &Options, origin: Origin) -> Result<(), String> {
        let (shape, order) = (&self.shape, self.mesh.order());
        let now = shape.sorted(order);
        let from = shape.view_of(&now, order, origin);
        let end = self.motion.on().map(Way::end);
        let end = end.map(|end| (end, end.sorted(order)));
        let to = end.as_ref();
        let to = to.map(|(end, sorted)| end.view_of(sorted, order, origin));
        let mut next = 0;
        for part in self.parts.all() {
            let triangles = part.triangles();
            if triangles.start != next {
                return Err(format!("a part begins at {}, not {next}", triangles.start));
            }
            next = triangles.end;
            let distance = 0.0;
            part.validate(order, options.partition, Grown { from, to, distance })?;
        }
        if next as usize != self.triangle_count() {
            return Err("the parts do not hold all triangles".into());
        }
        self.mesh.validate()
    }
}
