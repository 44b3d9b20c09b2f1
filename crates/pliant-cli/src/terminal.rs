//! Text on standard output; lines and progress bars on standard error.

use anyhow::Context;
use indicatif::ProgressBar;
use std::io::{self, Write};

/// Prints text on standard output.
pub(crate) fn print_all(text: &str) -> anyhow::Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())
        .and_then(|()| out.flush())
        .context("cannot write to standard output")
}

/// A progress bar on standard error; hidden if `quiet` or if that is no terminal.
pub(crate) fn progress(length: u64, quiet: bool) -> ProgressBar {
    if quiet {
        ProgressBar::hidden()
    } else {
        ProgressBar::new(length)
    }
}

/// Prints one line on standard error, whatever is quoted in it.
///
/// If standard error is closed, there is nothing left to do.
pub(crate) fn complain(line: &str) {
    let _ = writeln!(io::stderr(), "pliant: {}", one_line(line));
}

/// Prints the notes of a body, a line each on standard error.
pub(crate) fn note(body: &pliant_io::Body, quiet: bool) {
    for note in body.notes().iter().filter(|_| !quiet) {
        complain(&format!("note: {}: {note}", pliant_io::shown(body.name())));
    }
}

/// Puts a text in one line. A very long text keeps its beginning and its end.
pub(crate) fn one_line(text: &str) -> String {
    pliant_io::shown_within(text, 4000)
}
