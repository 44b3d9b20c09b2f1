//! Points side by side in memory, laid out so that one is read as four numbers at once.

use super::Scalar;
use crate::exec::Threads;
use crate::kernels::Level;
use crate::kernels::gather::{IN_A_ROW, RowBounds, gather};

/// Points in a job: some microseconds of work; a whole number of rows.
pub(crate) const POINTS_JOB: usize = 64 * IN_A_ROW;
/// So many points, or fewer, are not worth waking a thread.
pub(crate) const POINTS_SHARED: usize = 4 * POINTS_JOB;

/// Points of three coordinates and a fourth number that means nothing, so that each fills a register of four; and the bounds of
/// every few in a row.
#[derive(Clone, Debug)]
pub(crate) struct Points<S> {
    points: Vec<[S; 4]>,
    bounds: Vec<RowBounds<S>>,
}

impl<S: Scalar> Points<S> {
    /// Room for points that are yet to come.
    pub(crate) fn with_len(len: usize) -> Self {
        Self {
            points: vec![[S::default(); 4]; len],
            bounds: vec![[[S::default(); 4]; 2]; len.div_ceil(IN_A_ROW)],
        }
    }

    /// Points in the order in which they come.
    #[cfg(test)]
    pub(crate) fn of(points: &[[S; 3]]) -> Self {
        let order: Vec<u32> = (0..points.len() as u32).collect();
        let mut all = Self::with_len(points.len());
        all.gather(crate::kernels::widest(), &Threads::one(), points, &order);
        all
    }

    /// Takes the points that `order` names.
    pub(crate) fn gather(
        &mut self,
        level: Level,
        threads: &Threads,
        from: &[[S; 3]],
        order: &[u32],
    ) {
        let Self { points, bounds } = self;
        if points.len() <= POINTS_SHARED || !threads.are_many() {
            gather(level, from, order, points, bounds);
            return;
        }
        let mut jobs: Vec<_> = points
            .chunks_mut(POINTS_JOB)
            .zip(bounds.chunks_mut(POINTS_JOB / IN_A_ROW))
            .zip(order.chunks(POINTS_JOB))
            .collect();
        threads.run(&mut jobs, |_, ((points, bounds), order)| {
            gather(level, from, order, points, bounds);
        });
    }

    #[inline]
    pub(crate) fn get(&self, point: u32) -> [S; 3] {
        let [x, y, z, _] = *self.wide(point);
        [x, y, z]
    }
}

impl<S> Points<S> {
    /// A run of points, each with the number that means nothing.
    #[inline(always)]
    pub(crate) fn run(&self, run: std::ops::Range<usize>) -> &[[S; 4]] {
        &self.points[run]
    }

    /// The bounds of every [`IN_A_ROW`] points.
    #[inline(always)]
    pub(crate) fn bounds(&self) -> &[RowBounds<S>] {
        &self.bounds
    }

    /// A point and the number that means nothing.
    #[inline(always)]
    pub(crate) fn wide(&self, point: u32) -> &[S; 4] {
        &self.points[point as usize]
    }
}
