//! How a tree orders a mesh: triangles and vertices in tree order, and the way back to the caller's numbers.
//!
//! The tree orders the triangles so that those below any node are neighbours in memory, and the vertices are numbered in the
//! order in which these triangles first use them. So the vertices below a node are one run of numbers, plus the few on its
//! border that an earlier node used first (`tree::VertexSets`). Vertices that no triangle uses come last: they are checked
//! with the others and are in no box.

use super::Topology;
use crate::held::{self, Held};
use crate::ids::{CallerTriangle, CallerVertex, TreeTriangle, TreeVertex};

/// A mesh in tree order.
#[derive(Clone, Debug)]
pub(crate) struct Order {
    corners: Vec<[TreeVertex; 3]>,
    /// The caller's number of every triangle.
    triangles: Vec<u32>,
    /// The caller's number of every vertex.
    vertices: Vec<u32>,
    /// Vertices 0..used are corners of some triangle.
    used: usize,
}

const UNSEEN: u32 = u32::MAX;

impl Order {
    /// With triangle `triangles[t]` of the caller as triangle `t` of the tree.
    pub(crate) fn new(topology: &Topology, triangles: Vec<u32>) -> Self {
        let count = topology.vertex_count();
        let mut tree_vertex = vec![UNSEEN; count];
        let mut vertices = Vec::with_capacity(count);
        let mut renumber = |vertex: CallerVertex| {
            let number = &mut tree_vertex[vertex.index()];
            if *number == UNSEEN {
                *number = vertices.len() as u32;
                vertices.push(vertex.0);
            }
            TreeVertex(*number)
        };
        let corners = triangles
            .iter()
            .map(|&triangle| {
                topology
                    .corners(CallerTriangle(triangle))
                    .map(&mut renumber)
            })
            .collect();
        let used = vertices.len();
        let unused = (0..count as u32).filter(|&vertex| tree_vertex[vertex as usize] == UNSEEN);
        vertices.extend(unused);
        Self {
            corners,
            triangles,
            vertices,
            used,
        }
    }

    /// Forgets the triangles from a place on, and the vertices that they use first, of which there are `used` before them: these go with
    /// those that no triangle uses.
    pub(crate) fn cut_back(&mut self, triangles: usize, used: usize) {
        self.corners.truncate(triangles);
        self.triangles.truncate(triangles);
        self.used = used;
    }

    /// Numbers of so many more vertices, which no triangle uses yet.
    pub(crate) fn add_vertices(&mut self, count: usize) {
        let all = self.vertices.len() as u32;
        self.vertices.extend(all..all + count as u32);
    }

    /// Puts triangles behind all others, in this order. `slots` has for each of the caller's vertices its number here; where two of these
    /// are exchanged, `exchange` is told.
    pub(crate) fn append(
        &mut self,
        topology: &Topology,
        triangles: &[u32],
        slots: &mut [TreeVertex],
        mut exchange: impl FnMut([TreeVertex; 2]),
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
                    exchange([slot, next]);
                }
                self.used += 1;
                next
            });
            self.corners.push(corners);
            self.triangles.push(triangle);
        }
    }

    /// The corners of all triangles.
    pub(crate) fn all_corners(&self) -> &[[TreeVertex; 3]] {
        &self.corners
    }

    #[inline]
    pub(crate) fn corners(&self, triangle: TreeTriangle) -> [TreeVertex; 3] {
        self.corners[triangle.index()]
    }

    #[inline]
    pub(crate) fn caller_triangle(&self, triangle: TreeTriangle) -> CallerTriangle {
        CallerTriangle(self.triangles[triangle.index()])
    }

    #[inline]
    pub(crate) fn caller_vertex(&self, vertex: TreeVertex) -> CallerVertex {
        CallerVertex(self.vertices[vertex.index()])
    }

    /// The caller's numbers of all triangles.
    pub(crate) fn triangle_order(&self) -> &[u32] {
        &self.triangles
    }

    /// The caller's numbers of all vertices.
    pub(crate) fn vertex_order(&self) -> &[u32] {
        &self.vertices
    }

    /// How many vertices are corners of some triangle; they come first.
    pub(crate) fn used_vertices(&self) -> usize {
        self.used
    }

    /// Whether two triangles have a vertex of the mesh in common.
    #[inline]
    pub(crate) fn share_a_vertex(&self, a: TreeTriangle, b: TreeTriangle) -> bool {
        super::share_a_vertex(self.corners(a), self.corners(b))
    }
}

impl Held for Order {
    fn held(&self) -> usize {
        held::list(&self.corners) + held::list(&self.triangles) + held::list(&self.vertices)
    }
}

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
