//! Plain lines for programs, one per pair: `FRAME BODY TRIANGLE BODY TRIANGLE`, sorted.
//!
//! With `--count` there is one line per frame: `FRAME COUNT`. Nothing else is printed.

use super::form::Form;
use super::tally::Tally;
use crate::check::arguments::Arguments;
use pliant_check::{Check, Found};
use std::io::{self, Write};

pub(super) struct Lines {
    count_only: bool,
}

impl Lines {
    pub(super) fn new(arguments: &Arguments) -> Self {
        Self {
            count_only: arguments.count,
        }
    }
}

impl Form for Lines {
    fn head(&mut self, _: &mut dyn Write, _: &Check) -> io::Result<()> {
        Ok(())
    }

    fn frame(&mut self, out: &mut dyn Write, _: &Check, found: &Found) -> io::Result<()> {
        let frame = found.frame;
        if self.count_only {
            return writeln!(out, "{frame} {}", found.count);
        }
        found.pairs.iter().try_for_each(|[body_a, a, body_b, b]| {
            writeln!(out, "{frame} {body_a} {a} {body_b} {b}")
        })
    }

    fn end(
        &mut self,
        _: &mut dyn Write,
        _: &Check,
        _: &Tally,
        _: Option<&anyhow::Error>,
    ) -> io::Result<()> {
        Ok(())
    }
}
