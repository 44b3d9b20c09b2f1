//! What a body keeps once its mesh is edited: where its triangles and vertices are in tree order, and which are there no more.

use crate::held::{self, held};
use crate::ids::TreeVertex;
use crate::mesh::{Bits, Order, Topology, TrianglesAt};
use crate::queries::Removed;
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// No place.
pub(crate) const NOWHERE: u32 = u32::MAX;

/// What a body keeps once its mesh is edited.
#[derive(Clone)]
pub(crate) struct EditState<S> {
    /// For each of the caller's triangles its place in tree order.
    pub(crate) places: Vec<u32>,
    /// For each of the caller's vertices its number in tree order.
    pub(crate) slots: Vec<TreeVertex>,
    pub(crate) at: TrianglesAt,
    /// Triangles in tree order that were taken out.
    pub(crate) gone: Bits,
    /// Vertices, as the caller numbers them, that are empty.
    pub(crate) empty: Bits,
    /// By the caller's number of an alias, the orphans in tree order that stand where it does; some of these may have another by now.
    pub(crate) orphans_of: BTreeMap<u32, Vec<u32>>,
    /// A shape in which those that are empty are somewhere, kept from shape to shape.
    patched: Vec<[S; 3]>,
    /// All vertices in tree order, once somebody asks and there are orphans.
    pub(crate) without_orphans: OnceLock<Vec<u32>>,
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

    /// Whether a vertex has triangles.
    pub(crate) fn is_used(&self, vertex: u32) -> bool {
        self.at.of(vertex).next().is_some()
    }
}

held!(EditState<S>: places[], slots[], at, gone, empty, patched[]; |edits| {
    held::entries::<(u32, Vec<u32>)>(edits.orphans_of.len())
        + edits.orphans_of.values().map(held::list).sum::<usize>()
        + edits.without_orphans.get().map_or(0, held::list)
});
