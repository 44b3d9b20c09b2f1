//! One thing for each thread: what a thread works on without waiting for others.

use super::lock::locked;
use crate::held;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Things, one of which is each thread's own.
#[derive(Debug, Default)]
pub(crate) struct PerThread<T> {
    things: Vec<Mutex<T>>,
}

impl<T: Default> PerThread<T> {
    /// Has one for each of so many threads, at least.
    pub(crate) fn for_threads(&mut self, count: usize) {
        let count = count.max(self.things.len());
        self.things.resize_with(count, Mutex::default);
    }

    /// That of the calling thread, of those that work on a query. Of more threads than there are things, some share one, and wait.
    pub(crate) fn own(&self) -> MutexGuard<'_, T> {
        let thread = rayon::current_thread_index().map_or(0, |thread| thread + 1);
        locked(&self.things[thread % self.things.len()])
    }
}

impl<T> PerThread<T> {
    /// All of them.
    pub(crate) fn iter_mut(&mut self) -> impl Iterator<Item = &mut T> {
        let things = self.things.iter_mut();
        things.map(|thing| thing.get_mut().unwrap_or_else(PoisonError::into_inner))
    }

    /// Bytes of the heap that these are, and so many that each holds.
    pub(crate) fn held_by(&self, each: impl Fn(&T) -> usize) -> usize {
        let things = self.things.iter().map(|thing| each(&locked(thing)));
        held::list(&self.things) + things.sum::<usize>()
    }
}
