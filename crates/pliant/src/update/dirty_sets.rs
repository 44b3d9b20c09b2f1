//! Dirty sets of many trees, which all threads fill at once.
//!
//! Idea: one array of atomic words, each set a run of it (compressed sparse rows). Invariant: the
//! numbers in a set do not depend on the order in which threads add them.

use super::DirtySet;
use crate::held::held;
use std::sync::atomic::{AtomicU64, Ordering};

/// Dirty sets by the number of their tree.
#[derive(Debug, Default)]
pub(crate) struct DirtySets {
    words: Vec<AtomicU64>,
    /// End of each set in `words`.
    ends: Vec<usize>,
}

impl DirtySets {
    /// Removes all sets.
    pub(crate) fn clear(&mut self) {
        self.words.clear();
        self.ends.clear();
    }

    /// Appends an empty set of numbers below `end`. O(`end`).
    pub(crate) fn push(&mut self, end: usize) {
        let words = self.words.len() + end.div_ceil(64);
        self.words.resize_with(words, AtomicU64::default);
        self.ends.push(words);
    }

    /// Moves all numbers of `noted` into a set.
    pub(crate) fn note(&self, set: usize, noted: &mut DirtySet) {
        let words = self.of(set);
        for (number, bits) in noted.bits_by_word() {
            let word = &words[number as usize];
            // Mostly they are there, and a read does not take the word from other threads.
            if word.load(Ordering::Relaxed) & bits != bits {
                word.fetch_or(bits, Ordering::Relaxed);
            }
        }
        noted.clear();
    }

    /// Returns how many words of 64 numbers a set has. O(1).
    pub(crate) fn words(&self, set: usize) -> usize {
        self.of(set).len()
    }

    /// Returns how many numbers are in a set. O(words).
    pub(crate) fn count(&self, set: usize) -> usize {
        let words = self.of(set).iter();
        let counts = words.map(|word| word.load(Ordering::Relaxed).count_ones() as usize);
        counts.sum()
    }

    /// Moves all numbers of a set into another.
    pub(crate) fn take(&self, set: usize, into: &mut DirtySet) {
        for (number, word) in self.of(set).iter().enumerate() {
            // Nobody else has this set meanwhile.
            let bits = word.load(Ordering::Relaxed);
            if bits != 0 {
                into.insert_bits(number, bits);
                word.store(0, Ordering::Relaxed);
            }
        }
    }

    fn of(&self, set: usize) -> &[AtomicU64] {
        let start = set.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.words[start..self.ends[set]]
    }
}

held!(DirtySets: words[], ends[]);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_set_has_what_was_noted_for_it() {
        let mut sets = DirtySets::default();
        for end in [65, 0, 128] {
            sets.push(end);
        }
        let mut noted = DirtySet::default();
        for (set, numbers) in [(0, [3, 64]), (2, [64, 127]), (0, [64, 5])] {
            numbers.into_iter().for_each(|number| noted.insert(number));
            sets.note(set, &mut noted);
            assert!(noted.is_empty());
        }
        assert_eq!([0, 1, 2].map(|set| sets.count(set)), [3, 0, 2]);
        sets.take(0, &mut noted);
        assert!(noted.of(noted.words()).eq([3, 5, 64]));
        assert_eq!([0, 1, 2].map(|set| sets.count(set)), [0, 0, 2]);
    }
}
