//! Collision groups of vertices that do not meet each other, such as pinned or glued vertices.
//!
//! Two vertices of one group do not meet. Vertices of group 0 meet all. A pair of elements is left
//! out only if no vertex of one meets any vertex of the other: all are of one group. So each
//! element has a group: the common group of all its vertices, or 0.

use crate::held::held;
use crate::ids::TreeVertex;
use crate::mesh::{Elements, Order};

/// Groups of a body's elements, in tree order.
#[derive(Clone, Debug)]
pub(crate) struct Groups {
    pub(in crate::queries) vertices: Vec<u32>,
    pub(in crate::queries) edges: Vec<u32>,
    pub(in crate::queries) triangles: Vec<u32>,
}

impl Groups {
    /// Groups of all elements, from the groups of vertices in the caller's order.
    pub(crate) fn new(of_vertices: &[u32], order: &Order, elements: &Elements) -> Self {
        let in_order = order.vertex_order().iter();
        let vertices: Vec<u32> = in_order
            .map(|&vertex| of_vertices[vertex as usize])
            .collect();
        let of_all = |corners: &[TreeVertex]| {
            let mut groups = corners.iter().map(|corner| vertices[corner.index()]);
            let first = groups.next().unwrap_or(0);
            if groups.all(|group| group == first) {
                first
            } else {
                0
            }
        };
        Self {
            edges: elements.ends().iter().map(|ends| of_all(ends)).collect(),
            triangles: order
                .all_corners()
                .iter()
                .map(|corners| of_all(corners))
                .collect(),
            vertices,
        }
    }
}

/// Whether elements of these two groups meet.
#[inline(always)]
pub(in crate::queries) fn meet(a: u32, b: u32) -> bool {
    a == 0 || a != b
}

held!(Groups: vertices[], edges[], triangles[]);
