//! Hits in the order of their numbers, by counting digits.
//!
//! Triangle numbers are dense, so pairs of triangles differ in few bits: the numbers, less the smallest of each, side by side
//! make one key, and two or three passes over digits put thousands of pairs in order without a comparison, for a tenth of the work of a
//! comparison sort. The keys of few items are compared.
//!
//! Very many items are put into buckets by their first digit, by one thread, and each bucket is then sorted in cache. Several threads sort a
//! run each; so does one thread, several runs, where most items are in one bucket, because it can be interrupted between runs. Then some
//! keys of every run, evenly spaced, say where to cut all runs, so that what lies between two cuts is about as much for each thread to
//! merge (Shi and Schaeffer 1992, parallel sorting by regular sampling). Items of equal keys are equal: the result does not depend on
//! the number of threads.

use crate::held::{self, Held};
use crate::hits::Hit;
use crate::threads::Executor;

/// Below this, counting costs more than comparing.
const FEW: usize = 192;
/// Digits of at most so many bits: counts of all its values stay in the nearest cache.
const DIGIT: u32 = 11;
/// The same where there are [`MANY`] items: a pass less is worth counts that are further away.
const LONG_DIGIT: u32 = 16;
const MANY: usize = 1 << 15;
/// Items of a run, at least; fewer than two runs are not worth waking a thread.
const SHORTEST_RUN: usize = 1024;
/// Items of a run, at most: some milliseconds of work.
const LONGEST_RUN: usize = 1 << 17;
/// So many items are put into buckets before it is asked whether somebody wants to stop.
const UNINTERRUPTED: usize = 1 << 16;

/// Scratch.
#[derive(Debug, Default)]
pub(crate) struct Sorter {
    keys: Vec<u64>,
    spare: Vec<u64>,
    /// Where items with a digit go, for every run that is sorted at one time.
    places: Vec<u32>,
}

/// Sorts hits that have one first number, by the others. Interrupted, it leaves them in any state.
pub(crate) fn sort<T: Hit>(executor: Executor, items: &mut [T], scratch: &mut Sorter) {
    let Sorter {
        keys,
        spare,
        places,
    } = scratch;
    if items.len() < 2 {
        return;
    }
    let packing = Packing::of(items);
    if packing.bits() > u64::BITS || items.len() > u32::MAX as usize {
        items.sort_unstable_by_key(T::numbers);
        return;
    }
    // With millions of items each of these takes milliseconds.
    for scratch in [&mut *keys, &mut *spare] {
        if executor.is_interrupted() {
            return;
        }
        scratch.resize(items.len(), 0);
    }
    let sort_run = |run: &mut Run<T>| {
        let keys = run.items.iter().map(|item| packing.key(item.numbers()));
        sort_keys(keys, run.keys, run.spare, run.places, packing.bits());
    };
    let unpack = |keys: &[u64], items: &mut [T]| {
        for (place, &key) in items.iter_mut().zip(keys) {
            *place = T::of_numbers(packing.numbers(key));
        }
    };

    let most = executor.count().min(items.len() / SHORTEST_RUN);
    let runs = most.max(items.len().div_ceil(LONGEST_RUN));
    // Runs that are sorted one after the other are many, and their places few.
    let digit = if runs <= executor.count() {
        digit_of(items.len() / runs.max(1))
    } else {
        DIGIT
    };
    if !executor.are_many() && items.len() > LONGEST_RUN {
        places.resize(places.len().max(1 << LONG_DIGIT), 0);
        if sort_by_buckets(executor, items, packing, [keys, spare], places) {
            return;
        }
    }
    places.resize(places.len().max(runs.max(1) << digit), 0);
    if runs < 2 {
        sort_run(&mut Run {
            items,
            keys,
            spare,
            places,
        });
        unpack(keys, items);
        return;
    }
    let size = items.len().div_ceil(runs);
    let each = items.chunks(size);
    let scratch = keys.chunks_mut(size).zip(spare.chunks_mut(size));
    let mut sorts: Vec<_> = each
        .zip(scratch)
        .zip(places.chunks_mut(1 << digit))
        .map(|((items, (keys, spare)), places)| Run {
            items,
            keys,
            spare,
            places,
        })
        .collect();
    executor.run(&mut sorts, |_, run| sort_run(run));
    let mut merges = cut(keys.chunks(size).collect(), spare, items);
    executor.run(&mut merges, |_, merge| {
        merge.put_in_order();
        unpack(merge.keys, merge.items);
    });
}

/// Sorts items by buckets: those of equal first digits. Returns false, and has done nothing, if a bucket is too large to be sorted without
/// being interrupted.
fn sort_by_buckets<T: Hit>(
    executor: Executor,
    items: &mut [T],
    packing: Packing,
    [keys, spare]: [&mut [u64]; 2],
    places: &mut [u32],
) -> bool {
    let bits = packing.bits();
    let width = bits.min(DIGIT);
    let rest = bits - width;
    let bucket = |key: u64| (key.checked_shr(rest).unwrap_or(0)) as usize;
    let mut ends = [0_u32; 1 << DIGIT];
    let ends = &mut ends[..1 << width];
    for (items, keys) in items
        .chunks(UNINTERRUPTED)
        .zip(keys.chunks_mut(UNINTERRUPTED))
    {
        for (item, place) in items.iter().zip(keys) {
            let key = packing.key(item.numbers());
            *place = key;
            ends[bucket(key)] += 1;
        }
        if executor.is_interrupted() {
            return true;
        }
    }
    if ends.iter().any(|&count| count as usize > LONGEST_RUN) {
        return false;
    }
    let mut before = 0;
    for end in &mut *ends {
        before += std::mem::replace(end, before);
    }
    for keys in keys.chunks(UNINTERRUPTED) {
        for &key in keys {
            let place = &mut ends[bucket(key)];
            spare[*place as usize] = key;
            *place += 1;
        }
        if executor.is_interrupted() {
            return true;
        }
    }
    let mut start = 0;
    for &mut end in ends {
        let of_bucket = start..end as usize;
        start = of_bucket.end;
        let (from, to) = (&mut spare[of_bucket.clone()], &mut keys[of_bucket.clone()]);
        let sorted = sort_digits(from, to, places, rest);
        for (place, &key) in items[of_bucket].iter_mut().zip(&*sorted) {
            *place = T::of_numbers(packing.numbers(key));
        }
        if executor.is_interrupted() {
            return true;
        }
    }
    true
}

/// Items that one thread sorts: their keys will be in order.
struct Run<'k, T> {
    items: &'k [T],
    keys: &'k mut [u64],
    spare: &'k mut [u64],
    places: &'k mut [u32],
}

/// The same range of keys of all runs, where they will be in order, and the items that they will be.
struct Merge<'k, T> {
    of_runs: Vec<&'k [u64]>,
    keys: &'k mut [u64],
    items: &'k mut [T],
}

/// Cuts runs of keys that are in order into as many ranges.
fn cut<'k, T>(
    mut runs: Vec<&'k [u64]>,
    mut keys: &'k mut [u64],
    mut items: &'k mut [T],
) -> Vec<Merge<'k, T>> {
    let count = runs.len();
    let keys_at = |part: usize| runs.iter().map(move |run| run[run.len() * part / count]);
    let mut samples: Vec<u64> = (1..count).flat_map(keys_at).collect();
    samples.sort_unstable();
    let merge = |range: usize| {
        let end = samples.get((range + 1) * (count - 1));
        let cut = |run: &mut &'k [u64]| {
            let len = end.map_or(run.len(), |end| run.partition_point(|key| key < end));
            run.split_off(..len).unwrap_or_default()
        };
        let of_runs: Vec<_> = runs.iter_mut().map(cut).collect();
        let len = of_runs.iter().map(|run| run.len()).sum();
        Merge {
            of_runs,
            keys: keys.split_off_mut(..len).unwrap_or_default(),
            items: items.split_off_mut(..len).unwrap_or_default(),
        }
    };
    (0..count).map(merge).collect()
}

impl<T> Merge<'_, T> {
    /// Puts its keys in order.
    #[expect(
        clippy::stable_sort_primitive,
        reason = "the stable sort finds runs that are in order and merges them"
    )]
    fn put_in_order(&mut self) {
        let mut rest = &mut *self.keys;
        for run in &self.of_runs {
            let (place, after) = rest.split_at_mut(run.len());
            place.copy_from_slice(run);
            rest = after;
        }
        self.keys.sort();
    }
}

/// How three numbers make one key, behind a first that all have in common.
#[derive(Clone, Copy)]
struct Packing {
    first: u32,
    least: [u32; 3],
    widths: [u32; 3],
}

impl Packing {
    /// For all of these.
    fn of<T: Hit>(all: &[T]) -> Self {
        let (mut least, mut most) = ([u32::MAX; 3], [0; 3]);
        let mut first = 0;
        for numbers in all.iter().map(T::numbers) {
            first = numbers[0];
            for k in 0..3 {
                least[k] = least[k].min(numbers[k + 1]);
                most[k] = most[k].max(numbers[k + 1]);
            }
        }
        let mut widths = [0; 3];
        for k in 0..3 {
            widths[k] = u32::BITS - (most[k] - least[k]).leading_zeros();
        }
        Self {
            first,
            least,
            widths,
        }
    }

    fn bits(&self) -> u32 {
        self.widths.iter().sum()
    }

    fn key(&self, numbers: [u32; 4]) -> u64 {
        (0..3).fold(0, |key: u64, k| {
            key << self.widths[k] | u64::from(numbers[k + 1] - self.least[k])
        })
    }

    fn numbers(&self, key: u64) -> [u32; 4] {
        let [mut a, mut b, mut c] = self.least;
        let mut rest = key;
        for (number, width) in [&mut c, &mut b, &mut a]
            .into_iter()
            .zip(self.widths.iter().rev())
        {
            *number += (rest & ((1 << width) - 1)) as u32;
            rest >>= width;
        }
        [self.first, a, b, c]
    }
}

/// Puts keys of some bits into `sorted`, in order; the slices are as long as there are keys, and a digit has at most as many values as
/// there are places.
fn sort_keys(
    keys: impl Iterator<Item = u64>,
    sorted: &mut [u64],
    spare: &mut [u64],
    places: &mut [u32],
    bits: u32,
) {
    // Every pass goes from one to the other, the last to `sorted`.
    let (from, to) = if passes(sorted.len(), places.len(), bits).is_multiple_of(2) {
        (sorted, spare)
    } else {
        (spare, sorted)
    };
    for (place, key) in from.iter_mut().zip(keys) {
        *place = key;
    }
    sort_digits(from, to, places, bits);
}

/// The bits of a digit at most, where so many are sorted.
fn digit_of(count: usize) -> u32 {
    if count < MANY { DIGIT } else { LONG_DIGIT }
}

/// How many passes so many keys need, if there are so many places; none where they are compared.
fn passes(count: usize, places: usize, bits: u32) -> u32 {
    if count < FEW {
        0
    } else {
        bits.div_ceil(digit_of(count).min(places.ilog2()))
    }
}

/// Puts keys in the order of some low bits, the others being equal; returns where they are then.
fn sort_digits<'k>(
    mut from: &'k mut [u64],
    mut to: &'k mut [u64],
    places: &mut [u32],
    bits: u32,
) -> &'k mut [u64] {
    let passes = passes(from.len(), places.len(), bits);
    if passes == 0 {
        from.sort_unstable();
    }
    for pass in 0..passes {
        // Equal digits, or nearly, rather than full ones and a rest.
        let (low, high) = (bits * pass / passes, bits * (pass + 1) / passes);
        distribute(from, to, &mut places[..1 << (high - low)], low);
        std::mem::swap(&mut from, &mut to);
    }
    from
}

/// Puts keys in the order of a digit, of which there are as many as places, equal ones in the order in which they are.
fn distribute(from: &[u64], to: &mut [u64], places: &mut [u32], low: u32) {
    places.fill(0);
    let mask = places.len() - 1;
    let digit = |key: u64| (key >> (low % u64::BITS)) as usize & mask;
    for &key in from {
        places[digit(key)] += 1;
    }
    let mut before = 0;
    for place in &mut *places {
        before += std::mem::replace(place, before);
    }
    for &key in from {
        let place = &mut places[digit(key)];
        to[*place as usize] = key;
        *place += 1;
    }
}

impl Held for Sorter {
    fn held(&self) -> usize {
        held::list(&self.keys) + held::list(&self.spare) + held::list(&self.places)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Pair;
    use crate::threads::{Interrupt, Threads};
    use std::num::NonZeroUsize;

    #[test]
    fn any_numbers_in_any_number() {
        let mut state = 1_u64;
        let mut next = |bits: u32| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            ((state >> 32) as u32).checked_shr(32 - bits).unwrap_or(0)
        };
        let mut sorter = Sorter::default();
        for (count, first_bits, second_bits) in [
            (0, 9, 9),
            (1, 9, 9),
            (5, 9, 9),
            (5, 32, 32),
            (FEW - 1, 0, 7),
            (FEW, 15, 15),
            (5000, 15, 3),
            (5000, 0, 0),
            (5000, 0, 12),
            (4000, 32, 32),
            (4000, 1, 32),
            (70_000, 16, 17),
            (LONGEST_RUN + 9, 16, 17),
            (3 * LONGEST_RUN, 0, 0),
            (3 * LONGEST_RUN, 1, 9),
            (4 * LONGEST_RUN, 19, 18),
            (2 * LONGEST_RUN, 32, 31),
        ] {
            let items: Vec<Pair> = (0..count)
                .map(|_| [5, next(first_bits), 7, next(second_bits)])
                .map(Pair::of_numbers)
                .collect();
            let mut expected = items.clone();
            expected.sort_unstable();
            for threads in [1, 2, 7] {
                let interrupt = &Interrupt::default();
                let pool = &Threads::private(NonZeroUsize::new(threads).unwrap());
                let executor = Executor {
                    threads: pool,
                    interrupt,
                };
                let mut items = items.clone();
                sort(executor, &mut items, &mut sorter);
                assert!(
                    items == expected,
                    "{count} {first_bits} {second_bits} {threads}"
                );
            }
        }
    }
}
