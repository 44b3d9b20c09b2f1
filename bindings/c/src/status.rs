//! Statuses, errors as the caller gets them, and panics, which end here.

use pliant::{Error, ErrorKind};
use std::fmt::Display;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// `pliant_status`: 0 is success.
pub type PliantStatus = i32;

/// Statuses, by their names in the header without `PLIANT_`.
macro_rules! statuses {
    ($($name:ident = $number:literal;)*) => {
        $(pub(crate) const $name: PliantStatus = $number;)*

        #[cfg(test)]
        const STATUSES: &[(&str, PliantStatus)] = &[$((stringify!($name), $name)),*];
    };
}

statuses! {
    OK = 0;
    NULL = 1;
    BAD_SCALAR = 2;
    PANIC = 3;
    OTHER = 4;
    DIFFERENT_COUNTS = 10;
    BAD_CORNER = 11;
    BAD_WIDTH = 12;
}

/// Bytes of a message, the 0 at its end included.
const MESSAGE: usize = 256;

/// `pliant_error`: why a call was refused.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PliantError {
    /// Status that the call returned.
    pub status: PliantStatus,
    /// Corner of the pair; `u32::MAX` if none is refused.
    pub corner: u32,
    /// Pair of elements; `u64::MAX` if none is refused.
    pub pair: u64,
    /// The width that is refused, or NaN.
    pub number: f64,
    /// The position that is refused, or NaN.
    pub position: [f64; 3],
    /// One line of UTF-8 that ends with 0.
    pub message: [u8; MESSAGE],
}

/// A refused call.
pub(crate) struct Refused(Box<PliantError>);

impl Refused {
    pub(crate) fn new(status: PliantStatus, message: impl Display) -> Self {
        let mut text = message.to_string();
        while text.len() >= MESSAGE {
            text.pop();
        }
        let mut bytes = [0; MESSAGE];
        bytes[..text.len()].copy_from_slice(text.as_bytes());
        Self(Box::new(PliantError {
            status,
            corner: u32::MAX,
            pair: u64::MAX,
            number: f64::NAN,
            position: [f64::NAN; 3],
            message: bytes,
        }))
    }

    /// A pointer that is NULL, by its name in the header.
    pub(crate) fn null(name: &str) -> Self {
        Self::new(NULL, format_args!("{name} is NULL; give an array"))
    }
}

impl From<Error> for Refused {
    fn from(error: Error) -> Self {
        let status = match error.kind {
            ErrorKind::DifferentCounts { .. } => DIFFERENT_COUNTS,
            ErrorKind::BadCorner { .. } => BAD_CORNER,
            ErrorKind::BadWidth { .. } => BAD_WIDTH,
            _ => OTHER,
        };
        let mut refused = Self::new(status, &error);
        match error.kind {
            ErrorKind::BadCorner {
                pair,
                corner,
                position,
            } => {
                refused.0.pair = pair as u64;
                refused.0.corner = corner as u32;
                refused.0.position = position;
            }
            ErrorKind::BadWidth { width } => refused.0.number = width,
            _ => {}
        }
        refused
    }
}

/// Runs a call, and says in `error`, unless it is NULL, why it is refused. A panic is a refusal.
///
/// # Safety
///
/// `error` is NULL, or may be written.
pub(crate) unsafe fn call(
    error: *mut PliantError,
    work: impl FnOnce() -> Result<(), Refused>,
) -> PliantStatus {
    let done = catch_unwind(AssertUnwindSafe(work));
    let refused = match done {
        Ok(Ok(())) => return OK,
        Ok(Err(refused)) => refused,
        Err(payload) => {
            let said = payload.downcast_ref::<String>().map(String::as_str);
            let said = said.or_else(|| payload.downcast_ref::<&str>().copied());
            let said = said.unwrap_or("without a message");
            Refused::new(
                PANIC,
                format_args!("a fault of pliant: {said}; please report it"),
            )
        }
    };
    let status = refused.0.status;
    if !error.is_null() {
        // SAFETY: it is not NULL, so the caller lets it be written.
        unsafe { error.write_unaligned(*refused.0) };
    }
    status
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_header_has_every_status() {
        let header = include_str!("../include/pliant.h");
        let list = header
            .split("typedef int32_t pliant_status;")
            .nth(1)
            .unwrap();
        let list = list.split("};").next().unwrap().lines();
        let entries =
            list.filter_map(|line| line.trim().strip_prefix("PLIANT_")?.split_once(" = "));
        let number = |text: &str| text.split([',', ' ']).next().unwrap().parse().unwrap();
        let entries: Vec<(&str, PliantStatus)> =
            entries.map(|(name, rest)| (name, number(rest))).collect();
        assert_eq!(entries, STATUSES);
    }

    #[test]
    fn panics_end_here_and_messages_fit() {
        let mut error = *Refused::null("nothing").0;
        // SAFETY: the error may be written.
        let status = unsafe { call(&raw mut error, || panic!("{}", "ä".repeat(300))) };
        assert_eq!((status, error.status), (PANIC, PANIC));
        let end = error.message.iter().position(|&byte| byte == 0).unwrap();
        let said = std::str::from_utf8(&error.message[..end]).unwrap();
        assert!(
            said.starts_with("a fault of pliant: ää") && end > MESSAGE - 3,
            "{said}"
        );
    }
}
