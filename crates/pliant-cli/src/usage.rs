//! What is said of arguments that are none: one line, like of everything else that goes wrong.
//!
//! clap writes several: what is wrong, what is possible, tips, the usage, where help is. The usage is left to the help.

use crate::terminal::complain;
use clap::Error;
use clap::error::ErrorKind;
use std::process::ExitCode;

/// Prints help, or the version, or what is wrong.
pub(crate) fn said(error: &Error) -> ExitCode {
    match error.kind() {
        ErrorKind::DisplayHelp
        | ErrorKind::DisplayVersion
        | ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
            // Nobody to tell, if it cannot be printed.
            let _ = error.print();
            ExitCode::from(u8::from(error.use_stderr()) * 2)
        }
        _ => {
            complain(&in_one_line(&error.render().to_string()));
            ExitCode::from(2)
        }
    }
}

/// What clap says in several lines, without the usage.
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
            // What is possible, or what is missing, ends the sentence before it.
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
                "error: unrecognized subcommand 'chek'\n\n  tip: a similar subcommand exists: 'check'\n\nUsage: pliant <COMMAND>\n\nFor more information, try '--help'.\n",
                "unrecognized subcommand 'chek'; tip: a similar subcommand exists: 'check'; `--help` says more",
            ),
            (
                "error: the following required arguments were not provided:\n  <BODY>...\n\nUsage: pliant check <BODY>...\n",
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
