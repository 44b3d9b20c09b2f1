//! What a traversal has reached and finds not true.
//!
//! By default one level: the nodes of the groups that were reached, each from the distinct vertices below it. The paper's
//! variant makes "a specified number of levels in their sub-trees" bottom-up at once.

use super::bottom_up::make_levels_true;
use super::make::{Work, make_groups_true};
use crate::geometry::Scalar;
use crate::statistics::Statistics;
use crate::tree::Tree;

/// Groups that were reached, in the order of memory and each once, however often they were noted.
#[derive(Debug, Default)]
pub(crate) struct Reached {
    /// A bit for every group.
    noted: Vec<u64>,
    groups: Vec<u32>,
    /// For making several levels at once.
    below: Vec<u32>,
    any: bool,
}

impl Reached {
    /// Notes a group.
    #[inline]
    pub(crate) fn note(&mut self, group: u32) {
        let word = group as usize / 64;
        if word >= self.noted.len() {
            self.noted.resize(word + 1, 0);
        }
        self.noted[word] |= 1 << (group % 64);
        self.any = true;
    }

    /// Lists what was noted, and forgets it.
    fn list(&mut self) {
        self.groups.clear();
        if !std::mem::take(&mut self.any) {
            return;
        }
        for (word, bits) in self.noted.iter_mut().enumerate() {
            let mut rest = std::mem::take(bits);
            while rest != 0 {
                self.groups.push(word as u32 * 64 + rest.trailing_zeros());
                rest &= rest - 1;
            }
        }
    }
}

/// Makes groups true that were reached and are not, and with each of them `levels - 1` levels below. Returns how many boxes of
/// nodes it made.
pub(super) fn reach_groups<const N: usize, S: Scalar>(
    work: Work<'_, '_, S>,
    tree: &mut Tree<N>,
    reached: &mut Reached,
    levels: u32,
    statistics: &mut Statistics,
) -> u64 {
    reached.list();
    if levels == 1 {
        return make_groups_true(work, tree, &reached.groups, statistics);
    }
    let mut boxes = 0;
    for &group in &reached.groups {
        // A group may have been made with one above it.
        if tree.groups[group as usize].epoch != work.shape.epoch {
            boxes += make_levels_true(work, tree, group, levels, &mut reached.below, statistics);
        }
    }
    boxes
}
