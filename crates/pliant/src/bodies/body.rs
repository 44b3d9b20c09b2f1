//! One body: its mesh, its tree and boxes, the shape it has now, and what it may meet.

use super::decay::Decay;
use super::edit_state::EditState;
use super::mending_state::Mending;
use super::part::{OfElements, Part};
use super::positions::Positions;
use crate::error::ErrorKind;
use crate::geometry::{Aabb, Bounds, Origin, Points, Real, Shape};
use crate::held::{self, held};
use crate::ids::BodyId;
use crate::ids::{TreeTriangle, TreeVertex};
use crate::kernels::{Coordinate, Instructions};
use crate::mesh::{self, Changed, Elements, Order, Topology};
use crate::options::{Options, Partition};
use crate::queries::{BodyBoxes, Groups, NearElements, Needs, Reach, Removed, Which};
use crate::threads::Executor;
use crate::traversal::Side;
use crate::tree::build::{Balanced, Connectivity, CutAt, InitialShape, Plan, plan};
use crate::tree::{Source, Tree};
use pliant_exact::denormals_are_kept;
use std::borrow::Cow;
use std::iter;
use std::sync::OnceLock;

/// A body with its tree, of degree `N`.
pub(crate) struct Body<S> {
    pub(crate) id: BodyId,
    pub(crate) topology: Topology,
    pub(crate) order: Order,
    /// The first is over the triangles that were there when it was built, the others over those that came since.
    pub(crate) parts: Parts,
    pub(crate) positions: Positions<S>,
    /// Of the vertices that triangles use.
    pub(crate) bounds: Bounds<S>,
    /// Counts changes of shape, and of the origin that boxes are relative to. Boxes of other epochs are stale.
    pub(crate) epoch: u64,
    /// Counts meshes.
    pub(crate) meshes: u64,
    /// Counts meshes, and orders of a mesh.
    pub(crate) revision: u64,
    /// How much more the tree does than a fresh one would.
    pub(crate) decay: Decay,
    /// A tree that is to take its place.
    pub(crate) mending: Option<Box<Mending>>,
    membership: u32,
    mask: u32,
    pub(crate) loose: Option<Bounds<S>>,
    /// None before the first.
    pub(crate) motion: Option<Box<Motion<S>>>,
    /// The last number of motions that were forgotten: boxes of one of them are not those of another.
    motions: u64,
    /// Edges, and who owns what, once somebody asks.
    pub(crate) elements: OnceLock<Box<Elements>>,
    /// Whether somebody asked before the tree was exchanged, or another body was made like this one.
    edges_were_known: bool,
    /// None where all vertices meet.
    pub(crate) groups: Option<Box<VertexGroups>>,
    /// Once the mesh is edited.
    pub(crate) edits: Option<Box<EditState<S>>>,
}

/// The parts of a body: the first, which there always is, and the others.
pub(crate) struct Parts {
    pub(crate) first: Part,
    pub(crate) others: Vec<Part>,
}

impl Parts {
    pub(crate) fn len(&self) -> usize {
        1 + self.others.len()
    }

    pub(crate) fn all(&self) -> impl Iterator<Item = &Part> {
        iter::once(&self.first).chain(&self.others)
    }

    pub(crate) fn all_mut(&mut self) -> impl Iterator<Item = &mut Part> {
        iter::once(&mut self.first).chain(&mut self.others)
    }

    fn one_mut(&mut self, number: usize) -> &mut Part {
        match number.checked_sub(1) {
            None => &mut self.first,
            Some(number) => &mut self.others[number],
        }
    }

    /// Two of them, the lower number first.
    fn two_mut(&mut self, [low, high]: [usize; 2]) -> [&mut Part; 2] {
        let (before, rest) = self.others.split_at_mut(high - 1);
        let low = match low.checked_sub(1) {
            None => &mut self.first,
            Some(low) => &mut before[low],
        };
        [low, &mut rest[0]]
    }
}

/// Of so many triangles one is looked at to know how far vertices move.
const SAMPLED: usize = 16;

/// Where the vertices are going.
pub(crate) struct Motion<S> {
    /// The shape at the end, if there is a motion; if not, memory for the next.
    end: Positions<S>,
    /// Of the vertices that triangles use.
    bounds: Bounds<S>,
    /// Counts motions, and shapes on the way; from where those that were forgotten ended.
    epochs: u64,
    /// The number of this one.
    epoch: u64,
    is_on: bool,
    /// The shape on the way that was asked for last.
    partway: Option<Partway<S>>,
}

/// The shape in which what is looked at ends before the motion does.
struct Partway<S> {
    /// In tree order.
    points: Points<S>,
    /// Of which shape and which motion, and how far.
    of: (u64, u64, Reach),
    /// Its own number among motions.
    epoch: u64,
}

/// Groups of the caller's vertices, and of all elements in tree order once these are known.
pub(crate) struct VertexGroups {
    pub(crate) callers: Vec<u32>,
    pub(crate) of_elements: Option<Groups>,
}

/// Refuses what no body can be made of.
pub(crate) fn validate<S: Real>(
    triangles: &[[u32; 3]],
    positions: &[[S; 3]],
) -> Result<(), ErrorKind> {
    mesh::validate(triangles, positions.len())?;
    match positions
        .iter()
        .position(|&position| !is_in_range(position))
    {
        Some(vertex) => Err(ErrorKind::BadPosition {
            vertex,
            position: positions[vertex].map(S::to_f64),
        }),
        None => none_is_lost(positions),
    }
}

/// Refuses coordinates so small that this thread, where subnormal numbers are flushed, would lose them. Costs two products
/// where they are not.
pub(crate) fn none_is_lost<S: Real>(positions: &[[S; 3]]) -> Result<(), ErrorKind> {
    if denormals_are_kept() {
        return Ok(());
    }
    let is_lost = |position: &[S; 3]| position.iter().any(|x| x.needs_subnormals());
    match positions.iter().position(is_lost) {
        Some(vertex) => Err(ErrorKind::NeedsSubnormals { vertex }),
        None => Ok(()),
    }
}

#[inline]
pub(crate) fn is_in_range<S: Real>([x, y, z]: [S; 3]) -> bool {
    // No early exit: three comparisons without a branch.
    x.is_in_range() & y.is_in_range() & z.is_in_range()
}

/// Where the corners of a body's elements are, as the caller numbers all of it.
pub(crate) struct Places<'b, S> {
    pub(crate) triangles: &'b [[u32; 3]],
    pub(crate) edges: &'b [[u32; 2]],
    /// For each vertex its number in tree order, in which positions are.
    pub(crate) tree_vertices: &'b [TreeVertex],
    pub(crate) positions: &'b Points<S>,
}

impl<'b, S> Places<'b, S> {
    /// Where a vertex is, with padding.
    #[inline(always)]
    pub(crate) fn corner(&self, vertex: u32) -> &'b [S; 4] {
        self.positions.padded(self.tree_vertices[vertex as usize])
    }
}

/// Fewer triangles than one of so many are few: a tree in which these were edited does about what a fresh one would.
const OF_FEW: usize = 256;

impl<S: Coordinate> Body<S> {
    /// A body of validated parts; positions in the caller's order.
    pub(crate) fn new(
        id: BodyId,
        triangles: &[[u32; 3]],
        positions: &[[S; 3]],
        options: &Options,
    ) -> Self {
        let topology = Topology::new(triangles, positions.len());
        let (order, tree) = build(&topology, positions, options);
        let parts = Parts::of(tree, triangles.len());
        let used = order.vertex_order()[..order.used_vertices()].iter();
        let bounds = bounds_of(used.map(|&vertex| positions[vertex as usize]));
        Self {
            id,
            topology,
            order,
            parts,
            positions: Positions::new(positions),
            bounds,
            epoch: 1,
            meshes: 0,
            revision: 0,
            decay: Decay::default(),
            mending: None,
            membership: u32::MAX,
            mask: u32::MAX,
            loose: None,
            motion: None,
            motions: 0,
            elements: OnceLock::new(),
            edges_were_known: false,
            groups: None,
            edits: None,
        }
    }

    /// A body like this one, whose boxes are made anew.
    pub(crate) fn copy(&self) -> Self {
        Self {
            id: self.id,
            topology: self.topology.clone(),
            order: self.order.clone(),
            parts: Parts {
                first: self.parts.first.copy(),
                others: self.parts.others.iter().map(Part::copy).collect(),
            },
            positions: Positions::new(&self.stored_positions()),
            bounds: self.bounds,
            epoch: self.epoch,
            meshes: self.meshes,
            revision: self.revision,
            decay: self.decay,
            mending: None,
            membership: self.membership,
            mask: self.mask,
            loose: self.loose,
            motion: self.motion().map(|motion| {
                let end = motion.end.in_callers_order(&self.order);
                Box::new(Motion {
                    end: Positions::new(&end),
                    partway: None,
                    ..*motion
                })
            }),
            motions: self.motions,
            elements: self.edited_elements(),
            edges_were_known: self.edges_are_known(),
            groups: self.groups.as_ref().map(|groups| {
                Box::new(VertexGroups {
                    callers: groups.callers.clone(),
                    of_elements: None,
                })
            }),
            edits: self.edits.clone(),
        }
    }

    /// Builds the tree anew, on the shape of now.
    pub(crate) fn rebuild(&mut self, options: &Options) {
        let (order, tree) = build(&self.topology, &self.stored_positions(), options);
        self.exchange_tree(order, tree, &[]);
    }

    /// Has another tree from now on, over all triangles in another order, but for some that were changed since these had their order.
    pub(crate) fn exchange_tree(&mut self, order: Order, tree: Tree, changed: &[Changed]) {
        self.positions.forget_tree_order(&self.order);
        if let Some(motion) = &mut self.motion {
            motion.end.forget_tree_order(&self.order);
            motion.partway = None;
        }
        if let Some(groups) = &mut self.groups {
            groups.of_elements = None;
        }
        self.parts = Parts::of(tree, order.all_corners().len());
        self.order = order;
        if let Some(edits) = &mut self.edits {
            edits.find_places(&self.order);
            for &(triangle, _) in changed {
                edits.take_out(triangle);
            }
        }
        self.edges_were_known = self.edges_are_known();
        match (self.elements.get_mut(), &self.edits) {
            (Some(elements), Some(edits)) if elements.follows() => {
                elements.append(&self.order, &edits.gone, TreeTriangle(0), 0);
            }
            _ => drop(self.elements.take()),
        }
        self.epoch += 1;
        self.revision += 1;
        self.decay.begin_anew();
        self.mending = None;
    }

    /// The edges as they are numbered, if the mesh was edited since they were: these numbers stay.
    fn edited_elements(&self) -> OnceLock<Box<Elements>> {
        let known = self.elements.get().filter(|known| known.follows());
        known.map_or_else(OnceLock::new, |known| OnceLock::from(known.clone()))
    }

    /// All vertices, in the order in which triangles in tree order first use them.
    pub(crate) fn vertex_order(&self) -> &[u32] {
        match &self.edits {
            Some(edits) if self.order.orphans().count() > 0 => edits.vertex_order(&self.order),
            _ => self.order.vertex_order(),
        }
    }

    /// How many numbers of triangles there are, empty ones too.
    pub(crate) fn triangle_numbers(&self) -> usize {
        self.topology.triangles().len()
    }

    /// How many triangles there are in tree order, with those that were taken out and are still there.
    pub(crate) fn triangle_count(&self) -> usize {
        self.order.all_corners().len()
    }

    pub(crate) fn vertex_count(&self) -> usize {
        self.positions.len()
    }

    /// Brings the shape into tree order, which everything that looks at it needs, and what is looked at of a motion, if it is. Returns
    /// false if it was interrupted.
    pub(crate) fn bring_into_tree_order(
        &mut self,
        reach: Option<Reach>,
        instructions: Instructions,
        executor: Executor,
    ) -> bool {
        let order = self.order.vertex_order();
        let is_in_order = self
            .positions
            .bring_into_tree_order(instructions, executor, order);
        let motion = self.motion.as_mut();
        let (Some(motion), Some(reach)) = (motion.filter(|motion| motion.is_on), reach) else {
            return is_in_order;
        };
        let end = &mut motion.end;
        if !is_in_order || !end.bring_into_tree_order(instructions, executor, order) {
            return false;
        }
        motion.make_partway(self.positions.in_tree_order(), self.epoch, reach);
        true
    }

    /// Whether few triangles or none were edited since the tree was built.
    pub(crate) fn is_hardly_edited(&self) -> bool {
        let first = self.parts.first.triangles.len();
        let behind = self.order.all_corners().len() - first;
        let gone = self.edits.as_ref().map_or(0, |edits| edits.gone.count());
        (behind + gone) * OF_FEW < first
    }

    /// Finds out which triangles of a part share a vertex, unless that is known.
    pub(crate) fn know_neighbours(&mut self, part: usize, executor: Executor) {
        let part = self.parts.one_mut(part);
        part.know_neighbours(&self.order, executor);
    }

    /// The motion, if there is one.
    fn motion(&self) -> Option<&Motion<S>> {
        self.motion.as_deref().filter(|motion| motion.is_on)
    }

    pub(crate) fn is_moving(&self) -> bool {
        self.motion().is_some()
    }

    /// Makes the boxes of elements, unless they are those of the shape and the motion of now. Returns false if it was interrupted. The body
    /// was brought into tree order, with its motion.
    pub(crate) fn make_near_boxes(
        &mut self,
        which: Which,
        reach: Option<Reach>,
        origin: Origin,
        (instructions, executor): (Instructions, Executor),
    ) -> bool {
        if !self.know_elements(&|| executor.is_interrupted()) {
            return false;
        }
        let Some(elements) = self.elements.get() else {
            return false;
        };
        let motion = self.motion.as_deref().filter(|motion| motion.is_on);
        let of = OfElements {
            elements,
            shape: Shape {
                positions: self.positions.in_tree_order(),
                triangles: self.order.all_corners(),
                origin,
                epoch: self.epoch,
            },
            end: motion.zip(reach).map(|(motion, reach)| motion.held(reach)),
        };
        let mut parts = self.parts.all_mut();
        parts.all(|part| part.make_near_boxes(which, &of, (instructions, executor)))
    }

    /// Finds out the edges of the mesh, and which triangle owns what, unless that is known. Returns false if it was stopped.
    fn know_elements(&mut self, stop: &dyn Fn() -> bool) -> bool {
        let Self {
            topology,
            order,
            elements,
            groups,
            ..
        } = self;
        if elements.get().is_none() {
            let Some(new) = Elements::new(topology, order, stop) else {
                return false;
            };
            *elements = OnceLock::from(Box::new(new));
        }
        if let (Some(elements), Some(groups)) = (elements.get(), groups)
            && groups.of_elements.is_none()
        {
            groups.of_elements = Some(Groups::new(&groups.callers, order, elements));
        }
        true
    }

    /// The elements of the mesh; they are found out the first time.
    fn known_elements(&self) -> Option<&Elements> {
        let known = self.elements.get();
        known.map(Box::as_ref).or_else(|| {
            let new = Elements::new(&self.topology, &self.order, &|| false)?;
            Some(self.elements.get_or_init(|| Box::new(new)))
        })
    }

    /// Whether the edges have numbers that stay: from when somebody asks for them on.
    fn edges_are_known(&self) -> bool {
        self.edges_were_known || self.elements.get().is_some()
    }

    /// Of a mesh that is going to be edited: finds out the edges if they have numbers that stay.
    pub(crate) fn remember_edges(&self) {
        if self.edges_were_known {
            self.known_elements();
        }
    }

    /// The edges, if they have numbers that stay.
    pub(crate) fn numbered_edges(&self) -> Option<&[[u32; 2]]> {
        self.edges_are_known().then(|| self.edges())
    }

    /// Numbers the edges as those of another body with this mesh are. Returns false if they are not its edges, or have numbers already.
    pub(crate) fn number_edges(&mut self, edges: &[[u32; 2]]) -> bool {
        let is_new = !self.edges_are_known() && self.known_elements().is_some();
        let (elements, topology) = (self.elements.get_mut(), &self.topology);
        is_new && elements.is_some_and(|elements| elements.renumber(edges, topology))
    }

    /// The edges, as the caller numbers them.
    pub(crate) fn edges(&self) -> &[[u32; 2]] {
        self.known_elements().map_or(&[], Elements::callers)
    }

    /// Where the corners of elements are, as the caller numbers them; of a body that was brought into tree order.
    pub(crate) fn places(&self) -> Option<Places<'_, S>> {
        let elements = self.known_elements()?;
        Some(Places {
            triangles: self.topology.triangles(),
            edges: elements.callers(),
            tree_vertices: match &self.edits {
                Some(edits) => &edits.slots,
                None => elements.tree_vertices(&self.order),
            },
            positions: self.positions.in_tree_order(),
        })
    }

    /// By how many lengths of an edge vertices move, on the mean of some of both; 0 if there is no motion.
    pub(crate) fn motion_in_edges(&self) -> f64 {
        let Some(motion) = self.motion() else {
            return 0.0;
        };
        let order = self.order.vertex_order();
        let from = |vertex| self.positions.get(vertex, order);
        let to = |vertex| motion.end.get(vertex, order);
        let way = |p: [S; 3], q: [S; 3]| {
            let along = |axis: usize| (p[axis].to_f64() - q[axis].to_f64()).abs();
            along(0).max(along(1)).max(along(2))
        };
        let some = self.order.all_corners().iter().step_by(SAMPLED);
        let (mut ways, mut sides) = (0.0, 0.0);
        for &[a, b, _] in some {
            ways += way(from(a), to(a));
            sides += way(from(a), from(b));
        }
        if ways == 0.0 { 0.0 } else { ways / sides }
    }

    /// Gives every vertex a group; those of one group do not meet, unless it is 0.
    pub(crate) fn set_groups(&mut self, groups: &[u32]) -> Result<(), ErrorKind> {
        if groups.len() != self.vertex_count() {
            return Err(ErrorKind::WrongLength {
                what: "groups",
                expected: self.vertex_count(),
                found: groups.len(),
            });
        }
        let is_any = groups.iter().any(|&group| group != 0);
        self.groups = is_any.then(|| {
            Box::new(VertexGroups {
                callers: groups.to_vec(),
                of_elements: None,
            })
        });
        Ok(())
    }

    /// The group of every vertex.
    pub(crate) fn groups(&self) -> Vec<u32> {
        match &self.groups {
            None => vec![0; self.vertex_count()],
            Some(groups) => groups.callers.clone(),
        }
    }

    /// The shape in tree order, whether it was brought into it or not.
    pub(crate) fn in_tree_order(&self) -> Points<S> {
        let order = self.order.vertex_order();
        let vertices = (0..order.len() as u32).map(TreeVertex);
        Points::of(vertices.map(|vertex| self.positions.get(vertex, order)))
    }

    /// The shape at the end of a motion in tree order, and its epoch, if there is a motion.
    pub(crate) fn end_in_tree_order(&self) -> Option<(Points<S>, u64)> {
        let motion = self.motion()?;
        let order = self.order.vertex_order();
        let vertices = (0..order.len() as u32).map(TreeVertex);
        let points = Points::of(vertices.map(|vertex| motion.end.get(vertex, order)));
        Some((points, motion.epoch))
    }

    /// The shape, of which `positions` are in tree order.
    pub(crate) fn shape<'s>(&'s self, positions: &'s Points<S>, origin: Origin) -> Shape<'s, S> {
        Shape {
            positions,
            triangles: self.order.all_corners(),
            origin,
            epoch: self.epoch,
        }
    }

    /// What a query of some kind descends: one part of a body that was brought into tree order.
    pub(crate) fn side(&mut self, needs: &Needs, origin: Origin, part: usize) -> Side<'_, S> {
        let (parts, rest) = self.parts_and_rest();
        rest.side(needs, origin, parts.one_mut(part))
    }

    /// Two different parts of it, the one with the lower number first.
    pub(crate) fn two_sides(
        &mut self,
        needs: &Needs,
        origin: Origin,
        numbers: [usize; 2],
    ) -> [Side<'_, S>; 2] {
        let (parts, rest) = self.parts_and_rest();
        parts
            .two_mut(numbers)
            .map(|part| rest.side(needs, origin, part))
    }

    /// The parts, and what they have in common.
    fn parts_and_rest(&mut self) -> (&mut Parts, InCommon<'_, S>) {
        let rest = InCommon {
            body: self.id,
            order: &self.order,
            positions: &self.positions,
            epoch: self.epoch,
            motion: self.motion.as_deref().filter(|motion| motion.is_on),
            elements: self.elements.get().map(Box::as_ref),
            groups: self.groups.as_ref().and_then(|it| it.of_elements.as_ref()),
            removed: self
                .edits
                .as_ref()
                .and_then(|edits| edits.removed(&self.order)),
        };
        (&mut self.parts, rest)
    }

    /// All boxes are stale: some may have been left half made.
    pub(crate) fn forget_boxes(&mut self) {
        self.parts.all_mut().for_each(Part::forget_boxes);
    }

    /// Boxes made so far are stale, though the shape is the same: the origin moved.
    pub(crate) fn origin_moved(&mut self) {
        self.epoch += 1;
    }

    /// The corners of a triangle, whether the shape was brought into tree order or not; exact.
    #[inline]
    pub(crate) fn corners_now(&self, triangle: TreeTriangle) -> [[f64; 3]; 3] {
        let order = self.order.vertex_order();
        // Loops, which are compiled into their callers where closures may not be.
        let mut corners = [[0.0; 3]; 3];
        for (corner, vertex) in corners.iter_mut().zip(self.order.corners(triangle)) {
            let [x, y, z] = self.positions.get(vertex, order);
            *corner = [x.to_f64(), y.to_f64(), z.to_f64()];
        }
        corners
    }

    /// The corners of a triangle, with padding; of a body that was brought into tree order.
    pub(crate) fn padded_corners(&self, triangle: TreeTriangle) -> [&[S; 4]; 3] {
        let positions = self.positions.in_tree_order();
        let corners = self.order.corners(triangle);
        corners.map(|vertex| positions.padded(vertex))
    }

    /// The exact extent, in the caller's coordinates.
    pub(crate) fn bounds(&self) -> Bounds<S> {
        self.bounds
    }

    /// The box of the body, as a kind of query needs it.
    #[inline]
    pub(crate) fn box_for(&self, boxes: BodyBoxes, origin: Origin) -> Aabb {
        let motion = self.motion().filter(|_| boxes.hold_motions);
        let bounds = motion.map_or(self.bounds, |motion| self.bounds.union(&motion.bounds));
        boxes.of(bounds.to_box(origin))
    }

    /// The loose box, if there is one.
    pub(crate) fn loose_box(&self, origin: Origin) -> Option<Aabb> {
        self.loose.map(|loose| loose.to_box(origin))
    }

    /// Validates a new shape and takes it over; or leaves the body as it is and says what was wrong. A motion ends.
    pub(crate) fn set_positions(
        &mut self,
        instructions: Instructions,
        executor: Executor,
        positions: &[[S; 3]],
    ) -> Result<(), ErrorKind> {
        let taking = Taking::new(
            (instructions, executor),
            &self.order,
            self.loose,
            self.edits.as_deref(),
        );
        let positions = with_empty_ones(&mut self.edits, &self.order, positions);
        self.bounds = taking.take(&mut self.positions, positions)?;
        self.epoch += 1;
        self.end_motion();
        Ok(())
    }

    fn end_motion(&mut self) {
        if let Some(motion) = &mut self.motion {
            motion.is_on = false;
        }
    }

    /// Validates a shape that the body is going to have, and begins a motion to it, in place of any other.
    pub(crate) fn set_motion(
        &mut self,
        instructions: Instructions,
        executor: Executor,
        end: &[[S; 3]],
    ) -> Result<(), ErrorKind> {
        let taking = Taking::new(
            (instructions, executor),
            &self.order,
            self.loose,
            self.edits.as_deref(),
        );
        let stored = (self.motion.is_none()).then(|| self.stored_positions().into_owned());
        let end = with_empty_ones(&mut self.edits, &self.order, end);
        if let Some(motion) = &mut self.motion {
            motion.bounds = taking.take(&mut motion.end, end)?;
            motion.epochs += 1;
            motion.epoch = motion.epochs;
            motion.is_on = true;
            return Ok(());
        }
        // What is there before is of no interest; it has the right length.
        let mut place = Positions::new(&stored.unwrap_or_default());
        let bounds = taking.take(&mut place, end)?;
        self.motion = Some(Box::new(Motion {
            end: place,
            bounds,
            epochs: self.motions + 1,
            epoch: self.motions + 1,
            is_on: true,
            partway: None,
        }));
        Ok(())
    }

    /// Ends a motion whose vertices are not those of the body any more.
    pub(crate) fn forget_motion(&mut self) {
        if let Some(motion) = self.motion.take() {
            self.motions = motion.epochs;
        }
    }

    /// The end of a motion is the shape of now.
    pub(crate) fn finish_motion(&mut self) {
        if let Some(motion) = self.motion.as_mut().filter(|motion| motion.is_on) {
            std::mem::swap(&mut self.positions, &mut motion.end);
            self.bounds = motion.bounds;
            self.epoch += 1;
            motion.is_on = false;
        }
    }

    /// Of the way of a motion the part `t`, from 0 to 1, is gone: the shape is there, and the motion has ended. It is made in a list that
    /// is kept from call to call.
    pub(crate) fn advance_motion(
        &mut self,
        instructions: Instructions,
        executor: Executor,
        t: f64,
        shape: &mut Vec<[S; 3]>,
    ) -> Result<(), ErrorKind> {
        let Some(motion) = self.motion() else {
            return Ok(());
        };
        if t == 1.0 {
            self.finish_motion();
            return Ok(());
        }
        let order = self.order.vertex_order();
        shape.resize(self.vertex_count(), [S::default(); 3]);
        let orphans = self.order.orphans();
        for (vertex, &place) in (0..).zip(order) {
            if orphans.has(vertex) {
                continue;
            }
            let of = |positions: &Positions<S>| positions.get(TreeVertex(vertex), order);
            let [from, to] = [of(&self.positions), of(&motion.end)];
            shape[place as usize] = std::array::from_fn(|axis| from[axis].toward(to[axis], t));
        }
        self.set_positions(instructions, executor, shape)
    }

    /// The shape at the end of a motion as the caller orders vertices, if there is a motion.
    pub(crate) fn end_positions(&self) -> Option<Cow<'_, [[S; 3]]>> {
        let motion = self.motion()?;
        Some(self.without_empty_ones(motion.end.in_callers_order(&self.order)))
    }

    /// The shape as the caller orders vertices; those that are empty are nowhere.
    pub(crate) fn positions(&self) -> Cow<'_, [[S; 3]]> {
        self.without_empty_ones(self.stored_positions())
    }

    /// The shape as the caller orders vertices; those that are empty are somewhere.
    pub(crate) fn stored_positions(&self) -> Cow<'_, [[S; 3]]> {
        self.positions.in_callers_order(&self.order)
    }

    fn without_empty_ones<'p>(&self, mut positions: Cow<'p, [[S; 3]]>) -> Cow<'p, [[S; 3]]> {
        if let Some(edits) = &self.edits
            && edits.empty.count() > 0
        {
            for (vertex, position) in (0..).zip(positions.to_mut()) {
                if edits.empty.has(vertex) {
                    *position = [S::NAN; 3];
                }
            }
        }
        positions
    }

    pub(crate) fn set_filter(&mut self, membership: u32, mask: u32) {
        (self.membership, self.mask) = (membership, mask);
    }

    /// Membership and mask.
    pub(crate) fn filter(&self) -> (u32, u32) {
        (self.membership, self.mask)
    }

    /// The box that holds it in every pose, if it has one.
    pub(crate) fn loose(&self) -> Option<Bounds<S>> {
        self.loose
    }

    /// Whether the masks of two bodies, or of one and itself, let them meet.
    pub(crate) fn may_meet(&self, other: &Self) -> bool {
        self.membership & other.mask != 0 && other.membership & self.mask != 0
    }

    pub(crate) fn set_loose_box(&mut self, loose: Option<Bounds<S>>) -> Result<(), ErrorKind> {
        if let Some(loose) = loose {
            let is_box = is_in_range(loose.lo)
                && is_in_range(loose.hi)
                && loose.holds(loose.lo)
                && loose.holds(loose.hi);
            if !is_box {
                return Err(ErrorKind::BadLooseBox);
            }
            // Of vertices that are empty it does not matter where they were.
            let edits = self.edits.as_deref();
            let is_empty = |vertex| edits.is_some_and(|edits| edits.empty.has(vertex));
            all_inside(&loose, &self.stored_positions(), is_empty)?;
            if let Some(motion) = self.motion() {
                let end = motion.end.in_callers_order(&self.order);
                all_inside(&loose, &end, is_empty)?;
            }
        }
        self.loose = loose;
        Ok(())
    }
}

impl<S: Coordinate> Motion<S> {
    /// Makes the shape in which what is looked at ends before the motion does, unless it is there; both ends are in tree order.
    fn make_partway(&mut self, from: &Points<S>, epoch: u64, reach: Reach) {
        let (t, is_rounded) = match reach {
            Reach::End => return,
            Reach::Until(t) => (t, false),
            Reach::To(t) => (t, true),
        };
        let at = |from: S, to: S| {
            if is_rounded {
                from.toward(to, t)
            } else {
                from.past(to, t)
            }
        };
        let of = (epoch, self.epoch, reach);
        if self
            .partway
            .as_ref()
            .is_some_and(|partway| partway.of == of)
        {
            return;
        }
        self.epochs += 1;
        let mut points = match self.partway.take() {
            Some(partway) => partway.points,
            None => Points::with_len(0),
        };
        let ways = from.points.iter().zip(&self.end.in_tree_order().points);
        points.refill(ways.map(|(from, to)| std::array::from_fn(|axis| at(from[axis], to[axis]))));
        self.partway = Some(Partway {
            points,
            of,
            epoch: self.epochs,
        });
    }

    /// The other shape that boxes hold, and its number.
    fn held(&self, reach: Reach) -> (&Points<S>, u64) {
        match (&self.partway, reach) {
            (Some(partway), Reach::Until(_) | Reach::To(_)) => (&partway.points, partway.epoch),
            _ => (self.end.in_tree_order(), self.epoch),
        }
    }
}

/// How a new shape of a body is taken over.
struct Taking<'b, S> {
    instructions: Instructions,
    executor: Executor<'b>,
    order: &'b Order,
    loose: Option<Bounds<S>>,
    /// How many vertices are empty; their rows are those of others.
    empty: usize,
}

/// The shape that was given, with other vertices' rows in place of those of empty ones.
fn with_empty_ones<'p, S: Coordinate>(
    edits: &'p mut Option<Box<EditState<S>>>,
    order: &Order,
    positions: &'p [[S; 3]],
) -> &'p [[S; 3]] {
    match edits {
        Some(edits) => edits.patch(positions, order),
        None => positions,
    }
}

impl<'b, S: Coordinate> Taking<'b, S> {
    fn new(
        (instructions, executor): (Instructions, Executor<'b>),
        order: &'b Order,
        loose: Option<Bounds<S>>,
        edits: Option<&EditState<S>>,
    ) -> Self {
        Self {
            instructions,
            executor,
            order,
            loose,
            empty: edits.map_or(0, |edits| edits.empty.count()),
        }
    }

    /// Validates positions and puts them into a place for as many; or leaves it as it is and says what was wrong. Returns the bounds of
    /// those vertices that triangles use.
    fn take(&self, place: &mut Positions<S>, positions: &[[S; 3]]) -> Result<Bounds<S>, ErrorKind> {
        if positions.len() != place.len() {
            return Err(ErrorKind::WrongLength {
                what: "positions",
                expected: place.len(),
                found: positions.len(),
            });
        }
        let Some(staged) = place.stage(self.instructions, self.executor, positions) else {
            // Which vertex it was is found out only if there was one.
            return Err(first_outside(
                positions,
                |&position| is_in_range(position),
                |vertex, position| ErrorKind::BadPosition { vertex, position },
            ));
        };
        let all = staged.bounds;
        if let Some(loose) = self
            .loose
            .filter(|loose| !(loose.holds(all.lo) && loose.holds(all.hi)))
        {
            all_inside(&loose, positions, |_| false)?;
        }
        none_is_lost(positions)?;
        let order = self.order.vertex_order();
        place.commit(&staged, self.instructions, self.executor, positions, order);
        let used = self.order.used_vertices();
        let orphans = self.order.orphans().count();
        if used - orphans + self.empty >= positions.len() {
            return Ok(all);
        }
        let used = order[..used].iter();
        Ok(bounds_of(used.map(|&vertex| positions[vertex as usize])))
    }
}

impl Parts {
    /// Of a tree over all of so many triangles.
    fn of(tree: Tree, triangles: usize) -> Self {
        Self {
            first: Part::new(tree, 0..triangles as u32, TreeVertex(0)),
            others: Vec::new(),
        }
    }
}

/// What the parts of a body have in common.
#[derive(Clone, Copy)]
struct InCommon<'b, S> {
    body: BodyId,
    order: &'b Order,
    positions: &'b Positions<S>,
    epoch: u64,
    motion: Option<&'b Motion<S>>,
    elements: Option<&'b Elements>,
    groups: Option<&'b Groups>,
    removed: Option<Removed<'b>>,
}

impl<'b, S: Coordinate> InCommon<'b, S> {
    fn side(self, needs: &Needs, origin: Origin, part: &'b mut Part) -> Side<'b, S> {
        let shape = Shape {
            positions: self.positions.in_tree_order(),
            triangles: self.order.all_corners(),
            origin,
            epoch: self.epoch,
        };
        let motion = self.motion.zip(needs.reach);
        let end = motion.map(|(motion, reach)| {
            let (positions, epoch) = motion.held(reach);
            Shape {
                positions,
                epoch,
                ..shape
            }
        });
        let going = motion.map(|(motion, reach)| match reach {
            Reach::End | Reach::Until(_) => motion.end.in_tree_order(),
            Reach::To(_) => motion.held(reach).0,
        });
        let (tree, boxes, near_boxes) = part.for_query(needs.box_set);
        let elements = self.elements.zip(near_boxes);
        let elements = elements.filter(|_| !needs.triangles());
        let elements = elements.map(|(edges, boxes)| NearElements {
            edges,
            boxes,
            groups: self.groups,
            removed: self.removed,
        });
        Side {
            body: self.body,
            order: self.order,
            tree,
            boxes,
            source: Source::new(shape, end, needs.grows_by),
            motion: going,
            elements,
            removed: self.removed,
        }
    }
}

/// The tree that the options ask for, and the order it brings the mesh into.
fn build<S: Coordinate>(
    topology: &Topology,
    positions: &[[S; 3]],
    options: &Options,
) -> (Order, Tree) {
    let all = topology.triangles();
    let mut plan = if topology.live_count() == all.len() {
        divide(all, positions, options)
    } else {
        let numbers = (0..all.len() as u32).filter(|&triangle| topology.is_live(triangle));
        let numbers: Vec<u32> = numbers.collect();
        let corners: Vec<_> = numbers
            .iter()
            .map(|&triangle| all[triangle as usize])
            .collect();
        let plan = divide(&corners, positions, options);
        plan.with_numbers(&numbers)
    };
    let order = Order::new(topology, std::mem::take(&mut plan.order));
    let tree = Tree::new(&plan, &order, TreeVertex(0));
    (order, tree)
}

/// The plan that the options ask for.
pub(crate) fn divide<S: Real>(
    triangles: &[[u32; 3]],
    positions: &[[S; 3]],
    options: &Options,
) -> Plan {
    let degree = options.degree.get();
    let leaf_size = options.leaf_size.get();
    let count = triangles.len();
    let by_shape = |cut| {
        let rule = InitialShape::new(triangles.into(), positions.into(), cut, degree);
        plan(count, degree, leaf_size, rule)
    };
    match options.partition {
        Partition::Centre => by_shape(CutAt::Centre),
        Partition::Mean => by_shape(CutAt::Mean),
        Partition::Balanced => {
            let rule = Balanced::new(triangles, positions, degree, leaf_size);
            plan(count, degree, leaf_size, rule)
        }
        Partition::Connectivity => {
            let rule = Connectivity::new(triangles, degree, leaf_size);
            plan(count, degree, leaf_size, rule)
        }
    }
}

fn bounds_of<S: Real>(positions: impl Iterator<Item = [S; 3]>) -> Bounds<S> {
    let mut bounds = Bounds::EMPTY;
    positions.for_each(|position| bounds.include(position));
    bounds
}

/// Refuses positions of which some are outside a loose box, but for vertices that are empty.
pub(crate) fn all_inside<S: Real>(
    loose: &Bounds<S>,
    positions: &[[S; 3]],
    is_empty: impl Fn(u32) -> bool,
) -> Result<(), ErrorKind> {
    let mut all = (0..).zip(positions);
    let outside = all.find(|&(vertex, &position)| !loose.holds(position) && !is_empty(vertex));
    outside.map_or(Ok(()), |(vertex, position)| {
        Err(ErrorKind::OutsideLooseBox {
            vertex: vertex as usize,
            position: position.map(S::to_f64),
        })
    })
}

/// The error for the first position that is not good; there is one.
fn first_outside<S: Real>(
    positions: &[[S; 3]],
    is_good: impl Fn(&[S; 3]) -> bool,
    error: impl Fn(usize, [f64; 3]) -> ErrorKind,
) -> ErrorKind {
    let vertex = positions
        .iter()
        .position(|position| !is_good(position))
        .unwrap_or_default();
    error(vertex, positions[vertex].map(S::to_f64))
}

held!(Parts: first, others);
held!(Partway<S>: points);
held!(Motion<S>: end, partway);
held!(VertexGroups: callers[], of_elements);
held!(Body<S>: topology, order, parts, positions; |body| {
    held::boxes(&body.motion)
        + held::boxes(body.elements.get())
        + held::boxes(&body.edits)
        + held::boxes(&body.mending)
        + held::boxes(&body.groups)
});
