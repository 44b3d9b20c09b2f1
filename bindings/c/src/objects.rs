//! Objects that the caller holds by pointers: made, used by one call at a time, freed.

use crate::status::{BUSY, NULL, PANIC, Refused};
use std::sync::{Mutex, MutexGuard, TryLockError};

/// Makes an object for the caller, by the name of its pointer, unless that is NULL.
///
/// # Safety
///
/// `out` is NULL, or may be written.
pub(crate) unsafe fn hand_out<T>(
    out: *mut *mut T,
    name: &str,
    make: impl FnOnce() -> Result<T, Refused>,
) -> Result<(), Refused> {
    if out.is_null() {
        return Err(Refused::null(name));
    }
    let made = Box::into_raw(Box::new(make()?));
    // SAFETY: it is not NULL, so it may be written.
    unsafe { out.write_unaligned(made) };
    Ok(())
}

/// Frees an object of the caller, unless it is NULL.
///
/// # Safety
///
/// It is NULL, or [`hand_out`] made it, it is not freed, and no call is inside.
pub(crate) unsafe fn take_back<T>(object: *mut T) {
    if !object.is_null() {
        // SAFETY: it was made by a box, and nothing else refers to it.
        drop(unsafe { Box::from_raw(object) });
    }
}

/// The object, by its name in the header, unless it is NULL or another call is inside.
pub(crate) fn held<'o, T>(
    object: Option<&'o Mutex<T>>,
    name: &str,
) -> Result<MutexGuard<'o, T>, Refused> {
    let Some(object) = object else {
        let words = format_args!("{name} is NULL; make one first");
        return Err(Refused::new(NULL, words));
    };
    object.try_lock().map_err(|why| match why {
        TryLockError::WouldBlock => Refused::new(
            BUSY,
            format_args!("another call is inside {name}; wait for it"),
        ),
        TryLockError::Poisoned(_) => Refused::new(
            PANIC,
            format_args!("{name} is broken by an earlier fault; free it"),
        ),
    })
}

/// Functions of objects: name, arguments, and the call that is inside.
macro_rules! uses {
    (
        $object:ident: $type:ty as $held:ty;
        $(fn $name:ident($($argument:ident: $of:ty),* $(,)?) |$inside:ident| $work:block)*
    ) => {
        $(
            #[doc = concat!("`", stringify!($name), "`.")]
            ///
            /// # Safety
            ///
            /// Pointers are NULL, or as the header says.
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn $name(
                $object: *const $type,
                $($argument: $of,)*
                error: *mut $crate::status::PliantError,
            ) -> $crate::status::PliantStatus {
                let work = |$inside: &mut $held| $work;
                let work = || {
                    // SAFETY: as the header says.
                    let object = unsafe { $object.as_ref() }.map(|it| &it.0);
                    work(&mut *$crate::objects::held(object, stringify!($object))?)
                };
                // SAFETY: as the header says.
                unsafe { $crate::status::call(error, work) }
            }
        )*
    };
}
pub(crate) use uses;
