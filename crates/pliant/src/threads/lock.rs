//! Mutexes, locked whatever became of a thread that had them.

use std::sync::{Mutex, MutexGuard, PoisonError};

/// Locks a mutex, whatever happened to others that had it.
pub(crate) fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
