//! The interface of all output formats.

use super::tally::Tally;
use pliant_check::{Check, Found, Interval};
use std::io::{self, Write};

/// An output format, which writes the answers of a check.
pub(super) trait Form {
    /// Writes everything that is known before the first frame.
    fn head(&mut self, out: &mut dyn Write, check: &Check) -> io::Result<()>;
    /// Writes one frame.
    fn frame(&mut self, out: &mut dyn Write, check: &Check, found: &Found) -> io::Result<()>;
    /// Writes contacts on the way from the frame to the next; nothing in formats that refuse them.
    fn interval(&mut self, _: &mut dyn Write, _: &Check, _: &Interval) -> io::Result<()> {
        Ok(())
    }
    /// Whether the format has room for what lies inside bodies.
    fn says_inside(&self) -> bool {
        false
    }
    /// Writes the end of a check that was completed, or that stopped with an error.
    fn end(
        &mut self,
        out: &mut dyn Write,
        check: &Check,
        tally: &Tally,
        error: Option<&anyhow::Error>,
    ) -> io::Result<()>;
}
