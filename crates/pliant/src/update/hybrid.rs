//! How far ahead: the level down to which boxes are made before a traversal begins.
//!
//! Where a traversal is going to reach most of a tree anyway, it is cheapest to make all of it at once: boxes of inner nodes are
//! then merged from their children's and never made from vertices. What it is going to reach is about what it reached last time;
//! in a body that meets itself it is all, because every leaf meets at least itself. The paper's level n / 2 is for all other cases.

use super::bottom_up::refit_levels;
use super::refitted::{Partner, Refit, Refitted};
use super::whole::refit_whole;
use crate::Update;
use crate::ids::WideNodeId;
use crate::kernels::Coordinate;
use crate::statistics::Statistics;

/// One leaf in so many reached is much of a tree: on spheres in contact, nodes that are reached are then about half of all.
const MUCH: usize = 10;

/// The level of the lowest boxes made ahead, in a tree whose deepest leaf is at level `depth`; `much` of it was reached last time.
fn level_ahead(update: Update, depth: u32, much: bool) -> u32 {
    match update {
        Update::BottomUp => depth,
        Update::TopDown => 0,
        Update::Hybrid { level: None, .. } if much => depth,
        Update::Hybrid { level, .. } => level.unwrap_or(depth / 2).min(depth),
    }
}

impl Refit<'_> {
    /// Refits the upper levels, unless they are valid. `wide_nodes` is scratch.
    pub(crate) fn ahead<S: Coordinate>(
        &self,
        one: &mut Refitted<S>,
        partner: Partner,
        wide_nodes: &mut Vec<WideNodeId>,
        statistics: &mut Statistics,
    ) {
        let root = WideNodeId(0);
        // The root is the last box that is made, and the first that any strategy needs.
        one.boxes.expect(one.source.version());
        let depth = one.tree.depth;
        let level = |much| level_ahead(self.update, depth, much);
        if one.boxes.is_valid(root) {
            // In this shape the body met another before, and was refitted in part. All of it is
            // needed now: better at once than on the way.
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
        // The root alone, from the vertices, is the beginning of top-down.
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
