//! The mesh of a body, in the caller's numbers and in tree order.

mod edits;

use super::shape::NewShape;
use crate::geometry::Points;
use crate::held::{self, held};
use crate::ids::{BodyId, TreeTriangle, TreeVertex};
use crate::kernels::Coordinate;
use crate::mesh::{Bits, EMPTY, Elements, Order, Topology, TrianglesAt};
use crate::queries::Removed;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::OnceLock;

/// The mesh of a body, with the lists that edits and queries of elements need.
pub(crate) struct BodyMesh<S> {
    body: BodyId,
    topology: Topology,
    order: Order,
    /// Edges, and which triangle owns what, once somebody asks.
    elements: OnceLock<Box<Elements>>,
    /// Whether somebody asked for edges before the tree was exchanged or the body was copied.
    edges_were_known: bool,
    /// Present once the mesh was edited.
    edits: Option<Box<Edits<S>>>,
    /// Counts meshes.
    version: u64,
    /// Counts meshes, and orders of a mesh.
    order_version: u64,
}

/// Lists of a mesh that was edited: where things are in tree order, and which are gone.
#[derive(Clone)]
pub(crate) struct Edits<S> {
    /// For each of the caller's triangles its place in tree order.
    places: Vec<u32>,
    /// For each of the caller's vertices its number in tree order.
    slots: Vec<TreeVertex>,
    at: TrianglesAt,
    /// Triangles in tree order that were taken out.
    gone: Bits,
    /// Vertices, as the caller numbers them, that are empty.
    empty: Bits,
    /// By the caller's number of an alias, the orphans in tree order that stand where it does; some
    /// of these may have another by now.
    orphans_of: BTreeMap<u32, Vec<u32>>,
    /// A shape in which empty vertices are somewhere; memory that is kept from shape to shape.
    patched: Vec<[S; 3]>,
    /// All vertices in tree order, once somebody asks and there are orphans.
    without_orphans: OnceLock<Vec<u32>>,
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
    pub(crate) fn new(body: BodyId, topology: Topology, order: Order) -> Self {
        Self {
            body,
            topology,
            order,
            elements: OnceLock::new(),
            edges_were_known: false,
            edits: None,
            version: 0,
            order_version: 0,
        }
    }

    /// Takes the place of another mesh of the same body: versions go on from there.
    pub(crate) fn succeed(&mut self, before: &Self) {
        self.version = before.version + 1;
        self.order_version = before.order_version + 1;
    }

    /// Copies the mesh. Edges are found out again, unless an edit has kept their numbers.
    pub(crate) fn copy(&self) -> Self {
        let known = self.elements.get().filter(|known| known.follows());
        Self {
            topology: self.topology.clone(),
            order: self.order.clone(),
            elements: known.map_or_else(OnceLock::new, |known| OnceLock::from(known.clone())),
            edges_were_known: self.edges_are_known(),
            edits: self.edits.clone(),
            ..*self
        }
    }

    /// The body that has this mesh.
    #[inline]
    pub(crate) fn body(&self) -> BodyId {
        self.body
    }

    #[inline]
    pub(crate) fn topology(&self) -> &Topology {
        &self.topology
    }

    /// The triangles as the caller numbers them, empty numbers included.
    pub(crate) fn triangles(&self) -> &[[u32; 3]] {
        self.topology.triangles()
    }

    pub(crate) fn vertex_count(&self) -> usize {
        self.topology.vertex_count()
    }

    /// The version of mesh and order together.
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
        edits.is_some_and(|edits| edits.empty.has(vertex))
    }

    /// How many numbers are those of no vertex.
    fn empty_count(&self) -> usize {
        let edits = self.edits.as_ref();
        edits.map_or(0, |edits| edits.empty.count())
    }

    /// Whether a triangle or a vertex is gone whose number was not used again.
    pub(crate) fn has_empty_numbers(&self) -> bool {
        self.topology.live_count() < self.triangles().len() || self.empty_count() > 0
    }

    /// The elements; they are found out the first time, unless `stop` says so on the way.
    pub(crate) fn elements(&self, stop: &dyn Fn() -> bool) -> Option<&Elements> {
        self.known_elements().or_else(|| {
            let new = Elements::new(&self.topology, &self.order, stop)?;
            Some(self.elements.get_or_init(|| Box::new(new)))
        })
    }

    /// The elements, if they are known.
    pub(crate) fn known_elements(&self) -> Option<&Elements> {
        self.elements.get().map(Box::as_ref)
    }

    /// Whether the edges have numbers that stay: from when somebody asks for them on.
    fn edges_are_known(&self) -> bool {
        self.edges_were_known || self.elements.get().is_some()
    }

    /// The edges, as the caller numbers them.
    pub(crate) fn edges(&self) -> &[[u32; 2]] {
        self.elements(&|| false).map_or(&[], Elements::callers)
    }

    /// The edges, if they have numbers that stay.
    pub(crate) fn numbered_edges(&self) -> Option<&[[u32; 2]]> {
        self.edges_are_known().then(|| self.edges())
    }

    /// Numbers the edges as another body with this mesh does. Returns false if these are not its
    /// edges, or if they have numbers already.
    pub(crate) fn number_edges(&mut self, edges: &[[u32; 2]]) -> bool {
        let is_new = !self.edges_are_known() && self.elements(&|| false).is_some();
        let (elements, topology) = (self.elements.get_mut(), &self.topology);
        is_new && elements.is_some_and(|elements| elements.renumber(edges, topology))
    }

    #[inline]
    pub(crate) fn order(&self) -> &Order {
        &self.order
    }

    /// The number of triangles in tree order, with the ones that were only marked as taken out.
    pub(crate) fn tree_triangles(&self) -> usize {
        self.order.all_corners().len()
    }

    /// Whether a triangle in tree order was taken out of the mesh.
    #[inline]
    pub(crate) fn is_gone(&self, triangle: TreeTriangle) -> bool {
        let edits = self.edits.as_ref();
        edits.is_some_and(|edits| edits.gone.has(triangle.0))
    }

    /// The caller's numbers of the triangles of a run in tree order that were not taken out.
    pub(crate) fn still_there(&self, run: Range<u32>) -> impl Iterator<Item = u32> {
        let there = run.map(TreeTriangle).filter(|&place| !self.is_gone(place));
        there.map(|place| self.order.caller_triangle(place).0)
    }

    /// The number of triangles that were taken out, or came behind the first part, which has
    /// `first`.
    pub(crate) fn out_of_date(&self, first: usize) -> usize {
        let gone = self.edits.as_ref().map_or(0, |edits| edits.gone.count());
        self.tree_triangles() - first + gone
    }

    /// The triangles and vertices that were taken out, if there are any.
    pub(crate) fn removed(&self) -> Option<Removed<'_>> {
        let (triangles, vertices) = (&self.edits.as_ref()?.gone, self.order.orphans());
        let is_any = triangles.count() > 0 || vertices.count() > 0;
        is_any.then_some(Removed {
            triangles,
            vertices,
        })
    }

    /// All vertices, in the order in which triangles in tree order first use them.
    pub(crate) fn vertex_order(&self) -> &[u32] {
        let (all, orphans) = (self.order.vertex_order(), self.order.orphans());
        match &self.edits {
            Some(edits) if orphans.count() > 0 => edits.without_orphans.get_or_init(|| {
                let vertices = (0..).zip(all).filter(|(slot, _)| !orphans.has(*slot));
                vertices.map(|(_, &vertex)| vertex).collect()
            }),
            _ => all,
        }
    }

    /// Where the corners of a triangle are in tree order. Its place there is used as long as the
    /// mesh was not edited, its corners as the caller numbers them after that.
    pub(crate) fn slots(&self, place: usize, corners: [u32; 3]) -> [TreeVertex; 3] {
        match &self.edits {
            Some(edits) => corners.map(|vertex| edits.slots[vertex as usize]),
            None => self.order.corners(TreeTriangle(place as u32)),
        }
    }

    /// Where the corners of elements are in a shape in tree order, as the caller numbers them.
    pub(crate) fn places<'b>(&'b self, positions: &'b Points<S>) -> Option<Places<'b, S>> {
        let elements = self.elements(&|| false)?;
        Some(Places {
            triangles: self.triangles(),
            edges: elements.callers(),
            tree_vertices: match &self.edits {
                Some(edits) => &edits.slots,
                None => elements.tree_vertices(&self.order),
            },
            positions,
        })
    }

    /// A new shape, made of positions: empty vertices are put where another vertex is.
    pub(crate) fn new_shape<'n>(&'n mut self, positions: &'n [[S; 3]]) -> NewShape<'n, S> {
        let empty = self.empty_count();
        let used = self.order.used_vertices() - self.order.orphans().count();
        let are_all_used = used + empty >= self.vertex_count();
        let positions = match &mut self.edits {
            Some(edits) => edits.patch(positions, &self.order),
            None => positions,
        };
        NewShape {
            positions,
            order: &self.order,
            are_all_used,
        }
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
}

held!(Edits<S>: places[], slots[], at, gone, empty, patched[]; |edits| {
    held::entries::<(u32, Vec<u32>)>(edits.orphans_of.len())
        + edits.orphans_of.values().map(held::list).sum::<usize>()
        + edits.without_orphans.get().map_or(0, held::list)
});
held!(BodyMesh<S>: topology, order; |mesh| {
    held::boxes(mesh.elements.get()) + held::boxes(&mesh.edits)
});
