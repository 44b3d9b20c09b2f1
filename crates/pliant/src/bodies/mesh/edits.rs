//! Edits of a mesh: places of triangles and vertices in tree order, and which are removed.
//!
//! The parts of the body, which have the trees, are not known here: see `body::edits`.

use super::{BodyMesh, Edits};
use crate::bodies::shape::BodyShape;
use crate::edit::{Edit, Edited};
use crate::error::ErrorKind;
use crate::ids::{CallerVertex, TreeTriangle, TreeVertex};
use crate::kernels::Coordinate;
use crate::mesh::{Bits, Changed, Draft, EMPTY, Elements, Order, Outcome, Topology, TrianglesAt};
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// Marks a triangle without a place in tree order.
const NOWHERE: u32 = u32::MAX;

impl<S: Copy> Edits<S> {
    fn new(topology: &Topology, order: &Order) -> Self {
        let mut edits = Self {
            places: Vec::new(),
            slots: Vec::new(),
            at: TrianglesAt::new(topology.triangles(), topology.vertex_count()),
            gone: Bits::default(),
            empty: Bits::default(),
            orphans_of: BTreeMap::new(),
            patched: Vec::new(),
            without_orphans: OnceLock::new(),
        };
        edits.places.resize(topology.triangles().len(), NOWHERE);
        edits.find_places(order);
        edits
    }

    /// Records the places in an order that has all triangles, and no removed ones.
    fn find_places(&mut self, order: &Order) {
        self.places.fill(NOWHERE);
        for (place, &triangle) in (0..).zip(order.triangle_order()) {
            self.places[triangle as usize] = place;
        }
        self.slots.clear();
        self.slots.resize(order.vertex_order().len(), TreeVertex(0));
        for (slot, &vertex) in (0..).map(TreeVertex).zip(order.vertex_order()) {
            self.slots[vertex as usize] = slot;
        }
        self.gone = Bits::default();
        self.orphans_of.clear();
        self.without_orphans.take();
    }

    /// Marks a triangle as removed, if it has a place.
    fn take_out(&mut self, triangle: u32) {
        let place = std::mem::replace(&mut self.places[triangle as usize], NOWHERE);
        if place != NOWHERE {
            self.gone.insert(place);
        }
    }

    /// Positions in which empty vertices are where a used vertex is.
    pub(super) fn patch<'p>(&'p mut self, positions: &'p [[S; 3]], order: &Order) -> &'p [[S; 3]] {
        if self.empty.count() == 0 || positions.len() != self.slots.len() {
            return positions;
        }
        let some = positions[order.caller_vertex(TreeVertex(0)).index()];
        self.patched.clear();
        self.patched.extend_from_slice(positions);
        for (vertex, position) in (0..).zip(&mut self.patched) {
            if self.empty.has(vertex) {
                *position = some;
            }
        }
        &self.patched
    }

    /// Number of a vertex in tree order.
    fn slot(&self, vertex: u32) -> TreeVertex {
        self.slots[vertex as usize]
    }

    /// Whether a vertex has triangles.
    fn is_used(&self, vertex: u32) -> bool {
        self.at.of(vertex).next().is_some()
    }

    /// Vertices in tree order that lose their last triangle, each with a neighbour that stays, if
    /// there is one.
    ///
    /// The first `used` vertices in tree order are corners of triangles.
    fn lost(&self, changed: &[Changed], used: usize) -> BTreeMap<TreeVertex, Option<u32>> {
        let mut lost: BTreeMap<TreeVertex, Option<u32>> = BTreeMap::new();
        for (_, [old, _]) in changed {
            let old = old.iter().filter(|&&vertex| vertex != u32::MAX);
            let beside = old.clone().find(|&&vertex| self.is_used(vertex)).copied();
            for &vertex in old {
                let slot = self.slots[vertex as usize];
                if !self.is_used(vertex) && slot.index() < used {
                    let alias = lost.entry(slot).or_default();
                    *alias = alias.or(beside);
                }
            }
        }
        lost
    }
}

impl<S: Coordinate> BodyMesh<S> {
    /// Begins an edit of this mesh, in the world with this number.
    pub(crate) fn begin_edit(&self, world: u64) -> Edit<S> {
        let counts = [self.vertex_count(), self.triangles().len()];
        Edit::new((world, self.body, self.version), counts)
    }

    /// Drafts an edit: the outcome of its steps. Refused if the edit is of another mesh.
    pub(crate) fn draft(
        &mut self,
        edit: &Edit<S>,
        shape: &BodyShape<S>,
    ) -> Result<Outcome<S>, ErrorKind> {
        if edit.mesh != self.version {
            return Err(ErrorKind::OutdatedEdit);
        }
        let (topology, order, edits) = self.editable();
        let position_of = |vertex: u32| shape.get(edits.slot(vertex), order.vertex_order());
        let mut draft = Draft::new(topology, &edits.at, &edits.empty, &position_of);
        for step in &edit.steps {
            draft.take(step)?;
        }
        draft.finish()
    }

    /// Topology, order and lists that an edit changes. The lists are made the first time, in O(n).
    fn editable(&mut self) -> (&mut Topology, &mut Order, &mut Edits<S>) {
        let (topology, order) = (&mut self.topology, &mut self.order);
        let new = || Box::new(Edits::new(topology, order));
        let edits = self.edits.get_or_insert_with(new);
        (topology, order, edits)
    }

    /// Changes of an edit as its caller is told of them, if there are any.
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

    /// Makes all vertices exist: none is empty any more.
    pub(crate) fn fill(&mut self) {
        let (_, _, edits) = self.editable();
        edits.empty = Bits::default();
    }

    /// Makes the changes of an edit in the caller's numbers, and nothing in tree order.
    pub(crate) fn change(&mut self, outcome: &Outcome<S>) {
        if self.edges_were_known {
            // Edges have numbers, which stay.
            self.elements(&|| false);
        }
        self.version += 1;
        self.watertight.take();
        let (topology, changed) = (&mut self.topology, &outcome.changed);
        let Some(edits) = &mut self.edits else {
            return;
        };
        let mut elements = self.elements.get_mut();
        if let Some(elements) = &mut elements {
            elements.begin_to_follow(topology);
        }
        for &(triangle, [old, _]) in changed {
            edits.at.unlink(triangle, old);
        }
        let numbers = outcome.triangles.max(topology.triangles().len());
        let vertices = outcome.vertices.max(topology.vertex_count());
        edits.at.resize(vertices, numbers);
        for &(triangle, [_, new]) in changed {
            topology.set(triangle, new);
            edits.at.link(triangle, new);
        }
        if let Some(elements) = elements {
            elements.follow(changed, topology, &edits.at);
        }
        if let Some(stars) = self.stars.get_mut() {
            stars.resize(vertices);
            let both = changed.iter().flat_map(|&(_, corners)| corners);
            let touched = both.flatten().filter(|&vertex| vertex != u32::MAX);
            stars.find(touched, topology.triangles(), &edits.at);
            stars.resize(outcome.vertices);
        }
        edits.at.resize(outcome.vertices, outcome.triangles);
        topology.set_vertex_count(outcome.vertices);
        topology.set_triangle_count(outcome.triangles);
    }

    /// Takes changed triangles out of tree order, and puts new vertices behind all others.
    ///
    /// Returns the triangles that have corners now: they are still to be inserted.
    pub(crate) fn take_out(&mut self, outcome: &Outcome<S>, new_vertices: usize) -> Vec<u32> {
        let (_, order, edits) = self.editable();
        let slots = order.vertex_order().len() as u32..;
        let first = edits.slots.len() as u32;
        edits.slots.extend(slots.map(TreeVertex).take(new_vertices));
        order.add_vertices(first..first + new_vertices as u32);
        edits.without_orphans.take();
        let numbers = outcome.triangles.max(edits.places.len());
        edits.places.resize(numbers, NOWHERE);
        let mut coming = Vec::new();
        for &(triangle, [_, new]) in &outcome.changed {
            edits.take_out(triangle);
            if new != EMPTY {
                coming.push(triangle);
            }
        }
        edits.places.truncate(outcome.triangles);
        coming
    }

    /// Moves vertices that lose their last triangle to the end of tree order. Each leaves an orphan
    /// at its old number.
    ///
    /// An orphan stands where an alias does: a vertex near it in the tree, another for each orphan.
    /// So boxes over nothing but orphans are as large as other boxes, and no more of them are in
    /// one place.
    pub(crate) fn leave_orphans(&mut self, changed: &[Changed], shape: &mut BodyShape<S>) {
        let (topology, order, edits) = self.editable();
        let lost = edits.lost(changed, order.used_vertices());
        let some = || {
            let mut all = topology.triangles().iter();
            all.find(|corners| **corners != EMPTY).map_or(0, |it| it[0])
        };
        let mut any = None;
        let mut run = 0..0;
        for (&TreeVertex(slot), &beside) in &lost {
            if slot != run.end {
                run = slot..slot;
            }
            run.end = slot + 1;
            // The vertex at the mirrored place before the beginning of the run, in which all are
            // lost.
            let mirrored = run.start.checked_sub(1 + slot - run.start);
            let near = mirrored.map(|slot| order.caller_vertex(TreeVertex(slot)).0);
            let mut candidates = beside.into_iter().chain(near);
            let is_good = |&vertex: &u32| {
                edits.is_used(vertex) && !lost.contains_key(&edits.slots[vertex as usize])
            };
            let alias = candidates.find(is_good);
            let alias = alias.unwrap_or_else(|| *any.get_or_insert_with(some));
            let vertex = order.caller_vertex(TreeVertex(slot)).0;
            edits.slots[vertex as usize] = order.orphan(TreeVertex(slot), alias);
            shape.follow_to_the_end(TreeVertex(slot));
            let mut orphans = edits.orphans_of.remove(&vertex).unwrap_or_default();
            orphans.retain(|&orphan| order.set_alias(orphan, vertex, alias));
            orphans.push(slot);
            edits.orphans_of.entry(alias).or_default().extend(orphans);
        }
    }

    /// Places vertices that come again, empties others, and extends the bounds of the shape by all
    /// corners of changed triangles.
    pub(crate) fn place_vertices(
        &mut self,
        outcome: &Outcome<S>,
        again: &[(u32, [S; 3])],
        shape: &mut BodyShape<S>,
    ) {
        let (_, order, edits) = self.editable();
        for &(vertex, position) in again {
            edits.empty.remove(vertex);
            shape.place(CallerVertex(vertex), edits.slot(vertex), position, order);
        }
        for &vertex in &outcome.emptied {
            edits.empty.insert(vertex);
        }
        // Vertices that had no triangle until now, new or not, are not in the bounds.
        let new = outcome.changed.iter().flat_map(|&(_, [_, new])| new);
        for vertex in new.filter(|&vertex| vertex != u32::MAX) {
            shape.include(edits.slot(vertex), order);
        }
    }

    /// Extracts some triangles as a mesh of their own: their corners, and the positions of their
    /// vertices.
    pub(crate) fn alone(
        &mut self,
        triangles: &[u32],
        shape: &BodyShape<S>,
    ) -> (Vec<[u32; 3]>, Vec<[S; 3]>) {
        let (topology, order, edits) = self.editable();
        let all = topology.triangles();
        let corners = triangles.iter().map(|&it| all[it as usize]);
        let corners: Vec<[u32; 3]> = corners.collect();
        let mut used: Vec<u32> = corners.as_flattened().to_vec();
        used.sort_unstable();
        used.dedup();
        let place = |vertex: u32| used.partition_point(|&it| it < vertex) as u32;
        let order = order.vertex_order();
        let positions = used.iter();
        let positions = positions.map(|&vertex| shape.get(edits.slot(vertex), order));
        let positions = positions.collect();
        (
            corners.into_iter().map(|it| it.map(place)).collect(),
            positions,
        )
    }

    /// Appends triangles in this order from a place on, after cutting off everything behind it.
    ///
    /// They are the first to use vertices from `first_vertex` on.
    pub(crate) fn append(
        &mut self,
        (first, first_vertex): (u32, TreeVertex),
        triangles: &[u32],
        shape: &mut BodyShape<S>,
    ) {
        let (topology, order, edits) = self.editable();
        edits.gone.cut_back(first);
        let (used, slots) = (first_vertex.index(), &mut edits.slots);
        let mut moved = |moved| shape.follow(&moved);
        order.cut_back(first as usize, used, slots, &mut moved);
        order.append(topology, triangles, slots, moved);
        for (place, &triangle) in (first..).zip(triangles) {
            edits.places[triangle as usize] = place;
        }
        if let (Some(elements), Some(edits)) = (self.elements.get_mut(), &self.edits) {
            let first = TreeTriangle(first);
            elements.append(&self.order, &edits.gone, first, first_vertex.0);
        }
    }

    /// Increases the version of the order, which has changed.
    pub(crate) fn next_order(&mut self) {
        self.order_version += 1;
    }

    /// Exchanges the order. Triangles that were changed since the new one was made are taken out of
    /// it.
    pub(crate) fn exchange_order(&mut self, order: Order, changed: &[Changed]) {
        self.order = order;
        self.order_version += 1;
        if let Some(edits) = &mut self.edits {
            edits.find_places(&self.order);
            for &(triangle, _) in changed {
                edits.take_out(triangle);
            }
        }
        self.edges_were_known = self.edges_are_known();
        match self.elements.get_mut() {
            Some(elements) if elements.follows() => {
                let none = Bits::default();
                let gone = self.edits.as_ref().map_or(&none, |edits| &edits.gone);
                elements.append(&self.order, gone, TreeTriangle(0), 0);
            }
            _ => drop(self.elements.take()),
        }
    }

    /// Checks that every triangle is in the trees once, with its corners, and every vertex at its
    /// recorded number.
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
            self.validate_vertices(edits)?;
        }
        let is_live = |triangle: usize| self.topology.is_live(triangle as u32);
        match (0..seen.len()).find(|&triangle| seen[triangle] != is_live(triangle)) {
            Some(triangle) => Err(format!(
                "triangle {triangle}: in no tree, or in one and empty"
            )),
            None => Ok(()),
        }
    }

    fn validate_vertices(&self, edits: &Edits<S>) -> Result<(), String> {
        let order = &self.order;
        let has_place = |vertex: u32| {
            let slot = edits.slot(vertex);
            !order.orphans().has(slot.0) && order.caller_vertex(slot) == CallerVertex(vertex)
        };
        if let Some(vertex) = (0..edits.slots.len() as u32).find(|&it| !has_place(it)) {
            return Err(format!("vertex {vertex} is not where it is said to be"));
        }
        let misplaced = |it: &Elements| it.misplaced(|vertex| edits.slot(vertex));
        match self.known_elements().and_then(misplaced) {
            Some(edge) => Err(format!("edge {edge} has ends that are not its own")),
            None => Ok(()),
        }
    }
}
