//! Edits of a body's mesh: what is taken out stays in the trees and is passed over, what comes is put into trees of its own.
//!
//! The triangles in tree order are those of the first tree, then those of smaller ones: *parts* of the body, each over a run. Vertices are
//! numbered as triangles first use them, whichever tree these are in, so a part that comes behind all others changes nothing in them: not a
//! box becomes stale. A triangle that goes, or gets other corners, is marked as taken out; with other corners it comes again behind all
//! others. What comes makes a new part together with those last parts that are not much larger, so that there are few, and each triangle is
//! put into a tree a few times only (Bentley and Saxe 1980, *Decomposable searching problems*). When much of the first tree is out of date
//! the whole is built anew.
//!
//! So an edit costs what it names and what came lately, not what there is; but for the first of a body, which makes the lists that say where
//! triangles are, and for the one that builds the tree anew, whose cost is a small part of that of each edit before it.

use super::body::{Body, all_inside, divide, is_in_range, none_is_lost};
use super::edit_state::{EditState, NOWHERE};
use super::part::Part;
use crate::edit::{Edit, Edited};
use crate::error::ErrorKind;
use crate::ids::{CallerVertex, TreeTriangle, TreeVertex};
use crate::kernels::{Coordinate, Instructions};
use crate::mesh::{Bits, Changed, Draft, EMPTY, Outcome};
use crate::options::Options;
use crate::threads::Executor;
use crate::tree::Tree;
use std::collections::BTreeMap;

/// A part that is at most so many times as large as what comes is made anew with it.
const MUCH_LARGER: usize = 2;
/// A part of so few triangles is made anew with whatever comes.
const FEW: usize = 64;
/// The tree is built anew when this part of its triangles was taken out or came behind it,
const OUT_OF_DATE: usize = 16;
/// but not for so few.
const FEWEST: usize = 32;
/// A mesh of which more than this part differs is taken as another.
const MUCH: usize = 8;

impl<S: Coordinate> Body<S> {
    /// An edit of the mesh of now, of a world, without steps.
    pub(crate) fn begin_edit(&self, world: u64) -> Edit<S> {
        let counts = [self.vertex_count(), self.triangle_numbers()];
        Edit::new((world, self.id, self.meshes), counts)
    }

    /// Whether a triangle in tree order was taken out of the mesh.
    #[inline]
    pub(crate) fn is_gone(&self, triangle: TreeTriangle) -> bool {
        let edits = self.edits.as_ref();
        edits.is_some_and(|edits| edits.gone.has(triangle.0))
    }

    /// Whether a number is that of a triangle, for each.
    pub(crate) fn live_triangles(&self) -> Vec<bool> {
        let triangles = self.topology.triangles().iter();
        triangles.map(|&corners| corners != EMPTY).collect()
    }

    /// Whether a number is that of a vertex, for each.
    pub(crate) fn live_vertices(&self) -> Vec<bool> {
        let is_empty = |vertex| {
            let edits = self.edits.as_ref();
            edits.is_some_and(|edits| edits.empty.has(vertex))
        };
        let vertices = 0..self.vertex_count() as u32;
        vertices.map(|vertex| !is_empty(vertex)).collect()
    }

    /// Whether a triangle or a vertex is gone whose number was not used again.
    pub(crate) fn has_empty_numbers(&self) -> bool {
        let edits = self.edits.as_deref();
        self.topology.live_count() < self.triangle_numbers()
            || edits.is_some_and(|edits| edits.empty.count() > 0)
    }

    /// Makes all changes of an edit; or leaves the body as it is and says what was wrong.
    pub(crate) fn apply(&mut self, edit: &Edit<S>, options: &Options) -> Result<Edited, ErrorKind> {
        if edit.mesh != self.meshes {
            return Err(ErrorKind::OutdatedEdit);
        }
        self.prepare_to_edit();
        let outcome = self.draft(edit)?;
        self.check_new_vertices(&outcome)?;
        let is_nothing = outcome.changed.is_empty()
            && outcome.triangles == self.triangle_numbers()
            && outcome.new_vertices.is_empty()
            && outcome.emptied.is_empty();
        if is_nothing {
            return Ok(Edited::default());
        }
        let edited = self.said_of(&outcome);
        self.commit(&outcome, options);
        Ok(edited)
    }

    /// Gives the body another mesh and its shape; or leaves it as it is and says what was wrong. What is equal by number stays.
    pub(crate) fn set_mesh(
        &mut self,
        triangles: &[[u32; 3]],
        positions: &[[S; 3]],
        options: &Options,
        (instructions, executor): (Instructions, Executor),
    ) -> Result<(), ErrorKind> {
        super::body::validate(triangles, positions)?;
        if let Some(loose) = self.loose {
            all_inside(&loose, positions, |_| false)?;
        }
        let old = self.topology.triangles();
        let numbers = 0..old.len().max(triangles.len());
        let of = |all: &[[u32; 3]], triangle| all.get(triangle).copied().unwrap_or(EMPTY);
        let both = |triangle| {
            (
                triangle as u32,
                [of(old, triangle), of(triangles, triangle)],
            )
        };
        let changed = numbers.map(both).filter(|(_, [old, new])| old != new);
        let is_much = changed.clone().count() * MUCH > self.topology.live_count();
        if is_much || positions.len() < self.vertex_count() {
            *self = self.with_mesh(triangles, positions, options);
            return Ok(());
        }
        let changed: Vec<_> = changed.collect();
        self.groups = None;
        self.prepare_to_edit();
        if let Some(edits) = &mut self.edits {
            edits.empty = Bits::default();
        }
        let added = self.vertex_count().min(positions.len())..positions.len();
        let outcome = Outcome {
            changed,
            triangles: triangles.len(),
            vertices: positions.len(),
            new_vertices: added.map(|it| (it as u32, positions[it])).collect(),
            split_from: BTreeMap::new(),
            emptied: Vec::new(),
        };
        self.follow(&outcome);
        self.forget_motion();
        self.take_in(&outcome, options);
        self.set_positions(instructions, executor, positions)
    }

    /// Makes the lists that edits need, the first time.
    fn prepare_to_edit(&mut self) {
        let (topology, order) = (&self.topology, &self.order);
        self.edits
            .get_or_insert_with(|| Box::new(EditState::new(topology, order)));
    }

    /// What the steps of an edit come to.
    fn draft(&self, edit: &Edit<S>) -> Result<Outcome<S>, ErrorKind> {
        let Some(edits) = &self.edits else {
            return Err(ErrorKind::OutdatedEdit);
        };
        let order = self.order.vertex_order();
        let position_of = |vertex: u32| self.positions.get(edits.slots[vertex as usize], order);
        let mut draft = Draft::new(&self.topology, &edits.at, &edits.empty, &position_of);
        for step in &edit.steps {
            draft.take(step)?;
        }
        draft.finish()
    }

    /// What an edit is going to change.
    fn said_of(&self, outcome: &Outcome<S>) -> Edited {
        let mut edited = Edited::default();
        for &(triangle, [old, new]) in &outcome.changed {
            let list = match (old, new) {
                (EMPTY, _) => &mut edited.new_triangles,
                (_, EMPTY) => &mut edited.removed_triangles,
                _ => &mut edited.changed_triangles,
            };
            list.push(triangle);
        }
        let edits = self.edits.as_ref();
        let was_there = |vertex: &&u32| {
            (**vertex as usize) < self.vertex_count()
                && !edits.is_some_and(|edits| edits.empty.has(**vertex))
        };
        let gone = outcome.emptied.iter();
        edited.removed_vertices = gone.filter(was_there).copied().collect();
        let new = outcome.new_vertices.iter().map(|&(vertex, _)| vertex);
        let stay = new.filter(|vertex| outcome.emptied.binary_search(vertex).is_err());
        edited.new_vertices = stay.collect();
        edited
    }

    /// Refuses positions that no vertex can have.
    fn check_new_vertices(&self, outcome: &Outcome<S>) -> Result<(), ErrorKind> {
        for &(vertex, position) in &outcome.new_vertices {
            let vertex = vertex as usize;
            if !is_in_range(position) {
                return Err(ErrorKind::BadPosition {
                    vertex,
                    position: position.map(S::to_f64),
                });
            }
            if self.loose.is_some_and(|loose| !loose.holds(position)) {
                return Err(ErrorKind::OutsideLooseBox {
                    vertex,
                    position: position.map(S::to_f64),
                });
            }
            none_is_lost(&[position]).map_err(|kind| match kind {
                ErrorKind::NeedsSubnormals { .. } => ErrorKind::NeedsSubnormals { vertex },
                other => other,
            })?;
        }
        Ok(())
    }

    /// Makes changes that were found good. A motion ends.
    fn commit(&mut self, outcome: &Outcome<S>, options: &Options) {
        self.forget_motion();
        self.follow(outcome);
        self.take_in(outcome, options);
    }

    /// Changes the mesh, and what is said of it in the caller's numbers; nothing in tree order.
    fn follow(&mut self, outcome: &Outcome<S>) {
        self.remember_edges();
        let Some(edits) = &mut self.edits else {
            return;
        };
        let changed = &outcome.changed;
        if let Some(elements) = self.elements.get_mut() {
            elements.begin_to_follow(&self.topology);
        }
        for &(triangle, [old, _]) in changed {
            edits.at.unlink(triangle, old);
        }
        let numbers = outcome.triangles.max(self.topology.triangles().len());
        let vertices = outcome.vertices.max(self.topology.vertex_count());
        edits.at.resize(vertices, numbers);
        for &(triangle, [_, new]) in changed {
            self.topology.set(triangle, new);
            edits.at.link(triangle, new);
        }
        if let Some(elements) = self.elements.get_mut() {
            elements.follow(changed, &self.topology, &edits.at);
        }
        edits.at.resize(outcome.vertices, outcome.triangles);
        self.topology.set_vertex_count(outcome.vertices);
        self.topology.set_triangle_count(outcome.triangles);
        if let Some(groups) = &mut self.groups {
            // Of vertices as they were before: one that was split may have gone since, and its number may be another's.
            let group = |vertex: u32| {
                let from = outcome.split_from.get(&vertex);
                from.map_or(0, |&from| groups.callers[from as usize])
            };
            let new = outcome.new_vertices.iter();
            let new: Vec<(u32, u32)> = new.map(|&(vertex, _)| (vertex, group(vertex))).collect();
            groups.callers.resize(outcome.vertices, 0);
            for (vertex, group) in new {
                groups.callers[vertex as usize] = group;
            }
            groups.of_elements = None;
        }
    }

    /// Takes changes into tree order: a part for what comes, or the whole anew.
    fn take_in(&mut self, outcome: &Outcome<S>, options: &Options) {
        self.meshes += 1;
        if let Some(mending) = &mut self.mending {
            mending.note(&outcome.changed);
        }
        let known = self.vertex_count();
        let (again, new) = outcome.new_vertices.split_at(
            outcome
                .new_vertices
                .partition_point(|it| (it.0 as usize) < known),
        );
        self.add_vertices(new);
        let mut coming: Vec<u32> = Vec::new();
        let mut is_much = false;
        if let Some(edits) = &mut self.edits {
            edits.without_orphans.take();
            let first_of_others = self.parts.first.triangles.end;
            edits
                .places
                .resize(outcome.triangles.max(edits.places.len()), NOWHERE);
            for &(triangle, [_, new]) in &outcome.changed {
                edits.take_out(triangle);
                if new != EMPTY {
                    coming.push(triangle);
                }
            }
            if outcome.triangles < edits.places.len() {
                // A tree that is being built has numbers that are no more.
                self.mending = None;
            }
            edits.places.truncate(outcome.triangles);
            let behind = self.order.all_corners().len() - first_of_others as usize;
            let out_of_date = edits.gone.count() + behind + coming.len();
            is_much = out_of_date > FEWEST.max(first_of_others as usize / OUT_OF_DATE);
        }
        if !is_much {
            self.leave_orphans(&outcome.changed);
        }
        self.place_again(again);
        if let Some(edits) = &mut self.edits {
            for &vertex in &outcome.emptied {
                edits.empty.insert(vertex);
            }
            // Those that had no triangle until now, whether they are new or not, are not in the bounds.
            let new = outcome.changed.iter().flat_map(|&(_, [_, new])| new);
            let order = self.order.vertex_order();
            for vertex in new.filter(|&vertex| vertex != u32::MAX) {
                let slot = edits.slots[vertex as usize];
                self.bounds.include(self.positions.get(slot, order));
            }
        }
        if is_much {
            self.rebuild(options);
            return;
        }
        self.append(coming, options);
        self.revision += 1;
    }

    /// Vertices come, which no triangle in tree order has yet.
    fn add_vertices(&mut self, new: &[(u32, [S; 3])]) {
        let Some(edits) = &mut self.edits else {
            return;
        };
        let slots = self.order.vertex_order().len() as u32..;
        edits.slots.extend(slots.map(TreeVertex).take(new.len()));
        let first = self.positions.len() as u32;
        self.order.add_vertices(first..first + new.len() as u32);
        let new: Vec<[S; 3]> = new.iter().map(|&(_, position)| position).collect();
        self.positions.push(&new);
    }

    /// Vertices that were empty are somewhere. One that went and came within one edit still has triangles that were taken out, whose boxes
    /// were made.
    fn place_again(&mut self, again: &[(u32, [S; 3])]) {
        let Some(edits) = &mut self.edits else {
            return;
        };
        for &(vertex, position) in again {
            edits.empty.remove(vertex);
            let slot = edits.slots[vertex as usize];
            self.positions.place(CallerVertex(vertex), slot, position);
            self.epoch += u64::from(slot.index() < self.order.used_vertices());
        }
    }

    /// Vertices that lose their last triangle go to the end of tree order, and leave orphans. These stand where
    /// vertices do that are near them in the tree, each where another does: boxes over nothing but orphans are as large as others, and
    /// no more of them are in one place.
    pub(crate) fn leave_orphans(&mut self, changed: &[Changed]) {
        let used = self.order.used_vertices();
        let Some(edits) = &mut self.edits else {
            return;
        };
        let leaves =
            |edits: &EditState<S>, vertex: u32| edits.slots[vertex as usize].index() < used;
        let mut lost: BTreeMap<TreeVertex, Option<u32>> = BTreeMap::new();
        for (_, [old, _]) in changed {
            let mut stay = old
                .iter()
                .filter(|&&vertex| vertex != u32::MAX && edits.is_used(vertex));
            let beside = stay.next().copied();
            for &vertex in old.iter().filter(|&&vertex| vertex != u32::MAX) {
                if !edits.is_used(vertex) && leaves(edits, vertex) {
                    let alias = lost.entry(edits.slots[vertex as usize]).or_default();
                    *alias = alias.or(beside);
                }
            }
        }
        let some = || {
            let mut all = self.topology.triangles().iter();
            all.find(|corners| **corners != EMPTY).map_or(0, |it| it[0])
        };
        let is_good =
            |edits: &EditState<S>, lost: &BTreeMap<TreeVertex, Option<u32>>, vertex: u32| {
                edits.is_used(vertex) && !lost.contains_key(&edits.slots[vertex as usize])
            };
        let mut any = None;
        let mut run = 0..0;
        for (&TreeVertex(slot), &beside) in &lost {
            if slot != run.end {
                run = slot..slot;
            }
            run.end = slot + 1;
            // The mirror image in the beginning of the run, in which all are lost.
            let mirrored = run.start.checked_sub(1 + slot - run.start);
            let near = mirrored.map(|slot| self.order.caller_vertex(TreeVertex(slot)).0);
            let mut candidates = beside.into_iter().chain(near);
            let alias = candidates.find(|&vertex| is_good(edits, &lost, vertex));
            let alias = alias.unwrap_or_else(|| *any.get_or_insert_with(some));
            let vertex = self.order.caller_vertex(TreeVertex(slot)).0;
            edits.slots[vertex as usize] = self.order.orphan(TreeVertex(slot), alias);
            self.positions.follow_to_the_end(TreeVertex(slot));
            let mut orphans = edits.orphans_of.remove(&vertex).unwrap_or_default();
            orphans.retain(|&orphan| self.order.set_alias(orphan, vertex, alias));
            orphans.push(slot);
            edits.orphans_of.entry(alias).or_default().extend(orphans);
        }
    }

    /// Puts triangles behind all others, in a part with those last ones that are not much larger.
    pub(crate) fn append(&mut self, mut coming: Vec<u32>, options: &Options) {
        let Some(edits) = &mut self.edits else {
            return;
        };
        let mut start = (
            self.order.all_corners().len() as u32,
            TreeVertex(self.order.used_vertices() as u32),
        );
        while let Some(last) = self.parts.others.last() {
            let many = FEW.max(MUCH_LARGER * coming.len());
            if coming.is_empty() || last.triangles.len() > many {
                break;
            }
            let still = last
                .triangles
                .clone()
                .filter(|&place| !edits.gone.has(place));
            let order = self.order.triangle_order();
            coming.extend(still.map(|place| order[place as usize]));
            start = (last.triangles.start, last.first_vertex);
            self.parts.others.pop();
        }
        if coming.is_empty() {
            return;
        }
        coming.sort_unstable();
        let (first, first_vertex) = start;
        // Positions of the vertices that are used, and corners by them.
        let corners: Vec<[u32; 3]> = coming
            .iter()
            .map(|&triangle| self.topology.triangles()[triangle as usize])
            .collect();
        let mut used: Vec<u32> = corners.as_flattened().to_vec();
        used.sort_unstable();
        used.dedup();
        let vertex_order = self.order.vertex_order();
        let position = |vertex: &u32| {
            self.positions
                .get(edits.slots[*vertex as usize], vertex_order)
        };
        let positions: Vec<[S; 3]> = used.iter().map(position).collect();
        let place = |vertex: u32| used.partition_point(|&it| it < vertex) as u32;
        let corners: Vec<[u32; 3]> = corners.into_iter().map(|it| it.map(place)).collect();
        let mut plan = divide(&corners, &positions, options)
            .with_numbers(&coming)
            .behind(first);
        let order = std::mem::take(&mut plan.order);

        edits.gone.cut_back(first);
        let (triangles, used) = (first as usize, first_vertex.index());
        let all = &mut self.positions;
        self.order
            .cut_back(triangles, used, &mut edits.slots, |moved| {
                all.follow(&moved);
            });
        let all = &mut self.positions;
        self.order
            .append(&self.topology, &order, &mut edits.slots, |moved| {
                all.follow(&moved);
            });
        for (place, &triangle) in (first..).zip(&order) {
            edits.places[triangle as usize] = place;
        }
        let tree = Tree::new(&plan, &self.order, first_vertex);
        let end = first + order.len() as u32;
        self.parts
            .others
            .push(Part::new(tree, first..end, first_vertex));
        if let Some(elements) = self.elements.get_mut() {
            elements.append(
                &self.order,
                &edits.gone,
                TreeTriangle(first),
                first_vertex.0,
            );
        }
    }

    /// Checks that every triangle is in the trees once, with the corners that it has.
    pub(crate) fn validate_edits(&self) -> Result<(), String> {
        let mut seen = vec![false; self.triangle_numbers()];
        for place in (0..self.triangle_count() as u32).map(TreeTriangle) {
            if self.is_gone(place) {
                continue;
            }
            let triangle = self.order.caller_triangle(place);
            let corners = self
                .order
                .corners(place)
                .map(|it| self.order.caller_vertex(it));
            let is_first = seen
                .get_mut(triangle.index())
                .map(|seen| !std::mem::replace(seen, true));
            if is_first != Some(true) || corners != self.topology.corners(triangle) {
                return Err(format!("{place:?} is not {triangle:?}, or once too often"));
            }
        }
        if let Some(edits) = &self.edits {
            let has_place = |vertex: u32| {
                let slot = edits.slots[vertex as usize];
                !self.order.orphans().has(slot.0) && self.order.caller_vertex(slot).0 == vertex
            };
            if let Some(vertex) = (0..self.vertex_count() as u32).find(|&it| !has_place(it)) {
                return Err(format!("vertex {vertex} is not where it is said to be"));
            }
            let slot = |vertex: u32| edits.slots[vertex as usize];
            let elements = self.elements.get();
            if let Some(elements) = elements
                && let Some(edge) = elements.misplaced(slot)
            {
                return Err(format!("edge {edge} has ends that are not its own"));
            }
        }
        let is_live = |triangle: usize| self.topology.is_live(triangle as u32);
        match (0..seen.len()).find(|&triangle| seen[triangle] != is_live(triangle)) {
            Some(triangle) => Err(format!(
                "triangle {triangle}: in no tree, or in one and empty"
            )),
            None => Ok(()),
        }
    }

    /// The same body with another mesh, whose tree is built.
    fn with_mesh(&self, triangles: &[[u32; 3]], positions: &[[S; 3]], options: &Options) -> Self {
        let mut new = Self::new(self.id, triangles, positions, options);
        new.epoch = self.epoch + 1;
        new.meshes = self.meshes + 1;
        new.revision = self.revision + 1;
        new.loose = self.loose;
        let (membership, mask) = self.filter();
        new.set_filter(membership, mask);
        new
    }
}
