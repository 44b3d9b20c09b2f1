//! Per-thread values of a query: each thread works on its own without waiting for others.

use super::lock::locked;
use crate::held;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Values, one for each thread.
#[derive(Debug, Default)]
pub(crate) struct PerThread<T> {
    things: Vec<Mutex<T>>,
}

impl<T: Default> PerThread<T> {
    /// Grows to at least `count` values.
    pub(crate) fn for_threads(&mut self, count: usize) {
        let count = count.max(self.things.len());
        self.things.resize_with(count, Mutex::default);
    }

    /// Value of the calling thread, locked. If there are more threads than values, some share one,
    /// and wait.
    pub(crate) fn own(&self) -> MutexGuard<'_, T> {
        let thread = rayon::current_thread_index().map_or(0, |thread| thread + 1);
        locked(&self.things[thread % self.things.len()])
    }
}

impl<T> PerThread<T> {
    /// All values.
    pub(crate) fn iter_mut(&mut self) -> impl Iterator<Item = &mut T> {
        let things = self.things.iter_mut();
        things.map(|thing| thing.get_mut().unwrap_or_else(PoisonError::into_inner))
    }

    /// Bytes on the heap: the list, and for each value the bytes that `each` returns.
    pub(crate) fn held_by(&self, each: impl Fn(&T) -> usize) -> usize {
        let things = self.things.iter().map(|thing| each(&locked(thing)));
        held::list(&self.things) + things.sum::<usize>()
    }
}
