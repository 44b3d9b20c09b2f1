//! Edges of a mesh, and the one triangle that each vertex and each edge belongs to.
//!
//! An element belongs to the first of its triangles in tree order (representative triangles:
//! Curtis, Tamstorf, Manocha 2008). Vertices and edges are numbered in the order in which triangles
//! first use them. So the elements of a run of triangles are runs of numbers. Each pair of elements
//! comes up once, in one pair of runs. Where the mesh is edited, edges keep their numbers: see
//! `follow`.

mod edge_index;
mod follow;

use super::edges::{SortedEdges, UNINTERRUPTED, firsts_of, number_of, sides};
use super::{Order, Topology};
use crate::held::{self, held};
use crate::ids::{CallerTriangle, TreeTriangle, TreeVertex};
use edge_index::{EdgeIndex, UNSEEN};
pub(crate) use follow::Changed;
use std::ops::Range;
use std::sync::OnceLock;

/// Edges of a mesh, by the caller's numbers and in tree order.
#[derive(Clone, Debug)]
pub(crate) struct Elements {
    /// Ends of each edge, by the caller's numbers of edges and vertices, the smaller end first.
    ///
    /// `NO_EDGE` where a number is empty. Sorted, as long as the mesh was not edited.
    callers: Vec<[u32; 2]>,
    /// Ends of each edge in tree order.
    ends: Vec<[TreeVertex; 2]>,
    /// Caller's number of each edge in tree order.
    numbers: Vec<u32>,
    /// For each triangle the first vertex and edge that belong to it or to later ones: CSR offsets,
    /// which end with the totals.
    firsts: Vec<[u32; 2]>,
    /// Number in tree order of each of the caller's vertices; made when first asked for.
    tree_vertices: OnceLock<Box<[TreeVertex]>>,
    /// Where edges with each lower end begin, in the caller's numbers. Made when first asked for.
    firsts_at: OnceLock<Vec<u32>>,
    /// Index for edits, once the mesh is edited.
    index: Option<Box<EdgeIndex>>,
}

impl Elements {
    /// Numbers the edges of a mesh in tree order. Returns `None` if `stop` returned true.
    ///
    /// O(m + n) for m triangles and n vertices, apart from sorting the edges at one vertex.
    pub(crate) fn new(topology: &Topology, order: &Order, stop: &dyn Fn() -> bool) -> Option<Self> {
        let triangles = topology.triangles();
        let callers = SortedEdges::new(triangles, topology.vertex_count(), |_| true, stop)?;
        let mut elements = Self {
            callers: Vec::new(),
            ends: Vec::with_capacity(callers.edges.len()),
            numbers: Vec::with_capacity(callers.edges.len()),
            firsts: Vec::with_capacity(triangles.len() + 1),
            tree_vertices: OnceLock::new(),
            firsts_at: OnceLock::new(),
            index: None,
        };
        let mut is_given = vec![false; callers.edges.len()];
        let numbers = |triangle: TreeTriangle| {
            let corners = order.corners(triangle).map(|corner| {
                // An orphan goes by the number of its alias, which may have no such edge.
                let is_orphan = order.orphans().has(corner.0);
                (!is_orphan).then(|| order.caller_vertex(corner).0)
            });
            SIDES.map(|[i, j]| {
                // Edges that only removed triangles have are no edges of the mesh.
                let ends = [corners[i]?, corners[j]?];
                callers.number_of(ends)
            })
        };
        let is_new = |number: u32, _| !std::mem::replace(&mut is_given[number as usize], true);
        elements.give_to_triangles(order, TreeTriangle(0), 0, stop, numbers, is_new)?;
        elements.callers = callers.edges;
        Some(elements)
    }

    /// Assigns to each triangle from `first` on the vertices and edges that no earlier one has.
    ///
    /// Goes in tree order. The first `used` vertices are assigned before. `numbers` gives the
    /// caller's numbers of the sides of a triangle that are edges. `is_new` says whether no
    /// triangle has the edge yet; it is told the number in tree order that it would get. Returns
    /// `None` if `stop` returned true.
    fn give_to_triangles(
        &mut self,
        order: &Order,
        first: TreeTriangle,
        mut used: u32,
        stop: &dyn Fn() -> bool,
        numbers: impl Fn(TreeTriangle) -> [Option<u32>; 3],
        mut is_new: impl FnMut(u32, u32) -> bool,
    ) -> Option<()> {
        for at in (first.0..order.all_corners().len() as u32).map(TreeTriangle) {
            let corners = order.corners(at);
            self.firsts.push([used, self.ends.len() as u32]);
            used = corners
                .iter()
                .fold(used, |used, corner| used.max(corner.0 + 1));
            for ([i, j], number) in SIDES.into_iter().zip(numbers(at)) {
                if let Some(number) = number
                    && is_new(number, self.ends.len() as u32)
                {
                    self.ends.push([corners[i], corners[j]]);
                    self.numbers.push(number);
                }
            }
            if at.0.is_multiple_of(UNINTERRUPTED as u32) && stop() {
                return None;
            }
        }
        self.firsts.push([used, self.ends.len() as u32]);
        Some(())
    }

    /// Returns the ends of all edges, by the caller's numbers.
    pub(crate) fn callers(&self) -> &[[u32; 2]] {
        &self.callers
    }

    /// Returns the vertices that belong to a run of triangles. O(1).
    #[inline]
    pub(crate) fn vertices_of(&self, run: TriangleRun) -> Range<u32> {
        let [first, end] = run.ends();
        self.firsts[first][0]..self.firsts[end][0]
    }

    /// Returns the edges that belong to a run of triangles. O(1).
    #[inline]
    pub(crate) fn edges_of(&self, run: TriangleRun) -> Range<u32> {
        let [first, end] = run.ends();
        self.firsts[first][1]..self.firsts[end][1]
    }

    /// Returns the ends of all edges in tree order.
    #[inline]
    pub(crate) fn ends(&self) -> &[[TreeVertex; 2]] {
        &self.ends
    }

    /// Returns the number in tree order of each of the caller's vertices. `order` is the mesh's.
    pub(crate) fn tree_vertices(&self, order: &Order) -> &[TreeVertex] {
        self.tree_vertices.get_or_init(|| {
            let of_tree = order.vertex_order();
            let mut numbers = vec![TreeVertex(0); of_tree.len()];
            for (number, &vertex) in (0..).zip(of_tree) {
                numbers[vertex as usize] = TreeVertex(number);
            }
            numbers.into_boxed_slice()
        })
    }

    /// Returns the edges of a triangle, from each corner to the next, all by the caller's numbers.
    /// None where the two corners are one vertex.
    pub(crate) fn sides(&self, topology: &Topology, triangle: u32) -> [Option<u32>; 3] {
        if let Some(index) = &self.index {
            let of_triangle = index.of_triangles[triangle as usize];
            return of_triangle.map(|number| (number != UNSEEN).then_some(number));
        }
        let firsts = self
            .firsts_at
            .get_or_init(|| firsts_of(&self.callers, topology.vertex_count()));
        let corners = topology.corners(CallerTriangle(triangle)).map(|it| it.0);
        sides(corners).map(|ends| number_of(&self.callers, firsts, ends))
    }

    /// Returns the edge from a corner of a triangle to the next, by the caller's number. None if an
    /// earlier triangle in tree order has the edge too.
    pub(crate) fn own_edge(
        &self,
        order: &Order,
        triangle: TreeTriangle,
        corner: usize,
    ) -> Option<u32> {
        let corners = order.corners(triangle);
        let side = |[i, j]: [usize; 2]| [corners[i].min(corners[j]), corners[i].max(corners[j])];
        let wanted = side(SIDES[corner]);
        let run = TriangleRun {
            first: triangle,
            count: 1,
        };
        // A triangle that has a vertex twice has an edge there and back.
        let is_first = SIDES[..corner].iter().all(|&other| side(other) != wanted);
        let mut own = self.edges_of(run).filter(|_| is_first);
        let own = own.find(|&edge| {
            let [p, q] = self.ends[edge as usize];
            [p.min(q), p.max(q)] == wanted
        });
        own.map(|edge| self.numbers[edge as usize])
    }

    /// Finds an edge whose recorded ends in tree order are wrong; `place` gives the true ones.
    /// Returns its caller's number.
    pub(crate) fn misplaced(&self, place: impl Fn(u32) -> TreeVertex) -> Option<u32> {
        let is_misplaced = |&(edge, number): &(u32, u32)| {
            let mut expected = self.callers[number as usize].map(|end| place(end).0);
            let mut found = self.ends[edge as usize].map(|end| end.0);
            expected.sort_unstable();
            found.sort_unstable();
            expected != found
        };
        let live = (0..).zip(self.numbers.iter().copied());
        let mut live = live.filter(|&(edge, _)| !self.is_gone(edge));
        live.find(is_misplaced).map(|(_, number)| number)
    }

    /// Returns the caller's numbers of all edges, in tree order.
    #[inline]
    pub(crate) fn caller_edges(&self) -> &[u32] {
        &self.numbers
    }
}

/// Corners at the two ends of each side of a triangle.
const SIDES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

/// Run of triangles: consecutive in tree order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct TriangleRun {
    pub(crate) first: TreeTriangle,
    pub(crate) count: u32,
}

impl TriangleRun {
    /// Returns the first triangle, and the one behind the last.
    #[inline]
    fn ends(self) -> [usize; 2] {
        [self.first.index(), self.first.index() + self.count as usize]
    }

    /// Returns the triangles as a range of numbers.
    #[inline]
    pub(crate) fn range(self) -> Range<u32> {
        self.first.0..self.first.0 + self.count
    }
}

held!(Elements: callers[], ends[], numbers[], firsts[];
    |elements| held::boxes(&elements.index)
        + elements.firsts_at.get().map_or(0, held::list)
        + elements.tree_vertices.get().map_or(0, |all| size_of_val(&**all)));

#[cfg(test)]
mod tests {
    use super::super::edges::edges_of;
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_edge_has_one_number_and_one_triangle() {
        let triangles = [
            [4, 1, 2],
            [2, 1, 0],
            [6, 6, 4],
            [1, 2, 4],
            [5, 5, 5],
            [0, 7, 1],
        ];
        let topology = Topology::new(&triangles, 9);
        let order = Order::new(&topology, vec![3, 5, 0, 4, 2, 1]);
        let elements = Elements::new(&topology, &order, &|| false).unwrap();
        let expected: BTreeSet<[u32; 2]> = triangles.iter().flat_map(edges_of).collect();
        assert!(expected.into_iter().eq(elements.callers().iter().copied()));
        for (edge, ends) in elements.ends().iter().enumerate() {
            let mut named = ends.map(|end| order.caller_vertex(end).0);
            named.sort_unstable();
            let number = elements.caller_edges()[edge];
            assert_eq!(elements.callers()[number as usize], named);
        }
        for vertex in (0..9).map(TreeVertex) {
            let named = order.caller_vertex(vertex);
            assert_eq!(elements.tree_vertices(&order)[named.index()], vertex);
        }
        // Triangle by triangle, the elements that belong to them are all that is used, once.
        let mut next = [0, 0];
        for triangle in 0..triangles.len() as u32 {
            let run = TriangleRun {
                first: TreeTriangle(triangle),
                count: 1,
            };
            let [vertices, edges] = [elements.vertices_of(run), elements.edges_of(run)];
            assert_eq!([vertices.start, edges.start], next);
            next = [vertices.end, edges.end];
            let corners = order.corners(TreeTriangle(triangle));
            let is_corner = |vertex: u32| corners.contains(&TreeVertex(vertex));
            assert!(vertices.clone().all(is_corner));
            let ends = |edge: u32| elements.ends()[edge as usize];
            assert!(
                edges
                    .clone()
                    .all(|edge| ends(edge).iter().all(|end| corners.contains(end)))
            );
        }
        assert_eq!(
            next,
            [
                order.used_vertices() as u32,
                elements.callers().len() as u32
            ]
        );
        assert!(Elements::new(&topology, &order, &|| true).is_none());
    }
}
