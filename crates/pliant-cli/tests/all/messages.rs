//! A list of all texts that the program and the libraries can say, for reading.
//!
//! The helps come from the program, all other texts from the sources: every string literal of three
//! words or more, outside tests. So the list has new messages without a change here. Of Python
//! sources it has the lines that raise.
//!
//! ```sh
//! # the list, and the real messages of the tests in `people.rs`
//! cargo test -p pliant-cli --test all -- --include-ignored --nocapture --test-threads=1 \
//!     messages:: people::every
//! ```

use crate::common::pliant;
use std::fs;
use std::path::{Path, PathBuf};

/// Folders whose texts people see as messages.
const FOLDERS: [&str; 8] = [
    "crates/pliant/src",
    "crates/pliant-io/src",
    "crates/pliant-check/src",
    "crates/pliant-scenes/src",
    "crates/pliant-report/src",
    "crates/pliant-cli/src",
    "bindings/python/src",
    "bindings/python/python",
];
/// Code before a literal that only programmers read.
const INTERNAL: [&str; 7] = [
    "expect(",
    "reason = ",
    "unreachable!(",
    "panic!(",
    "assert!(",
    "cfg(",
    "include_str!(",
];

/// All literals of a source, each with its line and the code before it on that line.
fn literals(source: &str) -> Vec<(usize, &str, String)> {
    let mut found = Vec::new();
    let mut rest = source;
    let line_start = |at: usize| source[..at].rfind('\n').map_or(0, |end| end + 1);
    while let Some(start) = rest.find(['"', '/', '\'']) {
        let at = source.len() - rest.len() + start;
        let code = &rest[start..];
        let end = if code.starts_with("//") {
            code.find('\n').unwrap_or(code.len())
        } else if code.starts_with("'\"'") || code.starts_with("'\\") {
            3
        } else if code.starts_with('"') {
            let hashes = source[..at].len() - source[..at].trim_end_matches('#').len();
            let is_raw = source[..at - hashes].ends_with('r');
            let close = format!("\"{}", "#".repeat(hashes));
            let mut end = 1;
            while !(code[end..].starts_with(&close) && (is_raw || hashes == 0)) {
                let is_escape = code[end..].starts_with('\\') && !is_raw;
                end += if is_escape { 2 } else { 1 };
                while !code.is_char_boundary(end) {
                    end += 1;
                }
            }
            let lines = code[1..end].split("\\\n").map(str::trim_start);
            let number = source[..at].matches('\n').count() + 1;
            found.push((number, &source[line_start(at)..at], lines.collect()));
            end + close.len()
        } else {
            1
        };
        rest = &code[end..];
    }
    found
}

fn sources(folder: &Path, into: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, into);
        } else if path.file_name().is_some_and(|name| name != "tests.rs")
            && path
                .extension()
                .is_some_and(|end| end == "rs" || end == "py")
        {
            into.push(path);
        }
    }
}

#[test]
#[ignore = "a list for reading"]
fn list() {
    let folder = tempfile::tempdir().unwrap();
    let help = |arguments: &[&str]| {
        let help = pliant(folder.path(), &[arguments, &["--help"]].concat()).out;
        println!("== pliant {} --help\n{help}", arguments.join(" "));
        help
    };
    let all = help(&[]);
    let verbs = all.lines().skip_while(|line| *line != "Commands:").skip(1);
    let verbs = verbs.take_while(|line| !line.is_empty());
    // Lines that begin further in continue a description.
    let verbs = verbs.filter_map(|line| line.strip_prefix("  ")?.split(' ').next());
    let verbs: Vec<_> = verbs.filter(|verb| !verb.is_empty()).collect();
    assert!(verbs.contains(&"check"), "{verbs:?}");
    for verb in verbs.into_iter().filter(|verb| *verb != "help") {
        help(&[verb]);
    }
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut count = 0;
    for folder in FOLDERS {
        let mut files = Vec::new();
        sources(&workspace.join(folder), &mut files);
        files.sort();
        for file in files {
            let source = fs::read_to_string(&file).unwrap();
            let code = source.split("#[cfg(test)]\nmod tests").next().unwrap();
            let name = file.strip_prefix(&workspace).unwrap().display();
            if file.extension().is_some_and(|end| end == "py") {
                let raised = code.lines().filter(|line| line.contains("raise "));
                raised.for_each(|line| println!("{name}: {}", line.trim()));
                continue;
            }
            for (line, before, text) in literals(code) {
                let is_internal = INTERNAL.iter().any(|word| before.ends_with(word));
                if text.split_whitespace().count() >= 3 && !is_internal {
                    println!("{name}:{line}: {text}");
                    count += 1;
                }
            }
        }
    }
    assert!(count > 500, "only {count} texts");
}
