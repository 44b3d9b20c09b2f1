//! What a body keeps once its mesh is edited: where its triangles and vertices are in tree order, and which are there no more.
//!
//! A vertex that is empty still is a corner of triangles that were taken out, whose boxes are made with the others: it takes the place of
//! another vertex that was near it, its *alias*.

use crate::held::{self, Held};
use crate::ids::TreeVertex;
use crate::mesh::{Bits, Order, Topology, TrianglesAt};
use crate::queries::Removed;
use std::collections::BTreeMap;

/// No place.
pub(super) const NOWHERE: u32 = u32::MAX;

/// What a body keeps once its mesh is edited.
#[derive(Clone)]
pub(super) struct EditState<S> {
    /// For each of the caller's triangles its place in tree order.
    pub(super) places: Vec<u32>,
    /// For each of the caller's vertices its number in tree order.
    pub(super) slots: Vec<TreeVertex>,
    pub(super) at: TrianglesAt,
    /// Triangles in tree order that were taken out.
    pub(super) gone: Bits,
    /// Vertices, as the caller numbers them, that no triangle has any more, but some that was taken out.
    pub(super) unused: Bits,
    /// Those of them that are empty: all but what `set_mesh` left without triangles.
    pub(super) empty: Bits,
    /// For each of these another vertex, perhaps empty too.
    pub(super) aliases: BTreeMap<u32, u32>,
    /// A shape with the positions of aliases, kept from shape to shape.
    patched: Vec<[S; 3]>,
}

impl<S: Copy> EditState<S> {
    pub(super) fn new(topology: &Topology, order: &Order) -> Self {
        let mut edits = Self {
            places: Vec::new(),
            slots: Vec::new(),
            at: TrianglesAt::new(topology.triangles(), topology.vertex_count()),
            gone: Bits::default(),
            unused: Bits::default(),
            empty: Bits::default(),
            aliases: BTreeMap::new(),
            patched: Vec::new(),
        };
        edits.places.resize(topology.triangles().len(), NOWHERE);
        edits.find_places(order);
        edits
    }

    /// All triangles that there are are in this order, and none that was taken out.
    pub(super) fn find_places(&mut self, order: &Order) {
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
        self.unused = Bits::default();
    }

    /// What was taken out, if anything was.
    pub(super) fn removed<'b>(&'b self, order: &'b Order) -> Option<Removed<'b>> {
        let is_any = self.gone.count() > 0 || self.unused.count() > 0;
        is_any.then_some(Removed {
            triangles: &self.gone,
            vertices: &self.unused,
            order,
        })
    }

    /// A shape in which vertices that are empty are where their aliases are.
    pub(super) fn patch<'p>(&'p mut self, positions: &'p [[S; 3]]) -> &'p [[S; 3]] {
        if self.aliases.is_empty() || positions.len() != self.slots.len() {
            return positions;
        }
        self.patched.clear();
        self.patched.extend_from_slice(positions);
        for &vertex in self.aliases.keys() {
            self.patched[vertex as usize] = positions[self.alias(vertex) as usize];
        }
        &self.patched
    }

    /// The vertex that is not empty in whose place an empty one is. A vertex becomes the alias of others only while it is not empty, so
    /// this ends.
    pub(super) fn alias(&self, mut vertex: u32) -> u32 {
        while let Some(&other) = self.aliases.get(&vertex) {
            vertex = other;
        }
        vertex
    }
}

impl<S> Held for EditState<S> {
    fn held(&self) -> usize {
        held::list(&self.places)
            + held::list(&self.slots)
            + self.at.held()
            + self.gone.held()
            + self.empty.held()
            + held::entries::<(u32, u32)>(self.aliases.len())
            + held::list(&self.patched)
    }
}
