//! What people see: text on standard output, lines and bars on standard error.

use anyhow::Context;
use indicatif::ProgressBar;
use std::io::{self, Write};

/// Text on standard output.
pub(crate) fn print_all(text: &str) -> anyhow::Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())
        .and_then(|()| out.flush())
        .context("cannot write to standard output")
}

/// A bar on standard error where that is a terminal, or none.
pub(crate) fn progress(length: u64, quiet: bool) -> ProgressBar {
    if quiet {
        ProgressBar::hidden()
    } else {
        ProgressBar::new(length)
    }
}

/// A line on standard error, whatever is quoted in it; if even that is closed, there is nothing left to do.
pub(crate) fn complain(line: &str) {
    let _ = writeln!(io::stderr(), "pliant: {}", one_line(line));
}

/// What there is to say about a body, a line each on standard error.
pub(crate) fn note(body: &pliant_io::Body, quiet: bool) {
    for note in body.notes().iter().filter(|_| !quiet) {
        complain(&format!("note: {}: {note}", pliant_io::shown(body.name())));
    }
}

/// What is said in one line: of very many or very long names its beginning and its end.
pub(crate) fn one_line(text: &str) -> String {
    pliant_io::shown_within(text, 4000)
}
