//! How far ahead: the level down to which boxes are made before a traversal begins.
//!
//! Where a traversal is going to reach most of a tree anyway, it is cheapest to make all of it at once: boxes of inner nodes are
//! then merged from their children's and never made from vertices. What it is going to reach is about what it reached last time;
//! in a body that meets itself it is all, because every leaf meets at least itself. The paper's level n / 2 is for all other cases.

use super::Meets;
use super::bottom_up::make_levels_true;
use super::make::Work;
use crate::Update;
use crate::geometry::Scalar;
use crate::statistics::Statistics;
use crate::tree::Tree;

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

/// Makes the upper levels true, unless they are.
pub(super) fn refresh_ahead<const N: usize, S: Scalar>(
    work: Work<'_, '_, S>,
    tree: &mut Tree<N>,
    update: Update,
    meets: Meets,
    groups: &mut Vec<u32>,
    statistics: &mut Statistics,
) {
    // The root's group is the first that any of them makes.
    if tree.groups[0].epoch == work.shape.epoch {
        return;
    }
    let reached = tree.leaves.take_reached();
    let much = meets == Meets::Itself || reached * MUCH >= tree.leaves.len();
    let levels = level_ahead(update, tree.depth, much) + 1;
    let boxes = make_levels_true(work, tree, 0, levels, groups);
    if levels > tree.depth {
        tree.complete = work.shape.epoch;
    }
    // The root alone, from the vertices, is the beginning of top-down.
    *(if update == Update::TopDown {
        &mut statistics.boxes_top_down
    } else {
        &mut statistics.boxes_bottom_up
    }) += boxes;
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
