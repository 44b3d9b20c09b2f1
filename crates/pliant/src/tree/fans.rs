//! Fans: nodes below which all triangles share one vertex.
//!
//! Triangles round one vertex are neighbours, which are no answer. A mesh with very many (the lid
//! of a cylinder, a mesh that lies in one point) has the square of that in such pairs. Where all
//! triangles below two nodes have the same vertex, no triangles below them need be looked for. Of
//! elements one at least does not use the vertex: `rims` has boxes of these.

use super::{Child, Tree};
use crate::held::held;
use crate::ids::{NodeId, TreeTriangle};
use crate::mesh::Order;
use std::cmp::Reverse;

/// Sentinel: no vertex.
const NONE: u32 = u32::MAX;

/// Fewest triangles round a vertex that has fans.
pub(super) const MANY: u32 = 128;

/// For each node, the vertex that all triangles below it share, of those with many triangles; an
/// empty list if there are none.
#[derive(Clone, Debug)]
pub(crate) struct Fans(Vec<u32>);

impl Fans {
    /// Finds the fans of a tree, bottom-up. Cost: linear in the triangles and vertices.
    pub(super) fn new(tree: &Tree, order: &Order) -> Self {
        let corners = |triangle: usize| {
            let corners = order.corners(TreeTriangle(triangle as u32));
            corners.map(|vertex| vertex.0)
        };
        let mut triangles_at = vec![0_u32; order.vertex_order().len()];
        for triangle in tree.leaves.all_triangles() {
            let of_triangle = corners(triangle);
            for (which, &vertex) in of_triangle.iter().enumerate() {
                let is_first = !of_triangle[..which].contains(&vertex);
                triangles_at[vertex as usize] += u32::from(is_first);
            }
        }
        if triangles_at.iter().all(|&count| count < MANY) {
            return Self(Vec::new());
        }
        // Of several vertices the one with the most triangles, so that neighbours choose the same.
        let of_run = |mut run: std::ops::Range<usize>| {
            let rest = run.clone().skip(1);
            let in_all = |vertex: &u32| rest.clone().all(|it| corners(it).contains(vertex));
            let common = run.next().map(corners).into_iter().flatten().filter(in_all);
            let crowded = common.filter(|&vertex| triangles_at[vertex as usize] >= MANY);
            let best = crowded.max_by_key(|&it| (triangles_at[it as usize], Reverse(it)));
            best.unwrap_or(NONE)
        };
        let mut of_node = vec![NONE; tree.node_count()];
        // Backwards, because wide nodes come after the wide node above them.
        for wide_node in tree.wide_nodes.iter().rev() {
            for (node, child) in (wide_node.first_node as usize..).zip(wide_node.children()) {
                of_node[node] = match child {
                    Child::Inner(below) => {
                        let below = tree.wide_node(below);
                        let first = below.first_node as usize;
                        let nodes = &of_node[first..first + below.len()];
                        if nodes.iter().all(|&vertex| vertex == nodes[0]) {
                            nodes[0]
                        } else {
                            NONE
                        }
                    }
                    Child::Leaf(leaf) => of_run(tree.leaves.triangles(leaf)),
                };
            }
        }
        Self(of_node)
    }

    /// Whether no vertex has many triangles.
    pub(super) fn are_none(&self) -> bool {
        self.0.is_empty()
    }

    /// The vertex that all triangles below a node share, if it is one with many. Nodes are numbered
    /// level by level.
    pub(super) fn of_node(&self, number: usize) -> Option<u32> {
        let vertex = self.0.get(number).copied();
        vertex.filter(|&vertex| vertex != NONE)
    }

    /// Whether all triangles below two nodes share a vertex, as far as it is known.
    #[inline(always)]
    pub(super) fn are_one(&self, tree: &Tree, a: NodeId, b: NodeId) -> bool {
        let of_node = |node: NodeId| self.of_node(tree.number_of(node));
        !self.0.is_empty() && of_node(a).is_some_and(|vertex| of_node(b) == Some(vertex))
    }
}

held!(Fans: 0[]);
