//! Tree order: how a tree numbers triangles and vertices, and the way back to the caller's numbers.
//!
//! The triangles below any node are a run. Vertices are numbered in the order in which these
//! triangles first use them. So the vertices below a node are one run of numbers, and a few on its
//! border that an earlier node uses first (`tree::VertexSets`). Vertices that no triangle uses come
//! last: they are validated with the others and are in no box. Edits leave *orphans*: see
//! [`Order::orphan`].

use super::{Bits, Topology};
use crate::held::held;
use crate::ids::{CallerTriangle, CallerVertex, TreeTriangle, TreeVertex};
use crate::threads::Budget;
use std::ops::Range;

/// Mesh in tree order.
#[derive(Clone, Debug)]
pub(crate) struct Order {
    /// Corners of every triangle.
    corners: Vec<[TreeVertex; 3]>,
    /// Caller's number of every triangle.
    triangles: Vec<u32>,
    /// Caller's number of every vertex; an orphan has the number of its alias.
    vertices: Vec<u32>,
    /// Vertices `0..used` are corners of some triangle, be it removed.
    used: usize,
    /// Numbers of vertices that only removed triangles have as corners.
    orphans: Bits,
}

/// Tree order under construction, made some triangles at a time.
pub(crate) struct OrderBuilder {
    order: Order,
    /// Number in tree order of each of the caller's vertices, once a triangle uses it.
    tree_vertices: Vec<u32>,
}

/// Sentinel: no number in tree order yet.
const UNSEEN: u32 = u32::MAX;

/// Looks of the budget that a triangle takes: one a corner.
const LOOKS: usize = 3;
/// Triangles between two checks of the budget.
const AT_ONCE: usize = 256;

/// Change of the numbers of vertices.
pub(crate) enum Moved {
    /// Two vertices exchange their numbers.
    Exchanged([TreeVertex; 2]),
    /// The last vertex is removed.
    LastGone,
}

impl Order {
    /// Orders a mesh: triangle `triangles[t]` of the caller is triangle `t` of the tree. O(m + n).
    pub(crate) fn new(topology: &Topology, triangles: Vec<u32>) -> Self {
        let mut order = OrderBuilder::new(topology.vertex_count(), triangles);
        order.advance(|it| topology.triangles()[it as usize], &mut Budget::whole());
        order.finish()
    }

    /// Removes the triangles from a place on, with the orphans among the vertices that they use
    /// first.
    ///
    /// Of the vertices, `used` are used before these triangles. Others that they use first become
    /// unused. `slots` has the number here of each of the caller's vertices, and is kept true.
    /// `moved` is told of each exchange of two numbers, and when the last vertex is removed.
    pub(crate) fn cut_back(
        &mut self,
        triangles: usize,
        used: usize,
        slots: &mut [TreeVertex],
        mut moved: impl FnMut(Moved),
    ) {
        self.corners.truncate(triangles);
        self.triangles.truncate(triangles);
        for slot in (used..self.used).rev() {
            if !self.orphans.has(slot as u32) {
                continue;
            }
            let last = self.vertices.len() - 1;
            if slot != last {
                self.vertices.swap(slot, last);
                slots[self.vertices[slot] as usize] = TreeVertex(slot as u32);
                moved(Moved::Exchanged(
                    [slot, last].map(|it| TreeVertex(it as u32)),
                ));
            }
            self.vertices.pop();
            moved(Moved::LastGone);
        }
        self.orphans.cut_back(used as u32);
        self.used = used;
    }

    /// Renumbers a vertex that lost its last triangle to the end; its old number becomes an
    /// *orphan*. Returns the new number.
    ///
    /// Only removed triangles have an orphan as a corner. It stands where another vertex does,
    /// which is used: its *alias*, by the caller's number.
    pub(crate) fn orphan(&mut self, slot: TreeVertex, alias: u32) -> TreeVertex {
        let vertex = std::mem::replace(&mut self.vertices[slot.index()], alias);
        self.orphans.insert(slot.0);
        self.vertices.push(vertex);
        TreeVertex(self.vertices.len() as u32 - 1)
    }

    /// Gives an orphan another alias. Returns false if it is no orphan or its alias is not `old`.
    pub(crate) fn set_alias(&mut self, slot: u32, old: u32, new: u32) -> bool {
        let has_old = self.orphans.has(slot) && self.vertices[slot as usize] == old;
        if has_old {
            self.vertices[slot as usize] = new;
        }
        has_old
    }

    /// Returns the numbers of all orphans.
    pub(crate) fn orphans(&self) -> &Bits {
        &self.orphans
    }

    /// Appends vertices that no triangle uses yet.
    pub(crate) fn add_vertices(&mut self, callers: Range<u32>) {
        self.vertices.extend(callers);
    }

    /// Appends triangles in this order; `slots` and `moved` as for [`cut_back`](Self::cut_back).
    pub(crate) fn append(
        &mut self,
        topology: &Topology,
        triangles: &[u32],
        slots: &mut [TreeVertex],
        mut moved: impl FnMut(Moved),
    ) {
        for &triangle in triangles {
            let corners = topology.corners(CallerTriangle(triangle)).map(|vertex| {
                let slot = slots[vertex.index()];
                if slot.index() < self.used {
                    return slot;
                }
                let next = TreeVertex(self.used as u32);
                if slot != next {
                    let other = self.vertices[next.index()];
                    self.vertices.swap(slot.index(), next.index());
                    slots[vertex.index()] = next;
                    slots[other as usize] = slot;
                    moved(Moved::Exchanged([slot, next]));
                }
                self.used += 1;
                next
            });
            self.corners.push(corners);
            self.triangles.push(triangle);
        }
    }

    /// Returns the corners of all triangles.
    pub(crate) fn all_corners(&self) -> &[[TreeVertex; 3]] {
        &self.corners
    }

    /// Returns the corners of a triangle.
    #[inline]
    pub(crate) fn corners(&self, triangle: TreeTriangle) -> [TreeVertex; 3] {
        self.corners[triangle.index()]
    }

    /// Returns the caller's number of a triangle.
    #[inline]
    pub(crate) fn caller_triangle(&self, triangle: TreeTriangle) -> CallerTriangle {
        CallerTriangle(self.triangles[triangle.index()])
    }

    /// Returns the caller's number of a vertex; of an orphan its alias.
    #[inline]
    pub(crate) fn caller_vertex(&self, vertex: TreeVertex) -> CallerVertex {
        CallerVertex(self.vertices[vertex.index()])
    }

    /// Returns the caller's numbers of all triangles.
    pub(crate) fn triangle_order(&self) -> &[u32] {
        &self.triangles
    }

    /// Returns the caller's numbers of all vertices.
    pub(crate) fn vertex_order(&self) -> &[u32] {
        &self.vertices
    }

    /// Returns how many vertices are corners of some triangle; they come first.
    pub(crate) fn used_vertices(&self) -> usize {
        self.used
    }

    /// Whether two triangles have a vertex of the mesh in common.
    #[inline]
    pub(crate) fn share_a_vertex(&self, a: TreeTriangle, b: TreeTriangle) -> bool {
        super::share_a_vertex(self.corners(a), self.corners(b))
    }
}

impl OrderBuilder {
    /// Begins the order of a mesh that has `vertices` vertices, as [`Order::new`].
    pub(crate) fn new(vertices: usize, triangles: Vec<u32>) -> Self {
        Self {
            order: Order {
                corners: Vec::with_capacity(triangles.len()),
                triangles,
                vertices: Vec::with_capacity(vertices),
                used: 0,
                orphans: Bits::default(),
            },
            tree_vertices: vec![UNSEEN; vertices],
        }
    }

    /// Continues, given the corners of the caller's triangles. Returns whether all triangles are
    /// done.
    pub(crate) fn advance(
        &mut self,
        corners_of: impl Fn(u32) -> [u32; 3],
        budget: &mut Budget,
    ) -> bool {
        let Self {
            order,
            tree_vertices,
        } = self;
        let mut renumber = |vertex: u32| {
            let number = &mut tree_vertices[vertex as usize];
            if *number == UNSEEN {
                *number = order.vertices.len() as u32;
                order.vertices.push(vertex);
            }
            TreeVertex(*number)
        };
        while order.corners.len() < order.triangles.len() {
            if budget.is_spent() {
                return false;
            }
            let some = order.triangles[order.corners.len()..].iter().take(AT_ONCE);
            budget.spend(LOOKS * some.len());
            let corners = some.map(|&triangle| corners_of(triangle).map(&mut renumber));
            order.corners.extend(corners);
        }
        true
    }

    /// Returns the finished order.
    pub(crate) fn finish(self) -> Order {
        let mut order = self.order;
        order.used = order.vertices.len();
        let unused = (0..).zip(self.tree_vertices);
        let unused = unused.filter(|&(_, number)| number == UNSEEN);
        order.vertices.extend(unused.map(|(vertex, _)| vertex));
        order
    }
}

held!(OrderBuilder: order, tree_vertices[]);

held!(Order: corners[], triangles[], vertices[], orphans);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_there_and_back() {
        let triangles = [[4, 1, 2], [2, 1, 0], [6, 6, 4]];
        let topology = Topology::new(&triangles, 8);
        let order = Order::new(&topology, vec![2, 0, 1]);
        let corners = order.all_corners().iter().map(|c| c.map(|vertex| vertex.0));
        assert!(corners.eq([[0, 0, 1], [1, 2, 3], [3, 2, 4]]));
        assert_eq!(order.vertex_order(), [6, 4, 1, 2, 0, 3, 5, 7]);
        assert_eq!(order.used_vertices(), 5);
        for triangle in [0, 1, 2].map(TreeTriangle) {
            let back = order.corners(triangle).map(|v| order.caller_vertex(v));
            assert_eq!(back, topology.corners(order.caller_triangle(triangle)));
        }
        let share = |a, b| order.share_a_vertex(TreeTriangle(a), TreeTriangle(b));
        assert!(share(0, 1) && share(1, 2) && !share(0, 2));
    }
}
