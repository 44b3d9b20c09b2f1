//! Hits in the order of their numbers.
//!
//! Hits become keys as they are found (`packing`), with as many bits as the largest numbers so far need; keys are put in order
//! by their digits (`buckets`); and become hits again. Hits of which more than 63 bits are needed are compared.
//!
//! No two hits are equal.

mod buckets;
mod packing;

use crate::held::{self, Held};
use crate::hits::{Hit, Numbered};
use crate::kernels::Instructions;
use crate::threads::Executor;
use buckets::{Buckets, lengthen};
use packing::Packing;

/// Hits, and scratch.
#[derive(Debug)]
pub(crate) struct Sorter<T> {
    /// What is found, sorted at the end; before that hits that do not fit keys, or else what was found the time before.
    hits: Vec<T>,
    packing: Packing,
    keys: Vec<u64>,
    buckets: Buckets,
}

impl<T> Default for Sorter<T> {
    fn default() -> Self {
        Self {
            hits: Vec::new(),
            packing: Packing::default(),
            keys: Vec::new(),
            buckets: Buckets::default(),
        }
    }
}

impl<T: Hit> Sorter<T> {
    /// Forgets all hits.
    pub(crate) fn begin(&mut self) {
        // The list of hits is written anew, and not emptied: there is no need to fill it with something first.
        self.packing = Packing::default();
        self.keys.clear();
    }

    /// Takes hits.
    pub(crate) fn push(&mut self, hits: &[T]) {
        let packing = self.packing.with(hits);
        if packing != self.packing {
            self.pack_anew(packing);
        }
        if packing.fits() {
            let keys = hits.iter().map(|hit| packing.key(hit.numbers()));
            self.keys.extend(keys);
        } else {
            self.hits.extend_from_slice(hits);
        }
    }

    /// Keys of more bits; or hits, if these are too many.
    fn pack_anew(&mut self, packing: Packing) {
        let old = std::mem::replace(&mut self.packing, packing);
        if packing.fits() {
            for key in &mut self.keys {
                *key = packing.key(old.numbers(*key));
            }
        } else if old.fits() {
            self.unpack(old);
        }
    }

    /// Keys become hits.
    fn unpack(&mut self, packing: Packing) {
        self.hits.clear();
        let keys = self.keys.drain(..);
        let hits = keys.map(|key| T::of_numbers(packing.numbers(key)));
        self.hits.extend(hits);
    }

    /// Sorts all hits. Interrupted, it leaves them in any state.
    pub(crate) fn sort(&mut self, executor: Executor, instructions: Instructions) {
        let packing = self.packing;
        // Places in buckets are not counted further.
        let are_countable = u32::try_from(self.keys.len()).is_ok();
        if packing.fits() && are_countable {
            let zero = T::of_numbers([0; 4]);
            if lengthen(&mut self.hits, self.keys.len(), zero, executor) {
                let (buckets, hits) = (&mut self.buckets, &mut self.hits);
                let hit = |key| T::of_numbers(packing.numbers(key));
                buckets.put_in_order((executor, instructions), &self.keys, hit, hits);
            }
            return;
        }
        if packing.fits() {
            self.unpack(packing);
        }
        sort_by_numbers(&mut self.hits);
    }
}

/// Sorts hits of any kind by comparing their numbers.
pub(crate) fn sort_by_numbers<T: Numbered>(hits: &mut [T]) {
    hits.sort_unstable_by_key(T::numbers);
}

impl<T> Sorter<T> {
    /// What was found, in order once it is sorted.
    pub(crate) fn hits(&self) -> &[T] {
        &self.hits
    }
}

impl<T> Held for Sorter<T> {
    fn held(&self) -> usize {
        held::list(&self.hits) + held::list(&self.keys) + self.buckets.held()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Pair;
    use crate::threads::{Interrupt, Threads};
    use pliant_oracle::Random;
    use std::num::NonZeroUsize;

    /// Lists by how many hits they are of at most, as equal ones are left out; the bits of the four numbers; and whether they grow.
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
        // Buckets are uneven, as few bodies are others than the first: some become bitmaps, some are divided.
        (70_000, [4, 12, 4, 12], false),
        (20_000, [4, 12, 4, 12], false),
        // One bucket has nearly all of them: of rests with few bits, with many, and with more than a short one has room for.
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
            // Keys have more and more bits where numbers grow, and where they need more than 63 they become hits.
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
                        sorter.begin();
                        for some in items.chunks(100) {
                            sorter.push(some);
                        }
                        sorter.sort(executor, instructions);
                        let is_right = sorter.hits() == expected;
                        assert!(is_right, "{count} {bits:?} {threads}");
                    }
                }
            }
        }
    }
}
