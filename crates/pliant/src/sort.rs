//! Hits in the order of their numbers, by a radix sort: digits are counted.
//!
//! Bodies and what is numbered in them are few bits each, so the four numbers of a hit side by side make one key. Hits become keys as they
//! are found, with as many bits as the largest numbers so far need; two to four passes over digits put thousands of them in order without a
//! comparison, for a tenth of the work of a comparison sort; and the keys become hits again. Few keys are compared, and hits of which more
//! than 64 bits are needed.
//!
//! Very many keys are put into buckets by their first digit, those of a large bucket again, and each bucket is then sorted in cache. Several
//! threads sort a run each. Then some keys of every run, evenly spaced, say where to cut all runs, so that what lies between two cuts is
//! about as much for each thread to merge (Shi and Schaeffer 1992, parallel sorting by regular sampling). Hits of equal keys are equal: the
//! result does not depend on the number of threads.

use crate::held::{self, Held};
use crate::hits::Hit;
use crate::threads::Executor;

/// Below this, counting costs more than comparing.
const FEW: usize = 128;
/// Digits of at most so many bits: counts of all its values stay in the nearest cache.
const DIGIT: u32 = 11;
/// The same of fewer keys than [`SOME`]: going through the counts costs less than another pass.
const SHORT_DIGIT: u32 = 8;
const SOME: usize = 1 << 10;
/// The same where there are [`MANY`] keys: a pass less is worth counts that are further away.
const LONG_DIGIT: u32 = 16;
const MANY: usize = 1 << 15;
/// Keys in a bucket, about.
const BUCKET: usize = 1 << 12;
/// The most keys that are sorted without buckets, or in one run: some milliseconds of work.
const LARGEST: usize = 1 << 19;
/// Keys of a run, at least; fewer than two runs are not worth waking a thread.
const SHORTEST_RUN: usize = 1024;
/// So many keys are looked at before it is asked whether somebody wants to stop.
const UNINTERRUPTED: usize = 1 << 16;

/// Hits, and scratch.
#[derive(Debug)]
pub(crate) struct Sorter<T> {
    /// What is found, sorted at the end; before that only hits that do not fit keys.
    hits: Vec<T>,
    packing: Packing,
    keys: Vec<u64>,
    spare: Vec<u64>,
    /// Where keys with a digit go, for every run that is sorted at one time.
    places: Vec<u32>,
}

impl<T> Default for Sorter<T> {
    fn default() -> Self {
        Self {
            hits: Vec::new(),
            packing: Packing::default(),
            keys: Vec::new(),
            spare: Vec::new(),
            places: Vec::new(),
        }
    }
}

impl<T: Hit> Sorter<T> {
    /// Forgets all hits.
    pub(crate) fn begin(&mut self) {
        self.packing = Packing::default();
        self.hits.clear();
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
        } else {
            let hits = self.keys.drain(..);
            self.hits
                .extend(hits.map(|key| T::of_numbers(old.numbers(key))));
        }
    }

    /// Sorts all hits. Interrupted, it leaves them in any state.
    pub(crate) fn sort(&mut self, executor: Executor) {
        let Self {
            hits,
            packing,
            keys,
            spare,
            places,
        } = self;
        let packing = *packing;
        if !packing.fits() {
            hits.sort_unstable_by_key(T::numbers);
            return;
        }
        let first = keys.first().copied().unwrap_or(0);
        let differing = keys.iter().fold(0, |all, key| all | (key ^ first));
        let mut bits = u64::BITS - differing.leading_zeros();
        if u32::try_from(keys.len()).is_err() {
            // Places are not counted so far.
            keys.sort_unstable();
            bits = 0;
        }
        // With millions of keys each of these takes milliseconds.
        if executor.is_interrupted() {
            return;
        }
        spare.resize(keys.len(), 0);
        if executor.is_interrupted() {
            return;
        }
        hits.reserve(keys.len());
        let threads = executor.count().min(keys.len() / SHORTEST_RUN);
        if threads < 2 {
            let mut buckets = Buckets {
                executor,
                places,
                take: |sorted: &[u64]| {
                    let sorted = sorted.iter();
                    hits.extend(sorted.map(|&key| T::of_numbers(packing.numbers(key))));
                },
            };
            buckets.sort(keys, spare, bits);
            return;
        }
        let runs = threads.max(keys.len().div_ceil(LARGEST));
        let size = keys.len().div_ceil(runs);
        // Runs that are sorted one after the other are many, and their places few.
        let digit = digit_of(size).min(if runs > threads { DIGIT } else { LONG_DIGIT });
        places.resize(places.len().max(runs << digit), 0);
        let scratch = spare.chunks_mut(size).zip(places.chunks_mut(1 << digit));
        let mut sorts: Vec<_> = keys.chunks_mut(size).zip(scratch).collect();
        executor.run(&mut sorts, |_, (keys, (spare, places))| {
            sort_in_place(executor, keys, spare, places, bits);
        });
        hits.resize(keys.len(), T::of_numbers([0; 4]));
        let mut merges = cut(keys.chunks(size).collect(), spare, hits);
        executor.run(&mut merges, |_, merge| {
            merge.put_in_order();
            for (hit, &key) in merge.hits.iter_mut().zip(&*merge.keys) {
                *hit = T::of_numbers(packing.numbers(key));
            }
        });
    }
}

impl<T> Sorter<T> {
    /// What was found, in order once it is sorted.
    pub(crate) fn hits(&self) -> &[T] {
        &self.hits
    }
}

/// Shows keys to a function in order, some at a time.
struct Buckets<'q, F> {
    executor: Executor<'q>,
    places: &'q mut Vec<u32>,
    take: F,
}

impl<F: FnMut(&[u64])> Buckets<'_, F> {
    /// Of keys that differ in so many low bits; `spare` is as long. Interrupted, it shows some.
    fn sort(&mut self, keys: &mut [u64], spare: &mut [u64], bits: u32) {
        if self.executor.is_interrupted() {
            return;
        }
        let count = keys.len();
        if count <= LARGEST || bits == 0 {
            let digit = digit_of(count);
            self.places.resize(self.places.len().max(1 << digit), 0);
            let sorted = sort_digits(self.executor, keys, spare, self.places, bits);
            // Memory that is written for the first time takes longer than sorting.
            for sorted in sorted.chunks(UNINTERRUPTED) {
                if self.executor.is_interrupted() {
                    return;
                }
                (self.take)(sorted);
            }
            return;
        }
        let width = (count / BUCKET).ilog2().min(DIGIT).min(bits);
        let rest = bits - width;
        let mask = (1 << width) - 1;
        let bucket = |key: u64| (key >> rest) as usize & mask;
        let mut ends = [0; 1 << DIGIT];
        let ends = &mut ends[..1 << width];
        for keys in keys.chunks(UNINTERRUPTED) {
            for &key in keys {
                ends[bucket(key)] += 1;
            }
            if self.executor.is_interrupted() {
                return;
            }
        }
        to_starts(ends);
        for keys in keys.chunks(UNINTERRUPTED) {
            for &key in keys {
                let place = &mut ends[bucket(key)];
                spare[*place as usize] = key;
                *place += 1;
            }
            if self.executor.is_interrupted() {
                return;
            }
        }
        let mut start = 0;
        for &mut end in ends {
            let of_bucket = start..end as usize;
            start = of_bucket.end;
            if !of_bucket.is_empty() {
                self.sort(&mut spare[of_bucket.clone()], &mut keys[of_bucket], rest);
            }
        }
    }
}

/// The same range of keys of all runs, where they will be in order, and the hits that they will be.
struct Merge<'k, T> {
    of_runs: Vec<&'k [u64]>,
    keys: &'k mut [u64],
    hits: &'k mut [T],
}

/// Cuts runs of keys that are in order into as many ranges.
fn cut<'k, T>(
    mut runs: Vec<&'k [u64]>,
    mut keys: &'k mut [u64],
    mut hits: &'k mut [T],
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
            hits: hits.split_off_mut(..len).unwrap_or_default(),
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

/// How the four numbers of a hit make one key: of so many bits for a body, and for what is numbered in it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Packing {
    body: u32,
    number: u32,
}

impl Packing {
    /// That of these hits, too.
    fn with<T: Hit>(self, hits: &[T]) -> Self {
        let all = hits.iter().map(T::numbers);
        let (bodies, numbers) = all.fold((0, 0), |(bodies, numbers), [a, x, b, y]| {
            (bodies | a | b, numbers | x | y)
        });
        Self {
            body: self.body.max(u32::BITS - bodies.leading_zeros()),
            number: self.number.max(u32::BITS - numbers.leading_zeros()),
        }
    }

    fn fits(self) -> bool {
        2 * (self.body + self.number) <= u64::BITS
    }

    /// Where the first three numbers begin; where there are no bits for bodies, the first may begin behind the last bit.
    fn shifts(self) -> [u32; 3] {
        let Self { body, number } = self;
        [body + 2 * number, body + number, number]
    }

    #[inline(always)]
    fn key(self, numbers: [u32; 4]) -> u64 {
        let shifts = self.shifts();
        let [a, x, b, y] = numbers.map(u64::from);
        a.wrapping_shl(shifts[0]) | x << shifts[1] | b << shifts[2] | y
    }

    #[inline(always)]
    fn numbers(self, key: u64) -> [u32; 4] {
        let shifts = self.shifts();
        let [body, number] = [self.body, self.number].map(|bits| (1_u64 << bits) - 1);
        [
            (key.wrapping_shr(shifts[0]) & body) as u32,
            (key >> shifts[1] & number) as u32,
            (key >> shifts[2] & body) as u32,
            (key & number) as u32,
        ]
    }
}

/// Puts keys that differ in some low bits in order; `spare` is as long, and a digit has at most as many values as there are places.
fn sort_in_place(
    executor: Executor,
    keys: &mut [u64],
    spare: &mut [u64],
    places: &mut [u32],
    bits: u32,
) {
    let passes = passes(keys.len(), places.len(), bits);
    sort_digits(executor, keys, spare, places, bits);
    if !passes.is_multiple_of(2) {
        keys.copy_from_slice(spare);
    }
}

/// The bits of a digit at most, where so many are sorted.
fn digit_of(count: usize) -> u32 {
    match count {
        ..SOME => SHORT_DIGIT,
        SOME..MANY => DIGIT,
        _ => LONG_DIGIT,
    }
}

/// How many passes so many keys need, if there are so many places; none where they are compared.
fn passes(count: usize, places: usize, bits: u32) -> u32 {
    if count < FEW {
        0
    } else {
        bits.div_ceil(digit_of(count).min(places.ilog2()))
    }
}

/// Puts keys in the order of some low bits, the others being equal; returns where they are then. Interrupted, they are in any order.
fn sort_digits<'k>(
    executor: Executor,
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
        if executor.is_interrupted() {
            break;
        }
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
    to_starts(places);
    for &key in from {
        let place = &mut places[digit(key)];
        to[*place as usize] = key;
        *place += 1;
    }
}

/// Counts become the numbers of what is before.
fn to_starts(counts: &mut [u32]) {
    let mut before = 0;
    for count in counts {
        before += std::mem::replace(count, before);
    }
}

impl<T> Held for Sorter<T> {
    fn held(&self) -> usize {
        let of_keys = held::list(&self.keys) + held::list(&self.spare) + held::list(&self.places);
        held::list(&self.hits) + of_keys
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
        let mut sorter = Sorter::<Pair>::default();
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
            (LARGEST + 9, 16, 17),
            (3 * LARGEST, 0, 0),
            (3 * LARGEST, 1, 9),
            (4 * LARGEST, 19, 18),
            (2 * LARGEST, 32, 31),
        ] {
            // Keys have more and more bits where numbers grow, and where they need more than 64 they become hits.
            for (bodies, grow) in [([5, 7], false), ([5, 7], true), ([0, 0], true)] {
                if grow && count > 5000 {
                    continue;
                }
                let numbers =
                    (0..count).map(|_| [bodies[0], next(first_bits), bodies[1], next(second_bits)]);
                let mut items: Vec<Pair> = numbers.map(Pair::of_numbers).collect();
                let mut expected = items.clone();
                expected.sort_unstable();
                if grow {
                    items.clone_from(&expected);
                }
                for threads in [1, 2, 7] {
                    let interrupt = &Interrupt::default();
                    let pool = &Threads::private(NonZeroUsize::new(threads).unwrap());
                    let executor = Executor {
                        threads: pool,
                        interrupt,
                    };
                    sorter.begin();
                    for some in items.chunks(100) {
                        sorter.push(some);
                    }
                    sorter.sort(executor);
                    assert!(
                        sorter.hits() == expected,
                        "{count} {first_bits} {second_bits} {threads}"
                    );
                }
            }
        }
    }
}
