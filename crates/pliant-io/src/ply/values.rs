//! PLY values behind the header, row by row: one row for each repetition of an element.
//!
//! In ASCII a row is a line with exactly as many values as the header declares. A line with more
//! was written by a program that meant another header. Reading on would mistake the surplus for
//! something else.

use std::io::{self, BufRead, Read as _};
use std::marker::PhantomData;

use super::header::{Element, Scalar};
use crate::error::{Fault, Place, Reason};
use crate::text::{Lines, expected, number, quoted, words};

/// Stream of values in the order of the file.
///
/// Between [`begin_row`](Self::begin_row) and [`end_row`](Self::end_row), each property of the
/// element is read or skipped.
pub(super) trait Values {
    fn begin_row(&mut self, element: &Element, row: u64) -> Result<(), Fault>;
    fn end_row(&mut self) -> Result<(), Fault>;
    /// Reads the next number, of type `scalar`, exactly.
    fn real(&mut self, scalar: Scalar) -> Result<f64, Fault>;
    /// Reads the next integer, of an integer type `scalar`.
    fn integer(&mut self, scalar: Scalar) -> Result<i64, Fault>;
    fn skip(&mut self, scalar: Scalar, count: u64) -> Result<(), Fault>;
    /// Place of the current row.
    fn place(&self) -> Place;
}

fn truncated(element: &Element, row: u64) -> Reason {
    let name = String::from_utf8_lossy(&element.name);
    Reason::Truncated(format!(
        "element {name} has {row} rows; the header announces {}",
        element.count
    ))
}

/// ASCII values: words of lines.
pub(super) struct Ascii<R> {
    lines: Lines<R>,
    /// Bytes of the line read so far.
    read: usize,
}

impl<R: BufRead> Ascii<R> {
    pub(super) fn new(lines: Lines<R>) -> Self {
        Self { lines, read: 0 }
    }

    fn next_word(&mut self) -> Option<&[u8]> {
        let rest = &self.lines.line()[self.read..];
        let begin = rest.iter().position(|c| !c.is_ascii_whitespace())?;
        let length = rest[begin..]
            .iter()
            .position(u8::is_ascii_whitespace)
            .unwrap_or(rest.len() - begin);
        let from = self.read + begin;
        self.read = from + length;
        Some(&self.lines.line()[from..self.read])
    }

    fn next<T>(&mut self, wanted: &str, parse: impl Fn(&[u8]) -> Option<T>) -> Result<T, Fault> {
        let place = self.place();
        let word = self.next_word();
        word.and_then(parse)
            .ok_or_else(|| expected(wanted, word).at(place))
    }
}

impl<R: BufRead> Values for Ascii<R> {
    fn begin_row(&mut self, element: &Element, row: u64) -> Result<(), Fault> {
        self.read = 0;
        loop {
            if !self.lines.advance()? {
                return Err(truncated(element, row).at(self.place()));
            }
            if words(self.lines.line()).next().is_some() {
                return Ok(());
            }
        }
    }

    fn end_row(&mut self) -> Result<(), Fault> {
        let place = self.place();
        match self.next_word() {
            None => Ok(()),
            Some(word) => Err(Reason::Malformed(format!(
                "more values than the header declares, from {} on",
                quoted(word)
            ))
            .at(place)),
        }
    }

    fn real(&mut self, scalar: Scalar) -> Result<f64, Fault> {
        match scalar {
            Scalar::F64 => self.next("a number", number),
            Scalar::F32 => self.next("a number", |word| number::<f32>(word).map(f64::from)),
            _ => self.integer(scalar).map(|integer| integer as f64),
        }
    }

    fn integer(&mut self, _: Scalar) -> Result<i64, Fault> {
        self.next("a whole number", number)
    }

    fn skip(&mut self, _: Scalar, count: u64) -> Result<(), Fault> {
        for _ in 0..count {
            self.next("a value", |_| Some(()))?;
        }
        Ok(())
    }

    fn place(&self) -> Place {
        self.lines.place()
    }
}

/// Byte order of binary values.
pub(super) trait Endian {
    /// Returns `bytes` with the first `size` of them reordered, least significant first.
    fn little(bytes: [u8; 8], size: usize) -> [u8; 8];
}

pub(super) struct LittleEndian;
pub(super) struct BigEndian;

impl Endian for LittleEndian {
    fn little(bytes: [u8; 8], _: usize) -> [u8; 8] {
        bytes
    }
}

impl Endian for BigEndian {
    fn little(mut bytes: [u8; 8], size: usize) -> [u8; 8] {
        bytes[..size].reverse();
        bytes
    }
}

/// Binary values.
pub(super) struct Binary<R, E> {
    input: R,
    element: String,
    announced: u64,
    row: u64,
    endian: PhantomData<E>,
}

impl<R: BufRead, E: Endian> Binary<R, E> {
    pub(super) fn new(input: R) -> Self {
        Self {
            input,
            element: String::new(),
            announced: 0,
            row: 0,
            endian: PhantomData,
        }
    }

    /// Bytes of the next value, least significant first.
    fn next(&mut self, scalar: Scalar) -> Result<[u8; 8], Fault> {
        let mut bytes = [0; 8];
        let size = scalar.size();
        self.input
            .read_exact(&mut bytes[..size])
            .map_err(|error| self.fault(error))?;
        Ok(E::little(bytes, size))
    }

    fn fault(&self, error: io::Error) -> Fault {
        let reason = if error.kind() == io::ErrorKind::UnexpectedEof {
            Reason::Truncated(format!(
                "the header announces {} of this element",
                self.announced
            ))
        } else {
            error.into()
        };
        reason.at(self.place())
    }
}

impl<R: BufRead, E: Endian> Values for Binary<R, E> {
    fn begin_row(&mut self, element: &Element, row: u64) -> Result<(), Fault> {
        if row == 0 {
            self.element = String::from_utf8_lossy(&element.name).into_owned();
            self.announced = element.count;
        }
        self.row = row;
        Ok(())
    }

    fn end_row(&mut self) -> Result<(), Fault> {
        Ok(())
    }

    fn real(&mut self, scalar: Scalar) -> Result<f64, Fault> {
        match scalar {
            Scalar::F64 => self.next(scalar).map(f64::from_le_bytes),
            Scalar::F32 => self
                .next(scalar)
                .map(|[a, b, c, d, ..]| f32::from_le_bytes([a, b, c, d]).into()),
            _ => self.integer(scalar).map(|integer| integer as f64),
        }
    }

    fn integer(&mut self, scalar: Scalar) -> Result<i64, Fault> {
        let [a, b, c, d, ..] = self.next(scalar)?;
        Ok(match scalar {
            Scalar::I8 => i8::from_le_bytes([a]).into(),
            Scalar::U8 => a.into(),
            Scalar::I16 => i16::from_le_bytes([a, b]).into(),
            Scalar::U16 => u16::from_le_bytes([a, b]).into(),
            Scalar::I32 => i32::from_le_bytes([a, b, c, d]).into(),
            // The header was refused if an integer was to be read from a float type.
            Scalar::U32 | Scalar::F32 | Scalar::F64 => u32::from_le_bytes([a, b, c, d]).into(),
        })
    }

    fn skip(&mut self, scalar: Scalar, count: u64) -> Result<(), Fault> {
        let bytes = count.saturating_mul(scalar.size() as u64);
        let skipped = io::copy(&mut self.input.by_ref().take(bytes), &mut io::sink());
        if skipped.map_err(|error| self.fault(error))? < bytes {
            return Err(self.fault(io::ErrorKind::UnexpectedEof.into()));
        }
        Ok(())
    }

    fn place(&self) -> Place {
        Place::Element(self.element.clone(), self.row)
    }
}
