//! Dirty set: the wide nodes or leaves that a traversal reached and that are to be refitted.
//!
//! Each is in the set once, however often it was reached.

use crate::held::held;

/// Bit set of numbers that are near each other. Costs depend on the words between the first and the
/// last, not on all.
#[derive(Debug)]
pub(crate) struct DirtySet {
    bits: Vec<u64>,
    /// First and last word that may have bits.
    ends: [usize; 2],
}

/// Sentinel of `ends`: no word has a bit.
const NO_WORDS: [usize; 2] = [usize::MAX, 0];

impl Default for DirtySet {
    fn default() -> Self {
        Self {
            bits: Vec::new(),
            ends: NO_WORDS,
        }
    }
}

impl DirtySet {
    /// Adds a number. O(1).
    #[inline]
    pub(crate) fn insert(&mut self, number: u32) {
        self.insert_bits(number as usize / 64, 1 << (number % 64));
    }

    /// Adds some of eight consecutive numbers, a bit for each. O(1).
    #[inline]
    pub(crate) fn insert_eight(&mut self, first: u32, which: u8) {
        let (word, shift) = (first as usize / 64, first % 64);
        self.insert_bits(word, u64::from(which) << shift);
        if shift > 56 {
            self.insert_bits(word + 1, u64::from(which) >> (64 - shift));
        }
    }

    /// Adds all numbers below `end`.
    pub(crate) fn insert_below(&mut self, end: usize) {
        for word in 0..end / 64 {
            self.insert_bits(word, u64::MAX);
        }
        if !end.is_multiple_of(64) {
            self.insert_bits(end / 64, (1 << (end % 64)) - 1);
        }
    }

    /// Puts bits of a word of 64 numbers into the set.
    #[inline]
    pub(crate) fn insert_bits(&mut self, word: usize, bits: u64) {
        self.reach_to(word, word);
        self.bits[word] |= bits;
    }

    /// Makes room for words up to `last`, and widens the range that has numbers.
    #[inline]
    fn reach_to(&mut self, first: usize, last: usize) {
        if last >= self.bits.len() {
            self.bits.resize(last + 1, 0);
        }
        self.ends = [self.ends[0].min(first), self.ends[1].max(last)];
    }

    /// Whether the set is empty. O(1).
    pub(crate) fn is_empty(&self) -> bool {
        self.ends == NO_WORDS
    }

    /// Removes all numbers.
    pub(crate) fn clear(&mut self) {
        if !self.is_empty() {
            let words = self.words();
            self.bits[words].fill(0);
            self.ends = NO_WORDS;
        }
    }

    /// Moves all numbers of another set into this one.
    pub(crate) fn take(&mut self, other: &mut Self) {
        if other.is_empty() {
            return;
        }
        let words = other.words();
        self.reach_to(words.start, words.end - 1);
        for (own, bits) in self.bits[words.clone()].iter_mut().zip(&other.bits[words]) {
            *own |= bits;
        }
        other.clear();
    }

    /// Returns the range of words of 64 bits that has all numbers.
    pub(super) fn words(&self) -> std::ops::Range<usize> {
        if self.is_empty() {
            return 0..0;
        }
        self.ends[0]..self.ends[1] + 1
    }

    /// Words that have bits, by their numbers.
    pub(crate) fn bits_by_word(&self) -> impl Iterator<Item = (u32, u64)> {
        let words = self.words().zip(&self.bits[self.words()]);
        words.filter_map(|(word, &bits)| (bits != 0).then_some((word as u32, bits)))
    }

    /// Returns how many numbers are in the set.
    pub(crate) fn count(&self) -> usize {
        let words = &self.bits[self.words()];
        words.iter().map(|bits| bits.count_ones() as usize).sum()
    }

    /// Whether any number is in some words.
    #[inline]
    pub(super) fn are_any_in(&self, words: std::ops::Range<usize>) -> bool {
        self.bits[words].iter().any(|&bits| bits != 0)
    }

    /// Returns the numbers in some words, ascending.
    #[inline]
    pub(super) fn of(&self, words: std::ops::Range<usize>) -> impl Iterator<Item = u32> {
        words.flat_map(|word| {
            let mut rest = self.bits[word];
            std::iter::from_fn(move || {
                let lane = rest.trailing_zeros();
                let number = (rest != 0).then_some(word as u32 * 64 + lane);
                rest &= rest.wrapping_sub(1);
                number
            })
        })
    }
}

held!(DirtySet: bits[]);

#[cfg(test)]
mod tests {
    use super::*;

    fn all(set: &DirtySet) -> Vec<u32> {
        set.of(set.words()).collect()
    }

    #[test]
    fn what_was_reached_is_listed_once_and_in_order() {
        let mut set = DirtySet::default();
        assert!(set.is_empty() && all(&set).is_empty());
        for number in [700, 3, 64, 3] {
            set.insert(number);
        }
        set.insert_eight(60, 0b1001_0001);
        set.insert_eight(56, 0b1000_0000);
        set.insert_eight(704, 0b1000_0001);
        assert_eq!(set.count(), 8);
        let expected = [3, 60, 63, 64, 67, 700, 704, 711];
        assert_eq!(all(&set), expected);
        let mut other = DirtySet::default();
        other.take(&mut set);
        assert!(set.is_empty() && all(&set).is_empty());
        set.insert(5);
        set.insert(800);
        set.insert(700);
        other.take(&mut set);
        other.take(&mut set);
        assert_eq!(all(&other), [3, 5, 60, 63, 64, 67, 700, 704, 711, 800]);
        other.clear();
        assert!(other.is_empty() && all(&other).is_empty());
        other.insert(1);
        assert_eq!(all(&other), [1]);
        for end in [0, 1, 64, 65, 130] {
            other.clear();
            other.insert_below(end);
            assert!(all(&other).into_iter().eq(0..end as u32));
        }
    }
}
