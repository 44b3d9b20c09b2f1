//! Mesh of a body, in the caller's numbers and in tree order.

mod edits;

use super::shape::NewShape;
use crate::error::ErrorKind;
use crate::geometry::Points;
use crate::held::{self, held};
use crate::ids::{BodyId, TreeTriangle, TreeVertex};
use crate::kernels::Coordinate;
use crate::mesh::{Bits, EMPTY, Elements, Order, Stars, Topology, TrianglesAt, Watertight};
use crate::queries::{OwnEdges, Removed};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::OnceLock;

/// Mesh of a body, with the lists that edits and queries of elements need.
pub(crate) struct BodyMesh<S> {
    body: BodyId,
    topology: Topology,
    order: Order,
    /// Edges, and which triangle owns which elements. Made when first needed.
    elements: OnceLock<Box<Elements>>,
    /// Whether edges were asked for before the tree was exchanged or the body was copied.
    edges_were_known: bool,
    /// Stars of vertices. Made when first needed.
    stars: OnceLock<Box<Stars>>,
    /// Edges at which the mesh is not closed. Made when first needed.
    watertight: OnceLock<Box<Watertight>>,
    /// Lists that edits need. Present once the mesh was edited.
    edits: Option<Box<Edits<S>>>,
    /// Version of the mesh: counts its changes.
    version: u64,
    /// Version of mesh and order together: counts changes of either.
    order_version: u64,
}

/// Lists of an edited mesh: places in tree order, and removed triangles and vertices.
#[derive(Clone)]
pub(crate) struct Edits<S> {
    /// Place in tree order of each of the caller's triangles.
    places: Vec<u32>,
    /// Number in tree order of each of the caller's vertices.
    slots: Vec<TreeVertex>,
    at: TrianglesAt,
    /// Removed triangles, in tree order.
    gone: Bits,
    /// Empty vertices, by the caller's numbers.
    empty: Bits,
    /// Orphans in tree order that stand where an alias does, by the caller's number of the alias.
    /// Some may have another alias by now.
    orphans_of: BTreeMap<u32, Vec<u32>>,
    /// Scratch memory for a shape in which empty vertices are somewhere.
    patched: Vec<[S; 3]>,
    /// All vertices in tree order without orphans. Made when first needed, if there are orphans.
    without_orphans: OnceLock<Vec<u32>>,
}

/// Positions of the corners of a body's elements, by the caller's numbers.
pub(crate) struct Places<'b, S> {
    triangles: &'b [[u32; 3]],
    edges: &'b [[u32; 2]],
    /// Number in tree order, in which positions are, of each vertex.
    tree_vertices: &'b [TreeVertex],
    positions: &'b Points<S>,
}

impl<'b, S> Places<'b, S> {
    /// Position of a vertex, with padding.
    #[inline(always)]
    pub(crate) fn vertex(&self, vertex: u32) -> &'b [S; 4] {
        self.positions.padded(self.tree_vertices[vertex as usize])
    }

    /// Positions of the ends of an edge.
    #[inline(always)]
    pub(crate) fn edge(&self, edge: u32) -> [&'b [S; 4]; 2] {
        let [a, b] = self.edges[edge as usize];
        [self.vertex(a), self.vertex(b)]
    }

    /// Positions of the corners of a triangle.
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
            stars: OnceLock::new(),
            watertight: OnceLock::new(),
            edits: None,
            version: 0,
            order_version: 0,
        }
    }

    /// Continues the versions of the mesh that this one replaces in the same body.
    pub(crate) fn succeed(&mut self, before: &Self) {
        self.version = before.version + 1;
        self.order_version = before.order_version + 1;
    }

    /// Copies the mesh. Edges are found again, unless an edit has kept their numbers.
    pub(crate) fn copy(&self) -> Self {
        let known = self.elements.get().filter(|known| known.follows());
        Self {
            topology: self.topology.clone(),
            order: self.order.clone(),
            elements: known.map_or_else(OnceLock::new, |known| OnceLock::from(known.clone())),
            edges_were_known: self.edges_are_known(),
            stars: OnceLock::new(),
            watertight: self.watertight.clone(),
            edits: self.edits.clone(),
            ..*self
        }
    }

    /// Id of the body that has this mesh.
    #[inline]
    pub(crate) fn body(&self) -> BodyId {
        self.body
    }

    #[inline]
    pub(crate) fn topology(&self) -> &Topology {
        &self.topology
    }

    /// Triangles by the caller's numbers, including empty numbers.
    pub(crate) fn triangles(&self) -> &[[u32; 3]] {
        self.topology.triangles()
    }

    pub(crate) fn vertex_count(&self) -> usize {
        self.topology.vertex_count()
    }

    /// Version of mesh and order together.
    pub(crate) fn order_version(&self) -> u64 {
        self.order_version
    }

    /// Whether each number of a triangle is in use.
    pub(crate) fn live_triangles(&self) -> Vec<bool> {
        let triangles = self.triangles().iter();
        triangles.map(|&corners| corners != EMPTY).collect()
    }

    /// Whether each number of a vertex is in use.
    pub(crate) fn live_vertices(&self) -> Vec<bool> {
        let vertices = 0..self.vertex_count() as u32;
        vertices.map(|vertex| !self.is_empty(vertex)).collect()
    }

    /// Whether a number of a vertex is not in use.
    pub(crate) fn is_empty(&self, vertex: u32) -> bool {
        let edits = self.edits.as_ref();
        edits.is_some_and(|edits| edits.empty.has(vertex))
    }

    /// Number of vertex numbers that are not in use.
    fn empty_count(&self) -> usize {
        let edits = self.edits.as_ref();
        edits.map_or(0, |edits| edits.empty.count())
    }

    /// Whether any number of a triangle or a vertex is not in use.
    pub(crate) fn has_empty_numbers(&self) -> bool {
        self.topology.live_count() < self.triangles().len() || self.empty_count() > 0
    }

    /// Edges and owners of elements. Computed the first time; none if `stop` interrupts that.
    pub(crate) fn elements(&self, stop: &dyn Fn() -> bool) -> Option<&Elements> {
        self.known_elements().or_else(|| {
            let new = Elements::new(&self.topology, &self.order, stop)?;
            Some(self.elements.get_or_init(|| Box::new(new)))
        })
    }

    /// Edges and owners of elements, if they are known.
    pub(crate) fn known_elements(&self) -> Option<&Elements> {
        self.elements.get().map(Box::as_ref)
    }

    /// Whether edges have numbers that stay: from the first time that they are asked for.
    fn edges_are_known(&self) -> bool {
        self.edges_were_known || self.elements.get().is_some()
    }

    /// Edges by the caller's numbers.
    pub(crate) fn edges(&self) -> &[[u32; 2]] {
        self.elements(&|| false).map_or(&[], Elements::callers)
    }

    /// Edges of a triangle, from each corner to the next. None where the two are one vertex.
    pub(crate) fn sides(&self, triangle: u32) -> [Option<u32>; 3] {
        let elements = self.elements(&|| false);
        elements.map_or([None; 3], |it| it.sides(&self.topology, triangle))
    }

    /// Edges, if they have numbers that stay.
    pub(crate) fn numbered_edges(&self) -> Option<&[[u32; 2]]> {
        self.edges_are_known().then(|| self.edges())
    }

    /// Numbers the edges as another body with this mesh does.
    ///
    /// Returns false if these are not its edges, or if they have numbers already.
    pub(crate) fn number_edges(&mut self, edges: &[[u32; 2]]) -> bool {
        let is_new = !self.edges_are_known() && self.elements(&|| false).is_some();
        let (elements, topology) = (self.elements.get_mut(), &self.topology);
        is_new && elements.is_some_and(|elements| elements.renumber(edges, topology))
    }

    /// Numbers the edges as given, unless the mesh was edited. They are the mesh's, each once.
    pub(crate) fn set_edges(&mut self, edges: &[[u32; 2]]) -> Result<(), ErrorKind> {
        if self.edits.is_some() {
            return Err(ErrorKind::EditedMesh);
        }
        let edges: Vec<[u32; 2]> = edges.iter().map(|&[a, b]| [a.min(b), a.max(b)]).collect();
        let Some(mut new) = Elements::new(&self.topology, &self.order, &|| false) else {
            return Ok(());
        };
        let mut given: Vec<([u32; 2], u32)> = edges.iter().copied().zip(0..).collect();
        given.sort_unstable();
        let mut given = given.into_iter();
        for &ends in new.callers() {
            match given.next() {
                Some((known, _)) if known == ends => {}
                Some((other, edge)) if other < ends => {
                    let ends = other;
                    return Err(ErrorKind::NotAnEdge { edge, ends });
                }
                _ => return Err(ErrorKind::MissingEdge { ends }),
            }
        }
        if let Some((ends, edge)) = given.next() {
            return Err(ErrorKind::NotAnEdge { edge, ends });
        }
        new.renumber(&edges, &self.topology);
        self.elements = OnceLock::from(Box::new(new));
        Ok(())
    }

    #[inline]
    pub(crate) fn order(&self) -> &Order {
        &self.order
    }

    /// Number of triangles in tree order, including triangles that are marked as removed.
    pub(crate) fn tree_triangles(&self) -> usize {
        self.order.all_corners().len()
    }

    /// Whether a triangle in tree order was removed from the mesh.
    #[inline]
    pub(crate) fn is_gone(&self, triangle: TreeTriangle) -> bool {
        let edits = self.edits.as_ref();
        edits.is_some_and(|edits| edits.gone.has(triangle.0))
    }

    /// Caller's numbers of the triangles of a run in tree order that were not removed.
    pub(crate) fn still_there(&self, run: Range<u32>) -> impl Iterator<Item = u32> {
        let there = run.map(TreeTriangle).filter(|&place| !self.is_gone(place));
        there.map(|place| self.order.caller_triangle(place).0)
    }

    /// Number of triangles that were removed, or came behind the first part, which has `first`.
    pub(crate) fn out_of_date(&self, first: usize) -> usize {
        let gone = self.edits.as_ref().map_or(0, |edits| edits.gone.count());
        self.tree_triangles() - first + gone
    }

    /// Removed triangles and vertices that are still in the trees, if there are any.
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

    /// Numbers in tree order of the corners of a triangle.
    ///
    /// Its place in tree order is used until the mesh is edited, the caller's numbers of its
    /// corners after that.
    pub(crate) fn slots(&self, place: usize, corners: [u32; 3]) -> [TreeVertex; 3] {
        match &self.edits {
            Some(edits) => corners.map(|vertex| edits.slots[vertex as usize]),
            None => self.order.corners(TreeTriangle(place as u32)),
        }
    }

    /// Positions of the corners of elements in a shape in tree order, by the caller's numbers.
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

    /// Stars of all vertices. Computed the first time; none if `stop` interrupts that.
    pub(crate) fn stars(&self, stop: &dyn Fn() -> bool) -> Option<&Stars> {
        let known = self.stars.get().map(Box::as_ref);
        known.or_else(|| {
            let new = Stars::new(self.triangles(), self.vertex_count(), stop)?;
            Some(self.stars.get_or_init(|| Box::new(new)))
        })
    }

    /// Edges at which the mesh is not closed. Computed the first time.
    pub(crate) fn watertight(&self) -> &Watertight {
        let make = || Box::new(Watertight::of(self.triangles()));
        self.watertight.get_or_init(make)
    }

    /// A new shape from positions, in which empty vertices are put where another vertex is.
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

    /// Positions in which empty vertices are NaN.
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

impl<S: Coordinate> OwnEdges for BodyMesh<S> {
    /// In an edited mesh the smallest triangle at an edge has it, else the first in tree order.
    fn own_edge(
        &self,
        triangle: TreeTriangle,
        corner: usize,
        stop: &dyn Fn() -> bool,
    ) -> Option<u32> {
        let elements = self.elements(stop)?;
        let Some(edits) = &self.edits else {
            return elements.own_edge(&self.order, triangle, corner);
        };
        let triangle = self.order.caller_triangle(triangle).0;
        let corners = self.triangles()[triangle as usize];
        let [p, q] = [corners[corner], corners[(corner + 1) % 3]];
        let has_q = |other: &u32| self.triangles()[*other as usize].contains(&q);
        let is_own = edits.at.of(p).filter(has_q).min() == Some(triangle);
        let sides = elements.sides(&self.topology, triangle);
        let is_first = !sides[..corner].contains(&sides[corner]);
        sides[corner].filter(|_| is_own && is_first)
    }
}

held!(Edits<S>: places[], slots[], at, gone, empty, patched[]; |edits| {
    held::entries::<(u32, Vec<u32>)>(edits.orphans_of.len())
        + edits.orphans_of.values().map(held::list).sum::<usize>()
        + edits.without_orphans.get().map_or(0, held::list)
});
held!(BodyMesh<S>: topology, order; |mesh| {
    held::boxes(mesh.elements.get())
        + held::boxes(mesh.stars.get())
        + held::boxes(mesh.watertight.get())
        + held::boxes(&mesh.edits)
});
