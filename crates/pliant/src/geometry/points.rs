//! Points side by side in memory, laid out so that one is read as four numbers at once.

use super::Scalar;
use crate::exec::Threads;

/// Points in a job: some ten microseconds of work.
pub(crate) const POINTS_JOB: usize = 1 << 13;

/// Points of three coordinates and a fourth number that means nothing, so that each fills a register of four.
#[derive(Clone, Debug)]
pub(crate) struct Points<S> {
    points: Vec<[S; 4]>,
}

impl<S: Scalar> Points<S> {
    /// Room for points that are yet to come.
    pub(crate) fn with_len(len: usize) -> Self {
        Self {
            points: vec![[S::default(); 4]; len],
        }
    }

    /// Points in the order in which they come.
    #[cfg(test)]
    pub(crate) fn of(points: &[[S; 3]]) -> Self {
        let order: Vec<u32> = (0..points.len() as u32).collect();
        let mut all = Self::with_len(points.len());
        all.gather(&Threads::one(), points, &order);
        all
    }

    /// Takes the points that `order` names.
    pub(crate) fn gather(&mut self, threads: &Threads, from: &[[S; 3]], order: &[u32]) {
        let gather = |order: &[u32], places: &mut [[S; 4]]| {
            for (place, &point) in places.iter_mut().zip(order) {
                let [x, y, z] = from[point as usize];
                *place = [x, y, z, z];
            }
        };
        threads.run_parts(POINTS_JOB, order, &mut self.points, gather, |(), ()| ());
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

    /// A point and the number that means nothing.
    #[inline(always)]
    pub(crate) fn wide(&self, point: u32) -> &[S; 4] {
        &self.points[point as usize]
    }
}
