//! Radix sort of keys from the leading bits, which ends in ranks or bitmaps once buckets are small
//! or dense.
//!
//! The leading bits of a key choose its bucket and only the rest is written there; most buckets get
//! a dozen keys or two. In a small bucket the place of each key is its rank (`kernels::ranks`). A
//! large bucket of short rests becomes a bitmap; any other is divided again. Each thread's keys are
//! spread into buckets of their own; then each thread sorts a run of buckets, of all parts. No two
//! keys are equal: bitmaps would lose one of them.

use crate::held::{self, held};
use crate::kernels::{Instructions, Simd, dispatch, ranks};
use crate::threads::{Executor, Grain};
use std::ops::Range;

/// Keys in a bucket, on average, until there are [`BUCKETS`] of them.
const BUCKET: usize = 16;
/// The most buckets. Their ends, 4 bytes each, stay in a near cache.
const BUCKETS: usize = 1 << 16;
/// The most bits of rests for which a bitmap is made. It then takes 128 KiB.
const BITMAP: u32 = 20;
/// The most words of a bitmap's summary for each rest: up to here reading them costs less than
/// buckets.
const SUMMARY: usize = 4;
/// The fewest keys of a run: fewer are not worth waking a thread.
const SHORTEST_RUN: usize = 1024;
/// Number of keys between two looks at the interruption.
const UNINTERRUPTED: usize = 1 << 16;

/// Scratch memory of the sort, kept from list to list. Rests take as few bytes as they need.
#[derive(Debug, Default)]
pub(super) struct Buckets {
    short: Lists<u32>,
    long: Lists<u64>,
}

#[derive(Debug, Default)]
struct Lists<R> {
    /// Rests of each part's keys, bucket by bucket.
    rests: Vec<R>,
    /// Ends of the buckets of every part.
    ends: Vec<u32>,
    /// Scratch memory, one for each thread.
    scratch: Vec<Scratch<R>>,
}

#[derive(Debug, Default)]
struct Scratch<R> {
    /// Rests of one bucket, gathered from all parts.
    bucket: Vec<R>,
    /// Bitmap with a bit for each rest. It is all zero between buckets.
    bitmap: Vec<u64>,
    /// Bitmap with a bit for each word of `bitmap` that is not zero.
    summary: Vec<u64>,
    /// Lists for buckets of a bucket, and their ends: those that are not in use.
    inner: Vec<(Vec<R>, Vec<u32>)>,
}

impl Buckets {
    /// Sorts keys, which come in parts, and writes `make(key)` for each of them to `made`, in order
    /// of the keys. O(keys).
    ///
    /// There are fewer than 2^32 keys, at least `least` and at most `most`, which is at most 2^63.
    /// Interrupted, it leaves anything.
    pub(super) fn put_in_order<'k, T: Send>(
        &mut self,
        (executor, instructions): (Executor, Instructions),
        keys: impl Iterator<Item = &'k [u64]>,
        [least, most]: [u64; 2],
        make: impl Fn(u64) -> T + Copy + Sync,
        made: &mut [T],
    ) {
        if executor.is_interrupted() || made.is_empty() {
            return;
        }
        let division = Division::new(made.len(), least, most - least);
        let job = Job {
            executor,
            instructions,
            division,
            make,
        };
        // Ranks are for numbers below 2^31.
        if division.rest < u32::BITS {
            job.put_in_order(keys, &mut self.short, made);
        } else {
            job.put_in_order(keys, &mut self.long, made);
        }
    }
}

/// Resizes a list to `len` items. Returns false, and stops, if it is interrupted.
///
/// It looks at the interruption, because memory that is written for the first time takes longer
/// than sorting.
pub(super) fn lengthen<T: Clone>(list: &mut Vec<T>, len: usize, by: T, executor: Executor) -> bool {
    list.truncate(len);
    list.reserve(len - list.len());
    while list.len() < len {
        if executor.is_interrupted() {
            return false;
        }
        list.resize(len.min(list.len() + UNINTERRUPTED), by.clone());
    }
    true
}

/// Division of keys into buckets by their leading bits.
#[derive(Clone, Copy)]
struct Division {
    /// Least key: no key is below it.
    least: u64,
    /// Bits of the rest of a key, the low bits of `key - least`. The bits above are the number of
    /// its bucket.
    rest: u32,
    buckets: usize,
}

impl Division {
    /// Division for `count` keys, none of which is more than `range` above `least`.
    fn new(count: usize, least: u64, range: u64) -> Self {
        let most = (count / BUCKET).clamp(1, BUCKETS);
        let bits = u64::BITS - range.leading_zeros();
        let mut rest = bits.saturating_sub(most.ilog2() + 1);
        while range >> rest >= most as u64 {
            rest += 1;
        }
        Self {
            least,
            rest,
            buckets: (range >> rest) as usize + 1,
        }
    }

    /// The least key that a bucket can have.
    #[inline(always)]
    fn least_of(self, bucket: usize) -> u64 {
        self.least + ((bucket as u64) << self.rest)
    }
}

/// Rest of a key: its bits below the number of the bucket.
trait Rest: Copy + Default + Send + Sync {
    /// Narrows bits, for which it has room.
    fn of(bits: u64) -> Self;
    fn bits(self) -> u64;
    /// Rank of each number: how many of them are smaller. Ranks behind the last number mean
    /// nothing.
    fn rank<I: Simd>(i: I, few: &[Self], ranks: &mut [u32; ranks::MOST]);
}

impl Rest for u32 {
    #[inline(always)]
    fn of(bits: u64) -> Self {
        bits as u32
    }

    #[inline(always)]
    fn bits(self) -> u64 {
        self.into()
    }

    #[inline(always)]
    fn rank<I: Simd>(i: I, few: &[Self], ranks: &mut [u32; ranks::MOST]) {
        ranks::rank(i, few, ranks);
    }
}

impl Rest for u64 {
    #[inline(always)]
    fn of(bits: u64) -> Self {
        bits
    }

    #[inline(always)]
    fn bits(self) -> u64 {
        self
    }

    #[inline(always)]
    fn rank<I: Simd>(_: I, few: &[Self], ranks: &mut [u32; ranks::MOST]) {
        for (rank, one) in ranks.iter_mut().zip(few) {
            *rank = 0;
            for other in few {
                *rank += u32::from(other < one);
            }
        }
    }
}

/// Settings of one sort: how to divide the keys, and what is made of them.
#[derive(Clone, Copy)]
struct Job<'q, F> {
    executor: Executor<'q>,
    instructions: Instructions,
    division: Division,
    make: F,
}

/// Keys of one thread, or some of them, and their rests in buckets.
struct Part<'k, R> {
    keys: &'k [u64],
    rests: &'k mut [R],
    ends: &'k mut [u32],
}

impl<R> Part<'_, R> {
    /// Range of a bucket in the part's rests.
    #[inline(always)]
    fn bucket(&self, number: usize) -> Range<usize> {
        let start = number.checked_sub(1).map_or(0, |last| self.ends[last]);
        start as usize..self.ends[number] as usize
    }
}

/// Run of consecutive buckets, and the place for what their keys become.
struct Run<'k, R, T> {
    buckets: Range<usize>,
    made: &'k mut [T],
    scratch: &'k mut Scratch<R>,
}

impl<T: Send, F: Fn(u64) -> T + Copy + Sync> Job<'_, F> {
    fn put_in_order<'k, R: Rest>(
        self,
        keys: impl Iterator<Item = &'k [u64]>,
        lists: &mut Lists<R>,
        made: &mut [T],
    ) {
        let (executor, buckets) = (self.executor, self.division.buckets);
        let (rests, ends, scratch) = (&mut lists.rests, &mut lists.ends, &mut lists.scratch);
        if !lengthen(rests, made.len(), R::default(), executor) {
            return;
        }
        let nanoseconds = Grain::KEYS.time(made.len());
        let runs = executor.threads_for(nanoseconds);
        let runs = runs.min(made.len() / SHORTEST_RUN).max(1);
        scratch.resize_with(scratch.len().max(runs), Scratch::default);
        // One thread may have found nearly all.
        let most = made.len().div_ceil(runs);
        let mut keys = keys.flat_map(|keys| keys.chunks(most));
        let first = keys.next().unwrap_or_default();
        let second = keys.next();
        if runs == 1 && second.is_none() {
            // One part needs no list of parts, which every step would allocate.
            ends.resize(ends.len().max(buckets), 0);
            let ends = &mut ends[..buckets];
            let mut part = Part {
                keys: first,
                rests,
                ends,
            };
            self.spread(&mut part);
            let mut run = Run {
                buckets: 0..buckets,
                made,
                scratch: &mut scratch[0],
            };
            self.put_run_in_order(std::slice::from_ref(&part), &mut run);
            return;
        }
        let keys: Vec<&[u64]> = [first].into_iter().chain(second).chain(keys).collect();
        ends.resize(ends.len().max(keys.len() * buckets), 0);
        let mut rests = &mut **rests;
        let part = |(keys, ends): (&'k [u64], _)| Part {
            keys,
            rests: rests.split_off_mut(..keys.len()).unwrap_or_default(),
            ends,
        };
        let each = keys.into_iter().zip(ends.chunks_mut(buckets));
        let mut parts: Vec<_> = each.map(part).collect();
        executor.run(&mut parts, nanoseconds, |_, part| self.spread(part));
        if executor.is_interrupted() {
            return;
        }
        let mut runs = cut(&parts, made, &mut scratch[..runs]);
        executor.run(&mut runs, nanoseconds, |_, run| {
            self.put_run_in_order(&parts, run);
        });
    }

    /// Spreads the keys of a part into buckets.
    fn spread<R: Rest>(&self, part: &mut Part<R>) {
        let Part { keys, rests, ends } = part;
        self.spread_any(keys, |&key| key - self.division.least, rests, ends);
    }

    /// Spreads items into buckets by counting sort, in O(items). `above` returns an item's key less
    /// the least key.
    fn spread_any<K, R: Rest>(
        &self,
        keys: &[K],
        above: impl Fn(&K) -> u64,
        rests: &mut [R],
        ends: &mut [u32],
    ) {
        let rest = self.division.rest;
        ends.fill(0);
        for some in keys.chunks(UNINTERRUPTED) {
            if self.executor.is_interrupted() {
                return;
            }
            for key in some {
                ends[(above(key) >> rest) as usize] += 1;
            }
        }
        let mut before = 0;
        for end in &mut *ends {
            before += std::mem::replace(end, before);
        }
        for some in keys.chunks(UNINTERRUPTED) {
            if self.executor.is_interrupted() {
                return;
            }
            for key in some {
                let above = above(key);
                let place = &mut ends[(above >> rest) as usize];
                rests[*place as usize] = R::of(above & ((1 << rest) - 1));
                *place += 1;
            }
        }
    }

    /// Sorts the keys of a run of buckets, unless an interruption came before.
    fn put_run_in_order<R: Rest>(self, parts: &[Part<R>], run: &mut Run<R, T>) {
        if !self.executor.is_interrupted() {
            dispatch!(self.instructions, i => self.put_buckets_in_order(i, parts, run));
        }
    }

    #[inline(always)]
    fn put_buckets_in_order<I: Simd, R: Rest>(self, i: I, parts: &[Part<R>], run: &mut Run<R, T>) {
        let scratch = &mut *run.scratch;
        let mut rest = &mut *run.made;
        let mut looked_at = 0;
        let mut gathered = std::mem::take(&mut scratch.bucket);
        for number in run.buckets.clone() {
            let bucket = if let [part] = parts {
                &part.rests[part.bucket(number)]
            } else {
                gathered.clear();
                for part in parts {
                    gathered.extend_from_slice(&part.rests[part.bucket(number)]);
                }
                &gathered
            };
            let made = rest.split_off_mut(..bucket.len()).unwrap_or_default();
            self.put_bucket_in_order(i, bucket, self.division.least_of(number), scratch, made);
            looked_at += bucket.len();
            if looked_at > UNINTERRUPTED {
                looked_at = 0;
                if self.executor.is_interrupted() {
                    break;
                }
            }
        }
        scratch.bucket = gathered;
    }

    /// Sorts the keys of one bucket. `least` is the least key that the bucket can have.
    #[inline(always)]
    fn put_bucket_in_order<I: Simd, R: Rest>(
        self,
        i: I,
        bucket: &[R],
        least: u64,
        scratch: &mut Scratch<R>,
        made: &mut [T],
    ) {
        let rest = self.division.rest;
        if bucket.len() <= ranks::MOST {
            let mut ranks = [0; ranks::MOST];
            R::rank(i, bucket, &mut ranks);
            for (one, rank) in bucket.iter().zip(ranks) {
                made[rank as usize] = (self.make)(least + one.bits());
            }
        } else if rest <= BITMAP && 1 << rest >> 12 <= SUMMARY * bucket.len() {
            let mut places = made.iter_mut();
            scratch.in_order(bucket, rest, |bits| {
                if let Some(place) = places.next() {
                    *place = (self.make)(least + bits);
                }
            });
        } else {
            self.divide(bucket, least, scratch, made);
        }
    }

    /// Spreads the keys of a bucket into buckets of their own, and sorts these.
    #[cold]
    #[inline(never)]
    fn divide<R: Rest>(self, bucket: &[R], least: u64, scratch: &mut Scratch<R>, made: &mut [T]) {
        let (mut rests, mut ends) = scratch.inner.pop().unwrap_or_default();
        let range = (1 << self.division.rest) - 1;
        let division = Division::new(bucket.len(), least, range);
        let job = Self { division, ..self };
        if lengthen(&mut rests, bucket.len(), R::default(), self.executor) {
            ends.resize(ends.len().max(division.buckets), 0);
            let (rests, ends) = (&mut *rests, &mut ends[..division.buckets]);
            job.spread_any(bucket, |rest| rest.bits(), rests, ends);
            let keys = &[];
            let part = Part { keys, rests, ends };
            let mut run = Run {
                buckets: 0..division.buckets,
                made,
                scratch,
            };
            job.put_run_in_order(&[part], &mut run);
        }
        scratch.inner.push((rests, ends));
    }
}

impl<R: Rest> Scratch<R> {
    /// Shows rests of `bits` bits in order.
    #[inline(always)]
    fn in_order(&mut self, rests: &[R], bits: u32, mut show: impl FnMut(u64)) {
        let count = (1_usize << bits).div_ceil(64);
        let (bitmap, summary) = (&mut self.bitmap, &mut self.summary);
        bitmap.resize(bitmap.len().max(count), 0);
        summary.resize(summary.len().max(count.div_ceil(64)), 0);
        for rest in rests {
            let rest = rest.bits() as usize;
            let word = rest / 64;
            bitmap[word] |= 1 << (rest % 64);
            summary[word / 64] |= 1 << (word % 64);
        }
        for (place, of_words) in summary[..count.div_ceil(64)].iter_mut().enumerate() {
            take_bits(of_words, |word| {
                let word = 64 * place + word as usize;
                take_bits(&mut bitmap[word], |bit| show(64 * word as u64 + bit));
            });
        }
    }
}

/// Shows the set bits of a word, lowest first, and clears them.
#[inline(always)]
fn take_bits(word: &mut u64, mut show: impl FnMut(u64)) {
    let mut rest = std::mem::take(word);
    while rest != 0 {
        show(rest.trailing_zeros().into());
        rest &= rest - 1;
    }
}

/// Cuts all buckets into runs with about equal numbers of keys, one for each scratch memory.
fn cut<'k, R, T>(
    parts: &[Part<R>],
    mut made: &'k mut [T],
    scratch: &'k mut [Scratch<R>],
) -> Vec<Run<'k, R, T>> {
    let buckets = parts.first().map_or(0, |part| part.ends.len());
    // Number of keys in all buckets before one.
    let before = |number: usize| -> usize {
        let starts = parts.iter().map(|part| part.bucket(number).start);
        starts.sum()
    };
    let (runs, count) = (scratch.len(), made.len());
    let (mut start, mut done) = (0, 0);
    let run = |(number, scratch)| {
        let (mut end, mut until) = (buckets, count);
        if number + 1 < runs {
            let enough = count * (number + 1) / runs;
            let (mut low, mut high) = (start, buckets);
            while low < high {
                let middle = low.midpoint(high);
                if before(middle) < enough {
                    low = middle + 1;
                } else {
                    high = middle;
                }
            }
            if low < buckets {
                (end, until) = (low, before(low));
            }
        }
        let run = Run {
            buckets: start..end,
            made: made.split_off_mut(..until - done).unwrap_or_default(),
            scratch,
        };
        (start, done) = (end, until);
        run
    };
    scratch.iter_mut().enumerate().map(run).collect()
}

held!(Buckets: short, long);

held!(Lists<R>: rests[], ends[], scratch);

held!(Scratch<R>: bucket[], bitmap[], summary[];
    |scratch| held::list(&scratch.inner)
        + scratch.inner.iter().map(|(rests, ends)| held::list(rests) + held::list(ends))
            .sum::<usize>());
