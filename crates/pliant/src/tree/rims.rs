//! Rims: boxes of what does not use the vertex that all triangles below a node share.
//!
//! Elements with a vertex in common are no candidates. So where all triangles below two nodes share
//! a vertex (`fans`), one element at least of each candidate lies in the rim of its node. Two nodes
//! are left out if neither rim meets the box of the other node. Else a lid of n triangles, whose
//! leaves all meet at its middle, would have n^2 pairs of leaves.

use super::{BoxSource, Child, Grown, Tree, Version};
use crate::geometry::Aabb;
use crate::held::held;
use crate::ids::NodeId;
use crate::kernels::Coordinate;
use crate::threads::Executor;

/// Rims of the nodes of a tree, for one version of its shape and motion.
#[derive(Debug, Default)]
pub(crate) struct Rims {
    version: Option<Version>,
    /// By number of the node; what no fan has is never read. Empty where there are no fans.
    boxes: Vec<Aabb>,
}

impl Rims {
    /// Makes the rims, unless they are of this version. The source grows by nothing. Returns false
    /// if interrupted. O(vertices in fans).
    pub(crate) fn make<S: Coordinate>(
        &mut self,
        tree: &Tree,
        source: &Grown<S>,
        executor: Executor,
    ) -> bool {
        let Some(fans) = tree.fans().filter(|fans| !fans.are_none()) else {
            return true;
        };
        if self.version == Some(source.version()) {
            return true;
        }
        self.version = None;
        let nowhere = Aabb {
            lo: [f32::INFINITY; 3],
            hi: [f32::NEG_INFINITY; 3],
        };
        self.boxes.resize(tree.node_count(), nowhere);
        // Backwards, because wide nodes come after the wide node above them.
        for wide_node in tree.wide_nodes.iter().rev() {
            if executor.is_interrupted() {
                return false;
            }
            for (node, child) in (wide_node.first_node as usize..).zip(wide_node.children()) {
                let Some(vertex) = fans.of_node(node) else {
                    continue;
                };
                self.boxes[node] = match child {
                    Child::Inner(below) => {
                        let below = tree.wide_node(below);
                        let first = below.first_node as usize;
                        let below = &self.boxes[first..first + below.len()];
                        below.iter().fold(nowhere, |all, one| all.union(one))
                    }
                    Child::Leaf(leaf) => {
                        let run = &source.from.triangles[tree.leaves.triangles(leaf)];
                        let corners = run.iter().flatten().copied();
                        let mut rim = corners.filter(|corner| corner.0 != vertex).peekable();
                        if rim.peek().is_some() {
                            source.plainly(rim)
                        } else {
                            nowhere
                        }
                    }
                };
            }
        }
        self.version = Some(source.version());
        true
    }

    /// Whether there are any.
    pub(super) fn are_any(&self) -> bool {
        !self.boxes.is_empty()
    }
}

/// Rims of a tree, and the distance by which its boxes are grown.
#[derive(Clone, Copy)]
pub(super) struct GrownRims<'t> {
    pub(super) rims: &'t Rims,
    pub(super) tree: &'t Tree,
    pub(super) grown_by: f32,
}

impl GrownRims<'_> {
    /// Whether two nodes with these boxes are of one fan, and neither rim meets the other's box.
    pub(super) fn leave_out(self, nodes: [NodeId; 2], boxes: [Aabb; 2]) -> bool {
        let nodes = nodes.map(|node| self.tree.number_of(node));
        let fans = self.tree.fans();
        let meets = |which: usize, other: &Aabb| {
            // An empty rim grows to NaN, which overlaps nothing.
            let rim = self.rims.boxes[nodes[which]].grown(self.grown_by);
            rim.overlaps(other)
        };
        fans.is_some_and(|fans| fans.are_one(nodes)) && !meets(0, &boxes[1]) && !meets(1, &boxes[0])
    }
}

held!(Rims: boxes[]);
