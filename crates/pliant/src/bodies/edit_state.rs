//! What a body keeps once its mesh is edited: where its triangles and vertices are in tree order, and which are there no more.

use crate::held::{self, held};
use crate::ids::{CallerVertex, TreeVertex};
use crate::mesh::{
    Bits, Changed, Draft, EMPTY, Elements, Moved, Order, Outcome, Topology, TrianglesAt,
};
use crate::queries::Removed;
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// No place.
const NOWHERE: u32 = u32::MAX;

/// What a body keeps once its mesh is edited.
#[derive(Clone)]
pub(crate) struct EditState<S> {
    /// For each of the caller's triangles its place in tree order.
    places: Vec<u32>,
    /// For each of the caller's vertices its number in tree order.
    slots: Vec<TreeVertex>,
    at: TrianglesAt,
    /// Triangles in tree order that were taken out.
    gone: Bits,
    /// Vertices, as the caller numbers them, that are empty.
    empty: Bits,
    /// By the caller's number of an alias, the orphans in tree order that stand where it does; some of these may have another by now.
    orphans_of: BTreeMap<u32, Vec<u32>>,
    /// A shape in which those that are empty are somewhere, kept from shape to shape.
    patched: Vec<[S; 3]>,
    /// All vertices in tree order, once somebody asks and there are orphans.
    without_orphans: OnceLock<Vec<u32>>,
}

impl<S: Copy> EditState<S> {
    pub(crate) fn new(topology: &Topology, order: &Order) -> Self {
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

    /// All triangles that there are are in this order, and none that was taken out.
    pub(crate) fn find_places(&mut self, order: &Order) {
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

    /// A triangle has no place any more, if it had one.
    pub(crate) fn take_out(&mut self, triangle: u32) {
        let place = std::mem::replace(&mut self.places[triangle as usize], NOWHERE);
        if place != NOWHERE {
            self.gone.insert(place);
        }
    }

    /// What was taken out, if anything was.
    pub(crate) fn removed<'b>(&'b self, order: &'b Order) -> Option<Removed<'b>> {
        let is_any = self.gone.count() > 0 || order.orphans().count() > 0;
        is_any.then_some(Removed {
            triangles: &self.gone,
            vertices: order.orphans(),
        })
    }

    /// A shape in which vertices that are empty are where one is that is used.
    pub(crate) fn patch<'p>(&'p mut self, positions: &'p [[S; 3]], order: &Order) -> &'p [[S; 3]] {
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

    /// All vertices in tree order, without orphans.
    pub(crate) fn vertex_order(&self, order: &Order) -> &[u32] {
        self.without_orphans.get_or_init(|| {
            let all = (0..).zip(order.vertex_order());
            let vertices = all.filter(|(slot, _)| !order.orphans().has(*slot));
            vertices.map(|(_, &vertex)| vertex).collect()
        })
    }

    /// Where a vertex is in tree order.
    #[inline]
    pub(crate) fn slot(&self, vertex: u32) -> TreeVertex {
        self.slots[vertex as usize]
    }

    /// Where all vertices are in tree order.
    pub(crate) fn slots(&self) -> &[TreeVertex] {
        &self.slots
    }

    /// Triangles in tree order that were taken out.
    #[inline]
    pub(crate) fn gone(&self) -> &Bits {
        &self.gone
    }

    /// Vertices, as the caller numbers them, that are empty.
    pub(crate) fn empty(&self) -> &Bits {
        &self.empty
    }

    /// Whether a vertex has triangles.
    fn is_used(&self, vertex: u32) -> bool {
        self.at.of(vertex).next().is_some()
    }

    /// A draft of an edit, without steps.
    pub(crate) fn draft<'m>(
        &'m self,
        topology: &'m Topology,
        position_of: &'m dyn Fn(u32) -> [S; 3],
    ) -> Draft<'m, S> {
        Draft::new(topology, &self.at, &self.empty, position_of)
    }

    /// Gives triangles the corners that an edit gives them, in the caller's numbers; nothing in tree order.
    pub(crate) fn change(
        &mut self,
        topology: &mut Topology,
        elements: Option<&mut Elements>,
        outcome: &Outcome<S>,
    ) {
        let changed = &outcome.changed;
        for &(triangle, [old, _]) in changed {
            self.at.unlink(triangle, old);
        }
        let numbers = outcome.triangles.max(topology.triangles().len());
        let vertices = outcome.vertices.max(topology.vertex_count());
        self.at.resize(vertices, numbers);
        for &(triangle, [_, new]) in changed {
            topology.set(triangle, new);
            self.at.link(triangle, new);
        }
        if let Some(elements) = elements {
            elements.follow(changed, topology, &self.at);
        }
        self.at.resize(outcome.vertices, outcome.triangles);
        topology.set_vertex_count(outcome.vertices);
        topology.set_triangle_count(outcome.triangles);
    }

    /// Takes out of tree order what has other corners or none now. Returns what comes.
    pub(crate) fn take_out_changed(&mut self, outcome: &Outcome<S>) -> Vec<u32> {
        self.without_orphans.take();
        let numbers = outcome.triangles.max(self.places.len());
        self.places.resize(numbers, NOWHERE);
        let mut coming = Vec::new();
        for &(triangle, [_, new]) in &outcome.changed {
            self.take_out(triangle);
            if new != EMPTY {
                coming.push(triangle);
            }
        }
        self.places.truncate(outcome.triangles);
        coming
    }

    /// Vertices come behind all others, which no triangle in tree order has yet.
    pub(crate) fn add_vertices(&mut self, order: &mut Order, count: usize) {
        let slots = order.vertex_order().len() as u32..;
        let first = self.slots.len() as u32;
        self.slots.extend(slots.map(TreeVertex).take(count));
        order.add_vertices(first..first + count as u32);
    }

    /// A vertex that was empty is there again, or one that was there is empty.
    pub(crate) fn set_empty(&mut self, vertex: u32, is_empty: bool) {
        if is_empty {
            self.empty.insert(vertex);
        } else {
            self.empty.remove(vertex);
        }
    }

    /// No vertex is empty any more.
    pub(crate) fn fill_all(&mut self) {
        self.empty = Bits::default();
    }

    /// Vertices that lose their last triangle go to the end of tree order, and leave orphans: `left` is told which. These stand where
    /// vertices do that are near them in the tree, each where another does: boxes over nothing but orphans are as large as others, and
    /// no more of them are in one place.
    pub(crate) fn leave_orphans(
        &mut self,
        topology: &Topology,
        order: &mut Order,
        changed: &[Changed],
        mut left: impl FnMut(TreeVertex),
    ) {
        let lost = self.lost(changed, order.used_vertices());
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
            // The mirror image in the beginning of the run, in which all are lost.
            let mirrored = run.start.checked_sub(1 + slot - run.start);
            let near = mirrored.map(|slot| order.caller_vertex(TreeVertex(slot)).0);
            let mut candidates = beside.into_iter().chain(near);
            let is_good = |&vertex: &u32| {
                self.is_used(vertex) && !lost.contains_key(&self.slots[vertex as usize])
            };
            let alias = candidates.find(is_good);
            let alias = alias.unwrap_or_else(|| *any.get_or_insert_with(some));
            let vertex = order.caller_vertex(TreeVertex(slot)).0;
            self.slots[vertex as usize] = order.orphan(TreeVertex(slot), alias);
            left(TreeVertex(slot));
            let mut orphans = self.orphans_of.remove(&vertex).unwrap_or_default();
            orphans.retain(|&orphan| order.set_alias(orphan, vertex, alias));
            orphans.push(slot);
            self.orphans_of.entry(alias).or_default().extend(orphans);
        }
    }

    /// Where vertices are, of which so many are used in tree order, that lose their last triangle; and a vertex that stays beside each, if
    /// there is one.
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

    /// Puts triangles behind those before a place, in this order; these are the first to use vertices from another place on. What is
    /// behind now is forgotten; where numbers of vertices become others, `moved` is told.
    pub(crate) fn append(
        &mut self,
        topology: &Topology,
        order: &mut Order,
        (first, first_vertex): (u32, TreeVertex),
        triangles: &[u32],
        mut moved: impl FnMut(Moved),
    ) {
        self.gone.cut_back(first);
        let used = first_vertex.index();
        order.cut_back(first as usize, used, &mut self.slots, &mut moved);
        order.append(topology, triangles, &mut self.slots, moved);
        for (place, &triangle) in (first..).zip(triangles) {
            self.places[triangle as usize] = place;
        }
    }

    /// Checks that every vertex is where it is said to be, and so are the ends of edges, if these are known.
    pub(crate) fn validate(
        &self,
        order: &Order,
        elements: Option<&Elements>,
    ) -> Result<(), String> {
        let has_place = |vertex: u32| {
            let slot = self.slot(vertex);
            !order.orphans().has(slot.0) && order.caller_vertex(slot) == CallerVertex(vertex)
        };
        if let Some(vertex) = (0..self.slots.len() as u32).find(|&it| !has_place(it)) {
            return Err(format!("vertex {vertex} is not where it is said to be"));
        }
        let misplaced = elements.and_then(|it| it.misplaced(|vertex| self.slot(vertex)));
        match misplaced {
            Some(edge) => Err(format!("edge {edge} has ends that are not its own")),
            None => Ok(()),
        }
    }
}

held!(EditState<S>: places[], slots[], at, gone, empty, patched[]; |edits| {
    held::entries::<(u32, Vec<u32>)>(edits.orphans_of.len())
        + edits.orphans_of.values().map(held::list).sum::<usize>()
        + edits.without_orphans.get().map_or(0, held::list)
});
