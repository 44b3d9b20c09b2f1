//! Branch-free compaction: the set bits of a mask, appended to a list without a branch for each.
//!
//! The number of bits in a mask cannot be predicted, and a mispredicted branch costs as much as ten
//! items. So items are written four at a time, at least four, and the number of set bits then sets
//! the length.

use crate::held::held;

/// List with room behind its end for the items of one more mask.
#[derive(Debug, Default)]
pub(crate) struct Buffer<T> {
    items: Vec<T>,
    len: usize,
}

/// Most items of one mask, a `u64`.
const ROOM: usize = 64;

impl<T: Copy + Default> Buffer<T> {
    pub(crate) fn clear(&mut self) {
        self.len = 0;
    }

    #[inline]
    pub(crate) fn as_slice(&self) -> &[T] {
        &self.items[..self.len]
    }

    /// The items in groups of eight. The last item is repeated to fill the last group.
    pub(crate) fn eights(&mut self) -> &[[T; 8]] {
        if self.len == 0 {
            return &[];
        }
        let last = self.items[self.len - 1];
        let _ = self.room();
        let end = self.len.next_multiple_of(8);
        self.items[self.len..end].fill(last);
        self.items[..end].as_chunks().0
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.len == 0
    }

    pub(crate) fn extend(&mut self, items: &[T]) {
        let end = self.len + items.len();
        if self.items.len() < end {
            self.items.resize(end, T::default());
        }
        self.items[self.len..end].copy_from_slice(items);
        self.len = end;
    }

    #[inline]
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// The items from index `start` on.
    #[inline]
    pub(crate) fn tail_mut(&mut self, start: usize) -> &mut [T] {
        &mut self.items[start..self.len]
    }

    /// Keeps the first `len` items, or all if there are fewer.
    pub(crate) fn truncate(&mut self, len: usize) {
        self.len = self.len.min(len);
    }

    /// Keeps the items for which `keeps` returns true, in order.
    pub(crate) fn retain(&mut self, keeps: impl Fn(&T) -> bool) {
        self.retain_from(0, keeps);
    }

    /// Keeps the items before index `start`, and the others for which `keeps` returns true, in
    /// order.
    pub(crate) fn retain_from(&mut self, start: usize, keeps: impl Fn(&T) -> bool) {
        let mut kept = start;
        for place in start..self.len() {
            let item = self.as_slice()[place];
            if keeps(&item) {
                self.tail_mut(kept)[0] = item;
                kept += 1;
            }
        }
        self.truncate(kept);
    }

    /// Moves the last `count` items, or all if there are fewer, into `taken`, in their order.
    pub(crate) fn take_last(&mut self, count: usize, taken: &mut Vec<T>) {
        let rest = self.len.saturating_sub(count);
        taken.clear();
        taken.extend_from_slice(&self.items[rest..self.len]);
        self.len = rest;
    }

    pub(crate) fn push(&mut self, item: T) {
        self.room().slots[0] = item;
        self.len += 1;
    }

    /// Makes room for `count` items, which [`push_if`](Self::push_if) may then write.
    #[inline(always)]
    pub(crate) fn make_room(&mut self, count: usize) {
        if self.items.len() < self.len + count {
            self.items.resize(2 * self.len + 2 * count, T::default());
        }
    }

    /// Appends an item if `keep` is true, without a branch. [`make_room`](Self::make_room) must
    /// have been called.
    #[inline(always)]
    pub(crate) fn push_if(&mut self, item: T, keep: bool) {
        self.items[self.len] = item;
        self.len += usize::from(keep);
    }

    /// Room for the items of one mask.
    ///
    /// Ask for it before the mask is computed. Otherwise compilers spill everything that the mask
    /// is made of, across the call that makes room.
    #[inline(always)]
    pub(crate) fn room(&mut self) -> Room<'_, T> {
        if self.items.len() < self.len + ROOM {
            self.grow();
        }
        let slots = self.items[self.len..]
            .first_chunk_mut()
            .expect("room was made");
        Room {
            slots,
            len: &mut self.len,
        }
    }

    #[cold]
    #[inline(never)]
    fn grow(&mut self) {
        self.items.resize(2 * self.len + 2 * ROOM, T::default());
    }
}

/// Room for one mask's items at the end of a list.
pub(crate) struct Room<'l, T> {
    slots: &'l mut [T; ROOM],
    len: &'l mut usize,
}

impl<T: Copy> Room<'_, T> {
    /// Appends an item for every bit set in `mask`, lowest first.
    #[inline(always)]
    pub(crate) fn push_bits(self, mask: u64, item: impl Fn(u32) -> T) {
        let mut rest = mask;
        let mut place = 0;
        loop {
            for next in 0..4 {
                self.slots[(place + next) % ROOM] = item(rest.trailing_zeros() % u64::BITS);
                rest &= rest.wrapping_sub(1);
            }
            if rest == 0 {
                break;
            }
            place += 4;
        }
        *self.len += mask.count_ones() as usize;
    }

    /// Appends an item for every bit set in `mask` if `keep` returns true for it, lowest first.
    #[inline(always)]
    pub(crate) fn push_bits_if(self, mask: u64, item: impl Fn(u32) -> T, keep: impl Fn(T) -> bool) {
        let mut rest = mask;
        let mut place = 0;
        while rest != 0 {
            let item = item(rest.trailing_zeros());
            self.slots[place % ROOM] = item;
            place += usize::from(keep(item));
            rest &= rest.wrapping_sub(1);
        }
        *self.len += place;
    }
}

held!(Buffer<T>: items[]);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_bits_of_any_mask_in_order() {
        let mut list = Buffer::default();
        let mut expected = Vec::new();
        let mut mask = 0x9e37_79b9_7f4a_7c15_u64;
        for round in 0..200 {
            let mask_now = match round {
                0 => 0,
                1 => u64::MAX,
                _ => mask & mask.rotate_left(round),
            };
            list.push(1000 + round);
            list.room().push_bits(mask_now, |bit| bit);
            list.room()
                .push_bits_if(mask_now, |bit| bit, |bit| bit % 3 == 1);
            let bits = (0..64).filter(|bit| mask_now >> bit & 1 == 1);
            expected.push(1000 + round);
            expected.extend(bits.clone());
            expected.extend(bits.filter(|bit| bit % 3 == 1));
            mask = mask.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        }
        assert_eq!(list.as_slice(), expected);
        assert_eq!(list.len(), expected.len());
        let mut twice = Buffer::default();
        twice.extend(list.as_slice());
        twice.extend(list.as_slice());
        assert_eq!(twice.as_slice(), [&expected[..]; 2].concat());
        assert!(!twice.is_empty());
        let eights = list.eights().as_flattened().to_vec();
        assert_eq!(eights.len(), expected.len().next_multiple_of(8));
        assert_eq!(eights[..expected.len()], expected);
        assert!(
            eights[expected.len()..]
                .iter()
                .all(|item| Some(item) == expected.last())
        );
        let mut taken = vec![7];
        list.take_last(10, &mut taken);
        assert_eq!(taken, expected[expected.len() - 10..]);
        assert_eq!(list.as_slice(), &expected[..expected.len() - 10]);
        list.take_last(1 << 20, &mut taken);
        assert_eq!((taken.len(), list.len()), (expected.len() - 10, 0));
    }
}
