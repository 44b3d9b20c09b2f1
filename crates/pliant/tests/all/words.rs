//! Prose in the source of every crate, and of the site: it is short, and stands alone.
//!
//! Holds what a program can hold of the rules in CONTRIBUTING. The rest is for readers.
//! Comments are read by lines, not parsed; text in code blocks and headings is skipped.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// The most columns of a line, as the formatter has it for code.
const COLUMNS: usize = 100;
/// The most words of a sentence.
const WORDS: usize = 25;
/// The most sentences of a module's header, without lists and tables.
const SENTENCES: usize = 6;

/// Words with which no first line begins: they point at something that a tooltip does not show.
const OPENINGS: [&str; 12] = [
    "What ",
    "Those ",
    "These ",
    "That ",
    "This ",
    "The same",
    "The other",
    "Of ",
    "It ",
    "They ",
    "So ",
    "But ",
];
/// Words that stand for a noun which the reader has to look for.
const ANAPHORS: [&str; 6] = [
    "those of",
    "that of those",
    "the same of",
    "so many",
    "of now",
    "but for",
];

/// Ends of words with a full stop that ends no sentence.
const SHORT: [&str; 7] = ["e.g.", "i.e.", "al.", "vs.", "cf.", "p.", "pp."];

/// A comment: its kind (`//!`, `///`, `//` or `#`), its first line's number, its lines.
struct Comment<'t> {
    kind: &'static str,
    line: usize,
    text: Vec<&'t str>,
}

/// All comments that stand on lines of their own.
fn comments(text: &str) -> Vec<Comment<'_>> {
    let mut comments: Vec<Comment> = Vec::new();
    let mut last = None;
    for (number, line) in text.lines().enumerate() {
        let line = line.trim_start();
        let kinds = ["//!", "///", "//"];
        let kind = kinds.into_iter().find(|&kind| line.starts_with(kind));
        if let Some(kind) = kind {
            let said = line[kind.len()..].strip_prefix(' ');
            let said = said.unwrap_or(&line[kind.len()..]);
            match comments.last_mut() {
                Some(comment) if last == Some(kind) => comment.text.push(said),
                _ => comments.push(Comment {
                    kind,
                    line: number + 1,
                    text: vec![said],
                }),
            }
        }
        last = kind;
    }
    comments
}

/// The paragraphs, items of lists and cells of tables of a comment, and whether it is a paragraph.
fn pieces(comment: &Comment) -> Vec<(String, bool)> {
    let mut pieces: Vec<(String, bool)> = Vec::new();
    let mut is_code = false;
    let mut goes_on = false;
    for line in &comment.text {
        let line = line.trim();
        if line.starts_with("```") {
            is_code = !is_code;
            goes_on = false;
            continue;
        }
        let is_link = line.starts_with('[') && line.contains("]:");
        if is_code || line.is_empty() || line.starts_with('#') || is_link {
            goes_on = false;
            continue;
        }
        if let Some(row) = line.strip_prefix('|') {
            pieces.extend(row.split('|').map(|cell| (cell.trim().to_owned(), false)));
            goes_on = false;
            continue;
        }
        let digits = line.trim_start_matches(|c: char| c.is_ascii_digit());
        let is_item = line.starts_with("- ")
            || line.starts_with("* ")
            || digits.len() < line.len() && digits.starts_with(". ");
        match pieces.last_mut() {
            Some((piece, _)) if goes_on && !is_item => {
                piece.push(' ');
                piece.push_str(line);
            }
            _ => pieces.push((line.to_owned(), !is_item)),
        }
        goes_on = true;
    }
    pieces
}

/// The sentences of a piece, with code and targets of links left out.
fn sentences(piece: &str) -> Vec<String> {
    let mut plain = String::new();
    for (place, part) in piece.split('`').enumerate() {
        plain.push_str(if place % 2 == 0 { part } else { "code" });
    }
    while let Some(start) = plain.find("](") {
        let end = plain[start..]
            .find(')')
            .map_or(plain.len(), |end| start + end + 1);
        plain.replace_range(start..end, "");
    }
    let plain = plain.replace('[', "");
    let mut sentences = vec![String::new()];
    for word in plain.split_whitespace() {
        let sentence = sentences.last_mut().unwrap();
        sentence.push_str(word);
        sentence.push(' ');
        let end = word.trim_matches(['(', ')', '"', '*', '_', ']']);
        if end.ends_with(['.', '!', '?']) && !SHORT.contains(&end) {
            sentences.push(String::new());
        }
    }
    sentences.retain(|sentence| words(sentence) > 0);
    sentences
}

fn words(sentence: &str) -> usize {
    let words = sentence.split_whitespace();
    words
        .filter(|word| word.chars().any(char::is_alphanumeric))
        .count()
}

/// Everything that a file's prose does wrong, a line each: number and fault.
fn faults(text: &str, is_root: bool) -> Vec<(usize, String)> {
    let mut faults = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let columns = line.chars().count();
        if columns > COLUMNS {
            faults.push((number + 1, format!("{columns} columns")));
        }
    }
    for comment in comments(text) {
        let mut fault = |what: String| faults.push((comment.line, what));
        let pieces = pieces(&comment);
        let first = pieces.first().map_or("", |(piece, _)| piece);
        if comment.kind != "//"
            && let Some(opening) = OPENINGS.iter().find(|&&opening| first.starts_with(opening))
        {
            fault(format!("begins with {opening:?}: {first}"));
        }
        let mut in_paragraphs = 0;
        for (piece, is_paragraph) in &pieces {
            let sentences = sentences(piece);
            in_paragraphs += if *is_paragraph { sentences.len() } else { 0 };
            for sentence in sentences {
                let count = words(&sentence);
                if count > WORDS {
                    fault(format!("{count} words: {sentence}"));
                }
                let lower = sentence.to_lowercase();
                if let Some(anaphor) = ANAPHORS.iter().find(|&&anaphor| {
                    let mut rest = lower.split(anaphor);
                    let before = rest.next().unwrap_or("");
                    let is_whole = |text: &str| !text.starts_with(char::is_alphanumeric);
                    !before.ends_with(char::is_alphanumeric) && rest.next().is_some_and(is_whole)
                }) {
                    fault(format!("{anaphor:?}: {sentence}"));
                }
            }
        }
        if comment.kind == "//!" && !is_root && in_paragraphs > SENTENCES {
            fault(format!("{in_paragraphs} sentences in a header"));
        }
    }
    faults.sort();
    faults
}

/// Everything that the prose of a page does wrong; its tables, links and code may be wide.
fn faults_of_page(text: &str) -> Vec<(usize, String)> {
    let lines: Vec<&str> = text.lines().collect();
    let as_comment = format!("// {}", lines.join("\n// "));
    let mut faults = faults(&as_comment, true);
    faults.retain(|(_, fault)| !fault.ends_with(" columns"));
    let mut is_code = false;
    for (number, line) in text.lines().enumerate() {
        is_code ^= line.starts_with("```");
        let is_wide = is_code || line.starts_with(['|', '[']);
        if !is_wide && line.chars().count() > COLUMNS {
            faults.push((number + 1, format!("{} columns", line.chars().count())));
        }
    }
    faults
}

/// All files of a folder that hold code.
fn files(folder: &Path, into: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap_or_default();
        if path.is_dir() && name != "target" && name != "node_modules" {
            files(&path, into);
        } else if path.extension().is_some_and(|end| end == "rs") {
            into.push(path);
        }
    }
}

#[test]
fn prose_keeps_its_rules() {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut all = Vec::new();
    for folder in ["crates", "bindings", "fuzz"] {
        files(&workspace.join(folder), &mut all);
    }
    all.sort();
    let mut said = String::new();
    for path in all {
        let text = fs::read_to_string(&path).unwrap();
        let is_root = path.ends_with("src/lib.rs") || path.ends_with("src/main.rs");
        let name = path.strip_prefix(&workspace).unwrap_or(&path).display();
        for (line, fault) in faults(&text, is_root) {
            writeln!(said, "{name}:{line}: {fault}").unwrap();
        }
    }
    for folder in ["crates/pliant/guide", "site", "site/pages"] {
        for entry in fs::read_dir(workspace.join(folder)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|end| end == "md") {
                for (line, fault) in faults_of_page(&fs::read_to_string(&path).unwrap()) {
                    writeln!(said, "{}:{line}: {fault}", path.display()).unwrap();
                }
            }
        }
    }
    assert!(said.is_empty(), "{} faults\n{said}", said.lines().count());
}

#[test]
fn faults_of_prose_are_found() {
    let long = "word ".repeat(26);
    for (text, is_found) in [
        (format!("/// A {}", "b".repeat(94)), false),
        (format!("/// A {}", "b".repeat(95)), true),
        (
            format!("/// {}\n/// {}", &long[..25], &long[..5 * 18]),
            false,
        ),
        (
            format!("/// {}\n/// {}", &long[..40], &long[..5 * 18]),
            true,
        ),
        (format!("// {}. {}", &long[..50], &long[..40]), false),
        ("/// Those that meet.".to_owned(), true),
        ("/// Boxes.\n///\n/// Those that meet.".to_owned(), false),
        ("// Those that meet.".to_owned(), false),
        ("/// Boxes, but for one.".to_owned(), true),
        ("/// Boxes, but forgotten.".to_owned(), false),
        ("/// Boxes, `but for` one.".to_owned(), false),
        (format!("//! {}", "A b. ".repeat(6)), false),
        (format!("//! {}", "A b. ".repeat(7)), true),
        ("/// A.\n/// ```\n/// // so many\n/// ```".to_owned(), false),
    ] {
        assert_eq!(!faults(&text, false).is_empty(), is_found, "{text}");
    }
}
