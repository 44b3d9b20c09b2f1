//! STL reader: triangles without shared vertices, as text or as 50 bytes each.
//!
//! The crate has its own reader because stl_io tells text from binary by the first word, and many
//! programs begin binary files with "solid". Here the length decides: a binary file has exactly 84
//! bytes and 50 per triangle. Every corner is a vertex of its own, in file order, and every edge is
//! a seam that welding closes.
//!
//! - Text of exactly that length, whose bytes 80 to 83 give the matching count, does not occur.
//! - Bytes behind the triangles of a binary file are passed over, as some programs put colours
//!   there. A length of whole triangles is an error: the count is wrong.
//! - Normals are passed over: the corners determine them.
//! - Coordinates are f32: as stored, or nearest to the text.

use std::io::{self, BufRead, Read as _};

use crate::error::{Fault, Place, Reason};
use crate::frame::{Announced, Complete, Frame};
use crate::groups::Naming;
use crate::note::Note;
use crate::obj::name;
use crate::positions::Precision;
use crate::text::{Lines, expected, number, two_coordinates, words};

/// Bytes before the triangles: a comment of 80 bytes and their number.
const HEAD: usize = 84;
/// Bytes of a triangle: a normal, three corners, and two bytes of other meaning.
const TRIANGLE: usize = 50;

/// Reads one file of `length` bytes, which is one frame.
pub(crate) fn read(
    mut input: impl BufRead,
    length: u64,
    frame: &mut Frame,
) -> Result<Complete, Fault> {
    let mut head = Vec::with_capacity(HEAD);
    input.by_ref().take(HEAD as u64).read_to_end(&mut head)?;
    if head.is_empty() {
        return Err(Reason::Malformed("is empty".into()).into());
    }
    let count = head.get(80..HEAD).map(|count| {
        let &[a, b, c, d] = count else { return 0 };
        u32::from_le_bytes([a, b, c, d])
    });
    let needed = |count: u32| HEAD as u64 + TRIANGLE as u64 * u64::from(count);
    if let Some(count) = count
        && length == needed(count)
    {
        return read_binary(input, count, frame);
    }
    if is_text(&head) {
        return read_text((&head[..]).chain(input), frame);
    }
    // Binary files have other bytes too, before their triangles and in the number of these.
    if head.is_ascii() && !has_controls(&head) {
        let word = words(&head).next().unwrap_or_default();
        return Err(expected("\"solid\"", Some(word)).at(Place::Line(1)));
    }
    if let Some(count @ 1..) = count
        && length > needed(count)
        && !(length - needed(count)).is_multiple_of(TRIANGLE as u64)
    {
        return read_binary(input, count, frame);
    }
    Err(match count {
        None => Reason::Truncated(format!(
            "a binary STL file has {HEAD} bytes before its triangles, this one has {length}"
        )),
        Some(count) if length < needed(count) => Reason::Truncated(format!(
            "{count} triangles need {} bytes, the file has {length}",
            needed(count)
        )),
        Some(count) => Reason::Malformed(format!(
            "the header counts {count} triangles, but {} bytes follow it, enough for {}",
            length - HEAD as u64,
            (length - HEAD as u64) / TRIANGLE as u64
        )),
    }
    .at(Place::Byte(80)))
}

/// Whether a file that begins with these bytes is text.
fn is_text(head: &[u8]) -> bool {
    let first = words(head).next().unwrap_or_default();
    first.eq_ignore_ascii_case(b"solid") && !has_controls(head)
}

fn has_controls(head: &[u8]) -> bool {
    head.iter()
        .any(|byte| *byte < b' ' && !byte.is_ascii_whitespace())
}

fn read_binary(mut input: impl BufRead, count: u32, frame: &mut Frame) -> Result<Complete, Fault> {
    frame.begin(
        Precision::F32,
        Announced {
            vertices: 3 * u64::from(count),
            faces: u64::from(count),
        },
    )?;
    let mut bytes = [0; TRIANGLE];
    for triangle in 0..u64::from(count) {
        let start = HEAD as u64 + triangle * TRIANGLE as u64;
        input.read_exact(&mut bytes).map_err(|error| {
            let reason = match error.kind() {
                io::ErrorKind::UnexpectedEof => {
                    Reason::Truncated(format!("the header counts {count} triangles"))
                }
                _ => error.into(),
            };
            reason.at(Place::Byte(start))
        })?;
        for (corner, bytes) in bytes[12..48].chunks_exact(12).enumerate() {
            let mut position = [0.0; 3];
            for (value, bytes) in position.iter_mut().zip(bytes.chunks_exact(4)) {
                *value = f32::from_le_bytes(bytes.try_into().unwrap_or_default()).into();
            }
            let place = Place::Byte(start + 12 * (corner as u64 + 1));
            frame.vertex(position).map_err(|reason| reason.at(place))?;
        }
        triangle_of_the_last_three(frame, || Place::Byte(start))?;
    }
    frame.complete(0)
}

/// Reads the text format: several solids are one body.
///
/// A triangle is `facet`, `outer loop`, three times `vertex x y z`, `endloop`, `endfacet`, between
/// `solid` and `endsolid`, whose names are free. The last solid may end with `end solid`, or not at
/// all; this is noted.
fn read_text(input: impl BufRead, frame: &mut Frame) -> Result<Complete, Fault> {
    frame.begin(Precision::F32, Announced::default())?;
    let mut lines = Lines::new(input);
    // Keywords that end the open blocks, and the number of corners of the open triangle.
    let (mut open, mut corners): (Vec<&[u8]>, u32) = (Vec::new(), 0);
    let mut is_noted = false;
    while lines.advance()? {
        let at = |reason: Reason| reason.at(lines.place());
        let mut words = words(lines.line());
        let Some(word) = words.next() else { continue };
        match (
            open.last().copied().unwrap_or_default(),
            &word.to_ascii_lowercase()[..],
        ) {
            (b"", b"solid") => open.push(b"endsolid"),
            (b"endsolid", b"facet") => open.push(b"endfacet"),
            (b"endfacet", b"outer") if corners == 0 => open.push(b"endloop"),
            (b"endloop", b"vertex") if corners < 3 => {
                let mut position = [0.0; 3];
                for (axis, value) in position.iter_mut().enumerate() {
                    let word = words.next();
                    if word.is_none() && axis == 2 {
                        return Err(at(two_coordinates()));
                    }
                    *value = word
                        .and_then(number::<f32>)
                        .map(f64::from)
                        .ok_or_else(|| at(expected("a coordinate", word)))?;
                }
                if let Some(more) = words.next() {
                    return Err(at(expected("the end of the line", Some(more))));
                }
                frame.vertex(position).map_err(at)?;
                corners += 1;
            }
            (b"endsolid", b"end")
                if words
                    .next()
                    .is_some_and(|word| word.eq_ignore_ascii_case(b"solid")) =>
            {
                let end = "with \"end solid\" in place of \"endsolid\"";
                if !is_noted {
                    frame.note(Note::NoEnd { end });
                }
                is_noted = true;
                open.pop();
            }
            (end, word) if !end.is_empty() && word == end => {
                if end == b"endfacet" {
                    if corners != 3 {
                        let corners = corners as usize;
                        let face = frame.next_face();
                        return Err(at(Reason::FewCorners { face, corners }));
                    }
                    triangle_of_the_last_three(frame, || lines.place())?;
                    corners = 0;
                }
                open.pop();
            }
            (end, _) => {
                let wanted = match (end, corners) {
                    (b"", _) => "\"solid\"",
                    (b"endsolid", _) => "\"facet\" or \"endsolid\"",
                    (b"endfacet", 0) => "\"outer loop\"",
                    (b"endloop", 0..3) => "\"vertex\"",
                    (b"endloop", _) => "\"endloop\": a face has three corners",
                    _ => "\"endfacet\"",
                };
                return Err(at(expected(wanted, Some(word))));
            }
        }
    }
    if let [b"endsolid"] = open[..]
        && frame.next_face() > 0
    {
        let end = "without \"endsolid\"";
        frame.note(Note::NoEnd { end });
        open.clear();
    }
    if let Some(end) = open.last() {
        let end = String::from_utf8_lossy(end);
        return Err(Reason::Truncated(format!("\"{end}\" is missing")).at(lines.place()));
    }
    frame.complete(0)
}

/// Reads the names of solids, from a file that was read before.
///
/// A binary file names none. A solid without a name, or with an earlier one's, is called by its
/// number, from 1.
pub(crate) fn name_faces(
    mut input: impl BufRead,
    length: u64,
    naming: &mut Naming,
) -> Result<(), Fault> {
    let mut head = Vec::with_capacity(HEAD);
    input.by_ref().take(HEAD as u64).read_to_end(&mut head)?;
    let count = head
        .get(80..HEAD)
        .map_or([0; 4], |count| std::array::from_fn(|at| count[at]));
    let triangles = u32::from_le_bytes(count);
    let is_binary = length == HEAD as u64 + TRIANGLE as u64 * u64::from(triangles);
    if is_binary || !is_text(&head) {
        for _ in 0..triangles {
            naming.face()?;
        }
        return Ok(());
    }
    let mut lines = Lines::new((&head[..]).chain(input));
    let mut solids = 0_u32;
    while lines.advance()? {
        let mut words = words(lines.line());
        let Some(word) = words.next() else { continue };
        let at = |reason: Reason| reason.at(lines.place());
        if word.eq_ignore_ascii_case(b"solid") {
            solids += 1;
            naming.solid(name(words), solids).map_err(at)?;
        } else if word.eq_ignore_ascii_case(b"endfacet") {
            naming.face().map_err(at)?;
        }
    }
    Ok(())
}

/// Appends a triangle whose corners are the last three vertices.
fn triangle_of_the_last_three(frame: &mut Frame, place: impl Fn() -> Place) -> Result<(), Fault> {
    // A frame has fewer than 2^32 vertices.
    let last = frame.vertex_count() as u32;
    let corners = [
        last.saturating_sub(3),
        last.saturating_sub(2),
        last.saturating_sub(1),
    ];
    let taken = frame.face(&corners, &place);
    taken.map_err(|reason| reason.at(place()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::positions::Positions;

    fn read_bytes(file: &[u8]) -> Result<Frame, String> {
        let mut frame = Frame::new(1 << 20, true);
        match read(file, file.len() as u64, &mut frame) {
            Ok(_complete) => Ok(frame),
            Err(fault) => Err(format!("{}: {}", fault.place, fault.reason)),
        }
    }

    const TEXT: &str = "solid two words\n facet normal 0 0 1\n  OUTER loop\n   \
        vertex 0 0 0\n   vertex 1e0 0 0\r\n\
        vertex\t0 0.1 0\n endloop\nendfacet\nendsolid two words\n\n\
        solid\nfacet\nouter loop\nvertex 1 1 1\nvertex 2 2 2\n\
        vertex -3 3 3\nendloop\nendfacet\nendsolid\n";

    fn binary(head: &str, corners: &[[[f32; 3]; 3]]) -> Vec<u8> {
        let mut file = head.as_bytes().to_vec();
        file.resize(80, b' ');
        file.extend((corners.len() as u32).to_le_bytes());
        for triangle in corners {
            file.extend([0xff; 12]);
            file.extend(triangle.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
            file.extend([1, 2]);
        }
        file
    }

    const TWO: [[[f32; 3]; 3]; 2] = [
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.1, 0.0]],
        [[1.0; 3], [2.0; 3], [-3.0, 3.0, 3.0]],
    ];

    #[test]
    fn text_and_bytes_say_the_same() {
        // Binary files that begin like text, and a text as short as possible.
        let files = [
            TEXT.as_bytes().to_vec(),
            binary("", &TWO),
            binary("solid", &TWO),
            binary("solid made\nby\nfacet normal", &TWO),
        ];
        for file in files {
            let frame = read_bytes(&file).unwrap();
            assert_eq!(frame.positions(), Positions::F32(TWO.as_flattened()));
            assert_eq!(frame.polygons().triangles(), [[0, 1, 2], [3, 4, 5]]);
            assert_eq!(frame.polygons().faces(), None);
        }
    }

    #[test]
    fn errors_name_the_line() {
        let with = |from: &str, to: &str| {
            assert!(TEXT.contains(from));
            read_bytes(TEXT.replacen(from, to, 1).as_bytes()).unwrap_err()
        };
        let wanted = |line: u32, wanted: &str, found: &str| {
            format!(", line {line}: expected {wanted}, found {found}")
        };
        assert_eq!(with("1e0", "one"), wanted(5, "a coordinate", "\"one\""));
        assert_eq!(
            with("1e0 0 0", "1e0 0"),
            ", line 5: a vertex has two coordinates; pliant needs three"
        );
        assert_eq!(
            with("1e0 0 0", "1e0 0 0 0"),
            wanted(5, "the end of the line", "\"0\"")
        );
        assert_eq!(
            with("   vertex 1e0 0 0\r\n", ""),
            ", line 7: face 0 has 2 corners; a face needs at least 3"
        );
        assert_eq!(
            with("endloop", "vertex 1 2 3\nendloop"),
            wanted(7, "\"endloop\": a face has three corners", "\"vertex\"")
        );
        assert_eq!(
            with("facet normal", "face"),
            wanted(2, "\"facet\" or \"endsolid\"", "\"face\"")
        );
        assert_eq!(
            with("OUTER loop", ""),
            wanted(4, "\"outer loop\"", "\"vertex\"")
        );
        assert_eq!(
            with("endfacet", "outer loop"),
            wanted(8, "\"endfacet\"", "\"outer\"")
        );
        assert_eq!(
            with("\n\nsolid", "\nfacet"),
            wanted(10, "\"solid\"", "\"facet\"")
        );
        let range = "coordinates must be finite and at most 3.4028235e38 in magnitude";
        assert_eq!(
            with("1e0", "nan"),
            format!(", line 5: x of vertex 1 is NaN; {range}")
        );
        assert_eq!(
            with("1e0", "1e39"),
            format!(", line 5: x of vertex 1 is inf; {range}")
        );
        let cut = TEXT.rsplit_once("endloop").unwrap().0;
        assert_eq!(
            read_bytes(cut.as_bytes()).unwrap_err(),
            ", line 17: ends too early: \"endloop\" is missing"
        );
        assert_eq!(
            read_bytes(b"solid\nendsolid\n").unwrap_err(),
            ": holds no vertices"
        );
    }

    #[test]
    fn the_last_solid_may_end_otherwise() {
        let whole = read_bytes(TEXT.as_bytes()).unwrap();
        let (start, _) = TEXT.rsplit_once("endsolid").unwrap();
        for (text, is_noted) in [
            (TEXT.to_owned(), false),
            (TEXT.replace("endsolid", "end solid"), true),
            (format!("{start}END Solid two words"), true),
            (start.to_owned(), true),
        ] {
            let mut frame = read_bytes(text.as_bytes()).unwrap();
            assert_eq!(frame.positions(), whole.positions());
            let notes = frame.shape_polygons().unwrap();
            assert_eq!(notes.len(), usize::from(is_noted), "{text}");
        }
        for wrong in ["end", "end loop", "ending solid"] {
            let refused = read_bytes(format!("{start}{wrong}\n").as_bytes()).unwrap_err();
            assert!(refused.starts_with(", line 19: expected"), "{refused}");
        }
        let nothing = read_bytes(b"solid\n").unwrap_err();
        assert!(nothing.contains("\"endsolid\" is missing"), "{nothing}");
    }

    #[test]
    fn errors_name_the_byte() {
        let mut corners = TWO;
        corners[1][2][1] = f32::NAN;
        let nan = read_bytes(&binary("solid", &corners)).unwrap_err();
        assert!(nan.starts_with(", byte 170: y of vertex 5 is NaN"), "{nan}");
        let whole = binary("solid", &TWO);
        // The zeros of the count show that it is no text.
        for end in [84, 85, 183] {
            assert_eq!(
                read_bytes(&whole[..end]).unwrap_err(),
                format!(
                    ", byte 80: ends too early: 2 triangles need 184 bytes, the file has {end}"
                )
            );
        }
        // Further bytes are passed over, whatever the beginning of the file. Whole triangles are an
        // error: the count may be wrong.
        for start in ["solid", "COLOR="] {
            for more in [1, 49, 51, 1000 - 1] {
                let longer = [binary(start, &TWO), vec![7; more]].concat();
                let longer = read_bytes(&longer).unwrap();
                assert_eq!(longer.positions(), read_bytes(&whole).unwrap().positions());
            }
        }
        for more in [1, 3] {
            let longer = [&whole[..], &vec![0; 50 * more]].concat();
            let said = read_bytes(&longer).unwrap_err();
            let words = format!(
                "the header counts 2 triangles, but {} bytes follow it, enough for {}",
                100 + 50 * more,
                2 + more
            );
            assert!(said.ends_with(&words), "{said}");
        }
        assert!(
            read_bytes(&[0; 30])
                .unwrap_err()
                .contains("has 84 bytes before")
        );
        assert_eq!(
            read_bytes(&binary("", &[])).unwrap_err(),
            ": holds no vertices"
        );
        assert_eq!(read_bytes(b"").unwrap_err(), ": is empty");
        // Announced and present at first, but gone later.
        let mut frame = Frame::new(1 << 20, true);
        let fault = read(&whole[..140], 184, &mut frame).unwrap_err();
        assert_eq!(fault.place, Place::Byte(134));
    }
}
