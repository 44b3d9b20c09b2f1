//! Fans: nodes below which all triangles share one vertex.
//!
//! Triangles round one vertex are neighbours, which are no answer. A mesh with very many (the lid
//! of a cylinder, a mesh that lies in one point) has the square of that in such pairs. Where all
//! triangles below two nodes have the same vertex, no triangles below them need be looked for. Of
//! elements one at least does not use the vertex: `rims` has boxes of these.

use super::{Child, Leaves, WideNode};
use crate::held::held;
use crate::ids::TreeVertex;
use crate::mesh::Order;
use std::cmp::Reverse;
use std::ops::Range;

/// Sentinel: no vertex.
const NONE: u32 = u32::MAX;

/// Fewest triangles round a vertex that has fans.
const MANY: u32 = 128;

/// For each node, the vertex that all triangles below it share, of those with many triangles; an
/// empty list if there are none.
#[derive(Clone, Debug)]
pub(crate) struct Fans(Vec<u32>);

impl Fans {
    /// Finds the fans of a tree, bottom-up. Cost: linear in the triangles and vertices.
    pub(super) fn new(wide_nodes: &[WideNode], leaves: &Leaves, order: &Order) -> Self {
        let corners = order.all_corners();
        // A triangle that has a vertex twice counts twice, which does no harm.
        let mut triangles_at = vec![0_u32; order.vertex_order().len()];
        for vertex in corners[leaves.all_triangles()].as_flattened() {
            triangles_at[vertex.index()] += 1;
        }
        if triangles_at.iter().all(|&count| count < MANY) {
            return Self(Vec::new());
        }
        // Of several vertices the one with the most triangles, so that neighbours choose the same.
        let of_run = |run: Range<usize>| {
            let [first, rest @ ..] = &corners[run] else {
                return NONE;
            };
            let is_common = |vertex: &&TreeVertex| rest.iter().all(|it| it.contains(vertex));
            let common = first.iter().filter(is_common).map(|vertex| vertex.0);
            let crowded = common.filter(|&vertex| triangles_at[vertex as usize] >= MANY);
            let best = crowded.max_by_key(|&it| (triangles_at[it as usize], Reverse(it)));
            best.unwrap_or(NONE)
        };
        let nodes = wide_nodes.iter().map(WideNode::len).sum();
        let mut of_node = vec![NONE; nodes];
        // Backwards, because wide nodes come after the wide node above them.
        for wide_node in wide_nodes.iter().rev() {
            for (node, child) in (wide_node.first_node as usize..).zip(wide_node.children()) {
                of_node[node] = match child {
                    Child::Inner(below) => {
                        let below = &wide_nodes[below.index()];
                        let first = below.first_node as usize;
                        let nodes = &of_node[first..first + below.len()];
                        if nodes.iter().all(|&vertex| vertex == nodes[0]) {
                            nodes[0]
                        } else {
                            NONE
                        }
                    }
                    Child::Leaf(leaf) => of_run(leaves.triangles(leaf)),
                };
            }
        }
        Self(of_node)
    }

    /// Whether no vertex has many triangles.
    pub(super) fn are_none(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether all triangles below two nodes share a vertex with many.
    pub(super) fn are_one(&self, nodes: [usize; 2]) -> bool {
        let [a, b] = nodes.map(|node| self.of_node(node));
        a.is_some() && a == b
    }

    /// The vertex that all triangles below a node share, if it is one with many. Nodes are numbered
    /// level by level.
    pub(super) fn of_node(&self, number: usize) -> Option<u32> {
        let vertex = self.0.get(number).copied();
        vertex.filter(|&vertex| vertex != NONE)
    }
}

held!(Fans: 0[]);
