//! Hybrid update: the level down to which boxes are made ahead of a traversal.
//!
//! Where a traversal will reach most of a tree, it is cheapest to make all boxes at once. Boxes of
//! inner nodes are then merged from their children's, and never made from vertices. A traversal
//! reaches about as much as the last one did. In a body that meets itself it reaches all, because
//! every leaf meets at least itself. In all other cases the level is the paper's n / 2.

use super::bottom_up::refit_levels;
use super::refitted::{Partner, Refit, Refitted};
use super::whole::refit_whole;
use crate::Update;
use crate::ids::WideNodeId;
use crate::kernels::Coordinate;
use crate::statistics::Statistics;

/// Much of a tree was reached if one leaf in this many was. On spheres in contact, about half of
/// all nodes are then reached.
const MUCH: usize = 10;

/// Level of the lowest boxes made ahead; `depth` is the level of the deepest leaf.
///
/// `much`: whether much of the tree was reached the last time.
fn level_ahead(update: Update, depth: u32, much: bool) -> u32 {
    match update {
        Update::BottomUp => depth,
        Update::TopDown => 0,
        Update::Hybrid { level: None, .. } if much => depth,
        Update::Hybrid { level, .. } => level.unwrap_or(depth / 2).min(depth),
    }
}

impl Refit<'_> {
    /// Refits the upper levels before a traversal, unless they are valid. `wide_nodes` is scratch.
    pub(crate) fn ahead<S: Coordinate>(
        &self,
        one: &mut Refitted<S>,
        partner: Partner,
        wide_nodes: &mut Vec<WideNodeId>,
        statistics: &mut Statistics,
    ) {
        let root = WideNodeId(0);
        // The root is the last box that is made, and the first that any strategy needs. So it is
        // valid if levels were refitted ahead.
        one.boxes.expect(one.source.version());
        let depth = one.tree.depth;
        let level = |much| level_ahead(self.update, depth, much);
        if one.boxes.is_valid(root) {
            // The body was refitted in part, since it met another in this shape before. All of it
            // is needed now: better at once than on the way.
            let whole = partner == Partner::Itself && level(true) == depth;
            if !whole || one.boxes.are_nodes_complete() {
                return;
            }
        }
        let reached = one.boxes.take_reached();
        let much = partner == Partner::Itself || reached * MUCH >= one.tree.leaves.len();
        let levels = level(much) + 1;
        let is_whole = levels > depth && partner == Partner::Itself;
        let boxes = if is_whole && one.tree.leaves.are_blocks() {
            let [boxes, triangles] = refit_whole(self, one, wide_nodes);
            statistics.triangle_boxes += triangles;
            boxes
        } else {
            refit_levels(self, one, root, levels, wide_nodes)
        };
        if levels > depth {
            one.boxes.complete_nodes();
        }
        // A box of the root alone, made from the vertices, is where top-down begins.
        *(if self.update == Update::TopDown {
            &mut statistics.boxes_top_down
        } else {
            &mut statistics.boxes_bottom_up
        }) += boxes;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_of_the_three_strategies() {
        let hybrid = |level| Update::Hybrid {
            level,
            levels_at_once: std::num::NonZeroU32::MIN,
        };
        for (update, depth, level, level_if_much) in [
            (Update::BottomUp, 7, 7, 7),
            (Update::TopDown, 7, 0, 0),
            (hybrid(None), 7, 3, 7),
            (hybrid(None), 0, 0, 0),
            (hybrid(Some(5)), 7, 5, 5),
            (hybrid(Some(9)), 7, 7, 7),
        ] {
            let levels = [false, true].map(|much| level_ahead(update, depth, much));
            assert_eq!(levels, [level, level_if_much], "{update:?}, {depth}");
        }
    }
}
