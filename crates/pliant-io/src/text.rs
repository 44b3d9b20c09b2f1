//! Lines, words and numbers of text formats.

use std::io::{self, BufRead, Read as _};
use std::str::FromStr;

use crate::error::{Fault, Place, Reason};
use crate::shown::shown_within;

/// Longest allowed line in bytes: 16 MiB.
///
/// A polygon of a million corners fits, but a file without line breaks is not read whole.
pub(crate) const LONGEST_LINE: u64 = 16 << 20;

/// Line reader: lines without their ends (`\n` or `\r\n`), counted from 1.
///
/// If the first line ends with `\r` alone, as on old Macs, any line may.
#[derive(Debug)]
pub(crate) struct Lines<R> {
    input: R,
    line: Vec<u8>,
    number: u64,
    /// Whether a line may end with `\r` alone.
    returns: bool,
}

impl<R: BufRead> Lines<R> {
    pub(crate) fn new(input: R) -> Self {
        Self {
            input,
            line: Vec::new(),
            number: 0,
            returns: false,
        }
    }

    /// Moves to the next line; false at the end of the text.
    pub(crate) fn advance(&mut self) -> Result<bool, Fault> {
        self.line.clear();
        self.number += 1;
        let read = if self.number == 1 {
            self.read_first()
        } else if self.returns {
            self.read_until_any().map(|_| self.line.len())
        } else {
            let mut input = self.input.by_ref().take(LONGEST_LINE + 1);
            input.read_until(b'\n', &mut self.line)
        };
        if read.map_err(|error| Reason::Io(error).at(self.place()))? == 0 {
            return Ok(false);
        }
        if self.line.len() as u64 > LONGEST_LINE {
            let reason =
                "the line has more than 16 MiB, the most that is read; is this a binary file?";
            return Err(Reason::Malformed(reason.into()).at(self.place()));
        }
        if self.line.last() == Some(&b'\n') {
            self.line.pop();
        }
        if self.line.last() == Some(&b'\r') {
            self.line.pop();
        }
        Ok(true)
    }

    /// Reads the first line and detects how lines end.
    fn read_first(&mut self) -> io::Result<usize> {
        if self.read_until_any()? == Some(b'\r') {
            if self.input.fill_buf()?.first() == Some(&b'\n') {
                self.input.consume(1);
                self.line.push(b'\n');
            } else {
                self.returns = true;
            }
        }
        Ok(self.line.len())
    }

    /// Reads up to and including the next `\n` or `\r`, and returns it.
    ///
    /// None at the end of the text, and beyond the longest allowed line.
    fn read_until_any(&mut self) -> io::Result<Option<u8>> {
        while self.line.len() as u64 <= LONGEST_LINE {
            let some = match self.input.fill_buf() {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                some => some?,
            };
            if some.is_empty() {
                break;
            }
            let end = some.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
            let read = end.map_or(some.len(), |end| end + 1);
            self.line.extend_from_slice(&some[..read]);
            self.input.consume(read);
            if end.is_some() {
                return Ok(self.line.last().copied());
            }
        }
        Ok(None)
    }

    /// The current line; empty at the end of the text.
    pub(crate) fn line(&self) -> &[u8] {
        &self.line
    }

    pub(crate) fn place(&self) -> Place {
        Place::Line(self.number)
    }
}

/// Splits a line into words at white space.
pub(crate) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(u8::is_ascii_whitespace)
        .filter(|word| !word.is_empty())
}

/// Parses a word as a number; floats are rounded to nearest.
pub(crate) fn number<T: FromStr>(word: &[u8]) -> Option<T> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// The error `expected a number, found "abc"`.
///
/// `wanted` names what was expected; `found` is the word in its place, if there is one.
pub(crate) fn expected(wanted: &str, found: Option<&[u8]>) -> Reason {
    Reason::Malformed(match found {
        Some(word) => format!("expected {wanted}, found {}", quoted(word)),
        None => format!("expected {wanted}, found the end of the line"),
    })
}

/// The error for a vertex that ends behind its second coordinate.
pub(crate) fn two_coordinates() -> Reason {
    Reason::Malformed("a vertex has two coordinates; pliant needs three".into())
}

/// A word of a file in quotes, shortened to 40 characters.
pub(crate) fn quoted(word: impl AsRef<[u8]>) -> String {
    let text = String::from_utf8_lossy(word.as_ref());
    format!("\"{}\"", shown_within(&*text, 40))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_lose_their_ends_and_keep_their_numbers() {
        let mut lines = Lines::new(&b"one\r\n\n three \nlast"[..]);
        let mut seen = Vec::new();
        while lines.advance().unwrap() {
            seen.push((lines.place(), lines.line().to_vec()));
        }
        let expected = [(1, &b"one"[..]), (2, b""), (3, b" three "), (4, b"last")];
        assert_eq!(
            seen,
            expected.map(|(number, text)| (Place::Line(number), text.to_vec()))
        );
    }

    #[test]
    fn lines_may_end_as_those_of_old_macs() {
        for (text, lines) in [
            (
                &b"one\rtwo\r\rfour"[..],
                &[&b"one"[..], b"two", b"", b"four"][..],
            ),
            (b"\rtwo\nthree\r", &[b"", b"two", b"three"]),
            (b"one\r", &[b"one"]),
            // The first line does not end with `\r` alone, so it ends no line.
            (b"one\ntw\ro\r\n", &[b"one", b"tw\ro"]),
            (b"one\r\ntw\ro\r\n", &[b"one", b"tw\ro"]),
        ] {
            // Whatever the buffer reads at once.
            for capacity in [1, 2, 64] {
                let input = io::BufReader::with_capacity(capacity, text);
                let mut read = Lines::new(input);
                let mut seen = Vec::new();
                while read.advance().unwrap() {
                    seen.push(read.line().to_vec());
                }
                assert_eq!(seen, lines);
            }
        }
    }

    #[test]
    fn endless_lines_end() {
        let endless = || io::BufReader::new(io::repeat(b'x'));
        assert!(Lines::new(endless()).advance().is_err());
        for first in [&b"1\n"[..], b"1\r"] {
            let mut lines = Lines::new(io::Read::chain(first, endless()));
            assert!(lines.advance().unwrap() && lines.advance().is_err());
        }
    }

    #[test]
    fn long_words_are_quoted_in_part() {
        assert_eq!(quoted(b"a\"b\n"), r#""a"b\n""#);
        assert_eq!(quoted([b'7'; 99]).chars().count(), 42);
        assert_eq!(quoted("é".repeat(40)).chars().count(), 42);
        assert!(quoted([0xff; 1000]).chars().count() <= 42);
    }
}
