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
    /// The words in which there are any.
    words: std::ops::Range<usize>,
    listed: Vec<u32>,
    /// A list to work with.
    scratch: Vec<u32>,
}

impl Reached {
    /// Notes one.
    #[inline]
    pub(crate) fn note(&mut self, number: u32) {
        self.note_bits(number as usize / 64, 1 << (number % 64));
    }

    /// Notes nodes of one group of siblings, a bit for each lane.
    #[inline]
    pub(crate) fn note_lanes<const N: usize>(&mut self, group: u32, lanes: u8) {
        let first = group as usize * N;
        self.note_bits(first / 64, u64::from(lanes) << (first % 64));
    }

    #[inline]
    fn note_bits(&mut self, word: usize, bits: u64) {
        if word >= self.noted.len() {
            self.noted.resize(word + 1, 0);
        }
        self.noted[word] |= bits;
        self.words = if self.words.is_empty() {
            word..word + 1
        } else {
            self.words.start.min(word)..self.words.end.max(word + 1)
        };
    }

    /// Lists what was noted, and forgets it; also gives a list to work with.
    pub(super) fn list(&mut self) -> (&[u32], &mut Vec<u32>) {
        self.listed.clear();
        for word in std::mem::take(&mut self.words) {
            let mut rest = std::mem::take(&mut self.noted[word]);
            while rest != 0 {
                self.listed.push(word as u32 * 64 + rest.trailing_zeros());
                rest &= rest - 1;
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
