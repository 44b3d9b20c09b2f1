//! Grain sizes of jobs, and the number of threads that the work of a part pays for.
//!
//! Idea: `W` nanoseconds on `p` threads take about `W / p + p * HELPER + SHARING`. That is least at
//! `p = sqrt(W / HELPER)`, and more than `W` where that is small. Invariant: results never depend
//! on the number of threads. Times of jobs are rough figures: they choose how many threads wake,
//! and change no answer.

/// Size of a job of some kind of work.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grain {
    /// Items in a job.
    pub(crate) items: usize,
    /// Rough time of a job, in nanoseconds.
    pub(crate) nanoseconds: u64,
}

/// Assumed cost of one more thread, in nanoseconds: handing it a share, and waiting for it.
const HELPER: u64 = 2_000;
/// Assumed cost of sharing at all: one core reads what another has in its cache.
const SHARING: u64 = 6_000;

impl Grain {
    /// Boxes of wide nodes, from vertices or from the boxes below.
    pub(crate) const WIDE_NODES: Self = Self::of(16, 1_500);
    /// Boxes of wide nodes of leaves with all their triangles.
    pub(crate) const WHOLE: Self = Self::of(4, 1_000);
    /// Boxes of the triangles in leaves that were reached.
    pub(crate) const LEAVES: Self = Self::of(64, 4_000);
    /// Points that are checked, copied or brought into tree order; whole rows of 32.
    pub(crate) const POINTS: Self = Self::of(2_048, 3_000);
    /// Blocks of eight triangles that are quantized.
    pub(crate) const QUANTIZED: Self = Self::of(128, 1_000);
    /// Runs of triangles whose elements get boxes.
    pub(crate) const RUNS: Self = Self::of(256, 8_000);
    /// Close pairs that are measured.
    pub(crate) const MEASURED: Self = Self::of(1_024, 30_000);
    /// Points of the caller, of which a ray or the nearest triangles are looked at.
    pub(crate) const RAYS: Self = Self::of(512, 60_000);
    /// Hits that are more than their numbers, in either of the two passes of their sort.
    pub(crate) const LISTED: Self = Self::of(512, 20_000);
    /// Keys of hits, in either of the two passes of their sort.
    pub(crate) const KEYS: Self = Self::of(1_024, 6_000);

    /// Triangles of bodies that a query prepares, or that meet, if nothing more is known.
    pub(crate) const TRIANGLES: Self = Self::of(1_024, 10_000);
    /// Triangles that are counted at their vertices, or vertices where they were.
    pub(crate) const STARS: Self = Self::of(2_048, 12_000);
    /// Vertices whose triangles are looked at one by one.
    pub(crate) const STARS_LEFT: Self = Self::of(32, 6_000);
    /// Bodies, beside what is done with their triangles or points.
    pub(crate) const BODIES: Self = Self::of(1, 300);
    /// Bodies whose boxes are copied.
    pub(crate) const BOXES: Self = Self::of(64, 10_000);
    /// Bodies whose pairs the broad phase finds.
    pub(crate) const ROWS: Self = Self::of(32, 16_000);
    /// Pairs of nodes that waited for boxes, with all that they become.
    pub(crate) const NODE_PAIRS: Self = Self::of(64, 64_000);
    /// Pairs of leaves that are tested.
    pub(crate) const LEAF_PAIRS: Self = Self::of(64, 20_000);
    /// Leaves that are tested with themselves and their neighbours.
    pub(crate) const NEIGHBOURS: Self = Self::of(64, 5_000);

    /// Rough time of `items` items together, in nanoseconds.
    pub(crate) const fn time(self, items: usize) -> u64 {
        items as u64 * self.nanoseconds / self.items as u64
    }

    const fn of(items: usize, nanoseconds: u64) -> Self {
        Self { items, nanoseconds }
    }
}

/// Number of threads that work of `nanoseconds` pays for; at least one, the calling thread.
pub(crate) fn threads_for(nanoseconds: u64) -> usize {
    // Two threads save half of the work at most.
    if nanoseconds < 2 * (SHARING + HELPER) {
        return 1;
    }
    usize::try_from((nanoseconds / HELPER).isqrt()).unwrap_or(usize::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the model above, for work of 1 ns to 1 s, and up to 256 threads.
    #[test]
    fn more_threads_never_take_longer() {
        assert_eq!([15_999, 16_000].map(threads_for), [1, 2]);
        let shared = |threads: u64| SHARING + (threads - 1) * HELPER;
        let takes = |work: u64, threads: u64| match threads {
            1 => work,
            _ => work / threads + shared(threads),
        };
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
