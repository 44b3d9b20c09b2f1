//! Body of a world: joins its mesh, shape, motion, trees and filters.

mod edits;
mod looking;
mod queried;

use self::queried::Queried;
use super::build::build;
use super::checks;
use super::debug_view::TreeShape;
use super::filter::Filter;
use super::mesh::{BodyMesh, Places};
use super::motion::{Motion, Way};
use super::part::Part;
use super::parts::Parts;
use super::rebuild::{Rebuild, Work};
use super::shape::{BodyShape, Staged};
use super::thickness::BodyThickness;
use crate::error::ErrorKind;
use crate::geometry::{Aabb, Bounds, Origin};
use crate::held::held;
use crate::ids::{BodyId, TreeTriangle, TreeVertex};
use crate::kernels::{Coordinate, Instructions};
use crate::labels::Labels;
use crate::mesh::{Changed, EMPTY, Order, Topology};
use crate::options::Options;
use crate::queries::{BodyBoxes, Needs, Reach, StarredBody, Which};
use crate::threads::Executor;
use crate::traversal::{Read, Side};
use crate::tree::{BoxSet, Grown, Tree};
use std::borrow::Cow;

/// A body of a world. Its parts change each other only through their methods, called here.
pub(crate) struct Body<S> {
    mesh: BodyMesh<S>,
    shape: BodyShape<S>,
    motion: Motion<S>,
    parts: Parts,
    rebuild: Rebuild,
    filter: Filter<S>,
    thickness: BodyThickness,
}

/// Stride of the triangles that are sampled to know how far vertices move.
const SAMPLED: usize = 16;
/// Most samples of a body, about.
const SAMPLES: usize = 1024;

/// Divisor for few edits: with fewer edited than one of this many triangles, the tree does about as
/// well as a fresh one.
const OF_FEW: usize = 256;

impl<S: Coordinate> Body<S> {
    /// Makes a body of validated arguments, with positions in the caller's order.
    pub(crate) fn new(
        id: BodyId,
        triangles: &[[u32; 3]],
        positions: &[[S; 3]],
        options: &Options,
    ) -> Self {
        let topology = Topology::new(triangles, positions.len());
        let (order, tree) = build(&topology, positions, options);
        Self {
            shape: BodyShape::new(positions, &order),
            mesh: BodyMesh::new(id, topology, order),
            motion: Motion::default(),
            parts: Parts::of(tree, triangles.len()),
            rebuild: Rebuild::default(),
            filter: Filter::none(),
            thickness: BodyThickness::default(),
        }
    }

    /// Copies the body. Its boxes are made anew.
    pub(crate) fn copy(&self) -> Self {
        let order = self.mesh.order();
        Self {
            mesh: self.mesh.copy(),
            shape: self.shape.copy(order),
            motion: self.motion.copy(order),
            parts: self.parts.copy(),
            rebuild: self.rebuild.copy(),
            filter: self.filter.copy(),
            thickness: self.thickness.copy(),
        }
    }

    #[inline]
    pub(crate) fn id(&self) -> BodyId {
        self.mesh.body()
    }

    #[inline]
    pub(crate) fn mesh(&self) -> &BodyMesh<S> {
        &self.mesh
    }

    // Filters.

    pub(crate) fn set_filter(&mut self, membership: u32, mask: u32) {
        self.filter.set_masks(membership, mask);
    }

    /// Membership and mask.
    pub(crate) fn filter(&self) -> (u32, u32) {
        self.filter.masks()
    }

    pub(crate) fn set_environment(&mut self, environment: u32) {
        self.filter.set_environment(environment);
    }

    pub(crate) fn environment(&self) -> u32 {
        self.filter.environment()
    }

    /// Whether environments and masks of two bodies, or of one and itself, let them meet.
    pub(crate) fn may_meet(&self, other: &Self) -> bool {
        self.filter.lets_meet(&other.filter)
    }

    /// Gives every vertex a group. Vertices of one group do not meet, unless it is 0.
    pub(crate) fn set_groups(&mut self, groups: &[u32]) -> Result<(), ErrorKind> {
        self.filter.set_groups(groups, self.mesh.vertex_count())
    }

    /// Group of every vertex.
    pub(crate) fn groups(&self) -> Vec<u32> {
        self.filter.groups(self.mesh.vertex_count())
    }

    /// Sets the thickness of every vertex, after checking it.
    pub(crate) fn set_thickness(&mut self, all: &[f64]) -> Result<(), ErrorKind> {
        self.thickness.set(all, self.mesh.vertex_count())
    }

    /// Thickness of every vertex.
    pub(crate) fn thickness(&self) -> Vec<f64> {
        self.thickness.all(self.mesh.vertex_count())
    }

    /// Largest thickness.
    pub(crate) fn thickest(&self) -> f64 {
        self.thickness.most()
    }

    /// Sets a rest shape after checking it, or removes it.
    pub(crate) fn set_rest(&mut self, rest: Option<&[[S; 3]]>) -> Result<(), ErrorKind> {
        if let Some(rest) = rest {
            let expected = self.mesh.vertex_count();
            checks::length("rest positions", expected, rest.len())?;
            checks::all(self.mesh.new_shape(rest).positions)?;
        }
        self.filter.set_rest(rest);
        Ok(())
    }

    /// Rest shape in the caller's order, if there is one.
    pub(crate) fn rest(&self) -> Option<&[[S; 3]]> {
        self.filter.rest()
    }

    /// Sets the labels of triangles, or takes them away.
    pub(crate) fn set_labels(&mut self, labels: Option<Labels>) -> Result<(), ErrorKind> {
        let mesh = &self.mesh;
        self.filter
            .set_labels(labels, mesh.triangles(), mesh.vertex_count())
    }

    /// Labels of triangles, if there are any.
    pub(crate) fn labels(&self) -> Option<Labels<'_>> {
        self.filter.labels()
    }

    /// Finds which pairs labels leave out, unless that is known. O(m log m).
    pub(crate) fn know_labels(&mut self) {
        let mesh = &self.mesh;
        self.filter
            .know_labels(mesh.triangles(), mesh.vertex_count());
    }

    /// Whether labels leave out two triangles; they must be known.
    pub(crate) fn leaves_out(&self, pair: [TreeTriangle; 2]) -> bool {
        let labels = self.filter.known_labels();
        labels.is_some_and(|labels| labels.leave_out(self.mesh.order(), pair))
    }

    /// Numbers the edges as another body with this mesh does.
    ///
    /// Returns false if these are not its edges, or if they have numbers already.
    pub(crate) fn number_edges(&mut self, edges: &[[u32; 2]]) -> bool {
        self.mesh.number_edges(edges)
    }

    /// Numbers the edges as given.
    pub(crate) fn set_edges(&mut self, edges: &[[u32; 2]]) -> Result<(), ErrorKind> {
        self.mesh.set_edges(edges)
    }

    // The shape.

    /// Validates a new shape and takes it over; on an error the body stays as it is. A motion ends.
    pub(crate) fn set_positions(
        &mut self,
        positions: &[[S; 3]],
        threads: (Instructions, Executor),
    ) -> Result<(), ErrorKind> {
        let new = self.mesh.new_shape(positions);
        self.shape.take(&new, self.filter.loose(), threads)?;
        self.shape.begin_version();
        self.motion.stop();
        Ok(())
    }

    /// Validates a new shape; the body stays as it is.
    pub(crate) fn check_positions(
        &mut self,
        positions: &[[S; 3]],
        threads: (Instructions, Executor),
    ) -> Result<Staged<S>, ErrorKind> {
        let new = self.mesh.new_shape(positions);
        self.shape.check(&new, self.filter.loose(), threads)
    }

    /// Takes a shape over that was validated. A motion ends.
    pub(crate) fn accept_positions(
        &mut self,
        staged: &Staged<S>,
        positions: &[[S; 3]],
        threads: (Instructions, Executor),
    ) {
        let new = self.mesh.new_shape(positions);
        self.shape.accept(staged, &new, threads);
        self.shape.begin_version();
        self.motion.stop();
    }

    /// Positions in the caller's order. Positions of empty vertices are NaN.
    pub(crate) fn positions(&self) -> Cow<'_, [[S; 3]]> {
        self.mesh.without_empty_ones(self.stored_positions())
    }

    /// Positions in the caller's order. Empty vertices are somewhere.
    fn stored_positions(&self) -> Cow<'_, [[S; 3]]> {
        self.shape.in_callers_order(self.mesh.order())
    }

    /// Makes all boxes stale although the shape is the same: the origin moved.
    pub(crate) fn origin_moved(&mut self) {
        self.shape.begin_version();
    }

    /// Exact bounds, in the caller's coordinates.
    pub(crate) fn bounds(&self) -> Bounds<S> {
        self.shape.bounds()
    }

    /// Box of the body, as a kind of query needs it.
    #[inline]
    pub(crate) fn box_for(&self, boxes: BodyBoxes, origin: Origin) -> Aabb {
        let bounds = self.bounds();
        let way = self.motion.on().filter(|_| boxes.hold_motions);
        let bounds = way.map_or(bounds, |way| bounds.union(&way.end().bounds()));
        boxes.of(bounds.to_box(origin), self.thickness.most())
    }

    /// Loose box, which holds every pose, if there is one.
    pub(crate) fn loose(&self) -> Option<Bounds<S>> {
        self.filter.loose()
    }

    /// Loose box for the broad phase, if there is one.
    pub(crate) fn loose_box(&self, origin: Origin) -> Option<Aabb> {
        self.loose().map(|loose| loose.to_box(origin))
    }

    pub(crate) fn set_loose_box(&mut self, loose: Option<Bounds<S>>) -> Result<(), ErrorKind> {
        if let Some(loose) = &loose {
            checks::is_box(loose)?;
            // Positions of empty vertices do not matter.
            let is_empty = |vertex| self.mesh.is_empty(vertex);
            checks::all_inside(loose, &self.stored_positions(), is_empty)?;
            if let Some(way) = self.motion.on() {
                let end = way.end().in_callers_order(self.mesh.order());
                checks::all_inside(loose, &end, is_empty)?;
            }
        }
        self.filter.set_loose(loose);
        Ok(())
    }

    /// Exact corners of a triangle, whether or not the shape is in tree order.
    #[inline]
    pub(crate) fn corners_now(&self, triangle: TreeTriangle) -> [[f64; 3]; 3] {
        let order = self.mesh.order();
        // Loops, which are compiled into their callers where closures may not be.
        let mut corners = [[0.0; 3]; 3];
        for (corner, vertex) in corners.iter_mut().zip(order.corners(triangle)) {
            let [x, y, z] = self.shape.get(vertex, order.vertex_order());
            *corner = [x.to_f64(), y.to_f64(), z.to_f64()];
        }
        corners
    }

    /// Corners of a triangle, with padding. The shape must be in tree order.
    pub(crate) fn padded_corners(&self, triangle: TreeTriangle) -> [&[S; 4]; 3] {
        let positions = self.shape.in_tree_order();
        let corners = self.mesh.order().corners(triangle);
        corners.map(|vertex| positions.padded(vertex))
    }

    /// Positions of the corners of elements, by the caller's numbers. The shape must be in tree
    /// order.
    pub(crate) fn places(&self) -> Option<Places<'_, S>> {
        self.mesh.places(self.shape.in_tree_order())
    }

    // The motion.

    pub(crate) fn is_moving(&self) -> bool {
        self.motion.on().is_some()
    }

    /// Validates a shape that the body is going to have, and begins a motion to it, in place of any
    /// other.
    pub(crate) fn set_motion(
        &mut self,
        instructions: Instructions,
        executor: Executor,
        end: &[[S; 3]],
    ) -> Result<(), ErrorKind> {
        let end = self.mesh.new_shape(end);
        let threads = (instructions, executor);
        self.motion
            .begin(&self.shape, &end, self.filter.loose(), threads)
    }

    /// Ends a motion. The shape is then the motion's end.
    pub(crate) fn finish_motion(&mut self) {
        self.motion.finish(&mut self.shape);
    }

    /// Ends a motion at a part `t` of its way, from 0 to 1. The shape is then the one at `t`.
    ///
    /// `shape` is scratch memory, kept from call to call.
    pub(crate) fn advance_motion(
        &mut self,
        instructions: Instructions,
        executor: Executor,
        t: f64,
        shape: &mut Vec<[S; 3]>,
    ) -> Result<(), ErrorKind> {
        let Some(way) = self.motion.on() else {
            return Ok(());
        };
        if t == 1.0 {
            self.finish_motion();
            return Ok(());
        }
        let order = self.mesh.order().vertex_order();
        let orphans = self.mesh.order().orphans();
        shape.resize(self.mesh.vertex_count(), [S::default(); 3]);
        for (vertex, &place) in (0..).zip(order) {
            if orphans.has(vertex) {
                continue;
            }
            let ends = [&self.shape, way.end()];
            let [from, to] = ends.map(|positions| positions.get(TreeVertex(vertex), order));
            shape[place as usize] = std::array::from_fn(|axis| from[axis].toward(to[axis], t));
        }
        self.set_positions(shape, (instructions, executor))
    }

    /// Positions at the end of a motion in the caller's order, if there is a motion.
    pub(crate) fn end_positions(&self) -> Option<Cow<'_, [[S; 3]]>> {
        let end = self.motion.on()?.end();
        let end = end.in_callers_order(self.mesh.order());
        Some(self.mesh.without_empty_ones(end))
    }

    /// Mean displacement of sampled vertices, in mean lengths of edges. It is 0 if there is no
    /// motion.
    pub(crate) fn motion_in_edges(&self) -> f64 {
        let Some(end) = self.motion.on().map(Way::end) else {
            return 0.0;
        };
        let order = self.mesh.order().vertex_order();
        let from = |vertex| self.shape.get(vertex, order);
        let to = |vertex| end.get(vertex, order);
        let way = |p: [S; 3], q: [S; 3]| {
            let along = |axis: usize| (p[axis].to_f64() - q[axis].to_f64()).abs();
            along(0).max(along(1)).max(along(2))
        };
        let all = self.mesh.order().all_corners();
        let some = all.iter().step_by(SAMPLED.max(all.len() / SAMPLES));
        let (mut ways, mut sides) = (0.0, 0.0);
        for &[a, b, _] in some {
            ways += way(from(a), to(a));
            sides += way(from(a), from(b));
        }
        if ways == 0.0 { 0.0 } else { ways / sides }
    }

    // Queries.

    /// Number of triangles in tree order, including triangles that are marked as removed.
    pub(crate) fn triangle_count(&self) -> usize {
        self.mesh.tree_triangles()
    }

    /// Number of parts, each with a tree.
    pub(crate) fn part_count(&self) -> usize {
        self.parts.len()
    }

    /// Trees of all parts.
    pub(crate) fn trees(&self) -> impl Iterator<Item = &Tree> {
        self.parts.trees()
    }

    /// Depth, nodes and leaves of all trees.
    pub(crate) fn tree_shape(&self) -> TreeShape {
        self.parts.shape()
    }

    /// Brings the shape into tree order, which queries need, and with `reach` the motion too.
    /// Returns false if interrupted.
    pub(crate) fn bring_into_tree_order(
        &mut self,
        reach: Option<Reach>,
        instructions: Instructions,
        executor: Executor,
    ) -> bool {
        self.know_labels();
        let (order, threads) = (self.mesh.order(), (instructions, executor));
        self.filter.know_rest(order);
        self.thickness.know(order);
        let (shape, motion) = (&mut self.shape, &mut self.motion);
        shape.bring_into_tree_order(threads, order)
            && reach.is_none_or(|reach| motion.bring_into_tree_order(shape, reach, threads, order))
    }

    /// Finds which triangles of a part share a vertex, unless that is known.
    pub(crate) fn know_neighbours(&mut self, part: usize, executor: Executor) {
        let part = self.parts.one_mut(part);
        part.know_neighbours(self.mesh.order(), executor);
    }

    /// The body as the search for adjacent contacts reads it: stars are found, and the shape is
    /// brought into tree order. None if interrupted.
    pub(crate) fn starred<'q>(
        &'q mut self,
        (instructions, executor): (Instructions, Executor<'q>),
    ) -> Option<StarredBody<'q, S>> {
        if !self.bring_into_tree_order(None, instructions, executor) {
            return None;
        }
        let mesh = &self.mesh;
        let stars = mesh.stars(&|| executor.is_interrupted())?;
        Some(StarredBody {
            body: mesh.body(),
            shape: self.shape.view(mesh.order(), Origin::default()),
            order: mesh.order(),
            removed: mesh.removed(),
            labels: self.filter.known_labels(),
            mesh,
            stars,
            interrupt: executor.interrupt,
        })
    }

    /// Makes the boxes of elements, unless they hold the present shape and motion. Returns false if
    /// interrupted.
    ///
    /// Shape and motion must be in tree order.
    pub(crate) fn make_near_boxes(
        &mut self,
        which: Which,
        reach: Option<Reach>,
        origin: Origin,
        (instructions, executor): (Instructions, Executor),
    ) -> bool {
        let (mesh, order) = (&self.mesh, self.mesh.order());
        let Some(elements) = mesh.elements(&|| executor.is_interrupted()) else {
            return false;
        };
        self.filter.know_groups(order, elements);
        let way = self.motion.on().zip(reach);
        let source = Grown {
            from: self.shape.view(order, origin),
            to: way.map(|(way, reach)| way.held(reach, order, origin)),
            distance: 0.0,
        };
        let mut parts = self.parts.all_mut();
        parts.all(|part| {
            part.make_near_boxes(which, &source, (order, elements), (instructions, executor))
        })
    }

    /// One part of the body, as a query descends it. The shape must be in tree order.
    pub(crate) fn side(&mut self, needs: &Needs, origin: Origin, part: usize) -> Side<'_, S> {
        let (parts, side) = self.parts_and_sides(needs, origin);
        side(parts.one_mut(part))
    }

    /// Two different parts of the body, the one with the lower number first.
    pub(crate) fn two_sides(
        &mut self,
        needs: &Needs,
        origin: Origin,
        numbers: [usize; 2],
    ) -> [Side<'_, S>; 2] {
        let (parts, side) = self.parts_and_sides(needs, origin);
        parts.two_mut(numbers).map(side)
    }

    /// Data and boxes of one part, for the tasks of a query; all that they read was made ready.
    pub(crate) fn read(
        &self,
        needs: &Needs,
        origin: Origin,
        part: usize,
    ) -> Option<(Read<'_, S>, &BoxSet)> {
        let part = self.parts.all().nth(part)?;
        let (tree, boxes, near_boxes) = part.for_reading(needs.box_set)?;
        let (mesh, shape, motion) = (&self.mesh, &self.shape, &self.motion);
        let parts = (mesh, shape, motion, &self.filter, &self.thickness);
        let queried = Queried::of(parts, needs, origin);
        Some((queried.read(tree, near_boxes), boxes))
    }

    /// All parts, and a function that makes the side of one for a query.
    #[inline]
    fn parts_and_sides<'b>(
        &'b mut self,
        needs: &Needs,
        origin: Origin,
    ) -> (&'b mut Parts, impl Fn(&'b mut Part) -> Side<'b, S>) {
        let (mesh, shape, motion) = (&self.mesh, &self.shape, &self.motion);
        let parts = (mesh, shape, motion, &self.filter, &self.thickness);
        let (queried, set) = (Queried::of(parts, needs, origin), needs.box_set);
        (&mut self.parts, move |part: &'b mut Part| {
            let (tree, boxes, near_boxes) = part.for_query(set);
            let read = queried.read(tree, near_boxes);
            Side { read, boxes }
        })
    }

    /// Makes all boxes stale: an interruption may have left some half made.
    pub(crate) fn forget_boxes(&mut self) {
        self.parts.all_mut().for_each(Part::forget_boxes);
    }

    // The trees.

    /// Notes the work that queries did with the body.
    pub(crate) fn note_work(&mut self, work: Work) {
        let first = self.parts.in_first();
        let is_hardly_edited = self.mesh.out_of_date(first) * OF_FEW < first;
        self.rebuild
            .note_work(work, self.shape.version(), is_hardly_edited);
    }

    /// Factor by which the tree does more work than a fresh one would.
    pub(crate) fn tree_quality(&self) -> f64 {
        self.rebuild.quality()
    }

    /// Rebuilds the tree from the present shape. O(n log n).
    pub(crate) fn rebuild(&mut self, options: &Options) {
        let (order, tree) = build(self.mesh.topology(), &self.stored_positions(), options);
        self.exchange_tree(order, tree, &[]);
    }

    /// Continues to mend the tree, or begins to where it pays. Returns whether the tree was
    /// exchanged.
    pub(crate) fn mend(&mut self, options: &Options) -> bool {
        let know_neighbours = self.parts.know_neighbours();
        let (mesh, shape) = (&self.mesh, &self.shape);
        let mended = self.rebuild.advance(mesh, shape, know_neighbours, options);
        let Some((order, mut tree, changed)) = mended else {
            return false;
        };
        tree.has_thin = self.parts.all().any(|part| part.tree().has_thin);
        self.exchange_tree(order, tree, &changed);
        // Triangles that were edited since are marked as removed in the tree, and come behind it.
        if !changed.is_empty() {
            self.mesh.leave_orphans(&changed, &mut self.shape);
            let coming = changed.iter().filter(|(_, [_, now])| *now != EMPTY);
            self.append(coming.map(|&(triangle, _)| triangle).collect(), options);
        }
        true
    }

    /// Exchanges the tree for another, over triangles in another order.
    ///
    /// Triangles that were changed since it was begun are taken out of it.
    fn exchange_tree(&mut self, order: Order, tree: Tree, changed: &[Changed]) {
        self.shape.forget_tree_order(self.mesh.order());
        self.shape.begin_version();
        self.motion.forget_tree_order(self.mesh.order());
        self.filter.forget_tree_order();
        self.thickness.forget_tree_order();
        self.parts = Parts::of(tree, order.all_corners().len());
        self.mesh.exchange_order(order, changed);
        self.rebuild.begin_anew();
    }
}

held!(Body<S>: mesh, shape, motion, parts, rebuild, filter, thickness);
