//! Bit set of numbers: one bit each.

use crate::held::held;

/// Growable set of small numbers, which keeps count. Memory: a bit for each number up to the
/// largest.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bits {
    words: Vec<u64>,
    count: usize,
}

impl Bits {
    /// Whether a number is in the set.
    #[inline(always)]
    pub(crate) fn has(&self, number: u32) -> bool {
        let word = self.words.get(number as usize / 64);
        word.is_some_and(|word| word >> (number % 64) & 1 == 1)
    }

    /// Returns how many numbers are in the set. O(1).
    pub(crate) fn count(&self) -> usize {
        self.count
    }

    /// Adds a number.
    pub(crate) fn insert(&mut self, number: u32) {
        let place = number as usize / 64;
        if place >= self.words.len() {
            self.words.resize(place + 1, 0);
        }
        self.count += usize::from(!self.has(number));
        self.words[place] |= 1 << (number % 64);
    }

    /// Removes a number, if it is in the set.
    pub(crate) fn remove(&mut self, number: u32) {
        if self.has(number) {
            self.words[number as usize / 64] &= !(1 << (number % 64));
            self.count -= 1;
        }
    }

    /// Removes all numbers from `first` on. Cost: linear in the distance from there to the largest.
    pub(crate) fn cut_back(&mut self, first: u32) {
        let place = first as usize / 64;
        let Some(last) = self.words.get_mut(place) else {
            return;
        };
        let below = (1 << (first % 64)) - 1;
        let mut gone = (*last & !below).count_ones() as usize;
        *last &= below;
        for word in self.words.drain(place + 1..) {
            gone += word.count_ones() as usize;
        }
        self.count -= gone;
    }
}

held!(Bits: words[]);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_and_go() {
        let mut bits = Bits::default();
        for number in [0, 63, 64, 200, 63] {
            bits.insert(number);
        }
        assert_eq!(bits.count(), 4);
        bits.remove(64);
        bits.remove(999);
        assert!(
            bits.has(0) && bits.has(63) && !bits.has(64) && bits.has(200) && !bits.has(1 << 20)
        );
        for (first, left) in [(201, 3), (200, 2), (64, 2), (63, 1), (0, 0)] {
            bits.cut_back(first);
            assert_eq!(bits.count(), left);
        }
    }
}
