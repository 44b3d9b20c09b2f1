//! Output of `pliant check`, printed frame by frame. Each format is a file.

mod files;
mod form;
mod github;
mod inside;
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

/// Context of an error while printing.
const WRITING: &str = "cannot write to standard output";

/// Printer of a check, with running totals.
pub(super) struct Output {
    out: BufWriter<Stdout>,
    /// `None` where nothing is printed.
    form: Option<Box<dyn Form>>,
    tally: Tally,
    /// Whether bodies are solids, so that nothing may lie inside another.
    solid: bool,
}

impl Output {
    /// Prints everything that is known before the first frame.
    pub(super) fn begin(arguments: &Arguments, check: &Check) -> anyhow::Result<Self> {
        let form: Box<dyn Form> = match arguments.format {
            Format::Table => Box::new(table::Table::new(arguments)),
            Format::Json => Box::new(json::Json::new(arguments)),
            Format::Github => Box::new(github::Github::new(arguments)),
            Format::Lines => Box::new(lines::Lines::new(arguments)),
            Format::Jsonl | Format::Parquet => anyhow::bail!(
                "--format jsonl and parquet have a row for each check of a list; name one with \
                 `--files-from`"
            ),
        };
        let mut output = Self {
            out: BufWriter::new(io::stdout()),
            form: (!arguments.quiet).then_some(form),
            tally: Tally {
                within: arguments.within,
                ..Tally::default()
            },
            solid: arguments.solid,
        };
        output.print(|form, out, _| form.head(out, check))?;
        Ok(output)
    }

    /// Prints one frame.
    pub(super) fn frame(&mut self, check: &Check, found: &Found) -> anyhow::Result<()> {
        self.print(|form, out, _| {
            form.frame(out, check, found)?;
            // People watch and programs read along: each frame is shown when it is done.
            out.flush()
        })?;
        self.tally.count(found);
        Ok(())
    }

    /// Prints contacts on the way to the next frame.
    pub(super) fn interval(&mut self, check: &Check, interval: &Interval) -> anyhow::Result<()> {
        self.print(|form, out, _| {
            form.interval(out, check, interval)?;
            out.flush()
        })?;
        self.tally.count_interval(interval);
        Ok(())
    }

    /// Prints the end of a check that was completed, or that stopped with an error.
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
        // If both failed, the error that stopped the check comes first.
        checked.and(printed)?;
        if let Some(form) = &self.form
            && !form.says_inside()
            && self.tally.inside.is_any()
        {
            let lines = self.tally.inside.lines(check);
            lines
                .iter()
                .for_each(|line| complain(&format!("note: {line}")));
        }
        let [_, meeting] = self.tally.intervals;
        if let (Some(([frame, until], count)), Some(_)) = (self.tally.skipped, &self.form) {
            let count = counted((count, "interval", "intervals"));
            complain(&format!(
                "note: {count} between frames not looked at, for a mesh changes there: \
                 the first from frame {frame} to {until}"
            ));
        }
        let is_solid_inside = self.solid && self.tally.inside.is_any();
        Ok(
            if self.tally.intersecting > 0 || meeting > 0 || is_solid_inside {
                Outcome::Intersects
            } else {
                Outcome::Clear
            },
        )
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

/// Returns the error of a check that could not begin, and prints it where errors are annotations.
pub(super) fn annotate<T>(arguments: &Arguments, error: anyhow::Error) -> anyhow::Result<T> {
    if arguments.format == Format::Github && !arguments.quiet {
        // The error that stopped the check comes first, whether this can be printed or not.
        let _ = print_all(&github::failure(&error));
    }
    Err(error)
}
