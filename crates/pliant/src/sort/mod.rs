//! Sorting of hits by their numbers: radix sort of integer keys, with a comparison sort behind it.
//!
//! Every thread packs its hits into keys (`keys`, `packing`), with as many bits as its largest
//! numbers so far need. The keys of all threads are radix-sorted (`buckets`) and become hits again,
//! in O(hits). Hits that need more than 63 bits are compared instead, in O(n log n). No two hits
//! are equal.

mod buckets;
mod hit;
mod keys;
mod many_lists;
mod packing;

use crate::held::{Held, empty, held};
use crate::kernels::Instructions;
use crate::threads::{Executor, PerThread};
use buckets::{Buckets, lengthen};
pub(crate) use hit::{Hit, Numbered};
use keys::{Keys, NOTHING, both};
pub(crate) use many_lists::sort_lists;
use packing::Packing;

/// Hits of all threads, and the scratch memory to sort them.
#[derive(Debug)]
pub(crate) struct Sorter<T> {
    /// Sorted hits. Written by [`sort`](Self::sort).
    hits: Vec<T>,
    keys: PerThread<Keys<T>>,
    buckets: Buckets,
}

impl<T: Hit> Sorter<T> {
    /// Begins a new list: forgets all keys.
    pub(crate) fn begin(&mut self, executor: Executor) {
        // The list of hits is overwritten later and not emptied here: that saves filling it with
        // something first.
        self.keys.for_threads(executor.count());
        self.keys.iter_mut().for_each(Keys::clear);
    }

    /// Adds hits, found by the calling thread.
    pub(crate) fn push(&self, hits: &[T]) {
        self.keys.own().push(hits);
    }

    /// Hits in order, after [`sort`](Self::sort).
    pub(crate) fn hits(&self) -> &[T] {
        &self.hits
    }

    /// Sorts all hits. Interrupted, it leaves them in any state.
    pub(crate) fn sort(&mut self, executor: Executor, instructions: Instructions) {
        let Self {
            hits,
            keys,
            buckets,
        } = self;
        let packings = keys.iter_mut().map(|keys| keys.packing);
        let packing = packings.fold(Packing::default(), Packing::and);
        let count: usize = keys.iter_mut().map(|keys| keys.packed.len()).sum();
        // Places in buckets are `u32`.
        if !packing.fits() || u32::try_from(count).is_err() {
            hits.clear();
            keys.iter_mut().for_each(|keys| keys.unpack_to(hits));
            sort_by_numbers(hits);
            return;
        }
        let mut extent = NOTHING;
        for keys in keys.iter_mut() {
            keys.pack(packing);
            extent = both(extent, keys.extent);
        }
        let zero = T::of_numbers([0; 4]);
        if lengthen(hits, count, zero, executor) {
            let all = keys.iter_mut().map(|keys| keys.packed.as_slice());
            let hit = |key| T::of_numbers(packing.numbers(key));
            buckets.put_in_order((executor, instructions), all, extent, hit, hits);
        }
    }
}

/// Sorts hits of any kind by comparing their numbers. O(n log n).
fn sort_by_numbers<T: Numbered>(hits: &mut [T]) {
    hits.sort_unstable_by_key(T::numbers);
}

empty!(Sorter<T>: hits, keys, buckets);

held!(Sorter<T>: hits[], buckets; |sorter| sorter.keys.held_by(Held::held));

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Pair;
    use crate::threads::{Interrupt, Threads};
    use pliant_oracle::Random;
    use std::num::NonZeroUsize;

    /// Lists to sort: the most hits (equal ones are left out), the bits of the four numbers, and
    /// whether the numbers grow.
    const LISTS: [(usize, [u32; 4], bool); 21] = [
        (0, [0, 9, 0, 9], false),
        (1, [0, 9, 0, 9], false),
        (5, [0, 9, 0, 9], true),
        (5, [0, 32, 0, 32], false),
        (100, [0, 1, 0, 7], true),
        (300, [1, 15, 1, 15], false),
        (5000, [3, 15, 3, 3], true),
        (5000, [0, 0, 0, 0], false),
        (5000, [0, 0, 0, 12], false),
        (4000, [0, 32, 0, 32], true),
        (4000, [0, 1, 0, 31], true),
        (4000, [5, 26, 5, 26], true),
        (70_000, [0, 16, 0, 17], true),
        // Buckets are uneven, as few first bodies differ: some buckets become bitmaps, some are
        // divided.
        (70_000, [4, 12, 4, 12], false),
        (20_000, [4, 12, 4, 12], false),
        // One bucket has nearly all keys: with few bits of rest, with many, and with more than a
        // `u32` has room for.
        (70_000, [10, 0, 10, 17], false),
        (200_000, [10, 2, 10, 20], false),
        (70_000, [20, 1, 20, 10], false),
        (600_000, [0, 11, 0, 11], false),
        (600_000, [7, 18, 7, 18], false),
        (300_000, [0, 32, 0, 31], false),
    ];

    #[test]
    fn any_numbers_in_any_number() {
        let mut random = Random::new(7);
        let mut next = |bits: u32| (random.bits() >> 32 >> (32 - bits)) as u32;
        let mut sorter = Sorter::<Pair>::default();
        for (count, bits, grow) in LISTS {
            // Mostly it is the first body.
            let mut numbers = |place: usize| {
                let body = if place.is_multiple_of(50) { bits[0] } else { 0 };
                [
                    next(body),
                    next(bits[1]),
                    next(body.min(bits[2])),
                    next(bits[3]),
                ]
            };
            let found = (0..count).map(&mut numbers).map(Pair::of_numbers);
            let mut expected: Vec<Pair> = found.collect();
            let mut items = expected.clone();
            expected.sort_unstable();
            expected.dedup();
            let mut seen = std::collections::HashSet::new();
            items.retain(|item| seen.insert(*item));
            // Keys get more bits as numbers grow. Where they need more than 63 they become hits.
            let orders = [Some(items), grow.then(|| expected.clone())];
            for items in orders.iter().flatten() {
                for threads in [1, 2, 7] {
                    let interrupt = &Interrupt::default();
                    let pool = &Threads::private(NonZeroUsize::new(threads).unwrap());
                    let executor = Executor {
                        threads: pool,
                        interrupt,
                    };
                    for instructions in Instructions::all() {
                        sorter.begin(executor);
                        let mut jobs: Vec<_> = items.chunks(100).collect();
                        executor.run(&mut jobs, u64::MAX, |_, some| sorter.push(some));
                        sorter.sort(executor, instructions);
                        let is_right = sorter.hits() == expected;
                        assert!(is_right, "{count} {bits:?} {threads}");
                    }
                }
            }
        }
    }
}
