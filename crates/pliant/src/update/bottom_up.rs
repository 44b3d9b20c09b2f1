//! Bottom-up refit of several levels: the lowest from their vertices, upper ones from their
//! children.
//!
//! "The strength of this method is that a parent AABB can always be calculated very efficiently
//! directly from the AABBs of its children" (paper, 3.3). A leaf has no children: its box is made
//! from its vertices, whatever its level. Where leaves are single triangles, it is made from the
//! triangle's corners.

use super::refit::{refit_from_children, refit_from_vertices};
use super::refitted::{Refit, Refitted};
use crate::ids::WideNodeId;
use crate::kernels::Coordinate;
use crate::tree::Child;

/// Refits the nodes of `top` and `levels - 1` levels of wide nodes below it, bottom-up.
///
/// Returns how many boxes it made. `wide_nodes` is scratch.
pub(super) fn refit_levels<S: Coordinate>(
    refit: &Refit,
    one: &mut Refitted<S>,
    top: WideNodeId,
    levels: u32,
    wide_nodes: &mut Vec<WideNodeId>,
) -> u64 {
    // The wide nodes of the subtree level by level, ascending. Those from `lowest` on are the
    // lowest level to refit.
    wide_nodes.clear();
    let mut lowest = 0;
    if top == WideNodeId(0) {
        // From the root on, levels are whole.
        let level = one.tree.level(levels.min(one.tree.depth + 1) - 1);
        wide_nodes.extend((0..level.end as u32).map(WideNodeId));
        lowest = level.start;
    } else {
        wide_nodes.push(top);
        for _ in 1..levels {
            let end = wide_nodes.len();
            for parent in lowest..end {
                for child in one.tree.wide_node(wide_nodes[parent]).children() {
                    if let Child::Inner(below) = child {
                        wide_nodes.push(below);
                    }
                }
            }
            if wide_nodes.len() == end {
                break;
            }
            lowest = end;
        }
    }
    let (above, lowest) = wide_nodes.split_at(lowest);
    refit_from_vertices(refit, one, lowest) + refit_from_children(refit, one, above)
}
