//! What a traversal has reached and finds not true.
//!
//! By default one level: the nodes of the groups that were reached, each from the distinct vertices below it. The paper's
//! variant makes "a specified number of levels in their sub-trees" bottom-up at once.

use super::bottom_up::make_levels_true;
use super::make::{Work, make_groups_true};
use crate::geometry::Scalar;
use crate::tree::Tree;

/// Groups or leaves that were reached, in the order of memory and each once, however often they were noted.
#[derive(Debug)]
pub(crate) struct Reached {
    /// A bit for each.
    noted: Vec<u64>,
    /// The first and the last word in which there are any.
    words: [usize; 2],
    listed: Vec<u32>,
    /// A list to work with.
    scratch: Vec<u32>,
}

const NO_WORDS: [usize; 2] = [usize::MAX, 0];

impl Default for Reached {
    fn default() -> Self {
        Self {
            noted: Vec::new(),
            words: NO_WORDS,
            listed: Vec::new(),
            scratch: Vec::new(),
        }
    }
}

impl Reached {
    /// Notes one.
    #[inline]
    pub(crate) fn note(&mut self, number: u32) {
        self.note_bits(number as usize / 64, 1 << (number % 64));
    }

    /// Notes some of eight in a row, a bit for each.
    #[inline]
    pub(crate) fn note_eight(&mut self, first: u32, which: u8) {
        let (word, shift) = (first as usize / 64, first % 64);
        self.note_bits(word, u64::from(which) << shift);
        if shift > 56 {
            self.note_bits(word + 1, u64::from(which) >> (64 - shift));
        }
    }

    #[inline]
    fn note_bits(&mut self, word: usize, bits: u64) {
        if word >= self.noted.len() {
            self.noted.resize(word + 1, 0);
        }
        self.noted[word] |= bits;
        let [first, last] = self.words;
        self.words = [first.min(word), last.max(word)];
    }

    /// Lists what was noted, and forgets it; also gives a list to work with.
    pub(super) fn list(&mut self) -> (&[u32], &mut Vec<u32>) {
        self.listed.clear();
        let [first, last] = std::mem::replace(&mut self.words, NO_WORDS);
        for word in first..=last {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_noted_is_listed_once_and_in_order() {
        let mut reached = Reached::default();
        assert!(reached.list().0.is_empty());
        for number in [700, 3, 64, 3] {
            reached.note(number);
        }
        reached.note_eight(60, 0b1001_0001);
        reached.note_eight(56, 0b1000_0000);
        reached.note_eight(704, 0b1000_0001);
        assert_eq!(reached.list().0, [3, 60, 63, 64, 67, 700, 704, 711]);
        assert!(reached.list().0.is_empty());
        reached.note(5);
        assert_eq!(reached.list().0, [5]);
    }
}
