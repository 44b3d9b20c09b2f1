//! No message of this crate or of `pliant-io` names an option of the program.
//!
//! Python shows these messages too, where `--no-weld` means nothing. The program adds its flags in
//! `crates/pliant-cli/src/advice.rs`. A message may be assembled anywhere, so this test reads the
//! source: every line that is not a comment.

use std::fs;
use std::path::Path;

/// Openings of the program's commands, and their parts that are no flags.
const OF_THE_PROGRAM: [&str; 6] = [
    "`pliant ",
    "pliant check",
    "pliant convert",
    "pliant run",
    "A..B",
    "NAME=BODY",
];

/// Whether a line of source names an option of the program.
///
/// In the code itself, two minus signs never stand before a name.
fn names_an_option(line: &str) -> bool {
    let begins_a_flag = |(at, _): (usize, &str)| {
        let behind = line[at + 2..].chars().next();
        behind.is_some_and(|c| c.is_ascii_alphabetic() || c == '{')
    };
    line.match_indices("--").any(begins_a_flag)
        || OF_THE_PROGRAM.iter().any(|word| line.contains(word))
}

fn is_comment(line: &str) -> bool {
    line.trim_start().starts_with("//")
}

/// Collects every line that names an option, with its location; returns the number of lines read.
fn look_into(folder: &Path, found: &mut Vec<String>) -> usize {
    let mut looked_at = 0;
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            looked_at += look_into(&path, found);
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        for (number, line) in text.lines().enumerate() {
            if !is_comment(line) {
                looked_at += 1;
                if names_an_option(line) {
                    found.push(format!("{}:{}: {line}", path.display(), number + 1));
                }
            }
        }
    }
    looked_at
}

#[test]
fn no_message_names_an_option_of_the_program() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    for folder in ["src", "../pliant-io/src"] {
        let mut found = Vec::new();
        let looked_at = look_into(&here.join(folder), &mut found);
        assert!(looked_at > 500, "{folder}: {looked_at} lines are not all");
        assert!(found.is_empty(), "{}", found.join("\n"));
    }
}

#[test]
fn options_are_known_by_their_looks() {
    for line in [
        r#"#[error("exists already; use `--force` to write over it")]"#,
        r#"return Err(unsupported("ask for fewer with --fps"));"#,
        r#"format!("leave out `--{name}`")"#,
        r#""write it to a file with `pliant convert ...`""#,
        "                 --max-memory\"",
    ] {
        assert!(names_an_option(line) && !is_comment(line), "{line}");
    }
    for line in [
        "let less = a - -b;",
        "\"--\"",
        "\"PLY -- 1.0\"",
        "prefix(\".pliant-\")",
    ] {
        assert!(!names_an_option(line), "{line}");
    }
    assert!(is_comment("    /// As `--fps` of the program."));
}
