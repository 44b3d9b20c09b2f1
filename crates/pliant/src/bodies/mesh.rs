//! The mesh of a body, in the caller's numbers and in tree order.
//!
//! Once it is edited an `edit_state` says where triangles and vertices are in tree order. What else hangs
//! on the mesh are its `elements`.

use super::edit_state::EditState;
use super::elements::BodyElements;
use super::positions::NewShape;
use super::shape::BodyShape;
use crate::edit::{Edit, Edited};
use crate::error::ErrorKind;
use crate::geometry::Points;
use crate::held::{self, held};
use crate::ids::{BodyId, CallerVertex, TreeTriangle, TreeVertex};
use crate::kernels::Coordinate;
use crate::mesh::{Changed, EMPTY, Elements, Order, Outcome, Topology};
use crate::queries::{Groups, Removed};
use std::borrow::Cow;
use std::ops::Range;

/// The mesh of a body.
pub(crate) struct BodyMesh<S> {
    topology: Topology,
    order: Order,
    elements: BodyElements,
    /// Once it is edited.
    edits: Option<Box<EditState<S>>>,
    /// Counts meshes.
    version: u64,
    /// Counts meshes, and orders of a mesh.
    order_version: u64,
}

/// Where the corners of a body's elements are, as the caller numbers all of it.
pub(crate) struct Places<'b, S> {
    triangles: &'b [[u32; 3]],
    edges: &'b [[u32; 2]],
    /// For each vertex its number in tree order, in which positions are.
    tree_vertices: &'b [TreeVertex],
    positions: &'b Points<S>,
}

impl<'b, S> Places<'b, S> {
    /// Where a vertex is, with padding.
    #[inline(always)]
    pub(crate) fn vertex(&self, vertex: u32) -> &'b [S; 4] {
        self.positions.padded(self.tree_vertices[vertex as usize])
    }

    /// Where the ends of an edge are.
    #[inline(always)]
    pub(crate) fn edge(&self, edge: u32) -> [&'b [S; 4]; 2] {
        let [a, b] = self.edges[edge as usize];
        [self.vertex(a), self.vertex(b)]
    }

    /// Where the corners of a triangle are.
    #[inline(always)]
    pub(crate) fn triangle(&self, triangle: u32) -> [&'b [S; 4]; 3] {
        let [a, b, c] = self.triangles[triangle as usize];
        [self.vertex(a), self.vertex(b), self.vertex(c)]
    }
}

impl<S: Coordinate> BodyMesh<S> {
    pub(crate) fn new(topology: Topology, order: Order) -> Self {
        Self {
            topology,
            order,
            elements: BodyElements::default(),
            edits: None,
            version: 0,
            order_version: 0,
        }
    }

    /// Another mesh of the same body.
    pub(crate) fn after(&self, topology: Topology, order: Order) -> Self {
        Self {
            version: self.version + 1,
            order_version: self.order_version + 1,
            ..Self::new(topology, order)
        }
    }

    pub(crate) fn copy(&self) -> Self {
        Self {
            topology: self.topology.clone(),
            order: self.order.clone(),
            elements: self.elements.copy(),
            edits: self.edits.clone(),
            ..*self
        }
    }

    // In the caller's numbers.

    #[inline]
    pub(crate) fn topology(&self) -> &Topology {
        &self.topology
    }

    /// The triangles, with those whose numbers are empty.
    pub(crate) fn triangles(&self) -> &[[u32; 3]] {
        self.topology.triangles()
    }

    pub(crate) fn vertex_count(&self) -> usize {
        self.topology.vertex_count()
    }

    /// Counts meshes, and orders of a mesh.
    pub(crate) fn order_version(&self) -> u64 {
        self.order_version
    }

    /// Whether a number is that of a triangle, for each.
    pub(crate) fn live_triangles(&self) -> Vec<bool> {
        let triangles = self.triangles().iter();
        triangles.map(|&corners| corners != EMPTY).collect()
    }

    /// Whether a number is that of a vertex, for each.
    pub(crate) fn live_vertices(&self) -> Vec<bool> {
        let vertices = 0..self.vertex_count() as u32;
        vertices.map(|vertex| !self.is_empty(vertex)).collect()
    }

    /// Whether a number is that of no vertex.
    pub(crate) fn is_empty(&self, vertex: u32) -> bool {
        let edits = self.edits.as_ref();
        edits.is_some_and(|edits| edits.empty().has(vertex))
    }

    /// How many numbers are those of no vertex.
    fn empty_count(&self) -> usize {
        let edits = self.edits.as_ref();
        edits.map_or(0, |edits| edits.empty().count())
    }

    /// Whether a triangle or a vertex is gone whose number was not used again.
    pub(crate) fn has_empty_numbers(&self) -> bool {
        self.topology.live_count() < self.triangles().len() || self.empty_count() > 0
    }

    /// The edges, as the caller numbers them.
    pub(crate) fn edges(&self) -> &[[u32; 2]] {
        self.elements().map_or(&[], Elements::callers)
    }

    /// The edges, if they have numbers that stay.
    pub(crate) fn numbered_edges(&self) -> Option<&[[u32; 2]]> {
        self.elements.have_numbers().then(|| self.edges())
    }

    /// Numbers the edges as those of another body with this mesh are. Returns false if they are not its
    /// edges, or have numbers already.
    pub(crate) fn number_edges(&mut self, edges: &[[u32; 2]]) -> bool {
        self.elements.number(edges, &self.topology, &self.order)
    }

    /// Gives every vertex a group; those of one group do not meet, unless it is 0.
    pub(crate) fn set_groups(&mut self, groups: &[u32]) -> Result<(), ErrorKind> {
        let vertices = self.vertex_count();
        self.elements.set_groups(groups, vertices)
    }

    /// The group of every vertex.
    pub(crate) fn groups(&self) -> Vec<u32> {
        let groups = self.elements.groups();
        groups.map_or_else(|| vec![0; self.vertex_count()], <[u32]>::to_vec)
    }

    // In tree order.

    #[inline]
    pub(crate) fn order(&self) -> &Order {
        &self.order
    }

    /// How many triangles there are in tree order, with those that were taken out and are still there.
    pub(crate) fn tree_triangles(&self) -> usize {
        self.order.all_corners().len()
    }

    /// Whether a triangle in tree order was taken out of the mesh.
    #[inline]
    pub(crate) fn is_gone(&self, triangle: TreeTriangle) -> bool {
        let edits = self.edits.as_ref();
        edits.is_some_and(|edits| edits.gone().has(triangle.0))
    }

    /// The numbers of all triangles of a run that were not taken out.
    pub(crate) fn still_there(&self, run: Range<u32>) -> impl Iterator<Item = u32> {
        let there = run.map(TreeTriangle).filter(|&place| !self.is_gone(place));
        there.map(|place| self.order.caller_triangle(place).0)
    }

    /// How many triangles are out of date in a tree over the first so many: they were taken out or came behind it.
    pub(crate) fn out_of_date(&self, first: usize) -> usize {
        let gone = self.edits.as_ref().map_or(0, |edits| edits.gone().count());
        self.tree_triangles() - first + gone
    }

    /// What was taken out, if anything was.
    pub(crate) fn removed(&self) -> Option<Removed<'_>> {
        self.edits.as_ref()?.removed(&self.order)
    }

    /// All vertices, in the order in which triangles in tree order first use them.
    pub(crate) fn vertex_order(&self) -> &[u32] {
        match &self.edits {
            Some(edits) if self.order.orphans().count() > 0 => edits.vertex_order(&self.order),
            _ => self.order.vertex_order(),
        }
    }

    /// Where the corners of a triangle are in tree order, which is at a place in it unless the mesh was edited.
    pub(crate) fn slots(&self, place: usize, corners: [u32; 3]) -> [TreeVertex; 3] {
        match &self.edits {
            Some(edits) => corners.map(|vertex| edits.slot(vertex)),
            None => self.order.corners(TreeTriangle(place as u32)),
        }
    }

    /// Finds out the elements, unless they are known. Returns false if it was stopped.
    pub(crate) fn know_elements(&mut self, stop: &dyn Fn() -> bool) -> bool {
        self.elements.know(&self.topology, &self.order, stop)
    }

    /// The elements; they are found out the first time.
    fn elements(&self) -> Option<&Elements> {
        self.elements.get(&self.topology, &self.order)
    }

    /// The elements, if they are known, with their groups, if they have some.
    pub(crate) fn known_elements(&self) -> Option<(&Elements, Option<&Groups>)> {
        let known = self.elements.known()?;
        Some((known, self.elements.groups_of_elements()))
    }

    /// Where the corners of elements are in a shape in tree order, as the caller numbers them.
    pub(crate) fn places<'b>(&'b self, positions: &'b Points<S>) -> Option<Places<'b, S>> {
        let elements = self.elements()?;
        Some(Places {
            triangles: self.triangles(),
            edges: elements.callers(),
            tree_vertices: match &self.edits {
                Some(edits) => edits.slots(),
                None => elements.tree_vertices(&self.order),
            },
            positions,
        })
    }

    // Shapes.

    /// A new shape, in which rows of vertices that are empty are those of others.
    pub(crate) fn new_shape<'n>(&'n mut self, positions: &'n [[S; 3]]) -> NewShape<'n, S> {
        let empty = self.empty_count();
        let positions = match &mut self.edits {
            Some(edits) => edits.patch(positions, &self.order),
            None => positions,
        };
        NewShape::new(positions, &self.order, empty)
    }

    /// A shape in which vertices that are empty are nowhere.
    pub(crate) fn without_empty_ones<'p>(
        &self,
        mut positions: Cow<'p, [[S; 3]]>,
    ) -> Cow<'p, [[S; 3]]> {
        if self.empty_count() > 0 {
            for (vertex, position) in (0..).zip(positions.to_mut()) {
                if self.is_empty(vertex) {
                    *position = [S::NAN; 3];
                }
            }
        }
        positions
    }

    // Edits.

    /// An edit of the mesh of now, of a body and a world, without steps.
    pub(crate) fn begin_edit(&self, world: u64, body: BodyId) -> Edit<S> {
        let counts = [self.vertex_count(), self.triangles().len()];
        Edit::new((world, body, self.version), counts)
    }

    /// What the steps of an edit come to; refused if it is of another mesh.
    pub(crate) fn draft(
        &mut self,
        edit: &Edit<S>,
        position: impl Fn(TreeVertex, &Order) -> [S; 3],
    ) -> Result<Outcome<S>, ErrorKind> {
        if edit.mesh != self.version {
            return Err(ErrorKind::OutdatedEdit);
        }
        let (topology, order, _, edits) = self.to_edit();
        let edits = &*edits;
        let position_of = |vertex: u32| position(edits.slot(vertex), order);
        let mut draft = edits.draft(topology, &position_of);
        for step in &edit.steps {
            draft.take(step)?;
        }
        draft.finish()
    }

    /// All that an edit changes; the lists that it needs are made the first time.
    fn to_edit(
        &mut self,
    ) -> (
        &mut Topology,
        &mut Order,
        &mut BodyElements,
        &mut EditState<S>,
    ) {
        let Self {
            topology,
            order,
            elements,
            edits,
            ..
        } = self;
        let edits = edits.get_or_insert_with(|| Box::new(EditState::new(topology, order)));
        (topology, order, elements, edits)
    }

    /// What an edit is going to change, if anything.
    pub(crate) fn said_of(&self, outcome: &Outcome<S>) -> Option<Edited> {
        let is_nothing = outcome.changed.is_empty()
            && outcome.triangles == self.triangles().len()
            && outcome.new_vertices.is_empty()
            && outcome.emptied.is_empty();
        if is_nothing {
            return None;
        }
        let mut edited = Edited::default();
        for &(triangle, [old, new]) in &outcome.changed {
            let list = match (old, new) {
                (EMPTY, _) => &mut edited.new_triangles,
                (_, EMPTY) => &mut edited.removed_triangles,
                _ => &mut edited.changed_triangles,
            };
            list.push(triangle);
        }
        let was_there =
            |vertex: &&u32| (**vertex as usize) < self.vertex_count() && !self.is_empty(**vertex);
        let gone = outcome.emptied.iter();
        edited.removed_vertices = gone.filter(was_there).copied().collect();
        let new = outcome.new_vertices.iter().map(|&(vertex, _)| vertex);
        let stay = new.filter(|vertex| outcome.emptied.binary_search(vertex).is_err());
        edited.new_vertices = stay.collect();
        Some(edited)
    }

    /// No vertex is empty any more, and none has a group.
    pub(crate) fn fill(&mut self) {
        let (_, _, elements, edits) = self.to_edit();
        elements.forget_groups();
        edits.fill_all();
    }

    /// Makes changes in the caller's numbers; nothing in tree order.
    pub(crate) fn change(&mut self, outcome: &Outcome<S>) {
        let (topology, order, elements, edits) = self.to_edit();
        elements.begin_to_follow(topology, order);
        edits.change(topology, elements.known_mut(), outcome);
        elements.change_groups(outcome);
        self.version += 1;
    }

    /// Takes changes into tree order, but for triangles that come, which it returns: vertices come behind
    /// all others, and triangles are taken out.
    pub(crate) fn take_out(&mut self, outcome: &Outcome<S>, new_vertices: usize) -> Vec<u32> {
        let (_, order, _, edits) = self.to_edit();
        edits.add_vertices(order, new_vertices);
        edits.take_out_changed(outcome)
    }

    /// Vertices that lose their last triangle go to the end of tree order, and leave orphans.
    pub(crate) fn leave_orphans(&mut self, changed: &[Changed], shape: &mut BodyShape<S>) {
        let (topology, order, _, edits) = self.to_edit();
        edits.leave_orphans(topology, order, changed, |slot| {
            shape.follow_to_the_end(slot)
        });
    }

    /// Some vertices that were empty are somewhere, and others are empty. The shape holds all corners of changed triangles.
    pub(crate) fn place_vertices(
        &mut self,
        outcome: &Outcome<S>,
        again: &[(u32, [S; 3])],
        shape: &mut BodyShape<S>,
    ) {
        let (_, order, _, edits) = self.to_edit();
        for &(vertex, position) in again {
            edits.set_empty(vertex, false);
            shape.place(CallerVertex(vertex), edits.slot(vertex), position, order);
        }
        for &vertex in &outcome.emptied {
            edits.set_empty(vertex, true);
        }
        // Those that had no triangle until now, whether they are new or not, are not in the bounds.
        let new = outcome.changed.iter().flat_map(|&(_, [_, new])| new);
        for vertex in new.filter(|&vertex| vertex != u32::MAX) {
            shape.include(edits.slot(vertex), order);
        }
    }

    /// Some triangles as a mesh of their own: their corners, and the positions that these are places in.
    pub(crate) fn alone(
        &mut self,
        triangles: &[u32],
        shape: &BodyShape<S>,
    ) -> (Vec<[u32; 3]>, Vec<[S; 3]>) {
        let (topology, order, _, edits) = self.to_edit();
        let all = topology.triangles();
        let corners = triangles.iter().map(|&it| all[it as usize]);
        let corners: Vec<[u32; 3]> = corners.collect();
        let mut used: Vec<u32> = corners.as_flattened().to_vec();
        used.sort_unstable();
        used.dedup();
        let place = |vertex: u32| used.partition_point(|&it| it < vertex) as u32;
        let (shape, order) = (shape.positions(), order.vertex_order());
        let positions = used.iter();
        let positions = positions.map(|&vertex| shape.get(edits.slot(vertex), order));
        let positions = positions.collect();
        (
            corners.into_iter().map(|it| it.map(place)).collect(),
            positions,
        )
    }

    /// Puts triangles behind those before a place, in this order; these are the first to use vertices from
    /// another place on. What is behind now is forgotten.
    pub(crate) fn append(
        &mut self,
        (first, first_vertex): (u32, TreeVertex),
        triangles: &[u32],
        shape: &mut BodyShape<S>,
    ) {
        let (topology, order, elements, edits) = self.to_edit();
        let places = (first, first_vertex);
        edits.append(topology, order, places, triangles, |moved| {
            shape.follow(&moved)
        });
        if let Some(known) = elements.known_mut() {
            known.append(order, edits.gone(), TreeTriangle(first), first_vertex.0);
        }
    }

    /// The order of the trees is another one, for the same mesh or with it.
    pub(crate) fn next_order(&mut self) {
        self.order_version += 1;
    }

    /// Has another order from now on, but for triangles that were changed since these had their places in it.
    pub(crate) fn exchange_order(&mut self, order: Order, changed: &[Changed]) {
        self.order = order;
        if let Some(edits) = &mut self.edits {
            edits.find_places(&self.order);
            for &(triangle, _) in changed {
                edits.take_out(triangle);
            }
        }
        let gone = self.edits.as_ref().map(|edits| edits.gone());
        self.elements.exchange_order(&self.order, gone);
        self.order_version += 1;
    }

    /// Checks that every triangle is in the trees once, with the corners that it has, and every vertex where it is said to be.
    pub(crate) fn validate(&self) -> Result<(), String> {
        let mut seen = vec![false; self.triangles().len()];
        for place in (0..self.tree_triangles() as u32).map(TreeTriangle) {
            if self.is_gone(place) {
                continue;
            }
            let triangle = self.order.caller_triangle(place);
            let corners = self.order.corners(place);
            let corners = corners.map(|it| self.order.caller_vertex(it));
            let is_first = seen
                .get_mut(triangle.index())
                .map(|seen| !std::mem::replace(seen, true));
            if is_first != Some(true) || corners != self.topology.corners(triangle) {
                return Err(format!("{place:?} is not {triangle:?}, or once too often"));
            }
        }
        if let Some(edits) = &self.edits {
            edits.validate(&self.order, self.elements.known())?;
        }
        let is_live = |triangle: usize| self.topology.is_live(triangle as u32);
        match (0..seen.len()).find(|&triangle| seen[triangle] != is_live(triangle)) {
            Some(triangle) => Err(format!(
                "triangle {triangle}: in no tree, or in one and empty"
            )),
            None => Ok(()),
        }
    }
}

held!(BodyMesh<S>: topology, order, elements; |mesh| held::boxes(&mesh.edits));
