//! What a traversal has reached and finds not true.
//!
//! By default one level: the nodes of the groups that were reached, each from the distinct vertices below it. The paper's
//! variant makes "a specified number of levels in their sub-trees" bottom-up at once.

use super::bottom_up::make_levels_true;
use super::make::{Work, make_groups_true};
use crate::geometry::Scalar;
use crate::tree::Tree;

/// Groups or nodes that were reached, in the order of memory and each once, however often they were noted.
#[derive(Debug, Default)]
pub(crate) struct Reached {
    /// A bit for each.
    noted: Vec<u64>,
    any: bool,
    listed: Vec<u32>,
    /// A list to work with.
    scratch: Vec<u32>,
}

impl Reached {
    /// Notes one.
    #[inline]
    pub(crate) fn note(&mut self, number: u32) {
        let word = number as usize / 64;
        if word >= self.noted.len() {
            self.noted.resize(word + 1, 0);
        }
        self.noted[word] |= 1 << (number % 64);
        self.any = true;
    }

    /// Notes nodes of one group of siblings, a bit for each lane.
    #[inline]
    pub(crate) fn note_lanes<const N: usize>(&mut self, group: u32, lanes: u8) {
        let first = group as usize * N;
        if first / 64 >= self.noted.len() {
            self.noted.resize(first / 64 + 1, 0);
        }
        self.noted[first / 64] |= u64::from(lanes) << (first % 64);
        self.any = true;
    }

    /// Lists what was noted, and forgets it; also gives a list to work with.
    pub(super) fn list(&mut self) -> (&[u32], &mut Vec<u32>) {
        self.listed.clear();
        if std::mem::take(&mut self.any) {
            for (word, bits) in self.noted.iter_mut().enumerate() {
                let mut rest = std::mem::take(bits);
                while rest != 0 {
                    self.listed.push(word as u32 * 64 + rest.trailing_zeros());
                    rest &= rest - 1;
                }
            }
        }
        (&self.listed, &mut self.scratch)
    }
}

/// Makes groups true that were reached and are not, and with each of them `levels - 1` levels below. Returns how many boxes of
/// nodes it made.
pub(super) fn reach_groups<const N: usize, S: Scalar>(
    work: Work<'_, '_, S>,
    tree: &mut Tree<N>,
    reached: &mut Reached,
    levels: u32,
) -> u64 {
    let (reached, groups) = reached.list();
    if levels == 1 {
        return make_groups_true(work, tree, reached);
    }
    let mut boxes = 0;
    for &group in reached {
        // A group may have been made with one above it.
        if tree.groups[group as usize].epoch != work.shape.epoch {
            boxes += make_levels_true(work, tree, group, levels, groups);
        }
    }
    boxes
}
