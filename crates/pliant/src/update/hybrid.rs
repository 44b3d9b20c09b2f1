//! How far ahead: the level down to which boxes are made before a traversal begins.

use super::bottom_up::make_levels_true;
use super::make::Work;
use crate::Update;
use crate::geometry::Scalar;
use crate::statistics::Statistics;
use crate::tree::Tree;

/// The level of the lowest boxes made ahead, in a tree whose deepest leaf is at level `depth`.
fn level_ahead(update: Update, depth: u32) -> u32 {
    match update {
        Update::BottomUp => depth,
        Update::TopDown => 0,
        Update::Hybrid { level, .. } => level.unwrap_or(depth / 2).min(depth),
    }
}

/// Makes the upper levels true, unless they are.
pub(super) fn refresh_ahead<const N: usize, S: Scalar>(
    work: Work<'_, '_, S>,
    tree: &mut Tree<N>,
    update: Update,
    groups: &mut Vec<u32>,
    statistics: &mut Statistics,
) {
    // The root's group is the first that any of them makes.
    if tree.groups[0].epoch == work.shape.epoch {
        return;
    }
    let levels = level_ahead(update, tree.depth) + 1;
    let boxes = make_levels_true(work, tree, 0, levels, groups);
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
        for (update, depth, level) in [
            (Update::BottomUp, 7, 7),
            (Update::TopDown, 7, 0),
            (hybrid(None), 7, 3),
            (hybrid(None), 0, 0),
            (hybrid(Some(5)), 7, 5),
            (hybrid(Some(9)), 7, 7),
        ] {
            assert_eq!(level_ahead(update, depth), level, "{update:?}, {depth}");
        }
    }
}
