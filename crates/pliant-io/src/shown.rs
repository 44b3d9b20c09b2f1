//! Names as people see them: one escaping function for every name in messages, lines and pages.
//!
//! A file name may hold a line break, a command to a terminal or a CI runner, or a mark that
//! reverses the reading direction. A name inside a file may be as long as the file. So a shown name
//! is one line of visible characters; others are escaped as in Rust (`\n`, `\u{202e}`). A long name
//! keeps its beginning and its end. Output for programs, such as JSON, has escapes of its own and
//! the true names.

use std::ffi::OsStr;

/// Most characters of a name in a message.
const LONGEST: usize = 300;

/// Escapes a name for people: one line, nothing invisible, no command, at most 300 characters.
///
/// ```
/// use pliant_io::shown;
/// assert_eq!(shown("arm.obj"), "arm.obj");
/// assert_eq!(shown("a\u{1b}[2J\nb\u{202e}.obj"), r"a\u{1b}[2J\nb\u{202e}.obj");
/// // At the beginning of a line, GitHub's runner would obey it.
/// assert_eq!(shown("::error::b.obj"), r"\u{3a}:error::b.obj");
/// assert_eq!(shown("x".repeat(100_000)).chars().count(), 300);
/// ```
pub fn shown(name: impl AsRef<OsStr>) -> String {
    shown_within(name, LONGEST)
}

/// Escapes a name like [`shown`], in at most `most` characters.
///
/// A longer name keeps its beginning, two thirds, and its end, one third. In 0 characters nothing
/// of it is left.
///
/// ```
/// assert_eq!(pliant_io::shown_within("a_very_long_name.obj", 12), "a_very_….obj");
/// ```
pub fn shown_within(name: impl AsRef<OsStr>, most: usize) -> String {
    let name = name.as_ref().to_string_lossy();
    let (whole, is_whole) = fitting(pieces(&name), most);
    if is_whole || most == 0 {
        return whole.concat();
    }
    let end = most / 3;
    let (head, _) = fitting(pieces(&name), most.saturating_sub(end + 1));
    let (mut tail, _) = fitting(pieces(&name).rev(), end);
    tail.reverse();
    format!("{}…{}", head.concat(), tail.concat())
}

/// Characters of a name, each as it is or as its escape.
fn pieces(name: &str) -> impl DoubleEndedIterator<Item = String> {
    // `::error::` begins a line, perhaps behind spaces.
    let line = name.trim_start();
    let command = line.starts_with("::").then(|| name.len() - line.len());
    name.char_indices().map(move |(at, c)| {
        if Some(at) == command || c == '[' && is_marked(&name[..at]) {
            format!("\\u{{{:x}}}", u32::from(c))
        } else if is_visible(c) {
            c.to_string()
        } else {
            c.escape_debug().to_string()
        }
    })
}

/// Whether a `[` behind this text begins a CI command, anywhere in a line: `##[`, `##vso[`.
fn is_marked(before: &str) -> bool {
    let word = |c: char| c.is_ascii_alphanumeric();
    before.trim_end_matches(word).ends_with("##")
}

/// Whether a character can be shown as it is.
///
/// Rust's tables decide which are invisible: controls, direction marks, separators, unusual spaces.
/// The character is tested behind a letter, where combining accents are harmless.
fn is_visible(c: char) -> bool {
    let mut word = [b'x', 0, 0, 0, 0];
    let length = 1 + c.encode_utf8(&mut word[1..]).len();
    let is_itself = |word: &str| word.escape_debug().nth(2).is_none();
    matches!(c, '\'' | '"' | '\\') || std::str::from_utf8(&word[..length]).is_ok_and(is_itself)
}

/// As many pieces as fit into `most` characters, and whether these are all.
fn fitting(pieces: impl Iterator<Item = String>, most: usize) -> (Vec<String>, bool) {
    let (mut fitting, mut length) = (Vec::new(), 0_usize);
    for piece in pieces {
        length += piece.chars().count();
        if length > most {
            return (fitting, false);
        }
        fitting.push(piece);
    }
    (fitting, true)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_steers_is_escaped_and_what_is_written_is_not() {
        // A combining accent, as macOS writes it; quotes and backslashes; another script.
        for name in [
            "e\u{301}té",
            r#"C:\a"b'.obj"#,
            "布_01.obj",
            "a b[1]#.obj",
            "",
        ] {
            assert_eq!(shown(name), name);
        }
        let invisible = [
            ("\0", r"\0"),
            ("\t\r\n", r"\t\r\n"),
            ("\u{7f}\u{85}\u{9b}", r"\u{7f}\u{85}\u{9b}"),
            ("\u{ad}\u{200b}\u{feff}", r"\u{ad}\u{200b}\u{feff}"),
            ("\u{200e}\u{202e}\u{2066}", r"\u{200e}\u{202e}\u{2066}"),
            ("\u{2028}\u{2029}\u{e0041}", r"\u{2028}\u{2029}\u{e0041}"),
        ];
        for (name, escaped) in invisible {
            assert_eq!(shown(format!("a{name}b")), format!("a{escaped}b"));
        }
    }

    #[test]
    fn no_runner_takes_a_name_for_a_command() {
        for (name, harmless) in [
            ("::error::a", r"\u{3a}:error::a"),
            ("  ::add-mask::a", r"  \u{3a}:add-mask::a"),
            ("a::b", "a::b"),
            ("a##[error]b", r"a##\u{5b}error]b"),
            ("##vso[task]a", r"##vso\u{5b}task]a"),
            ("a#[1]", "a#[1]"),
        ] {
            assert_eq!(shown(name), harmless);
        }
    }

    #[test]
    fn long_names_keep_both_ends_and_no_escape_is_cut() {
        let name = format!("{}{}", "\u{1b}".repeat(1000), "é".repeat(1000));
        assert_eq!(shown_within(&name, 0), "");
        for most in 1..60 {
            let shown = shown_within(&name, most);
            assert!(shown.chars().count() <= most, "{shown}");
            let (head, tail) = shown.split_once('…').unwrap();
            assert_eq!(head.replace(r"\u{1b}", ""), "");
            assert_eq!(tail, "é".repeat(most / 3));
        }
        assert_eq!(shown_within("abc", 3), "abc");
    }
}
