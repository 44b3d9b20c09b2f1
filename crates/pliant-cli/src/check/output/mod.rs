//! What `pliant check` prints, frame by frame as it goes. Each format is a file.

mod files;
mod form;
mod github;
mod json;
mod lines;
mod places;
mod table;
mod tally;

use super::arguments::{Arguments, Format};
use super::figures::counted;
use crate::outcome::Outcome;
use crate::terminal::{complain, print_all};
use anyhow::Context;
use form::Form;
use pliant_check::{Check, Found, Interval};
use std::io::{self, BufWriter, Stdout, Write};
use tally::Tally;

/// What a failing write is the failure of.
const WRITING: &str = "cannot write to standard output";

/// Where answers go.
pub(super) struct Output {
    out: BufWriter<Stdout>,
    /// None where nothing is to be printed.
    form: Option<Box<dyn Form>>,
    tally: Tally,
}

impl Output {
    /// Prints what is known before the first frame.
    pub(super) fn begin(arguments: &Arguments, check: &Check) -> anyhow::Result<Self> {
        let form: Box<dyn Form> = match arguments.format {
            Format::Table => Box::new(table::Table::new(arguments)),
            Format::Json => Box::new(json::Json::new(arguments)),
            Format::Github => Box::new(github::Github::new(arguments)),
            Format::Lines => Box::new(lines::Lines::new(arguments)),
        };
        let mut output = Self {
            out: BufWriter::new(io::stdout()),
            form: (!arguments.quiet).then_some(form),
            tally: Tally {
                within: arguments.within,
                ..Tally::default()
            },
        };
        output.print(|form, out, _| form.head(out, check))?;
        Ok(output)
    }

    /// Prints one frame.
    pub(super) fn frame(&mut self, check: &Check, found: &Found) -> anyhow::Result<()> {
        self.print(|form, out, _| {
            form.frame(out, check, found)?;
            // Someone is looking, or reading: each frame is shown when it is done.
            out.flush()
        })?;
        self.tally.count(found);
        Ok(())
    }

    /// Prints what meets on the way to the next frame.
    pub(super) fn interval(&mut self, check: &Check, interval: &Interval) -> anyhow::Result<()> {
        self.print(|form, out, _| {
            form.interval(out, check, interval)?;
            out.flush()
        })?;
        self.tally.count_interval(interval);
        Ok(())
    }

    /// Prints the end, of a check that was completed or of one that could not be.
    pub(super) fn end(
        mut self,
        check: &Check,
        checked: anyhow::Result<()>,
    ) -> anyhow::Result<Outcome> {
        let error = checked.as_ref().err();
        let printed = self.print(|form, out, tally| {
            form.end(out, check, tally, error)?;
            out.flush()
        });
        // If both went wrong, what stopped the check comes first.
        checked.and(printed)?;
        let [_, meeting] = self.tally.intervals;
        if let (Some(([frame, until], count)), Some(_)) = (self.tally.skipped, &self.form) {
            let count = counted((count, "interval", "intervals"));
            complain(&format!(
                "note: {count} between frames not looked at, for a mesh changes there: the first from frame {frame} to {until}"
            ));
        }
        Ok(if self.tally.intersecting > 0 || meeting > 0 {
            Outcome::Intersects
        } else {
            Outcome::Clear
        })
    }

    fn print(
        &mut self,
        write: impl FnOnce(&mut dyn Form, &mut dyn Write, &Tally) -> io::Result<()>,
    ) -> anyhow::Result<()> {
        match &mut self.form {
            Some(form) => write(form.as_mut(), &mut self.out, &self.tally).context(WRITING),
            None => Ok(()),
        }
    }
}

/// Passes on why a check could not begin; where errors are annotations, prints that too.
pub(super) fn annotate<T>(arguments: &Arguments, error: anyhow::Error) -> anyhow::Result<T> {
    if arguments.format == Format::Github && !arguments.quiet {
        // What stopped the check comes first, whether this can be printed or not.
        let _ = print_all(&github::failure(&error));
    }
    Err(error)
}
