//! Arrays of numbers of the caller, read and written; and lists that the caller reads.

use crate::status::{Refused, TOO_LARGE, WRONG_LENGTH};
use std::ptr::null;

/// `pliant_list`: rows of numbers that belong to the world.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PliantList {
    /// Number of rows.
    pub count: usize,
    /// Numbers, row by row.
    pub numbers: *const u32,
}

impl PliantList {
    /// Rows, which must stay while the caller reads them.
    pub(crate) fn of<R>(rows: &[R]) -> Self {
        const { assert!(align_of::<R>() == align_of::<u32>()) };
        let (count, numbers) = (rows.len(), start(rows));
        Self { count, numbers }
    }
}

impl Default for PliantList {
    fn default() -> Self {
        Self::of::<u32>(&[])
    }
}

/// Address of the first of some items as the caller knows it; NULL if there are none.
pub(crate) fn start<T, N>(list: &[T]) -> *const N {
    if list.is_empty() {
        null()
    } else {
        list.as_ptr().cast()
    }
}

/// A structure of the caller's, wherever it lies; none if the pointer is NULL.
///
/// # Safety
///
/// It is NULL, or may be read.
pub(crate) unsafe fn read<T: Copy>(data: *const T) -> Option<T> {
    // SAFETY: it is not NULL, so it may be read.
    (!data.is_null()).then(|| unsafe { data.read_unaligned() })
}

/// Writes a result, unless the pointer is NULL.
///
/// # Safety
///
/// `out` is NULL, or may be written.
pub(crate) unsafe fn give<T>(out: *mut T, value: T) {
    if !out.is_null() {
        // SAFETY: it is not NULL, so it may be written.
        unsafe { out.write_unaligned(value) };
    }
}

/// Writes rows into an array of the caller's, by the name of the array. It must have as many.
///
/// # Safety
///
/// `out` is NULL, or `count` rows may be written.
pub(crate) unsafe fn write<R: Copy>(
    rows: &[R],
    (out, count, name): (*mut f64, usize, &str),
    body: u32,
) -> Result<(), Refused> {
    if count != rows.len() {
        let all = rows.len();
        let words = format_args!("{name} has {count} rows for {all} vertices; give as many");
        let mut refused = Refused::new(WRONG_LENGTH, words);
        refused.0.body = body;
        (refused.0.count, refused.0.limit) = (count as u64, all as u64);
        return Err(refused);
    }
    if out.is_null() && count > 0 {
        return Err(Refused::null(name));
    }
    for (place, &row) in rows.iter().enumerate() {
        // SAFETY: there is a row for each.
        unsafe { out.cast::<R>().wrapping_add(place).write_unaligned(row) };
    }
    Ok(())
}

/// Copies a list of the caller's, by its name in the header.
///
/// # Safety
///
/// It is NULL, or may be read.
pub(crate) unsafe fn list<T: Copy>(
    data: *const T,
    count: usize,
    name: &str,
) -> Result<Vec<T>, Refused> {
    if data.is_null() && count > 0 {
        return Err(Refused::null(name));
    }
    countable(count, name)?;
    let at = |place| data.wrapping_add(place);
    // SAFETY: the caller says that these may be read.
    Ok((0..count)
        .map(|place| unsafe { at(place).read_unaligned() })
        .collect())
}

/// A row of the caller's, by its name in the header.
///
/// # Safety
///
/// It is NULL, or may be read.
pub(crate) unsafe fn row<T: Copy>(data: *const T, name: &str) -> Result<T, Refused> {
    // SAFETY: as above.
    unsafe { list(data, 1, name) }.map(|all| all[0])
}

/// Refuses a count of things that 32-bit numbers cannot keep apart, by its name in the header.
pub(crate) fn countable(count: usize, name: &str) -> Result<(), Refused> {
    if u32::try_from(count).is_ok() {
        return Ok(());
    }
    let words = format_args!("{name} is {count}, more than 32-bit numbers keep apart");
    let mut refused = Refused::new(TOO_LARGE, words);
    (refused.0.count, refused.0.limit) = (count as u64, u32::MAX.into());
    Err(refused)
}
