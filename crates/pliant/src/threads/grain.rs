//! Sizes of jobs, and how many threads the work of a part pays.
//!
//! Idea: `W` nanoseconds on `p` threads take about `W / p + p * HELPER`, the least of which is at
//! `p = sqrt(W / HELPER)`. Invariant: work is cut by its size alone, never by the number of threads.
//! What a job takes is a rough figure: it chooses how many threads wake, and changes no answer.

/// A job of some kind of work.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grain {
    /// Items in a job.
    pub(crate) items: usize,
    /// About how long a job takes, in nanoseconds.
    pub(crate) nanoseconds: u64,
}

/// What it takes to give one thread more a share and to wait for it, in nanoseconds.
const HELPER: u64 = 2_000;

impl Grain {
    /// Boxes of wide nodes, from vertices or from the boxes below.
    pub(crate) const WIDE_NODES: Self = Self::of(16, 1_500);
    /// Boxes of wide nodes of leaves with all their triangles.
    pub(crate) const WHOLE: Self = Self::of(4, 3_000);
    /// Boxes of the triangles in leaves, which were reached.
    pub(crate) const LEAVES: Self = Self::of(64, 4_000);
    /// Points that are checked, copied or brought into tree order; whole rows of 32.
    pub(crate) const POINTS: Self = Self::of(2_048, 3_000);
    /// Blocks of eight triangles that are quantized.
    pub(crate) const QUANTIZED: Self = Self::of(128, 2_000);
    /// Runs of triangles whose elements get boxes.
    pub(crate) const RUNS: Self = Self::of(256, 8_000);
    /// Close pairs that are measured.
    pub(crate) const MEASURED: Self = Self::of(1_024, 30_000);
    /// Keys of hits, in either of the two passes that put them in order.
    pub(crate) const KEYS: Self = Self::of(1_024, 6_000);

    /// Triangles of bodies that a query makes ready, or that meet, if nothing more is known.
    pub(crate) const TRIANGLES: Self = Self::of(1_024, 10_000);
    /// Pairs of leaves that are tested.
    pub(crate) const LEAF_PAIRS: Self = Self::of(64, 20_000);

    /// About how long so many items take together, in nanoseconds.
    pub(crate) const fn time(self, items: usize) -> u64 {
        items as u64 * self.nanoseconds / self.items as u64
    }

    const fn of(items: usize, nanoseconds: u64) -> Self {
        Self { items, nanoseconds }
    }
}

/// How many threads work of so many nanoseconds pays; at least one, the calling thread.
pub(crate) fn threads_for(nanoseconds: u64) -> usize {
    usize::try_from((nanoseconds / HELPER).isqrt()).map_or(usize::MAX, |count| count.max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the model above, for work of 1 ns to 1 s, and up to 256 threads that there are.
    #[test]
    fn more_threads_never_take_longer() {
        let takes = |work: u64, threads: u64| work / threads + (threads - 1) * HELPER;
        for work in (0..30).map(|power| 1 << power) {
            let mut before = u64::MAX;
            for there_are in 1..=256 {
                let used = threads_for(work).min(there_are) as u64;
                let now = takes(work, used);
                assert!(now <= before, "{work} ns, {there_are} threads");
                before = now;
            }
            assert!(before <= work);
        }
    }
}
