//! How far ahead: the level down to which boxes are made before a traversal begins.

use super::top_down::reach_groups;
use crate::Update;
use crate::geometry::{Scalar, Shape};
use crate::kernels::Level;
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

/// Makes the upper levels true, unless they are. Returns the boxes made.
pub(crate) fn refresh_ahead<const N: usize, S: Scalar>(
    level: Level,
    tree: &mut Tree<N>,
    update: Update,
    shape: &Shape<S>,
    groups: &mut Vec<u32>,
    statistics: &mut Statistics,
) {
    let levels = level_ahead(update, tree.depth) + 1;
    // The root's group is the first that any of them makes.
    let boxes = reach_groups(level, tree, &[0], levels, shape, groups, statistics);
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
