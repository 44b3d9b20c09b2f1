//! What every format does.

use super::tally::Tally;
use pliant_check::{Check, Found, Interval};
use std::io::{self, Write};

/// How answers are written.
pub(super) trait Form {
    /// What is known before the first frame.
    fn head(&mut self, out: &mut dyn Write, check: &Check) -> io::Result<()>;
    /// One frame.
    fn frame(&mut self, out: &mut dyn Write, check: &Check, found: &Found) -> io::Result<()>;
    /// What meets on the way from the frame to the next; of forms that are refused where this is asked, nothing.
    fn interval(&mut self, _: &mut dyn Write, _: &Check, _: &Interval) -> io::Result<()> {
        Ok(())
    }
    /// The end, of a check that was completed or of one that could not be.
    fn end(
        &mut self,
        out: &mut dyn Write,
        check: &Check,
        tally: &Tally,
        error: Option<&anyhow::Error>,
    ) -> io::Result<()>;
}
