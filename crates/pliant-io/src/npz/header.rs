//! NPY header: type, order and shape of an array.
//!
//! The crate has its own parser because npyz 0.9.1 fails on hostile files. It allocates the claimed
//! length of the header, up to 4 GiB. It multiplies the shape with an overflow that panics in debug
//! builds, and it parses nested Python values by unlimited recursion. Readable arrays have a
//! dictionary of three flat entries:
//!
//! ```text
//! \x93NUMPY, major, minor, length of the rest (u16; from major 2 on u32)
//! {'descr': '<f4', 'fortran_order': False, 'shape': (60, 13380, 3), }
//! ```

use std::io::{self, Read};

use crate::error::Reason;
use crate::text::quoted;

/// Longest header in bytes: numpy writes about 128, and by default refuses more than 10,000.
const LONGEST: usize = 10_000;

/// A parsed NPY header.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Header {
    /// Byte order, kind and size, such as `<f4`.
    pub(super) dtype: Dtype,
    pub(super) fortran_order: bool,
    pub(super) shape: Vec<u64>,
    /// Offset of the data, in bytes.
    pub(super) length: u64,
}

/// Element type of an array.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Dtype {
    pub(super) big_endian: bool,
    /// Kind as numpy abbreviates it: `f`, `i`, `u`, ...
    pub(super) kind: char,
    /// Size in bytes; 0 for kinds whose size is not a number of bytes.
    pub(super) size: usize,
    pub(super) written: String,
}

impl Header {
    /// Reads the header and leaves `input` at the first byte of the data.
    pub(super) fn read(input: &mut impl Read) -> Result<Self, Reason> {
        let ends_early = |error: io::Error| match error.kind() {
            io::ErrorKind::UnexpectedEof => {
                Reason::Truncated("the header of an array is incomplete".into())
            }
            _ => error.into(),
        };
        let mut start = [0; 8];
        input.read_exact(&mut start).map_err(ends_early)?;
        let major = start[6];
        if !start.starts_with(b"\x93NUMPY") || !(1..=3).contains(&major) {
            return Err(Reason::Malformed("is not an array that numpy wrote".into()));
        }
        let size_of_length = if major == 1 { 2 } else { 4 };
        let mut length = [0; 4];
        input
            .read_exact(&mut length[..size_of_length])
            .map_err(ends_early)?;
        let length = u32::from_le_bytes(length) as usize;
        if length > LONGEST {
            return Err(Reason::Malformed(format!(
                "the header of the array has {length} bytes; at most {LONGEST} are read"
            )));
        }
        let mut text = vec![0; length];
        input.read_exact(&mut text).map_err(ends_early)?;
        let total = start.len() + size_of_length + length;
        Parser { rest: &text }.dictionary(total as u64)
    }
}

/// Parser of the dictionary; refuses nested values, so it needs no recursion.
struct Parser<'a> {
    rest: &'a [u8],
}

impl<'a> Parser<'a> {
    fn dictionary(mut self, length: u64) -> Result<Header, Reason> {
        let (mut dtype, mut fortran_order, mut shape) = (None, None, None);
        self.expect(b'{')?;
        while !self.take(b'}') {
            let key = self.string()?;
            self.expect(b':')?;
            match key {
                b"descr" if self.peek() == Some(b'[') => {
                    let advice =
                        "an array of records; save the coordinates as a plain array of floats";
                    return Err(Reason::Unsupported(advice.into()));
                }
                b"descr" => dtype = Some(Dtype::parse(self.string()?)?),
                b"fortran_order" => fortran_order = Some(self.boolean()?),
                b"shape" => shape = Some(self.shape()?),
                _ => return Err(self.malformed()),
            }
            if !self.take(b',') && self.peek() != Some(b'}') {
                return Err(self.malformed());
            }
        }
        match (dtype, fortran_order, shape) {
            (Some(dtype), Some(fortran_order), Some(shape)) if self.peek().is_none() => {
                Ok(Header {
                    dtype,
                    fortran_order,
                    shape,
                    length,
                })
            }
            _ => Err(self.malformed()),
        }
    }

    fn string(&mut self) -> Result<&'a [u8], Reason> {
        let quote = self
            .peek()
            .filter(|c| matches!(c, b'\'' | b'"'))
            .ok_or_else(|| self.malformed())?;
        let rest = &self.rest[1..];
        let end = rest
            .iter()
            .position(|&c| c == quote)
            .ok_or_else(|| self.malformed())?;
        self.rest = &rest[end + 1..];
        Ok(&rest[..end])
    }

    fn boolean(&mut self) -> Result<bool, Reason> {
        self.peek();
        for (word, value) in [(&b"True"[..], true), (b"False", false)] {
            if let Some(rest) = self.rest.strip_prefix(word) {
                self.rest = rest;
                return Ok(value);
            }
        }
        Err(self.malformed())
    }

    fn shape(&mut self) -> Result<Vec<u64>, Reason> {
        let mut shape = Vec::new();
        self.expect(b'(')?;
        while !self.take(b')') {
            self.peek();
            let end = self
                .rest
                .iter()
                .position(|c| !c.is_ascii_digit())
                .unwrap_or(self.rest.len());
            let (digits, rest) = self.rest.split_at(end);
            shape.push(crate::text::number(digits).ok_or_else(|| self.malformed())?);
            // Python 2 marks long integers with an L.
            self.rest = rest.strip_prefix(b"L").unwrap_or(rest);
            if !self.take(b',') && self.peek() != Some(b')') {
                return Err(self.malformed());
            }
        }
        Ok(shape)
    }

    /// The next character that is not white space.
    fn peek(&mut self) -> Option<u8> {
        self.rest = self.rest.trim_ascii_start();
        self.rest.first().copied()
    }

    /// Consumes the next character if it is `wanted`.
    fn take(&mut self, wanted: u8) -> bool {
        let there = self.peek() == Some(wanted);
        if there {
            self.rest = &self.rest[1..];
        }
        there
    }

    fn expect(&mut self, wanted: u8) -> Result<(), Reason> {
        if self.take(wanted) {
            Ok(())
        } else {
            Err(self.malformed())
        }
    }

    fn malformed(&self) -> Reason {
        Reason::Malformed(format!(
            "the header of the array cannot be understood from {} on",
            quoted(self.rest)
        ))
    }
}

impl Dtype {
    fn parse(text: &[u8]) -> Result<Self, Reason> {
        let malformed = || {
            Reason::Malformed(format!(
                "type {} cannot be read; a type is byte order, kind and size, such as \"<f4\"",
                quoted(text)
            ))
        };
        let written = std::str::from_utf8(text).map_err(|_| malformed())?;
        let mut letters = written.chars();
        let (order, kind) = (
            letters.next().ok_or_else(malformed)?,
            letters.next().ok_or_else(malformed)?,
        );
        if !matches!(order, '<' | '>' | '|' | '=') {
            return Err(malformed());
        }
        Ok(Self {
            big_endian: order == '>' || (order == '=' && cfg!(target_endian = "big")),
            kind,
            size: letters.as_str().parse().unwrap_or(0),
            written: written.to_owned(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(text: &str) -> Result<Header, Reason> {
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((text.len() as u16).to_le_bytes());
        bytes.extend(text.as_bytes());
        Header::read(&mut &bytes[..])
    }

    #[test]
    fn numpy_and_its_relatives_are_understood() {
        for text in [
            "{'descr': '<f4', 'fortran_order': False, 'shape': (60, 13380, 3), }          \n",
            "{\"shape\":(60L,13380L,3L),\"descr\":\"<f4\",\"fortran_order\":False}",
        ] {
            let header = header(text).unwrap();
            assert_eq!(header.shape, [60, 13380, 3]);
            assert!(!header.fortran_order);
            assert_eq!(
                (
                    header.dtype.kind,
                    header.dtype.size,
                    header.dtype.big_endian
                ),
                ('f', 4, false)
            );
            assert_eq!(header.length, 10 + text.len() as u64);
        }
        let scalar = header("{'descr': '>i8', 'fortran_order': True, 'shape': ()}").unwrap();
        assert_eq!(
            (
                scalar.shape.len(),
                scalar.fortran_order,
                scalar.dtype.big_endian
            ),
            (0, true, true)
        );
        assert_eq!(
            header("{'descr': '|u1', 'fortran_order': False, 'shape': (7,)}")
                .unwrap()
                .shape,
            [7]
        );
    }

    #[test]
    fn versions_two_and_three_have_longer_lengths() {
        let text = b"{'descr': '<f8', 'fortran_order': False, 'shape': (1, 3)}";
        for major in [2, 3] {
            let mut bytes = [b"\x93NUMPY", &[major, 0][..]].concat();
            bytes.extend((text.len() as u32).to_le_bytes());
            bytes.extend(text);
            assert_eq!(
                Header::read(&mut &bytes[..]).unwrap().length,
                12 + text.len() as u64
            );
        }
    }

    #[test]
    fn anything_else_is_refused() {
        let valid = "{'descr': '<f4', 'fortran_order': False, 'shape': (60, 13380, 3)}";
        for (from, to) in [
            ("'shape'", "'size'"),
            ("(60", "(-60"),
            ("(60", "((60"),
            ("60,", "60"),
            ("60,", "60,,"),
            ("60", "99999999999999999999"),
            ("False", "0"),
            ("'<f4'", "'<'"),
            ("'<f4'", "'f4'"),
            ("'<f4'", "<f4"),
            ("'<f4'", "[('x', '<f4')]"),
            ("3)}", "3)"),
            ("3)}", "3)}}"),
            (", 'shape': (60, 13380, 3)", ""),
        ] {
            assert!(valid.contains(from));
            assert!(header(&valid.replace(from, to)).is_err(), "{from} as {to}");
        }
        assert!(header(&"(".repeat(9_999)).is_err());
        assert!(header(&format!("{{'shape': {}", "(".repeat(9_000))).is_err());
        assert!(Header::read(&mut &b"\x93NUMPY\x02\x00\xff\xff\xff\xff"[..]).is_err());
        assert!(Header::read(&mut &b"\x93NUMPY\x04\x00\x02\x00{}"[..]).is_err());
        assert!(Header::read(&mut &b"\x93NUM"[..]).is_err());
    }
}
