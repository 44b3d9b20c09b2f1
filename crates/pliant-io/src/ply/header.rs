//! PLY header: text in all encodings.
//!
//! ```text
//! ply
//! format binary_little_endian 1.0
//! comment anything
//! element vertex 8                                  name and count, a claim
//! property double x                                 one number
//! element face 12
//! property list uchar int vertex_indices            a count, then as many numbers
//! end_header
//! ```

use std::io::BufRead;

use crate::error::{Fault, Reason};
use crate::text::{Lines, expected, number, quoted, words};

/// Most lines of a header: limits the memory that a hostile file can take.
const MOST_LINES: usize = 10_000;

/// A parsed header: encoding, and elements in the order of the file.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
}

/// Encoding of the values behind the header.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// A kind of row: its name, how often it is repeated, and its columns.
#[derive(Debug)]
pub(super) struct Element {
    pub(super) name: Vec<u8>,
    /// Number of rows; a claim, for which no memory is allocated.
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

/// A column of an element.
#[derive(Debug)]
pub(super) struct Property {
    pub(super) name: Vec<u8>,
    pub(super) kind: Kind,
}

/// Type of a property.
#[derive(Debug, Clone, Copy)]
pub(super) enum Kind {
    One(Scalar),
    List { count: Scalar, item: Scalar },
}

/// Type of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn named(word: &[u8]) -> Option<Self> {
        Some(match word {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    pub(super) fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }

    /// Size in bytes.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

impl Header {
    /// Reads up to and including the line `end_header`.
    pub(super) fn read(lines: &mut Lines<impl BufRead>) -> Result<Self, Fault> {
        if !lines.advance()? {
            return Err(Reason::Malformed("is empty".into()).into());
        }
        if words(lines.line()).ne([&b"ply"[..]]) {
            let found = quoted(lines.line());
            return Err(Reason::Malformed(format!(
                "a PLY file begins with a line `ply`, this one with {found}"
            ))
            .at(lines.place()));
        }
        let mut encoding = None;
        let mut elements = Vec::new();
        for _ in 0..MOST_LINES {
            if !lines.advance()? {
                return Err(
                    Reason::Truncated("the header has no line `end_header`".into())
                        .at(lines.place()),
                );
            }
            let line: Vec<&[u8]> = words(lines.line()).take(6).collect();
            let declared = match line[..] {
                [b"end_header"] => {
                    let no_format = || {
                        Reason::Malformed("the header has no line `format`".into())
                            .at(lines.place())
                    };
                    let encoding = encoding.ok_or_else(no_format)?;
                    return Ok(Self { encoding, elements });
                }
                [] | [b"comment" | b"obj_info", ..] => Ok(()),
                [b"format", name, version] if encoding.is_none() => {
                    format(name, version).map(|format| encoding = Some(format))
                }
                [b"element", name, count] => {
                    element(name, count, &elements).map(|element| elements.push(element))
                }
                [b"property", ref words @ ..] => match elements.last_mut() {
                    Some(element) => {
                        property(words).map(|property| element.properties.push(property))
                    }
                    None => Err(Reason::Malformed("a property before any element".into())),
                },
                _ => Err(Reason::Malformed(format!(
                    "not a line of a PLY header: {}",
                    quoted(lines.line())
                ))),
            };
            declared.map_err(|reason| reason.at(lines.place()))?;
        }
        Err(Reason::Malformed(format!(
            "the header has more than {MOST_LINES} lines, the most that are read"
        ))
        .at(lines.place()))
    }

    pub(super) fn element(&self, name: &str) -> Option<&Element> {
        self.elements
            .iter()
            .find(|element| element.name == name.as_bytes())
    }
}

fn format(name: &[u8], version: &[u8]) -> Result<Encoding, Reason> {
    if version != b"1.0" {
        return Err(Reason::Unsupported(format!(
            "PLY version {} cannot be read, only 1.0",
            quoted(version)
        )));
    }
    match name {
        b"ascii" => Ok(Encoding::Ascii),
        b"binary_little_endian" => Ok(Encoding::LittleEndian),
        b"binary_big_endian" => Ok(Encoding::BigEndian),
        _ => Err(expected(
            "ascii, binary_little_endian or binary_big_endian",
            Some(name),
        )),
    }
}

fn element(name: &[u8], count: &[u8], before: &[Element]) -> Result<Element, Reason> {
    if before.iter().any(|element| element.name == name) {
        return Err(Reason::Malformed(format!(
            "element {} is declared twice",
            quoted(name)
        )));
    }
    Ok(Element {
        name: name.to_vec(),
        count: number(count).ok_or_else(|| expected("a count", Some(count)))?,
        properties: Vec::new(),
    })
}

/// Parses a declaration; `words` follow the keyword `property`.
fn property(words: &[&[u8]]) -> Result<Property, Reason> {
    let scalar =
        |word: &[u8]| Scalar::named(word).ok_or_else(|| expected("a type of number", Some(word)));
    let (name, kind) = match *words {
        [b"list", count, item, name] => {
            let (count, item) = (scalar(count)?, scalar(item)?);
            if !count.is_integer() {
                return Err(Reason::Malformed(format!(
                    "list {} has a float type for its count; it must be an integer type",
                    quoted(name)
                )));
            }
            (name, Kind::List { count, item })
        }
        [one, name] => (name, Kind::One(scalar(one)?)),
        _ => {
            return Err(Reason::Malformed(
                "a property line is `property TYPE NAME`, or `property list COUNT ITEM NAME`"
                    .into(),
            ));
        }
    };
    let name = name.to_vec();
    Ok(Property { name, kind })
}
