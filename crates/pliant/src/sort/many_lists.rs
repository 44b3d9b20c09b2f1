//! Parallel sort of one list a thread by regular sampling (Shi and Schaeffer 1992).
//!
//! Pieces of the lists are sorted. Splitters from regular samples of all pieces then cut each into
//! ranges; a range of all pieces is merged by one thread. Differs from `buckets`: items are more
//! than keys. The order is total, as no two items are equal, so it does not depend on the lists.

use super::{Numbered, sort_by_numbers};
use crate::threads::{Executor, Grain, PerThread};

/// Fewest items of a piece or a range: fewer are not worth a thread.
const FEWEST: usize = 512;
/// Samples of a piece for each range.
const SAMPLES: usize = 4;

/// Sorts the items of all lists together. O(n log n), shared by threads. `sorted` is scratch.
/// Interrupted, it returns anything.
pub(crate) fn sort_lists<'l, T: Numbered + Copy + Send + Sync>(
    lists: &'l mut PerThread<Vec<T>>,
    executor: Executor,
    sorted: &'l mut Vec<T>,
) -> &'l [T] {
    let count: usize = lists.iter_mut().map(|list| list.len()).sum();
    let nanoseconds = Grain::LISTED.time(count);
    let ranges = executor.threads_for(nanoseconds).min(count / FEWEST);
    if ranges < 2 {
        let mut lists = lists.iter_mut();
        let Some(all) = lists.next() else {
            return &[];
        };
        lists.for_each(|list| all.append(list));
        sort_by_numbers(all);
        return all;
    }
    // One thread may have found nearly all.
    let pieces = lists
        .iter_mut()
        .flat_map(|list| list.chunks_mut(count.div_ceil(ranges)));
    let mut pieces: Vec<&mut [T]> = pieces.collect();
    executor.run(&mut pieces, nanoseconds, |_, piece| sort_by_numbers(piece));
    if executor.is_interrupted() {
        return &[];
    }
    let samples = pieces.iter().flat_map(|piece| {
        let every = piece.len().div_ceil(SAMPLES * ranges).max(1);
        piece.iter().step_by(every).map(T::numbers)
    });
    let mut samples: Vec<_> = samples.collect();
    samples.sort_unstable();
    let splitter = |range: usize| samples[range * samples.len() / ranges];
    let filler = pieces.iter().find_map(|piece| piece.first().copied());
    let Some(filler) = filler else { return &[] };
    sorted.resize(count, filler);
    let mut rest = &mut sorted[..];
    let mut starts = vec![0; pieces.len()];
    let mut jobs: Vec<_> = (1..=ranges)
        .map(|range| {
            let slices = pieces.iter().zip(&mut starts).map(|(piece, start)| {
                let end = if range < ranges {
                    piece.partition_point(|item| item.numbers() < splitter(range))
                } else {
                    piece.len()
                };
                &piece[std::mem::replace(start, end)..end]
            });
            let slices: Vec<&[T]> = slices.collect();
            let items = slices.iter().map(|slice| slice.len()).sum();
            let place = rest.split_off_mut(..items).unwrap_or_default();
            (slices, place)
        })
        .collect();
    executor.run(&mut jobs, nanoseconds, |_, (slices, place)| {
        let mut rest = &mut **place;
        for slice in slices {
            let (head, tail) = rest.split_at_mut(slice.len());
            head.copy_from_slice(slice);
            rest = tail;
        }
        // A stable sort sees that it is sorted runs, and merges them.
        place.sort_by_key(T::numbers);
    });
    sorted
}

#[cfg(test)]
mod tests {
    use super::super::Hit;
    use super::*;
    use crate::Pair;
    use crate::threads::{Interrupt, Threads};
    use pliant_oracle::Random;
    use std::num::NonZeroUsize;

    #[test]
    fn lists_of_any_lengths() {
        let mut random = Random::new(3);
        for lengths in [
            &[0_u32, 0][..],
            &[9, 0, 1],
            &[0, 20_000, 0],
            &[3_000, 1, 9_000, 700, 0, 5_000],
        ] {
            let mut next = 0;
            let lists: Vec<Vec<Pair>> = lengths
                .iter()
                .map(|&length| {
                    let numbers = (0..length).map(|_| {
                        next += 1;
                        // Few first numbers; all are different.
                        let first = (random.bits() % 7) as u32;
                        [first, (random.bits() >> 60) as u32, 0, next]
                    });
                    numbers.map(Pair::of_numbers).collect()
                })
                .collect();
            let mut expected = lists.concat();
            expected.sort_unstable();
            for threads in [1, 2, 7] {
                let pool = &Threads::private(NonZeroUsize::new(threads).unwrap());
                let interrupt = &Interrupt::default();
                let executor = Executor {
                    threads: pool,
                    interrupt,
                };
                let mut sorted = vec![Pair::of_numbers([9; 4])];
                let mut all = PerThread::<Vec<Pair>>::default();
                all.for_threads(lists.len());
                let each = all.iter_mut().zip(&lists);
                each.for_each(|(list, of)| list.clone_from(of));
                let sorted = sort_lists(&mut all, executor, &mut sorted);
                assert!(sorted == expected, "{lengths:?} {threads}");
            }
        }
    }
}
