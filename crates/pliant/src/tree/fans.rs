//! Fans: nodes below which all triangles share one vertex.
//!
//! Triangles round one vertex are neighbours, which are no answer. A mesh with very many (the lid
//! of a cylinder, a mesh that lies in one point) has the square of that in such pairs. Where all
//! triangles below two nodes have the same vertex, nothing below them need be looked for. Only
//! meshes with crowded blocks ask: see `neighbours`.

use super::{Child, Leaves, WideNode};
use crate::held::held;
use crate::ids::{TreeTriangle, WideNodeId};
use crate::mesh::Order;

/// Sentinel: no vertex.
const NONE: u32 = u32::MAX;

/// Up to three vertices that all triangles below the nodes of a wide node have.
type Common = [u32; 3];

/// Common vertices of the triangles below each wide node; an empty list if nobody is to ask.
#[derive(Clone, Debug, Default)]
pub(super) struct Fans(Vec<Common>);

impl Fans {
    /// Finds the common vertices, bottom-up. Cost: linear in the triangles.
    pub(super) fn new(wide_nodes: &[WideNode], leaves: &Leaves, order: &Order) -> Self {
        let corners = |triangle: usize| {
            let corners = order.corners(TreeTriangle(triangle as u32));
            corners.map(|vertex| vertex.0)
        };
        let mut all = vec![[NONE; 3]; wide_nodes.len()];
        // Backwards, because wide nodes come after the wide node above them.
        for (number, wide_node) in wide_nodes.iter().enumerate().rev() {
            let of_child = |child| match child {
                Child::Inner(below) => all[below.index()],
                Child::Leaf(leaf) => leaves
                    .triangles(leaf)
                    .map(corners)
                    .reduce(in_both)
                    .unwrap_or([NONE; 3]),
            };
            let common = wide_node.children().map(of_child).reduce(in_both);
            all[number] = common.unwrap_or([NONE; 3]);
        }
        Self(all)
    }

    /// Whether all triangles below the nodes of two wide nodes have one vertex in common.
    #[inline(always)]
    pub(super) fn are_one(&self, a: WideNodeId, b: WideNodeId) -> bool {
        !self.0.is_empty() && in_both(self.0[a.index()], self.0[b.index()]) != [NONE; 3]
    }
}

/// Returns the vertices of `a` that are in `b` too.
fn in_both(a: Common, b: Common) -> Common {
    a.map(|vertex| if b.contains(&vertex) { vertex } else { NONE })
}

held!(Fans: 0[]);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_three_corners_have_in_common() {
        assert_eq!(in_both([1, 2, 3], [3, 4, 1]), [1, NONE, 3]);
        assert_eq!(in_both([1, NONE, 3], [NONE, 4, 1]), [1, NONE, NONE]);
        assert_eq!(in_both([NONE; 3], [1, 2, 3]), [NONE; 3]);
        // One vertex three times is one.
        assert_eq!(in_both([7, 7, 7], [5, 7, 9]), [7, 7, 7]);
    }
}
