//! Usage errors in one line, like all other errors.
//!
//! clap prints several lines: the error, possible values, tips, the usage, a pointer to the help.
//! The usage is left to the help.

use crate::terminal::complain;
use clap::Error;
use clap::error::ErrorKind;
use std::process::ExitCode;

/// Prints help, the version or a usage error, and returns the exit code.
pub(crate) fn said(error: &Error) -> ExitCode {
    match error.kind() {
        ErrorKind::DisplayHelp
        | ErrorKind::DisplayVersion
        | ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
            // If printing fails, there is nobody to tell.
            let _ = error.print();
            ExitCode::from(u8::from(error.use_stderr()) * 2)
        }
        _ => {
            complain(&in_one_line(&error.render().to_string()));
            ExitCode::from(2)
        }
    }
}

/// Joins the lines of a message of clap, without the usage.
fn in_one_line(text: &str) -> String {
    let mut line = String::new();
    let text = text.strip_prefix("error: ").unwrap_or(text);
    for part in text.lines().map(str::trim) {
        let part = match part {
            "" => continue,
            usage if usage.starts_with("Usage: ") => continue,
            "For more information, try '--help'." => "`--help` says more",
            part => part,
        };
        if !line.is_empty() {
            // Possible values and missing arguments end the sentence before them.
            let goes_on = line.ends_with(':') || part.starts_with('[');
            line.push_str(if goes_on { " " } else { "; " });
        }
        line.push_str(part);
    }
    line
}

#[cfg(test)]
mod tests {
    use super::in_one_line;

    #[test]
    fn what_clap_says_becomes_one_line() {
        for (text, line) in [
            (
                "error: unrecognized subcommand 'chek'\n\n  tip: a similar subcommand exists: \
                 'check'\n\nUsage: pliant <COMMAND>\n\nFor more information, try '--help'.\n",
                "unrecognized subcommand 'chek'; tip: a similar subcommand exists: 'check'; \
                 `--help` says more",
            ),
            (
                "error: the following required arguments were not provided:\n  <BODY>...\n\n\
                 Usage: pliant check <BODY>...\n",
                "the following required arguments were not provided: <BODY>...",
            ),
            (
                "error: invalid value '3' for '--degree <N>'\n  [possible values: 2, 4, 8]\n",
                "invalid value '3' for '--degree <N>' [possible values: 2, 4, 8]",
            ),
        ] {
            assert_eq!(in_one_line(text), line);
        }
    }
}
